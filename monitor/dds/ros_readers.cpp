#include "monitor/dds/ros_readers.hpp"

#include <algorithm>

namespace clearance {

RosReaders::~RosReaders() {
  for (const Reader& reader : readers_) dds_delete(reader.handle);
}

bool RosReaders::look() {
  if (!present_.look()) return false;
  for (const auto& [handle, writer] : present_.writers()) {
    const TopicName name = as_in_ros(writer.topic, writer.type);
    const auto wanted = intake_.topic(name);
    if (!wanted || wanted->delivery == nullptr) continue;
    if (std::ranges::find(readers_, wanted->number, &Reader::topic) != readers_.end()) continue;
    readers_.push_back({participant_.ros_reader(*wanted->delivery, writer.topic), wanted->number});
  }
  return true;
}

std::vector<std::uint64_t> RosReaders::writers() const {
  std::vector<std::uint64_t> writers;
  for (const auto& [handle, writer] : present_.writers()) writers.push_back(handle);
  return writers;
}

// A sample without a time of sending counts as sent now.
void take_into(Intake& intake, std::uint32_t topic, dds_entity_t reader, const Now& now,
               std::vector<CdrSample>& taken, std::vector<std::uint64_t>* ended) {
  std::size_t count = kMostAtOnce;
  while (count == kMostAtOnce) {
    count = take_cdr(reader, taken, ended);
    for (const CdrSample& sample : taken) {
      intake.take({.topic = topic,
                   .cdr = sample.bytes(),
                   .sent_ns = sample.source_ns() > 0 ? sample.source_ns() : now.realtime_ns,
                   .writer = sample.writer(),
                   .bytes = CdrBytes::kOfReader},
                  now);
    }
    taken.clear();
  }
}

}  // namespace clearance
