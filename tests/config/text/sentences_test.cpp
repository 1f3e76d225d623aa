#include "config/text/sentences.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace clearance {
namespace {

TEST(Sentences, NameAlternativesWithOrBeforeTheLast) {
  EXPECT_EQ(one_of(std::vector<std::string>{}), "");
  EXPECT_EQ(one_of(std::vector<std::string>{"a"}), "'a'");
  EXPECT_EQ(one_of(std::vector<std::string>{"a", "b", "c"}), "'a', 'b' or 'c'");
}

TEST(Sentences, ListAsManyAsAskedForAndCountTheRest) {
  const std::vector<std::string> names = {"a", "b", "c", "d"};
  EXPECT_EQ(listed(names, 4), "a, b, c, d");
  EXPECT_EQ(listed(names, 3), "a, b, c and 1 more");
  EXPECT_EQ(listed(std::vector<std::string>{}, 3), "");
}

TEST(Sentences, CountInTheSingularAndInThePlural) {
  EXPECT_EQ(counted(0, "part"), "0 parts");
  EXPECT_EQ(counted(1, "part"), "1 part");
  EXPECT_EQ(counted(2, "part"), "2 parts");
}

}  // namespace
}  // namespace clearance
