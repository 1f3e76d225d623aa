// Joins the messages of the daemons of a cell's shares. The oracle is a list of all pairs of all
// shares: the least of their true distances, and which of them are known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "core/convex_body.hpp"
#include "monitor/client/complete_reports.hpp"
#include "monitor/client/share_merge.hpp"
#include "monitor/interface/report.hpp"
#include "monitor/wire/convert.hpp"
#include "monitor/wire/dds_sample.hpp"
#include "tests/config/cells.hpp"
#include "tests/shared/random.hpp"

namespace clearance::client {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

// Six balls that are all watched, in three shares, with a zone of the first two shares and one of
// the last.
Cell balls() {
  std::string objects = "objects:\n";
  for (const char* name : {"a", "b", "c", "d", "e", "f"}) {
    objects += std::string("  - {name: ") + name + ", groups: [all, " +
               (*name < 'd' ? "first" : "last") + "], sphere: {radius: 0.1}}\n";
  }
  return read_good(
      cell_text(objects + "pairs: [{between: [all, all]}]\n"
                          "zones:\n"
                          "  - {name: wide, between: [all, all], enter_below: 1, leave_above: 1}\n"
                          "  - {name: far, between: [last, last], enter_below: 1, leave_above: 1}\n"
                          "shares:\n"
                          "  - {name: one, pairs: [{between: [first, first]}]}\n"
                          "  - {name: two, pairs: [{between: [first, last]}]}\n"
                          "  - {name: three, pairs: [{between: [last, last]}]}\n"));
}

struct Shares {
  Cell cell = balls();
  Sample<clearance_msg_Catalogue> catalogue = make_catalogue(cell);
  ShareMap map{*catalogue};
  std::vector<Sample<clearance_msg_Distances>> reports{3};
  std::vector<ShareView> views{3};
  Sample<clearance_msg_Distances> joined;

