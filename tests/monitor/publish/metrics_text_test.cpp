// Every figure of a daemon comes through as Prometheus' own reader understands it.
#include "monitor/publish/metrics_text.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "monitor/wire/dds_sample.hpp"
#include "tests/monitor/publish/metrics_client.hpp"
#include "tests/shared/random.hpp"

namespace clearance {
namespace {

class MetricsText : public testing::Test {
 protected:
  MetricsText() {
    scene.name = "cell \"A\"\\\n";
    scene.revision = health->scene_revision = 0xab;
    scene.zones.resize(2);
    scene.zones[0].name = "slow";
    scene.zones[1].name = "stop";
    health->cycle = 2000;
    health->now_ns = 1'500'000'000;
    health->overruns = 3;
    health->skipped_cycles = 4;
    health->dropped_reports = 5;
    health->undecodable_samples = 6;
    reserve_sequence(health->inputs, 2);
    health->inputs._length = 2;
    fill(health->inputs._buffer[0], "cart", 2'000'000, false, "tracker");
    fill(health->inputs._buffer[1], "a, b", -1, true, "");
    reserve_sequence(health->joints, 1);
    health->joints._length = 1;
    fill(health->joints._buffer[0], "elbow", 3'000'000, true, "driver");
    reserve_sequence(health->rejected, 1);
    health->rejected._length = 1;
    health->rejected._buffer[0] = {dds_string_dup("cart"), dds_string_dup("too fast"), 7,
                                   dds_string_dup("")};
    reserve_sequence(health->sources, 1);
    health->sources._length = 1;
    std::strcpy(health->sources._buffer[0].source, "tracker");
    health->sources._buffer[0].batches = 8;
    health->sources._buffer[0].lost_batches = 9;
  }
  template <class Input>
  static void fill(Input& input, const char* name, std::int64_t age_ns, bool stale,
                   const char* source) {
    input = {};
    input.name = dds_string_dup(name);
    input.age_ns = age_ns;
    input.stale = stale;
    std::strcpy(input.source, source);
  }
  std::map<std::string, double> read() {
    return test::read_metrics(
        metrics_text({.scene = scene,
                      .health = *health,
                      .report = report,
                      .is_active = [](std::uint32_t zone) { return zone == 1; },
                      .statistics = statistics}));
  }

  Scene scene;
  Sample<clearance_msg_Health> health;
  const clearance_msg_Distances* report = nullptr;
  const LoopStatistics* statistics = nullptr;
};

TEST_F(MetricsText, HasEveryFigureOfTheHealth) {
  auto read = this->read();
  EXPECT_EQ(read["clearance_ticks_total"], 2000.0);
  EXPECT_EQ(read["clearance_time_seconds"], 1.5);
  EXPECT_EQ(read["clearance_overruns_total"], 3.0);
  EXPECT_EQ(read["clearance_skipped_cycles_total"], 4.0);
  EXPECT_EQ(read["clearance_dropped_reports_total"], 5.0);
  EXPECT_EQ(read["clearance_undecodable_samples_total"], 6.0);
  EXPECT_EQ(read["clearance_refused_total cause=too fast input=cart"], 7.0);
  EXPECT_EQ(read["clearance_batches_total source=tracker"], 8.0);
  EXPECT_EQ(read["clearance_lost_batches_total source=tracker"], 9.0);
  EXPECT_EQ(read["clearance_input_age_seconds input=cart source=tracker"], 0.002);
  EXPECT_EQ(read["clearance_input_age_seconds input=joint elbow source=driver"], 0.003);
  EXPECT_FALSE(read.contains("clearance_input_age_seconds input=a, b source=")) << "never came";
  EXPECT_EQ(read["clearance_input_usable input=cart"], 1.0);
  EXPECT_EQ(read["clearance_input_usable input=joint elbow"], 0.0);
  EXPECT_EQ(read["clearance_input_usable input=a, b"], 0.0);
  EXPECT_EQ(read["clearance_zone_active zone=slow"], 0.0);
  EXPECT_EQ(read["clearance_zone_active zone=stop"], 1.0);
  bool is_named = false;
  for (const auto& [name, value] : read) {
    is_named |= name.starts_with("clearance_info") &&
                name.find("cell=cell \"A\"\\\n revision=00000000000000ab") != std::string::npos;
    EXPECT_FALSE(name.starts_with("clearance_minimum") || name.starts_with("clearance_tick_"))
        << name << ": not known yet";
  }
  EXPECT_TRUE(is_named);
}

TEST_F(MetricsText, HasTheMinimumWithItsBoundsWhereItIsKnown) {
  Sample<clearance_msg_Distances> last;
  last->minimum_certified = true;
  last->pairs_total = 10;
  last->unknown = 2;
  report = &*last;
  auto unknown = read();
  EXPECT_FALSE(unknown.contains("clearance_minimum_distance_meters bound=lower"));
  EXPECT_EQ(unknown["clearance_pairs state=unknown"], 2.0);
  last->minimum_known = true;
  last->minimum.distance = -0.25;
  last->minimum.lower = -0.5;
  last->minimum.upper = 0.125;
  auto known = read();
  EXPECT_EQ(known["clearance_minimum_distance_meters bound=distance"], -0.25);
  EXPECT_EQ(known["clearance_minimum_distance_meters bound=lower"], -0.5);
  EXPECT_EQ(known["clearance_minimum_distance_meters bound=upper"], 0.125);
  EXPECT_EQ(known["clearance_minimum_certified"], 1.0);
}

// Oracle: the values themselves. A bin is at most 1/64 wide.
TEST_F(MetricsText, HasHistogramsWhoseBucketsHoldTheValues) {
  LoopStatistics loop;
  Random random(33);
  std::vector<double> values;
  double sum = 0.0;
  for (int i = 0; i < 5000; ++i) {
    const double seconds = 1e-6 * std::pow(10.0, random.uniform(0.0, 5.0));
    values.push_back(seconds);
    sum += seconds;
    loop.tick.add(static_cast<std::int64_t>(1e9 * seconds));
  }
  statistics = &loop;
  auto read = this->read();
  EXPECT_EQ(read["clearance_tick_seconds_count"], 5000.0);
  EXPECT_EQ(read["clearance_tick_seconds_bucket le=+Inf"], 5000.0);
  EXPECT_EQ(read["clearance_wakeup_delay_seconds_count"], 0.0);
  EXPECT_NEAR(read["clearance_tick_seconds_sum"], sum, sum / 64);
  int buckets = 0;
  for (const auto& [name, count] : read) {
    const std::string prefix = "clearance_tick_seconds_bucket le=";
    if (!name.starts_with(prefix) || name.ends_with("Inf")) continue;
    ++buckets;
    const double le = std::stod(name.substr(prefix.size()));
    const auto up_to = [&](double most) {
      return static_cast<double>(
          std::ranges::count_if(values, [&](double v) { return v <= most; }));
    };
    EXPECT_LE(count, up_to(le)) << name;
    EXPECT_GE(count, up_to(le * 63 / 64 - 1e-9)) << name;
  }
  EXPECT_GE(buckets, 10);
}

}  // namespace
}  // namespace clearance
