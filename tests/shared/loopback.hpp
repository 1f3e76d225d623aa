// DDS for tests: on the loopback interface, and separated from every other test run on this
// machine.
#pragma once

#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "monitor/participant/participant.hpp"
#include "tests/shared/eventually.hpp"

namespace clearance::test {

// Returns a new domain and a new partition at every call. Domains repeat, because there are few;
// partitions do not. Domains below 100 avoid the ports that the kernel assigns.
[[nodiscard]] inline DdsOptions own_dds() {
  static std::atomic<int> calls{0};
  const auto pid = static_cast<std::uint32_t>(getpid());
  DdsOptions dds;
  dds.domain = 1 + pid % 99;
  dds.interface = "lo";
  dds.partition = "test-" + std::to_string(pid) + "-" + std::to_string(++calls);
  return dds;
}

[[nodiscard]] inline std::uint32_t matched_readers(dds_entity_t writer) {
  dds_publication_matched_status_t status{};
  dds_get_publication_matched_status(writer, &status);
  return status.current_count;
}

[[nodiscard]] inline std::uint32_t matched_writers(dds_entity_t reader) {
  dds_subscription_matched_status_t status{};
  dds_get_subscription_matched_status(reader, &status);
  return status.current_count;
}

// The types of the readers in a partition by topic, as 'ros2 topic info' knows them.
[[nodiscard]] inline std::map<std::string, std::set<std::string>> types_read(
    const Participant& participant, const std::string& partition) {
  const dds_entity_t reader =
      dds_create_reader(participant.handle(), DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION, nullptr, nullptr);
  std::map<std::string, std::set<std::string>> types;
  std::array<void*, 256> samples{};
  std::array<dds_sample_info_t, 256> infos{};
  const dds_return_t count = dds_take(reader, samples.data(), infos.data(), 256, 256);
  for (std::size_t i = 0; i < static_cast<std::size_t>(std::max(count, 0)); ++i) {
    if (!infos[i].valid_data) continue;
    const auto& endpoint = *static_cast<const dds_builtintopic_endpoint_t*>(samples[i]);
    std::uint32_t partitions = 0;
    char** names = nullptr;
    if (!dds_qget_partition(endpoint.qos, &partitions, &names)) continue;
    if (partitions == 1 && names[0] == partition)
      types[endpoint.topic_name].insert(endpoint.type_name);
    for (std::uint32_t each = 0; each < partitions; ++each) dds_free(names[each]);
    dds_free(names);
  }
  if (count > 0) dds_return_loan(reader, samples.data(), count);
  dds_delete(reader);
  return types;
}

// Waits until all these topics have readers in a partition.
[[nodiscard]] inline bool have_readers(const Participant& participant, const std::string& partition,
                                       const std::vector<std::string>& topics) {
  return eventually([&] {
    const auto types = types_read(participant, partition);
    return std::ranges::all_of(topics, [&](const auto& topic) { return types.contains(topic); });
  });
}

}  // namespace clearance::test
