// All combinations of what three shares of a cell may say, and of what is known of them: the report
// and the zone of the whole.
//
// Oracle: the list of shares. Each says where its least pair may be, and how near its other pairs.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <optional>
#include <vector>

#include "monitor/client/share_merge.hpp"
#include "monitor/interface/report.hpp"
#include "monitor/wire/convert.hpp"
#include "tests/config/cells.hpp"
#include "tests/shared/every_choice.hpp"

namespace clearance::client {
namespace {

constexpr double kFarOff = std::numeric_limits<double>::infinity();

// A share with two pairs of three balls.
Cell cell_of_three_shares() {
  return read_good(
      cell_text("objects:\n"
                "  - {name: a, groups: [all], sphere: {radius: 0.1}}\n"
                "  - {name: b, groups: [all], sphere: {radius: 0.1}}\n"
                "  - {name: c, groups: [all], sphere: {radius: 0.1}}\n"
                "pairs: [{between: [all, all]}]\n"
                "zones: [{name: wide, between: [all, all], enter_below: 1, leave_above: 1}]\n"
                "shares:\n  - {name: one, pairs: [{between: [a, b]}]}\n"
                "  - {name: two, pairs: [{between: [a, c]}]}\n  - {name: three, pairs: [{between: "
                "[b, c]}]}\n"));
}

struct Said {
  ShareState state = ShareState::kWhole;
  std::optional<std::array<double, 2>> least = {};  // bounds of the pair with the least upper one
  double others = -kFarOff;                         // no other pair is nearer
  bool is_certified = false;
};
constexpr std::array kSaid = {Said{.least = {{0.2, 0.2}}, .others = 0.2, .is_certified = true},
                              Said{.least = {{0.9, 0.9}}, .others = 0.9, .is_certified = true},
                              Said{.least = {{0.1, 0.5}}, .others = 0.5, .is_certified = true},
                              Said{.least = {{0.4, 0.4}}, .others = 0.15},
                              Said{.least = {{0.4, 0.4}}, .others = -kFarOff},
                              Said{.others = 0.3},
                              Said{.state = ShareState::kMissing},
                              Said{.state = ShareState::kLate},
                              Said{.state = ShareState::kOtherRevision},
                              Said{.state = ShareState::kOtherDivision},
                              Said{.state = ShareState::kHeld}};

void fill_report(const Said& said, std::size_t share, clearance_msg_Distances& report) {
  report = {};
  report.now_ns = report.publish_ns = 1000 * static_cast<std::int64_t>(share + 1);
  report.pairs_total = 1;
  report.minimum_known = said.least.has_value();
  report.minimum_certified = said.is_certified;
  report.lower_all = said.others;
  if (!said.least) return;
  report.minimum.pair = static_cast<std::uint32_t>(share);
  report.minimum.lower = (*said.least)[0];
  report.minimum.upper = report.minimum.distance = (*said.least)[1];
  report.lower_all = std::min(said.others, report.minimum.lower);
}

TEST(EveryShare, OfThreeThatSayAnythingHasTheLeastOfAllAndIsCertifiedIfNoPairCanBeNearer) {
  const Cell cell = cell_of_three_shares();
  const auto catalogue = make_catalogue(cell);
  const ShareMap map(*catalogue);
  ASSERT_EQ(map.names().size(), 3u);
  Sample<clearance_msg_Distances> joined;
  test::EveryChoice choice;
  while (choice.next() && !testing::Test::HasFailure()) {
    std::array<clearance_msg_Distances, 3> reports;
    std::array<Said, 3> said;
    std::vector<ShareView> views(3);
    for (std::size_t share = 0; share < 3; ++share) {
      said[share] = kSaid[choice.of(kSaid.size())];
      fill_report(said[share], share, reports[share]);
      views[share] = {said[share].state, &reports[share], nullptr};
    }
    join_reports(map, views, *joined);
    const Said* least = nullptr;
    double lower = kFarOff;
    std::int64_t oldest_ns = 0;
    for (std::size_t share = 0; share < 3; ++share) {
      const Said& one = said[share];
      lower = std::min({lower, one.others, one.least ? (*one.least)[0] : kFarOff});
      if (one.state != ShareState::kWhole) continue;
      if (oldest_ns == 0) oldest_ns = reports[share].publish_ns;
      if (one.least && (least == nullptr || (*one.least)[1] < (*least->least)[1])) least = &one;
    }
    SCOPED_TRACE(choice.runs());
    EXPECT_EQ(joined->lower_all, lower);
    EXPECT_EQ(joined->publish_ns, oldest_ns);
    EXPECT_EQ(joined->pairs_total, 3u);
    EXPECT_EQ(joined->unknown, std::ranges::count_if(said, [](const Said& one) {
                return one.state != ShareState::kWhole;
              }));
    ASSERT_EQ(joined->minimum_known, least != nullptr);
    if (least != nullptr) {
      EXPECT_EQ(joined->minimum.upper, (*least->least)[1]);
    }
    const bool none_is_nearer =
        least != nullptr && std::ranges::all_of(said, [&](const Said& one) {
          const double upper = (*least->least)[1];
          return one.others >= upper && (!one.least || &one == least || (*one.least)[0] >= upper);
        });
    EXPECT_EQ(joined->minimum_certified, none_is_nearer);
  }
  EXPECT_EQ(choice.runs(), kSaid.size() * kSaid.size() * kSaid.size());
}

struct SaidOfZone {
  bool is_heard, is_active, is_certified;
  double clearance;
};

TEST(EveryShare, OfThreeMakesTheZoneActiveThatIsActiveOrNotKnownInOne) {
  constexpr std::array kZone = {
      SaidOfZone{false, true, false, -kFarOff}, SaidOfZone{true, false, true, 2.0},
      SaidOfZone{true, false, false, 1.5}, SaidOfZone{true, true, true, 0.5},
      SaidOfZone{true, true, false, -kFarOff}};
  const Cell cell = cell_of_three_shares();
  const auto catalogue = make_catalogue(cell);
  const ShareMap map(*catalogue);
  test::EveryChoice choice;
  while (choice.next() && !testing::Test::HasFailure()) {
    std::array<clearance_msg_ZoneState, 3> states{};
    std::array<const clearance_msg_ZoneState*, 3> of_shares{};
    bool is_active = false, is_certified = true;
    double least_of_active = kFarOff, least = kFarOff;
    for (std::size_t share = 0; share < 3; ++share) {
      const SaidOfZone& said = kZone[choice.of(kZone.size())];
      std::strcpy(states[share].name, "wide");
      states[share].active = said.is_active;
      states[share].certified = said.is_certified;
      states[share].clearance = states[share].swept_clearance = said.clearance;
      if (said.is_heard) of_shares[share] = &states[share];
      is_active = is_active || said.is_active;
      is_certified = is_certified && said.is_certified;
      least = std::min(least, said.clearance);
      if (said.is_active) least_of_active = std::min(least_of_active, said.clearance);
    }
    const clearance_msg_ZoneState joined = join_zone(map, 0, of_shares);
    SCOPED_TRACE(choice.runs());
    EXPECT_EQ(joined.active, is_active);
    EXPECT_EQ(joined.certified, is_certified);
    EXPECT_EQ(joined.swept_clearance, is_active ? least_of_active : least);
    const bool lacks_one = std::ranges::count(of_shares, nullptr) > 0;
    EXPECT_EQ(joined.cause == static_cast<std::uint8_t>(ZoneCause::kNoShare), lacks_one);
  }
  EXPECT_EQ(choice.runs(), std::size_t{5 * 5 * 5});
}

}  // namespace
}  // namespace clearance::client
