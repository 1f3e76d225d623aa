// People see names that a cell states, and none that a program made.
#include "monitor/interface/pair_name.hpp"

#include <gtest/gtest.h>

#include "config/cell/cell_file.hpp"
#include "config/cell/shape_reader.hpp"

namespace clearance {
namespace {

TEST(GivenName, OfAPartThatIsCalledByItsKindIsNone) {
  for (const std::string& kind : ShapeReader::kinds()) {
    for (const char* const made : {"0", "17", "0.3", "2.11"})
      EXPECT_EQ(given_name(kind + made), "") << kind << made;
  }
}

TEST(GivenName, OfAStatedPartIsThatNameWithoutTheNumberOfASplit) {
  EXPECT_EQ(given_name("lower_finger"), "lower_finger");
  EXPECT_EQ(given_name("finger2"), "finger2");
  EXPECT_EQ(given_name("gripper.14"), "gripper");
  EXPECT_EQ(given_name("v1.x"), "v1.x");
  EXPECT_EQ(given_name("box_of_tools"), "box_of_tools");
  EXPECT_EQ(given_name(""), "");
}

TEST(BodyName, HasThePartOnlyWhereItTellsSomething) {
  EXPECT_EQ(body_name("hand", 3, "finger"), "hand.finger");
  EXPECT_EQ(body_name("hand", 1, "finger"), "hand");
  EXPECT_EQ(body_name("trunk", 24, "mesh0.17"), "trunk");
}

}  // namespace
}  // namespace clearance
