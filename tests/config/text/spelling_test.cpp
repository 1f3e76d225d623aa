#include "config/text/spelling.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace clearance {
namespace {

TEST(Spelling, DistanceCountsInsertionsDeletionsSubstitutionsAndSwaps) {
  EXPECT_EQ(edit_distance("", ""), 0u);
  EXPECT_EQ(edit_distance("abc", ""), 3u);
  EXPECT_EQ(edit_distance("radius", "radus"), 1u);
  EXPECT_EQ(edit_distance("radius", "raduis"), 1u);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
}

TEST(Spelling, CaseAndHyphensCountForNothing) {
  EXPECT_EQ(edit_distance("Half-Space", "half_space"), 0u);
}

TEST(Spelling, OnlyANearNameIsSuggested) {
  const std::vector<std::string> known = {"radius", "centre"};
  EXPECT_EQ(did_you_mean("raduis", known), "; did you mean 'radius'?");
  EXPECT_EQ(did_you_mean("center", known), "; did you mean 'centre'?");
  EXPECT_EQ(did_you_mean("colour", known), "");
  EXPECT_EQ(did_you_mean("x", std::vector<std::string>{}), "");
}

}  // namespace
}  // namespace clearance
