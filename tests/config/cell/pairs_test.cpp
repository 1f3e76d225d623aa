#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "tests/config/cells.hpp"

namespace clearance {
namespace {

// Objects a0, a1, a2 in group a; b0, b1 in group b; f0, f1 fixed in group f; all of them in group
// all.
const std::string kObjects =
    "objects:\n"
    "  - {name: a0, groups: [a, all], sphere: {radius: 1}}\n"
    "  - {name: b0, groups: [b, all], sphere: {radius: 1}}\n"
    "  - {name: f0, groups: [f, all], fixed: true, sphere: {radius: 1}}\n"
    "  - {name: a1, groups: [a, all], sphere: {radius: 1}}\n"
    "  - {name: b1, groups: [b, all], sphere: {radius: 1}}\n"
    "  - {name: a2, groups: [a, all], sphere: {radius: 1}}\n"
    "  - {name: f1, groups: [f, all], fixed: true, sphere: {radius: 1}}\n";

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

Pairs pairs_of(const Scene& scene) {
  Pairs pairs;
  for (const ObjectPair& pair : scene.pairs) pairs.emplace_back(pair.first, pair.second);
  return pairs;
}

// Names the groups that a case does not use, so that they are not refused. This adds the pair
// a0-b0.
const std::string kNamed =
    "  - {between: [all, b0], publish: false}\n  - {between: [a, b1], publish: false}\n"
    "  - {between: [f, b0], publish: false}\n  - {between: [b, a0], publish: false}\n";

TEST(Pairs, EveryTwoObjectsOfTheSidesMeetOnceInSceneOrder) {
  const Scene scene = scene_of(cell_text(kObjects + "pairs:\n" + kNamed));
  // The rules pair everything with b0, the a's with b1, and a0 with the b's. The pairs a0-b1 and
  // a0-b0 occur twice.
  EXPECT_EQ(pairs_of(scene),
            (Pairs{{0, 1}, {0, 4}, {1, 2}, {1, 3}, {1, 4}, {1, 5}, {1, 6}, {3, 4}, {4, 5}}));
}

TEST(Pairs, AGroupAgainstItselfIsSelfCollision) {
  const Scene scene =
      scene_of(cell_text(kObjects + "pairs:\n  - {between: [all, all]}\n" + kNamed));
  EXPECT_EQ(scene.pairs.size(), 7u * 6u / 2u - 1u);  // all but f0-f1: two fixed objects never pair
  for (const ObjectPair& pair : scene.pairs) {
    EXPECT_LT(pair.first, pair.second);
    EXPECT_FALSE(scene.objects[pair.first].fixed && scene.objects[pair.second].fixed);
  }
}

// The base of a robot beside a post: the rule covers it, and two fixed objects never meet.
TEST(Pairs, AFixedMemberOfAGroupNeedsNoPairOfItsOwn) {
  const std::string objects =
      "objects:\n"
      "  - {name: base, groups: [arm], fixed: true, sphere: {radius: 1}}\n"
      "  - {name: tip, groups: [arm], sphere: {radius: 1}}\n"
      "  - {name: post, fixed: true, sphere: {radius: 1}}\n";
  EXPECT_EQ(pairs_of(scene_of(cell_text(objects + "pairs: [{between: [arm, post]}]\n"))),
            (Pairs{{1, 2}}));
  EXPECT_NE(errors_of(cell_text(objects + "pairs: [{between: [tip, post]}]\n")).find("'base'"),
            std::string::npos);
}

TEST(Pairs, APairIsPublishedWhenAnyRuleSaysSo) {
  const Scene scene =
      scene_of(cell_text(kObjects + "pairs:\n" + kNamed + "  - {between: [b0, a1]}\n"));
  for (const ObjectPair& pair : scene.pairs) {
    EXPECT_EQ(pair.publish, pair.first == 1 && pair.second == 3);
  }
}

TEST(Pairs, AnExceptionRemovesExactlyItsPairs) {
  const Scene scene =
      scene_of(cell_text(kObjects + "pairs:\n" + kNamed +
                         "allowed_collisions:\n"
                         "  - {between: [b0, a0], reason: they carry one load}\n"
                         "  - {between: [b1, a], reason: they are bolted together}\n"));
  EXPECT_EQ(pairs_of(scene), (Pairs{{1, 2}, {1, 3}, {1, 4}, {1, 5}, {1, 6}}));
}

TEST(Pairs, AZoneCoversTheWatchedPairsOfItsGroups) {
  const Scene scene =
      scene_of(cell_text(kObjects + "pairs:\n" + kNamed +
                         "allowed_collisions:\n"
                         "  - {between: [b0, a0], reason: they carry one load}\n"
                         "zones:\n"
                         "  - {name: z, between: [a, b], enter_below: 0.1, leave_above: 0.2}\n"));
  // Without a0-b0, the pairs are 0: a0-b1, 1: b0-f0, 2: b0-a1, 3: b0-b1, 4: b0-a2, 5: b0-f1, 6:
  // a1-b1, 7: b1-a2.
  ASSERT_EQ(scene.zones.size(), 1u);
  EXPECT_EQ(scene.zones[0].pairs, (std::vector<std::uint32_t>{0, 2, 4, 6, 7}));
  EXPECT_EQ(scene.zones[0].group_a, "a");
  EXPECT_EQ(scene.zones[0].group_b, "b");
}

TEST(Pairs, AMillionAreReadWhenTheyAreNotPublished) {
  std::string objects = "objects:\n";
  for (int i = 0; i < 1500; ++i) {
    objects += "  - {name: o" + std::to_string(i) + ", groups: [g], sphere: {radius: 1}}\n";
  }
  const Scene scene =
      scene_of(cell_text(objects + "pairs: [{between: [g, g], publish: false}]\n" +
                         "zones: [{name: z, between: [g, g], enter_below: 1, leave_above: 1}]\n"));
  EXPECT_EQ(scene.pairs.size(), 1500u * 1499u / 2u);
  ASSERT_EQ(scene.zones.size(), 1u);
  EXPECT_EQ(scene.zones[0].pairs.size(), scene.pairs.size());
}

}  // namespace
}  // namespace clearance
