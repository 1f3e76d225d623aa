#include "monitor/wire/written_zones.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace clearance
