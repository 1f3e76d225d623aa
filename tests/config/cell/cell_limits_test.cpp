// Cells that are larger than a report can carry are refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/config/cells.hpp"

namespace clearance {
namespace {

TEST(CellLimits, TooManyPairsThatHaveToBePublishedAreRefused) {
  std::string objects = "objects:\n";
  for (int i = 0; i < 92; ++i) {
    objects += "  - {name: o" + std::to_string(i) + ", groups: [g], sphere: {radius: 1}}\n";
  }
  EXPECT_THAT(errors_of(cell_text(objects + "pairs: [{between: [g, g], publish: true}]\n")),
              testing::HasSubstr("cell.yaml:97:8: found 4186 pairs with publish: true; expected at "
                                 "most 4096"));
  const auto published = [&](const std::string& rule) {
    const Scene scene = scene_of(cell_text(objects + "pairs: [{between: [g, g]" + rule + "}]\n"));
    EXPECT_EQ(scene.pairs.size(), 4186u);
    return std::ranges::count(scene.pairs, true, &ObjectPair::publish);
  };
  EXPECT_EQ(published(", publish: false"), 0);
  EXPECT_EQ(published(""), 4096);
}

// 91 objects have 4,095 pairs.
TEST(CellLimits, AsManyPublishedPairsAsAReportCarriesAreAcceptedAndOneMoreIsNot) {
  std::string objects = "objects:\n";
  for (int i = 0; i < 93; ++i) {
    objects += "  - {name: o" + std::to_string(i) + (i < 91 ? ", groups: [g]" : "") +
               ", sphere: {radius: 1}}\n";
  }
  const std::string most = objects +
                           "pairs:\n  - {between: [g, g], publish: true}\n"
                           "  - {between: [o91, o92], publish: true}\n";
  EXPECT_EQ(scene_of(cell_text(most)).pairs.size(), 4096u);
  EXPECT_THAT(errors_of(cell_text(most + "  - {between: [o0, o91], publish: true}\n")),
              testing::HasSubstr("found 4097 pairs with publish: true"));
}

TEST(CellLimits, AsManySourcesAsCanBeToldApartAreAcceptedAndOneMoreIsNot) {
  const auto text = [](int sources) {
    std::string objects = "objects:\n";
    for (int i = 0; i < sources; ++i) {
      objects += "  - {name: o" + std::to_string(i) + ", groups: [g], source: s" +
                 std::to_string(i) + ", sphere: {radius: 1}}\n";
    }
    return cell_text(objects + "pairs: [{between: [g, g]}]\n");
  };
  EXPECT_EQ(scene_of(text(15)).objects.size(), 15u);
  EXPECT_THAT(errors_of(text(16)), testing::HasSubstr("'s15' after 15 others"));
}

TEST(CellLimits, TooManyObjectsAndZonesAreRefused) {
  std::string objects = "objects:\n", zones = "zones:\n";
  for (int i = 0; i < 4097; ++i) {
    objects += "  - {name: o" + std::to_string(i) + ", groups: [g], sphere: {radius: 1}}\n";
  }
  for (int i = 0; i < 257; ++i) {
    zones += "  - {name: z" + std::to_string(i) +
             ", between: [o0, o1], enter_below: 1, leave_above: 1}\n";
  }
  const std::string errors =
      errors_of(cell_text(objects + "pairs: [{between: [o0, g]}]\n" + zones));
  EXPECT_THAT(errors, testing::HasSubstr("found 4097 objects; expected at most 4096"));
  EXPECT_THAT(errors, testing::HasSubstr("found 257 zones; expected at most 256"));
}

// The shapes of 10,000 objects and their 50 million pairs would take most of a minute and 2 GB.
TEST(CellLimits, OfTooManyObjectsNoneIsRead) {
  std::string objects = "objects:\n";
  for (int i = 0; i < 10'000; ++i) {
    objects += "  - {name: o" + std::to_string(i) + ", groups: [g], sphere: {radius: -1}}\n";
  }
  const std::string errors = errors_of(cell_text(objects + "pairs: [{between: [g, g]}]\n"));
  EXPECT_EQ(
      "cell.yaml:4101:5: found 10000 objects; expected at most 4096, which is what a report can "
      "carry\n",
      errors);
}

}  // namespace
}  // namespace clearance
