// The key `contacts` of a cell.
#include <gtest/gtest.h>

#include <string>

#include "config/scene/scene_map.hpp"
#include "tests/config/cells.hpp"

namespace clearance {
namespace {

// Pairs: part-table, part-robot, robot-table, person-robot; the last one is in a zone with
// separation.
std::string cell_with(const std::string& contacts) {
  return cell_text(
      "objects:\n"
      "  - {name: part, groups: [things], sphere: {radius: 1}}\n"
      "  - {name: robot, groups: [things], sphere: {radius: 1}}\n"
      "  - {name: table, fixed: true, sphere: {radius: 1}}\n"
      "  - {name: person, max_speed: 2, sphere: {radius: 1}}\n"
      "pairs: [{between: [things, table], publish: false}, {between: [part, robot]}, "
      "{between: [person, robot]}]\n"
      "zones:\n"
      "  - {name: people, between: [person, robot], enter_below: 1, leave_above: 1, "
      "separation: {human: person, reaction_time_ms: 100, stopping_time_ms: 100, "
      "stopping_distance: 0.1, intrusion_distance: 0, robot_speed: 1}}\n" +
      contacts);
}

std::string one(const std::string& keys) {
  return cell_with("contacts: [{name: lift, by: planner, reason: test, " + keys + "}]\n");
}

TEST(ContactKeys, AContactHasItsTermsAndItsPairsArePublished) {
  const Scene scene = scene_of(
      one("between: [things, table], depth: 0.002, until: {distance: 0.01, duration_ms: 2.5, "
          "time_ns: 1700000000123456789, cycle: 70}"));
  ASSERT_EQ(scene.contacts.size(), 1u);
  const AllowedContact& contact = scene.contacts[0];
  EXPECT_EQ(contact.name, "lift");
  EXPECT_EQ(contact.group_a, "things");
  EXPECT_EQ(contact.group_b, "table");
  EXPECT_EQ(contact.by, "planner");
  EXPECT_EQ(contact.reason, "test");
  EXPECT_TRUE((contact.end == ContactEnd{.distance = 0.01,
                                         .duration_ns = 2'500'000,
                                         .time_ns = 1'700'000'000'123'456'789,
                                         .last_cycle = 70}));
  ASSERT_EQ(contact.pairs.size(), 2u);
  for (const std::uint32_t pair : contact.pairs) {
    EXPECT_TRUE(scene.pairs[pair].publish);
    EXPECT_EQ(scene.objects[scene.pairs[pair].second].name, "table");
  }
  const auto pairs = contact_pairs(scene);
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_LT(pairs[0].pair, pairs[1].pair);
}

TEST(ContactKeys, WithoutUntilAContactEndsWhenItIsWithdrawn) {
  const Scene scene = scene_of(one("between: [part, table], depth: 0.002"));
  EXPECT_TRUE(scene.contacts[0].end == ContactEnd{});
}

TEST(ContactKeys, EachMistakeIsRefusedAtItsPlace) {
  const auto refuses = [](const std::string& text) { return !errors_of(text).empty(); };
  EXPECT_FALSE(refuses(one("between: [part, table], depth: 0.002")));
  EXPECT_TRUE(refuses(one("between: [part, table]"))) << "no depth";
  EXPECT_TRUE(refuses(one("between: [part, table], depth: 0"))) << "rounding would be too deep";
  EXPECT_TRUE(refuses(one("between: [part, tabel], depth: 0.002"))) << "no such name";
  EXPECT_TRUE(refuses(one("between: [part, person], depth: 0.002"))) << "not watched";
  EXPECT_TRUE(refuses(one("between: [person, robot], depth: 0.002"))) << "a person";
  EXPECT_TRUE(refuses(one("between: [part, table], depth: 0.002, until: {}"))) << "no condition";
  EXPECT_TRUE(refuses(one("between: [part, table], depth: 0.002, until: {time_ns: 1.5}")));
  EXPECT_TRUE(refuses(one("between: [part, table], depth: 0.002, until: {apart: 1}")));
  EXPECT_TRUE(
      refuses(cell_with("contacts: [{name: a, between: [part, table], depth: 1, reason: test}]\n")))
      << "no contact is allowed there";
  const std::string two =
      "contacts: [{name: a, between: [part, table], depth: 0.1, by: x, reason: y}, "
      "{name: b, between: [things, table], depth: 0.1, by: x, reason: y}]\n";
  EXPECT_TRUE(refuses(cell_with(two))) << "one pair in two contacts";
}

// What the robot carries may not touch a person either: the pair would not be watched.
TEST(ContactKeys, WhatIsAttachedToARobotMayNotTouchAPerson) {
  const auto carried = [](const std::string& touch) {
    std::string text = cell_with("");
    const std::string rigid = "{between: [part, robot]}, ";
    text.erase(text.find(rigid), rigid.size());
    const std::string part = "{name: part, groups: [things], sphere: {radius: 1}";
    return text.replace(text.find(part), part.size(),
                        part + ", attached: {to: robot, touch: [" + touch + "]}");
  };
  EXPECT_TRUE(errors_of(carried("table")).empty());
  EXPECT_FALSE(errors_of(carried("person")).empty());
  std::string too_many = "table";
  for (int i = 0; i < 4096; ++i) too_many += ", table";
  EXPECT_FALSE(errors_of(carried(too_many)).empty()) << "a million would take minutes";
}

// An exception leaves a pair out of every zone, so a person would limit nothing.
TEST(ContactKeys, AnExceptionLeavesNoPairOfAPersonOutThatARobotMoves) {
  const auto allowed = [](const std::string& pair, const std::string& keys_of_robot) {
    std::string text =
        cell_with("allowed_collisions: [{between: [" + pair + "], reason: they may touch}]\n");
    const std::string robot = "{name: robot, ";
    text.replace(text.find(robot), robot.size(), robot + keys_of_robot);
    const std::string people = "between: [person, robot], enter";
    return text.replace(text.find(people), people.size(), "between: [person, things], enter")
        .replace(text.find("{between: [person, robot]}"), 26, "{between: [person, things]}");
  };
  EXPECT_EQ(errors_of(allowed("robot, table", "")), "");
  EXPECT_EQ(errors_of(allowed("robot, person", "fixed: true, ")), "") << "a base, say";
  const std::string error = errors_of(allowed("robot, person", ""));
  for (const char* name : {"'robot'", "'person'", "'people'"})
    EXPECT_NE(error.find(name), std::string::npos) << name << " in: " << error;
}

// The entries of both scenes are those of the same names and terms.
TEST(ContactKeys, AChangedSceneKnowsWhichContactsGoOn) {
  const Scene before = scene_of(one("between: [things, table], depth: 0.002"));
  const auto counterparts = [&](const std::string& keys) {
    return scene_map(before, scene_of(one(keys))).contact_pairs;
  };
  constexpr std::uint32_t kNone = SceneMap::kNone;
  using Found = std::vector<std::uint32_t>;
  EXPECT_EQ(counterparts("between: [things, table], depth: 0.002"), (Found{0, 1}));
  EXPECT_EQ(counterparts("between: [table, robot], depth: 0.002"), (Found{1}));
  EXPECT_EQ(counterparts("between: [part, robot], depth: 0.002"), (Found{kNone}));
  EXPECT_EQ(counterparts("between: [part, table], depth: 0.003"), (Found{kNone}));
  EXPECT_EQ(counterparts("between: [part, table], depth: 0.002, until: {cycle: 5}"),
            (Found{kNone}));
}

}  // namespace
}  // namespace clearance
