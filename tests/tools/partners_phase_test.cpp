// The time between the reports of one tick by two partners, by the time stamps of DDS alone.
//
// A longer measurement: CLEARANCE_PHASE_SECONDS=60 CLEARANCE_KILLS_RATE=1000
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <utility>
#include <vector>

#include "tests/tools/running_partners.hpp"

namespace clearance {
namespace {

using test::Partners;

// A plain reader of reports. Those of one lineage and cycle are of one tick.
class WriteTimes {
 public:
  WriteTimes(Participant& participant, const Cell& cell)
      : reader_(participant.reader(TopicKind::kDistances, cell.topics.distances, 4096)) {}

  void take() {
    void* pointer = &*sample_;
    dds_sample_info_t info;
    while (dds_take(reader_, &pointer, &info, 1, 1) > 0) {
      if (!info.valid_data) continue;
      const auto tick = std::pair(sample_->lineage, sample_->cycle);
      const auto [first, is_new] =
          waiting_.emplace(tick, std::pair(sample_->daemon, info.source_timestamp));
      if (is_new || first->second.first == sample_->daemon) continue;
      apart_us.push_back(
          1e-3 * std::abs(static_cast<double>(info.source_timestamp - first->second.second)));
      waiting_.erase(first);
    }
  }

  std::vector<double> apart_us;

 private:
  dds_entity_t reader_;
  Sample<clearance_msg_Distances> sample_;
  std::map<std::pair<std::uint64_t, std::uint64_t>, std::pair<std::uint64_t, std::int64_t>>
      waiting_;
};

TEST_F(Partners, WriteTheirReportsOfOneTickTogether) {
  const auto seconds = static_cast<std::int64_t>(test::number_of("CLEARANCE_PHASE_SECONDS", 2));
  start("left");
  ASSERT_TRUE(read_until([this] { return came > 20; })) << logs();
  start("right");
  ASSERT_TRUE(agree()) << logs();
  WriteTimes times(connection.participant(), cell);
  const std::int64_t begin = dds_time();
  const std::uint64_t before = came;
  read_until(
      [&] {
        times.take();
        return dds_time() - begin > seconds * 1'000'000'000;
      },
      static_cast<int>(seconds) + 1);
  std::vector<double>& apart_us = times.apart_us;
  // Most reports that were merged have two writers if the machine keeps the rate.
  ASSERT_GT(apart_us.size(), ran_over() ? 0 : (came - before) / 2) << logs();
  std::ranges::sort(apart_us);
  const auto at = [&apart_us](double share) {
    return apart_us[static_cast<std::size_t>(share * static_cast<double>(apart_us.size() - 1))];
  };
  std::printf(
      "%zu ticks of both, %llu reports merged; written apart by p50 %.0f us, p99 %.0f us, "
      "p99.9 %.0f us, at most %.0f us\n",
      apart_us.size(), static_cast<unsigned long long>(came - before), at(0.5), at(0.99), at(0.999),
      apart_us.back());
}

}  // namespace
}  // namespace clearance
