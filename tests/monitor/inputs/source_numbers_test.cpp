// The numbers of sources. Oracle: the rule of source_numbers.hpp, with a list of all that was
// heard.
#include "monitor/inputs/source_numbers.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace clearance {
namespace {

Scene scene_naming(std::uint32_t sources) {
  Scene scene;
  for (std::uint32_t i = 0; i < sources; ++i)
    scene.objects.emplace_back().source = "named" + std::to_string(i);
  return scene;
}

SourceName numbered_name(const char* text, std::uint32_t i) {
  return SourceName(text + std::to_string(i));
}

TEST(SourceNumbers, BeginWithThoseThatTheCellNamesAndReplaceTheOneHeardLongestAgo) {
  for (std::uint32_t named = 0; named < kMaxSources; ++named) {
    SourceNumbers numbers(scene_naming(named));
    for (std::uint32_t i = 0; i < named; ++i) EXPECT_EQ(numbers.of(numbered_name("named", i)), i);
    for (std::uint32_t i = named; i < kMaxSources; ++i)
      EXPECT_EQ(numbers.of(numbered_name("other", i)), i);
    EXPECT_EQ(numbers.of(numbered_name("other", named)), named) << "it is heard again";
    const std::uint32_t longest_ago = named + 1 < kMaxSources ? named + 1 : named;
    EXPECT_EQ(numbers.of(SourceName("new")), longest_ago);
    EXPECT_EQ(numbers.name(longest_ago), SourceName("new"));
    EXPECT_EQ(numbers.name(kMaxSources), SourceName());
  }
}

TEST(SourceNumbers, KeepThoseThatAChangedSceneNamesIfThereIsRoomForAll) {
  SourceNumbers numbers(scene_naming(kMaxSources - 2));
  const std::uint32_t heard = numbers.of(SourceName("heard"));
  const std::vector<SourceName> two = {SourceName("heard"), SourceName("x")};
  const std::vector<SourceName> three = {two[0], two[1], SourceName("y")};
  const std::vector<SourceName> known = {numbered_name("named", 0), two[0], two[1]};
  EXPECT_FALSE(numbers.add_named(three));
  EXPECT_EQ(numbers.of(SourceName("a")), kMaxSources - 1) << "none of them is named";
  EXPECT_EQ(numbers.of(SourceName("b")), heard) << "this one neither";
  EXPECT_TRUE(numbers.add_named(known)) << "one of them was named before";
  EXPECT_EQ(numbers.of(SourceName("other")), kNoSource);
  EXPECT_FALSE(numbers.add_named(std::vector{SourceName("z")}));
  EXPECT_TRUE(numbers.add_named(known));
}

TEST(SourceName, ThatIsTooLongKeepsItsEnd) {
  const std::string longest(kMaxSourceLength, 'a');
  EXPECT_EQ(SourceName(longest).view(), longest);
  EXPECT_EQ(SourceName("b" + longest).view(), longest);
  EXPECT_EQ(SourceName(longest + "/c").view(), longest.substr(2) + "/c");
}

}  // namespace
}  // namespace clearance
