#include "monitor/dds/partner_frames.hpp"

#include <utility>

#include "monitor/app/log_line.hpp"
#include "monitor/participant/wire_values.hpp"

namespace clearance {
namespace {

constexpr std::int64_t kSilentNs = 500'000'000;

}  // namespace

PartnerFrames::PartnerFrames(Participant& participant, const Topics& topics,
                             const DaemonIdentity& identity, const TickPartner& ticks)
    : identity_(identity),
      ticks_(ticks),
      writer_(participant.writer(TopicKind::kPartnerFrames, topics.partner_frames)),
      reader_(participant.partner_reader(TopicKind::kPartnerFrames, topics.partner_frames)) {}

void PartnerFrames::send(const BuiltFrame& frame, std::uint64_t content) {
  Sample<clearance_msg_PartnerFrame> sample;
  Sample<clearance_msg_SensorFrame> built = to_wire(frame, 0, true);
  std::swap(sample->frame, *built);
  write(sample, frame.sensor, content);
}

void PartnerFrames::answer(std::uint32_t sensor, std::uint64_t content) {
  Sample<clearance_msg_PartnerFrame> sample;
  sample->is_answer = true;
  write(sample, sensor, content);
}

void PartnerFrames::write(Sample<clearance_msg_PartnerFrame>& sample, std::uint32_t sensor,
                          std::uint64_t content) {
  copy_text(identity_.partner, sample->partner);
  sample->sensor = sensor;
  sample->daemon = identity_.id;
  sample->content = content;
  const dds_return_t result = dds_write(writer_, &*sample);
  if (result != DDS_RETCODE_OK)
    log_line(lines::kWriteFailed, "a frame for the partner", dds_strretcode(result),
             lines::Count{1});
}

void PartnerFrames::take(std::int64_t now_ns, const Answered& answered, const Sent& sent) {
  void* pointer = &*heard_;
  dds_sample_info_t info;
  while (dds_take(reader_, &pointer, &info, 1, 1) > 0) {
    if (!info.valid_data) continue;
    if (heard_->is_answer) {
      answered(heard_->sensor, heard_->content);
    } else {
      heard_ns_ = now_ns;
      sent(from_wire(heard_->frame), heard_->content);
    }
  }
}

bool PartnerFrames::builds_its_own(std::int64_t now_ns) const noexcept {
  const PartnerStanding standing = ticks_.standing();
  if (standing == PartnerStanding::kLeading) return true;
  const bool hears_frames = heard_ns_ != 0 && now_ns - heard_ns_ < kSilentNs;
  return standing != PartnerStanding::kFollowing && !hears_frames;
}

}  // namespace clearance
