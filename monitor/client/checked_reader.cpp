#include "monitor/client/checked_reader.hpp"

#include <fmt/format.h>

#include "monitor/client/report_judge.hpp"
#include "monitor/participant/participant.hpp"
#include "monitor/wire/report_checksum.hpp"

namespace clearance::client {

CheckedReader::CheckedReader(Participant& participant, TopicKind kind, const std::string& topic,
                             bool of_several)
    : entity_(of_several ? participant.reader_of_several(kind, topic)
                         : participant.reader(kind, topic)),
      address_(participant.address(topic)),
      refused_{.topic = topic} {}

template <class Message>
bool CheckedReader::take(Message& message, dds_sample_info_t& info, bool keys_too) {
  void* pointer = &message;
  while (dds_take(entity_, &pointer, &info, 1, 1) > 0) {
    if (!info.valid_data && keys_too) return true;
    if (!info.valid_data) continue;
    const ReportError error = delivery_error(message, address_);
    if (error == ReportError::kGood) return true;
    ++refused_.count;
    refused_.last = error;
  }
  return false;
}

template bool CheckedReader::take(clearance_msg_Catalogue&, dds_sample_info_t&, bool);
template bool CheckedReader::take(clearance_msg_ZoneState&, dds_sample_info_t&, bool);
template bool CheckedReader::take(clearance_msg_Health&, dds_sample_info_t&, bool);
template bool CheckedReader::take(clearance_msg_CommandResult&, dds_sample_info_t&, bool);
template bool CheckedReader::take(clearance_msg_Answer&, dds_sample_info_t&, bool);

std::string text_of(const std::vector<RefusedMessages>& topics) {
  std::string text;
  for (const RefusedMessages& refused : topics) {
    if (refused.count == 0) continue;
    const bool is_one = refused.count == 1;
    text += fmt::format("{}{} message{} of {} {} refused, the last one as {}",
                        text.empty() ? "" : "; ", refused.count, is_one ? "" : "s", refused.topic,
                        is_one ? "was" : "were", name(refused.last));
  }
  return text;
}

}  // namespace clearance::client
