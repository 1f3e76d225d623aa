#include "monitor/wire/written_zones.hpp"

#include <gtest/gtest.h>

#include "clearance.h"
#include "monitor/interface/report.hpp"

namespace clearance {
namespace {

TEST(WrittenZones, AreWhatWasSetLastUntilTheyAreForgotten) {
  WrittenZones written(2);
  EXPECT_FALSE(written.last(0));
  EXPECT_FALSE(written.is_active(0)) << "it was never written";
  written.set(0, {.active = true, .cause = 3, .cause_object = 4});
  EXPECT_TRUE(written.is_active(0));
  EXPECT_EQ(written.last(0), (WrittenZone{true, 3, 4}));
  EXPECT_FALSE(written.last(1)) << "each zone by itself";
  written.set(0, {.active = false});
  EXPECT_TRUE(written.last(0));
  EXPECT_FALSE(written.is_active(0));
  written.forget(0);
  EXPECT_FALSE(written.last(0));
}

TEST(WrittenZones, TakeAReportAndItsMessageForTheSame) {
  ZoneReport report;
  report.active = true;
  report.cause = ZoneCause::kLate;
  report.cause_object = 5;
  clearance_msg_ZoneState message{};
  message.active = true;
  message.cause = static_cast<std::uint8_t>(ZoneCause::kLate);
  message.cause_object = 5;
  EXPECT_EQ(WrittenZone::of(report), WrittenZone::of(message));
  for (const auto& change : {+[](ZoneReport& zone) { zone.active = false; },
                             +[](ZoneReport& zone) { zone.cause = ZoneCause::kNear; },
                             +[](ZoneReport& zone) { zone.cause_object = 6; }}) {
    ZoneReport other = report;
    change(other);
    EXPECT_NE(WrittenZone::of(other), WrittenZone::of(message));
  }
}

}  // namespace
}  // namespace clearance
