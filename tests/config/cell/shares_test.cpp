// The key `shares` of a cell, and the scene of one share.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include "config/cell/share_topics.hpp"
#include "config/edit/cell_editor.hpp"
#include "config/scene/refresh_share.hpp"
#include "tests/config/cells.hpp"

namespace clearance {
namespace {

// Two halls with two carts and a post each, and all four carts watched against each other.
std::string halls(const std::string& shares) {
  return cell_text(
             "objects:\n"
             "  - {name: a, groups: [left, carts], sphere: {radius: 0.1}}\n"
             "  - {name: b, groups: [left, carts], sphere: {radius: 0.1}}\n"
             "  - {name: c, groups: [right, carts], sphere: {radius: 0.1}}\n"
             "  - {name: d, groups: [right, carts], sphere: {radius: 0.1}}\n"
             "  - {name: post, groups: [left], fixed: true, sphere: {radius: 0.1}}\n"
             "  - {name: pole, groups: [right], fixed: true, sphere: {radius: 0.1}}\n"
             "pairs: [{between: [left, left]}, {between: [right, right], publish: false}, "
             "{between: [carts, carts]}]\n"
             "zones:\n"
             "  - {name: west, between: [left, left], enter_below: 1, leave_above: 2}\n"
             "  - {name: all, between: [carts, carts], enter_below: 1, leave_above: 2}\n") +
         shares;
}
const std::string kThree =
    "shares:\n"
    "  - {name: left cell, pairs: [{between: [left, left]}]}\n"
    "  - {name: right cell, pairs: [{between: [right, right]}]}\n"
    "  - {name: between, pairs: [{between: [left, right]}]}\n";

Cell read(const std::string& yaml, const std::string& share = {}) {
  auto result = parse_cell(yaml, "cell.yaml", {.share = share});
  if (const auto* errors = std::get_if<std::vector<CellError>>(&result)) {
    ADD_FAILURE() << errors->front().text;
    return {};
  }
  return std::get<Cell>(std::move(result));
}

std::string mistake(const std::string& yaml, const std::string& share = {}) {
  const auto result = parse_cell(yaml, "cell.yaml", {.share = share});
  const auto* errors = std::get_if<std::vector<CellError>>(&result);
  return errors == nullptr ? "" : errors->front().text;
}

std::vector<std::string> named(const Scene& scene, const std::vector<ObjectPair>& pairs) {
  std::vector<std::string> names;
  for (const ObjectPair& pair : pairs)
    names.push_back(scene.objects[pair.first].name + "-" + scene.objects[pair.second].name);
  return names;
}

TEST(Shares, TogetherHaveEveryPairOnce) {
  const Cell whole = read(halls(kThree));
  ASSERT_EQ(whole.shares.all.size(), 3u);
  std::vector<std::uint32_t> pairs;
  for (const Share& share : whole.shares.all)
    pairs.insert(pairs.end(), share.pairs.begin(), share.pairs.end());
  std::ranges::sort(pairs);
  std::vector<std::uint32_t> all(whole.scene.pairs.size());
  std::iota(all.begin(), all.end(), 0u);
  EXPECT_EQ(pairs, all);
  EXPECT_EQ(whole.shares.all[0].zones, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(whole.shares.all[2].zones, std::vector<std::uint32_t>{1});
  EXPECT_FALSE(whole.shares.is_one());
}

TEST(Shares, TheSceneOfOneHasItsPairsZonesAndInputsAndTheIdsOfTheWhole) {
  const Cell whole = read(halls(kThree));
  const Cell left = read(halls(kThree), "left cell");
  EXPECT_EQ(left.scene.revision, whole.scene.revision);
  EXPECT_EQ(left.shares.name(), "left cell");
  EXPECT_EQ(named(left.scene, left.scene.pairs),
            (std::vector<std::string>{"a-b", "a-post", "b-post"}));
  for (std::size_t i = 0; i < left.scene.pairs.size(); ++i) {
    const ObjectPair& there = whole.scene.pairs[left.shares.own_pairs()[i]];
    EXPECT_EQ(there.first, left.scene.pairs[i].first);
    EXPECT_EQ(there.second, left.scene.pairs[i].second);
  }
  ASSERT_EQ(left.scene.zones.size(), 2u);
  EXPECT_EQ(left.scene.zones[0].pairs, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(left.scene.zones[1].pairs, std::vector<std::uint32_t>{0});
  const std::vector<bool> is_read = {true, true, false, false, true, false};
  for (std::size_t i = 0; i < is_read.size(); ++i)
    EXPECT_EQ(left.scene.objects[i].is_read, is_read[i]) << left.scene.objects[i].name;
  EXPECT_EQ(left.topics.poses, whole.topics.poses);
  EXPECT_EQ(left.topics.distances, "clearance/distances/share/left_cell");
  EXPECT_EQ(left.topics.commands, "clearance/commands/share/left_cell");
}

// A robot's joints are read where a pair has one of its links, and so is all on which it stands.
TEST(Shares, ARobotIsReadWithWhatItStandsOn) {
  const std::string cell = cell_text(
      "objects:\n"
      "  - {name: wagon, sphere: {radius: 0.1}}\n"
      "  - {name: tool, sphere: {radius: 0.1}, attached: {to: wagon, pose: {xyz: [0, 0, 1]}}}\n"
      "  - {name: box, sphere: {radius: 0.1}}\n"
      "  - {name: post, fixed: true, sphere: {radius: 0.1}}\n"
      "pairs: [{between: [tool, post]}, {between: [box, post]}, {between: [wagon, box]}]\n"
      "shares:\n"
      "  - {name: one, pairs: [{between: [tool, post]}]}\n"
      "  - {name: two, pairs: [{between: [box, post]}, {between: [wagon, box]}]}\n");
  const Cell one = read(cell, "one");
  EXPECT_TRUE(one.scene.objects[0].is_read);
  for (const Object& object : one.scene.objects) {
    if (object.name == "box") {
      EXPECT_FALSE(object.is_read);
    }
    if (object.name == "tool") {
      EXPECT_TRUE(object.is_read);
    }
  }
}

// A sensor that is seen in this share only, on a frame of tf or in the world.
TEST(Shares, AllThatMayCarryASensorOnTfIsRead) {
  for (const bool is_on_tf : {false, true}) {
    const std::string mount = is_on_tf ? "{frame: mast}" : "{pose: {xyz: [0, 0, 2]}}";
    const Cell one = read(
        cell_text("objects:\n"
                  "  - {name: wagon, sphere: {radius: 0.1}}\n"
                  "  - {name: box, sphere: {radius: 0.1}}\n"
                  "sensors: [{name: eye, points: /points, depth_error: {constant: 0.01}, range: "
                  "[0.3, 4], mount: " +
                  mount +
                  "}]\n"
                  "pairs: [{between: [box, eye]}, {between: [wagon, box]}]\n"
                  "shares:\n"
                  "  - {name: one, pairs: [{between: [box, eye]}]}\n"
                  "  - {name: two, pairs: [{between: [wagon, box]}]}\n"),
        "one");
    EXPECT_EQ(one.scene.objects[0].is_read, is_on_tf);
    EXPECT_TRUE(one.scene.objects[1].is_read);
  }
}

TEST(Shares, ThatOverlapAreRefusedWithThePairAndBothNames) {
  const std::string text =
      mistake(halls("shares:\n"
                    "  - {name: one, pairs: [{between: [left, left]}, {between: [left, right]}]}\n"
                    "  - {name: two, pairs: [{between: [right, right]}, {between: [a, c]}]}\n"));
  for (const char* part : {"'a'", "'c'", "'one'", "'two'", "in one share"})
    EXPECT_NE(text.find(part), std::string::npos) << text;
}

TEST(Shares, ThatLeavePairsOutAreRefusedWithOneOfThemAndTheirNumber) {
  const std::string text =
      mistake(halls("shares:\n"
                    "  - {name: one, pairs: [{between: [left, left]}]}\n"
                    "  - {name: two, pairs: [{between: [right, right]}]}\n"));
  for (const char* part : {"no share", "'a'", "'c'", "3 other pairs"})
    EXPECT_NE(text.find(part), std::string::npos) << text;
}

TEST(Shares, AnUnknownOneIsRefusedWithThoseThatAre) {
  EXPECT_NE(mistake(halls(kThree), "left").find("'right cell'"), std::string::npos);
  EXPECT_NE(mistake(halls(""), "left").find("no 'shares'"), std::string::npos);
}

TEST(Shares, NamesThatWouldHaveTheSameTopicsAreRefused) {
  std::string yaml = halls(kThree);
  yaml.replace(yaml.find("right cell"), 10, "left.cell!");
  EXPECT_EQ(mistake(yaml), "") << "these differ";
  yaml = halls(kThree);
  yaml.replace(yaml.find("right cell"), 10, "left-cell");
  EXPECT_NE(mistake(yaml).find("topics"), std::string::npos);
}

// The cost of no share exceeds that of another by more than one pair's.
TEST(Shares, BalancedOnesCostTheSameWithinOnePair) {
  for (const std::uint32_t count : {1u, 2u, 3u, 5u}) {
    const std::string yaml = halls("shares: {auto: " + std::to_string(count) + "}\n");
    const Cell whole = read(yaml);
    ASSERT_EQ(whole.shares.all.size(), count);
    const auto costs = expected_costs(whole.scene.objects, whole.scene.pairs);
    std::uint64_t least = ~0ull, most = 0;
    std::size_t pairs = 0;
    for (const Share& share : whole.shares.all) {
      std::uint64_t cost = 0;
      for (const std::uint32_t pair : share.pairs) cost += costs[pair];
      least = std::min(least, cost);
      most = std::max(most, cost);
      pairs += share.pairs.size();
    }
    EXPECT_EQ(pairs, whole.scene.pairs.size());
    EXPECT_LE(most - least, 2 * *std::ranges::max_element(costs));
    const Cell again = read(yaml);
    for (std::size_t i = 0; i < count; ++i)
      EXPECT_EQ(again.shares.all[i].pairs, whole.shares.all[i].pairs);
  }
  EXPECT_NE(mistake(halls("shares: {auto: 40}\n")).find("empty"), std::string::npos);
}

// The pairs of `halls` in their order: a-b, a-c, a-d, a-post, b-c, b-d, b-post, c-d, c-pole,
// d-pole.
TEST(Shares, BalancedOnesBeginWhereTheCellSays) {
  const Cell whole = read(halls("shares: {auto: 3, begin: [[a, post], [d, c]]}\n"));
  ASSERT_EQ(whole.shares.all.size(), 3u);
  EXPECT_EQ(whole.shares.all[0].pairs, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(whole.shares.all[1].pairs, (std::vector<std::uint32_t>{3, 4, 5, 6}));
  EXPECT_EQ(whole.shares.all[2].pairs, (std::vector<std::uint32_t>{7, 8, 9}));
  EXPECT_EQ(whole.shares.all[1].zones, (std::vector<std::uint32_t>{0, 1}));
}

// The cell may have changed since. It does not watch the pair a-pole, so the share begins at the
// next pair, b-c.
TEST(Shares, AShareBeginsAfterAPairThatIsNotWatched) {
  const Cell whole = read(halls("shares: {auto: 2, begin: [[pole, a]]}\n"));
  ASSERT_EQ(whole.shares.all.size(), 2u);
  EXPECT_EQ(whole.shares.all[1].pairs.front(), 4u);
}

TEST(Shares, BeginsThatDoNotDivideTheCellAreRefused) {
  const auto with = [](const std::string& begins) {
    return mistake(halls("shares: {auto: 3, begin: " + begins + "}\n"));
  };
  EXPECT_NE(with("[[a, b]]").find("found 1 first pairs"), std::string::npos);
  EXPECT_NE(with("[[b, c], [a, c]]").find("order"), std::string::npos);
  EXPECT_NE(with("[[b, c], [b, c]]").find("empty"), std::string::npos);
  EXPECT_NE(with("[[a, b], [b, c]]").find("empty"), std::string::npos) << "no pair is before a-b";
  EXPECT_NE(with("[[b, nothing], [b, c]]").find("'nothing'"), std::string::npos);
  EXPECT_NE(with("[[b], [b, c]]").find("two objects"), std::string::npos);
}

// The budget has to refresh each share, and not the whole.
TEST(Shares, EachHasToFitIntoTheBudget) {
  const auto with_budget = [](int budget, const std::string& shares) {
    return "budget: " + std::to_string(budget) + "\nrefresh_s: 0.001\n" + halls(shares);
  };
  EXPECT_NE(mistake(with_budget(5, "")).find("budget"), std::string::npos);
  EXPECT_EQ(mistake(with_budget(5, kThree)), "");
  EXPECT_NE(mistake(with_budget(2, kThree)).find("budget"), std::string::npos);
  EXPECT_EQ(mistake(with_budget(5, kThree), "left cell"), "");
}

// All shares are asked for each command, and none of them watches all pairs.
TEST(Shares, TakeAChangeOfAPairThatAnotherShareHas) {
  for (const char* share : {"left cell", "right cell"}) {
    auto opened = CellEditor::open(halls(kThree), "cell.yaml", {.share = share});
    CellEditor& editor = std::get<CellEditor>(opened);
    const auto is_taken = [&](const CellChange& change) {
      return std::holds_alternative<Cell>(editor.dry_run(std::vector{change}));
    };
    EXPECT_TRUE(is_taken(SetPair{"c", "pole", SetPair::Rule::kPublish})) << share;
    const auto contact = [](const char* a, const char* b) {
      return AllowContact{"dock", a, b, 0.01, {}, "an engineer", "docking"};
    };
    EXPECT_TRUE(is_taken(contact("c", "pole"))) << share;
    EXPECT_FALSE(is_taken(SetPair{"post", "pole", SetPair::Rule::kPublish})) << "both are fixed";
    EXPECT_FALSE(is_taken(contact("post", "pole"))) << share;
  }
}

}  // namespace
}  // namespace clearance