  // A report of every share by the bounds of each pair of the whole cell. All are evaluated.
  explicit Shares(const std::vector<std::pair<double, double>>& bounds) {
    for (std::size_t share = 0; share < 3; ++share) {
      clearance_msg_Distances& report = *reports[share];
      const auto& pairs = cell.shares.all[share].pairs;
      reserve_sequence(report.pairs, pairs.size());
      report.cycle = 10 * (share + 1);
      report.now_ns = report.publish_ns = 1000 * static_cast<std::int64_t>(share + 1);
      report.pairs_total = report.evaluated = static_cast<std::uint32_t>(pairs.size());
      report.lower_all = kNone;
      report.minimum_known = report.minimum_certified = true;
      for (const std::uint32_t pair : pairs) {
        clearance_msg_PairDistance& to = report.pairs._buffer[report.pairs._length++];
        to = {};
        to.pair = pair;
        to.lower = to.swept_lower = bounds[pair].first;
        to.distance = to.upper = bounds[pair].second;
        report.lower_all = std::min(report.lower_all, to.lower);
        if (report.pairs._length == 1 || to.upper < report.minimum.upper) report.minimum = to;
      }
      report.swept_lower_all = report.lower_all;
      views[share] = {ShareState::kWhole, &report, nullptr};
    }
  }
  const clearance_msg_Distances& join() {
    join_reports(map, views, *joined);
    return *joined;
  }
};

std::vector<std::pair<double, double>> random_bounds(Random& random) {
  std::vector<std::pair<double, double>> bounds;
  for (int pair = 0; pair < 15; ++pair) {
    const double distance = random.uniform(0.1, 2.0);
    bounds.emplace_back(distance - 1e-9, distance);
  }
  return bounds;
}

TEST(ShareMerge, TheWholeHasEveryPairOnceAndTheLeastOfAll) {
  Random random(34);
  for (int trial = 0; trial < 100; ++trial) {
    const auto bounds = random_bounds(random);
    Shares shares(bounds);
    const clearance_msg_Distances& whole = shares.join();
    ASSERT_EQ(whole.pairs._length, bounds.size());
    std::size_t least = 0;
    for (std::uint32_t pair = 0; pair < bounds.size(); ++pair) {
      EXPECT_EQ(whole.pairs._buffer[pair].pair, pair);
      EXPECT_EQ(whole.pairs._buffer[pair].lower, bounds[pair].first);
      if (bounds[pair].second < bounds[least].second) least = pair;
    }
    EXPECT_TRUE(whole.minimum_known && whole.minimum_certified);
    EXPECT_EQ(whole.minimum.pair, least);
    EXPECT_EQ(whole.lower_all, bounds[least].first);
    EXPECT_EQ(whole.pairs_total, bounds.size());
    EXPECT_EQ(whole.evaluated, bounds.size());
    EXPECT_EQ(whole.publish_ns, 1000) << "it is as old as its oldest share";
    EXPECT_EQ(whole.scene_revision, shares.cell.scene.revision);
  }
}

TEST(ShareMerge, HiddenPlacesOfAllSharesComeInTheOrderOfPairs) {
  Random random(36);
  Shares shares(random_bounds(random));
  for (std::size_t share = 0; share < 3; ++share) {
    auto& hidden = shares.reports[share]->hidden;
    const auto& pairs = shares.cell.shares.all[share].pairs;
    reserve_sequence(hidden, pairs.size());
    for (const std::uint32_t pair : pairs) {
      clearance_msg_HiddenState& place = hidden._buffer[hidden._length++];
      place = {};
      place.pair = pair;
      place.thickness = 0.01 * pair;
    }
  }
  const clearance_msg_Distances& whole = shares.join();
  ASSERT_EQ(whole.hidden._length, 15u);
  for (std::uint32_t pair = 0; pair < 15; ++pair) {
    EXPECT_EQ(whole.hidden._buffer[pair].pair, pair);
    EXPECT_EQ(whole.hidden._buffer[pair].thickness, 0.01 * pair);
  }
  shares.views[1].state = ShareState::kLate;
  EXPECT_EQ(shares.join().hidden._length, 15u - shares.cell.shares.all[1].pairs.size());
}

// Whatever is missing, each pair has a true lower bound or none, and nothing is certified.
TEST(ShareMerge, AShareThatIsNotWholeIsUnknownByNameAndNeverClear) {
  Random random(35);
  for (const auto state : {ShareState::kMissing, ShareState::kLate, ShareState::kOtherRevision}) {
    for (std::size_t lost = 0; lost < 3; ++lost) {
      Shares shares(random_bounds(random));
      shares.views[lost].state = state;
      const clearance_msg_Distances& whole = shares.join();
      EXPECT_FALSE(whole.minimum_certified);
      EXPECT_EQ(whole.lower_all, -kNone);
      EXPECT_EQ(whole.swept_lower_all, -kNone);
      const std::vector<std::uint32_t>& pairs = shares.cell.shares.all[lost].pairs;
      EXPECT_EQ(whole.unknown, pairs.size());
      EXPECT_EQ(whole.pairs_total, 15u);
      for (std::uint32_t i = 0; i < whole.pairs._length; ++i) {
        const clearance_msg_PairDistance& pair = whole.pairs._buffer[i];
        const bool is_lost = std::ranges::binary_search(pairs, pair.pair);
        EXPECT_EQ(pair.status == static_cast<std::uint8_t>(PairStatus::kUnknown), is_lost);
        if (is_lost) {
          EXPECT_EQ(pair.lower, -kNone);
          EXPECT_TRUE(std::isnan(pair.distance));
        }
      }
    }
  }
}

TEST(ShareMerge, WithoutAnyShareEverythingIsUnknown) {
  Shares shares(std::vector<std::pair<double, double>>(15, {1.0, 1.0}));
  for (ShareView& view : shares.views) view = {};
  const clearance_msg_Distances& whole = shares.join();
  EXPECT_EQ(whole.unknown, 15u);
  EXPECT_FALSE(whole.minimum_known);
  EXPECT_EQ(whole.lower_all, -kNone);
  EXPECT_EQ(whole.pairs._length, 15u);
}

// The least upper bound is another share's, but the pair may be nearer all the same.
TEST(ShareMerge, AWideMinimumOfAShareMayBeNearerThanTheLeastOfAll) {
  std::vector<std::pair<double, double>> bounds(15, {1.0, 1.0});
  const Shares of_pairs(bounds);
  const std::uint32_t first = of_pairs.cell.shares.all[0].pairs.front(),
                      second = of_pairs.cell.shares.all[1].pairs.front();
  bounds[first] = {0.5, 0.5};
  bounds[second] = {0.6, 0.8};
  EXPECT_TRUE(Shares(bounds).join().minimum_certified) << "all of it is farther";
  bounds[second] = {0.4, 0.8};
  EXPECT_FALSE(Shares(bounds).join().minimum_certified);
  bounds[first] = {0.3, 0.5};
  bounds[second] = {0.5, 0.8};
  EXPECT_TRUE(Shares(bounds).join().minimum_certified) << "the least itself may be wide";
}

// A share without a certified minimum may hold a nearer pair, unless all its bounds are beyond.
TEST(ShareMerge, TheMinimumIsCertifiedOnlyIfNoOtherShareCanHaveANearerPair) {
  std::vector<std::pair<double, double>> bounds(15, {1.0, 1.0});
  const Cell cell = balls();
  const std::uint32_t near = cell.shares.all[0].pairs[1];
  bounds[near] = {0.5, 0.5};
  Shares shares(bounds);
  shares.reports[2]->minimum_certified = false;
  EXPECT_TRUE(shares.join().minimum_certified);
  shares.reports[2]->lower_all = 0.4;
  EXPECT_FALSE(shares.join().minimum_certified);
  EXPECT_EQ(shares.join().minimum.pair, near);
}

// A carried pair is the nearest of its share by its upper bound, and may be nearer than that.
TEST(ShareMerge, ALooseMinimumOfAShareMayBeNearerThanThatOfTheWhole) {
  std::vector<std::pair<double, double>> bounds(15, {2.0, 2.0});
  const Cell cell = balls();
  const std::uint32_t near = cell.shares.all[0].pairs[0], loose = cell.shares.all[1].pairs[0];
  bounds[near] = {1.0, 1.0};
  bounds[loose] = {0.5, 1.1};
  Shares shares(bounds);
  shares.reports[1]->minimum.status = static_cast<std::uint8_t>(PairStatus::kCarried);
  EXPECT_EQ(shares.join().minimum.pair, near);
  EXPECT_FALSE(shares.join().minimum_certified);
}

// A pair that a report leaves out is not clear.
TEST(ShareMerge, APublishedPairThatItsShareDoesNotReportIsUnknown) {
  Shares shares(std::vector<std::pair<double, double>>(15, {1.0, 1.0}));
  shares.reports[1]->pairs._length -= 1;
  const clearance_msg_Distances& whole = shares.join();
  EXPECT_EQ(std::ranges::count(std::span(whole.pairs._buffer, whole.pairs._length),
                               static_cast<std::uint8_t>(PairStatus::kUnknown),
                               &clearance_msg_PairDistance::status),
            1);
}

clearance_msg_ZoneState zone_state(bool active, double clearance) {
  clearance_msg_ZoneState state{};
  std::strcpy(state.name, "wide");
  state.active = active;
  state.certified = true;
  state.cause = active ? 1 : 0;
  state.clearance = state.swept_clearance = clearance;
  return state;
}

TEST(ShareMerge, AZoneIsActiveIfItIsInOneShareOrIfAShareOfItIsNotHeard) {
  const Shares shares(std::vector<std::pair<double, double>>(15, {1.0, 1.0}));
  const clearance_msg_ZoneState clear = zone_state(false, 2.0), nearer = zone_state(false, 1.5),
                                active = zone_state(true, 0.5);
  const auto joined = [&](std::uint32_t zone, std::vector<const clearance_msg_ZoneState*> states) {
    return join_zone(shares.map, zone, states);
  };
  EXPECT_FALSE(joined(0, {&clear, &nearer, &clear}).active);
  EXPECT_EQ(joined(0, {&clear, &nearer, &clear}).clearance, 1.5);
  EXPECT_TRUE(joined(0, {&clear, &active, &clear}).active);
  EXPECT_EQ(joined(0, {&clear, &active, &clear}).clearance, 0.5);
  const clearance_msg_ZoneState unknown = joined(0, {&clear, nullptr, &clear});
  EXPECT_TRUE(unknown.active);
  EXPECT_FALSE(unknown.certified);
  EXPECT_EQ(unknown.cause, static_cast<std::uint8_t>(ZoneCause::kNoShare));
  EXPECT_EQ(unknown.pair, shares.cell.shares.all[1].pairs.front());
  EXPECT_FALSE(joined(1, {nullptr, nullptr, &clear}).active) << "it has pairs of one share only";
}

TEST(ShareMerge, ASeparationOfAShareThatIsNotHeardStopsTheRobot) {
  Shares shares(std::vector<std::pair<double, double>>(15, {1.0, 1.0}));
  auto& separated = shares.catalogue->separated_zones;
  separated._buffer[separated._length++] = 0;
  shares.map = ShareMap(*shares.catalogue);
  std::vector<Sample<clearance_msg_Separation>> of(3);
  for (std::size_t share = 0; share < 3; ++share) {
    reserve_sequence(of[share]->zones, 1);
    of[share]->zones._buffer[of[share]->zones._length++] = {
        0, 2, static_cast<std::uint32_t>(share), 1.0 - 0.1 * static_cast<double>(share), 2.0, 1.0};
    shares.views[share].separation = &*of[share];
  }
  Sample<clearance_msg_Separation> joined;
  join_separations(shares.map, shares.views, *joined);
  ASSERT_EQ(joined->zones._length, 1u);
  EXPECT_EQ(joined->zones._buffer[0].validity, 2);
  EXPECT_EQ(joined->zones._buffer[0].remaining, 0.8);
  of[0]->zones._buffer[0].scaling = 0.5;
  join_separations(shares.map, shares.views, *joined);
  EXPECT_EQ(joined->zones._buffer[0].scaling, 0.5);
  EXPECT_EQ(joined->zones._buffer[0].remaining, 0.8) << "the least of each figure";
  of[2]->zones._buffer[0].remaining = 1.2;
  join_separations(shares.map, shares.views, *joined);
  EXPECT_EQ(joined->zones._buffer[0].remaining, 0.9) << "in whichever share";
  shares.views[1].separation = nullptr;
  join_separations(shares.map, shares.views, *joined);
  EXPECT_EQ(joined->zones._buffer[0].validity, 0);
  EXPECT_EQ(joined->zones._buffer[0].scaling, 0.0);
  EXPECT_EQ(joined->zones._buffer[0].speed_limit, 0.0);
}

TEST(ShareMerge, ARobotStopsClearIfItDoesInAllShares) {
  Shares shares(std::vector<std::pair<double, double>>(15, {1.0, 1.0}));
  auto& stopping = shares.catalogue->stopping_robots;
  reserve_sequence(stopping, 1);
  stopping._buffer[stopping._length++] = 3;
  shares.map = ShareMap(*shares.catalogue);
  std::vector<Sample<clearance_msg_Separation>> of(3);
  for (std::size_t share = 0; share < 3; ++share) {
    reserve_sequence(of[share]->stops, 1);
    of[share]->stops._buffer[of[share]->stops._length++] = {.robot = 3,
                                                            .validity = 2,
                                                            .scaling = 1.0,
                                                            .clearance = 0.2,
                                                            .pair = std::uint32_t(share),
                                                            .share = 1.0,
                                                            .time = 0.3};
    shares.views[share].separation = &*of[share];
  }
  clearance_msg_RobotStop &worst = of[1]->stops._buffer[0], &late = of[2]->stops._buffer[0];
  worst.scaling = 0.4;
  worst.share = 0.6;
  late.validity = 1;
  late.clearance = 0.1;
  late.time = 0.5;
  Sample<clearance_msg_Separation> joined;
  const auto stop = [&]() -> const clearance_msg_RobotStop& {
    join_separations(shares.map, shares.views, *joined);
    return joined->stops._buffer[0];
  };
  EXPECT_EQ(stop().robot, 3u);
  EXPECT_EQ(joined->stops._length, 1u);
  EXPECT_EQ(stop().scaling, 0.4);
  EXPECT_EQ(stop().pair, 1u) << "the pair that limits it";
  EXPECT_EQ(stop().validity, 1) << "the least of each figure";
  EXPECT_EQ(stop().clearance, 0.1);
  EXPECT_EQ(stop().share, 0.6);
  EXPECT_EQ(stop().time, 0.5) << "the longest";
  shares.views[0].separation = nullptr;
  EXPECT_EQ(stop().validity, 0);
  EXPECT_EQ(stop().scaling, 0.0);
  EXPECT_EQ(stop().clearance, -kInfinity);
  shares.views[0].separation = &*of[0];
  shares.views[0].state = ShareState::kLate;
  EXPECT_EQ(stop().scaling, 0.0);
}

// The first two shares have gradients of all their pairs, the last one has none.
TEST(ShareMerge, GradientsOfAllSharesComeInTheOrderOfPairs) {
  Shares shares(std::vector<std::pair<double, double>>(15, {1.0, 1.0}));
  std::vector<Sample<clearance_msg_Gradients>> of(2);
  std::size_t first_two = 0;
  for (std::size_t share = 0; share < 2; ++share) {
    const auto& pairs = shares.cell.shares.all[share].pairs;
    first_two += pairs.size();
    reserve_sequence(of[share]->pairs, pairs.size());
    reserve_sequence(of[share]->alternatives, pairs.size());
    for (const std::uint32_t pair : pairs) {
      clearance_msg_PairGradient& to = of[share]->pairs._buffer[of[share]->pairs._length++];
      to.pair = pair;
      reserve_sequence(to.joints, 1);
      to.joints._buffer[to.joints._length++] = {pair + 1, 0.5 * pair};
      of[share]->alternatives._buffer[of[share]->alternatives._length++].farther = pair;
    }
    shares.views[share].gradients = &*of[share];
  }
  const auto joined = [&] {
    Sample<clearance_msg_Gradients> out;
    join_gradients(shares.map, shares.views, *out);
    return out;
  };
  const Sample<clearance_msg_Gradients> both = joined();
  ASSERT_EQ(both->pairs._length, first_two);
  ASSERT_EQ(both->alternatives._length, first_two);
  for (std::uint32_t i = 0; i < both->pairs._length; ++i) {
    const clearance_msg_PairGradient& pair = both->pairs._buffer[i];
    EXPECT_TRUE(i == 0 || pair.pair > both->pairs._buffer[i - 1].pair);
    ASSERT_EQ(pair.joints._length, 1u);
    EXPECT_EQ(pair.joints._buffer[0].joint, pair.pair + 1);
    EXPECT_EQ(pair.joints._buffer[0].rate, 0.5 * pair.pair);
    EXPECT_EQ(both->alternatives._buffer[i].farther, pair.pair);
  }
  shares.views[0].state = ShareState::kLate;
  EXPECT_EQ(joined()->pairs._length, shares.cell.shares.all[1].pairs.size());
}

}  // namespace
}  // namespace clearance::client
