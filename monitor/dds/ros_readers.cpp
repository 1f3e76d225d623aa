#include "monitor/dds/ros_readers.hpp"

#include <algorithm>
#include <utility>

#include "monitor/app/log_line.hpp"

namespace clearance {

RosReaders::~RosReaders() {
  for (const Reader& reader : readers_) dds_delete(reader.handle);
  for (const auto& [topic, handle] : standing_) {
    if (handle > 0) dds_delete(handle);
  }
}

void RosReaders::stand() {
  has_new_names_ = true;
  for (const NamedTopic& named : intake_.named()) {
    const std::string topic = ros_dds_name(named.name);
    const auto [place, is_new] =
        standing_.try_emplace({topic, named.delivery->descriptor, named.delivery->is_latched}, 0);
    try {
      if (is_new) place->second = participant_.ros_reader(*named.delivery, topic);
    } catch (const DdsError& error) {
      log_line(lines::kInputsFailed, error.what());
    }
  }
}

// Readers for another type or delivery of the topic are deleted: ROS 2's tools refuse a topic of
// two types.
dds_entity_t RosReaders::reader_of(const RosType& delivery, const std::string& topic) {
  const Standing wanted{topic, delivery.descriptor, delivery.is_latched};
  dds_entity_t reader = 0;
  for (auto& [standing, handle] : standing_) {
    if (handle <= 0 || std::get<0>(standing) != topic) continue;
    const dds_entity_t stood = std::exchange(handle, 0);
    if (standing == wanted) {
      reader = stood;
    } else {
      dds_delete(stood);
    }
  }
  return reader > 0 ? reader : participant_.ros_reader(delivery, topic);
}

bool RosReaders::poll() {
  const bool has_new_names = std::exchange(has_new_names_, false);
  if (!present_.poll() && !has_new_names) return false;
  for (const auto& [handle, writer] : present_.writers()) {
    const TopicName name = as_in_ros(writer.topic, writer.type);
    const auto wanted = intake_.topic(name);
    if (!wanted || wanted->delivery == nullptr) continue;
    const bool is_latched = wanted->delivery->may_be_latched && writer.is_latched;
    const auto is_there = [&](const Reader& reader) {
      return reader.topic == wanted->number && reader.is_latched == is_latched;
    };
    if (std::ranges::any_of(readers_, is_there)) continue;
    RosType delivery = *wanted->delivery;
    if (is_latched) delivery.is_latched = delivery.is_reliable = true;
    readers_.push_back({reader_of(delivery, writer.topic), wanted->number, is_latched});
  }
  return true;
}

std::vector<std::uint64_t> RosReaders::writers() const {
  std::vector<std::uint64_t> writers;
  for (const auto& [handle, writer] : present_.writers()) writers.push_back(handle);
  return writers;
}

bool RosReaders::is_read_by_other(const Reader& reader, std::uint64_t writer) const {
  const auto of_writer = present_.writers().find(writer);
  if (of_writer == present_.writers().end() || !of_writer->second.is_latched) return false;
  return std::ranges::any_of(readers_, [&](const Reader& other) {
    return other.topic == reader.topic && other.is_latched;
  });
}

void RosReaders::take(const Reader& reader, const Now& now, std::vector<CdrSample>& taken) {
  const bool is_one_of_two =
      !reader.is_latched && std::ranges::count(readers_, reader.topic, &Reader::topic) > 1;
  if (!is_one_of_two) return take_into(intake_, reader.topic, reader.handle, now, taken);
  take_into(intake_, reader.topic, reader.handle, now, taken, nullptr,
            [&](std::uint64_t writer) { return !is_read_by_other(reader, writer); });
}

// A sample without a time of sending counts as sent now.
void take_into(Intake& intake, std::uint32_t topic, dds_entity_t reader, const Now& now,
               std::vector<CdrSample>& taken, std::vector<std::uint64_t>* ended,
               const std::function<bool(std::uint64_t writer)>& counts) {
  std::size_t count = kMostAtOnce;
  while (count == kMostAtOnce) {
    count = take_cdr(reader, taken, ended);
    for (const CdrSample& sample : taken) {
      if (counts && !counts(sample.writer())) continue;
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
