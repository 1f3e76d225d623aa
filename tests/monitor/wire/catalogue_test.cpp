// Contacts with their ends and shares in a catalogue, and the zones with separation and robots with
// stops that other messages are about.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "monitor/wire/convert.hpp"

namespace clearance {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

template <class Sequence>
auto sequence_list(const Sequence& sequence) {
  return std::vector(sequence._buffer, sequence._buffer + sequence._length);
}

// Three objects, each pair of them, and two zones.
Cell plain_cell() {
  Cell cell;
  cell.scene.objects.resize(3);
  for (std::uint32_t i = 0; i < 3; ++i) cell.scene.objects[i].name = std::string(1, "abc"[i]);
  cell.scene.pairs = {{0, 1, true}, {0, 2, true}, {1, 2, true}};
  cell.scene.zones.resize(2);
  return cell;
}

TEST(Catalogue, HasContactsWithTheEndsThatAreStated) {
  Cell cell = plain_cell();
  const ContactEnd kEnds[] = {{},
                              {.distance = 0.5},
                              {.duration_ns = 7},
                              {.time_ns = 8},
                              {.last_cycle = 9},
                              {.distance = 0.25, .duration_ns = 3, .time_ns = 4, .last_cycle = 5}};
  for (const ContactEnd& end : kEnds)
    cell.scene.contacts.push_back({.name = "grip",
                                   .group_a = "hand",
                                   .group_b = "parts",
                                   .depth = 0.01,
                                   .end = end,
                                   .by = "planner",
                                   .reason = "it holds it",
                                   .pairs = {}});
  const auto catalogue = make_catalogue(cell);
  ASSERT_EQ(catalogue->contacts._length, std::size(kEnds));
  for (std::uint32_t i = 0; i < std::size(kEnds); ++i) {
    const clearance_msg_CatalogueContact& contact = catalogue->contacts._buffer[i];
    const ContactEnd& end = kEnds[i];
    EXPECT_EQ(contact.id, i);
    EXPECT_STREQ(contact.name, "grip");
    EXPECT_STREQ(contact.group_a, "hand");
    EXPECT_STREQ(contact.group_b, "parts");
    EXPECT_STREQ(contact.by, "planner");
    EXPECT_STREQ(contact.reason, "it holds it");
    EXPECT_EQ(contact.depth, 0.01);
    EXPECT_EQ(contact.end_distance, end.distance);
    EXPECT_EQ(contact.end_duration_ns, end.duration_ns < 100 ? end.duration_ns : -1);
    EXPECT_EQ(contact.end_time_ns, end.time_ns < 100 ? end.time_ns : 0);
    EXPECT_EQ(contact.last_cycle, end.last_cycle < 100 ? end.last_cycle : 0);
  }
}

TEST(Catalogue, NamesTheZonesWithSeparationAndTheRobotsThatStateStops) {
  Cell cell = plain_cell();
  cell.scene.zones[1].separation.emplace();
  cell.scene.robots.resize(3);
  for (std::uint32_t i = 0; i < 3; ++i) cell.scene.robots[i].name = std::string(1, "rst"[i]);
  cell.scene.robots[2].stopping.joints.push_back(JointStop::by_time(0.1));
  const auto catalogue = make_catalogue(cell);
  EXPECT_THAT(sequence_list(catalogue->separated_zones), ElementsAre(1));
  EXPECT_THAT(sequence_list(catalogue->stopping_robots), ElementsAre(2));
  ASSERT_EQ(catalogue->robots._length, 3u);
  for (std::uint32_t i = 0; i < 3; ++i)
    EXPECT_EQ(cell.scene.robots[i].name, catalogue->robots._buffer[i]);
}

// The shares "even" and "odd". With `own`, the scene has only the pairs of that one.
Cell cell_in_shares(std::optional<std::uint32_t> own) {
  Cell cell = plain_cell();
  cell.shares.all = {{"even", {0, 2}, {0, 1}}, {"odd", {1}, {1}}};
  cell.shares.own = own;
  if (!own) return cell;
  cell.shares.pairs = cell.scene.pairs;
  cell.shares.separated = {0};
  std::vector<ObjectPair> pairs;
  for (const std::uint32_t pair : cell.shares.all[*own].pairs)
    pairs.push_back(cell.scene.pairs[pair]);
  cell.scene.pairs = pairs;
  return cell;
}

void expect_both_shares(const clearance_msg_Catalogue& catalogue) {
  ASSERT_EQ(catalogue.shares._length, 2u);
  EXPECT_STREQ(catalogue.shares._buffer[0].name, "even");
  EXPECT_STREQ(catalogue.shares._buffer[1].name, "odd");
  EXPECT_EQ(catalogue.shares._buffer[0].pairs_total, 2u);
  EXPECT_EQ(catalogue.shares._buffer[1].pairs_total, 1u);
  EXPECT_THAT(sequence_list(catalogue.shares._buffer[0].zones), ElementsAre(0, 1));
  EXPECT_THAT(sequence_list(catalogue.shares._buffer[1].zones), ElementsAre(1));
}

std::vector<std::uint32_t> first_objects(const clearance_msg_Catalogue& catalogue) {
  std::vector<std::uint32_t> objects;
  for (const clearance_msg_CataloguePair& pair : sequence_list(catalogue.pairs))
    objects.push_back(pair.object_a);
  return objects;
}

TEST(Catalogue, OfAWholeCellInSharesSaysWhichShareHasAPair) {
  for (const CataloguePairs pairs : {CataloguePairs::kOfScene, CataloguePairs::kOfWholeCell}) {
    const auto catalogue = make_catalogue(cell_in_shares({}), {}, pairs);
    EXPECT_STREQ(catalogue->share, "");
    expect_both_shares(*catalogue);
    EXPECT_THAT(sequence_list(catalogue->pair_shares), ElementsAre(0, 1, 0));
    EXPECT_THAT(first_objects(*catalogue), ElementsAre(0, 0, 1));
    EXPECT_THAT(sequence_list(catalogue->separated_zones), IsEmpty());
  }
}

TEST(Catalogue, OfAShareHasItsPairsOrThoseOfTheWholeCell) {
  const auto own = make_catalogue(cell_in_shares(1), {}, CataloguePairs::kOfScene);
  EXPECT_STREQ(own->share, "odd");
  expect_both_shares(*own);
  EXPECT_THAT(sequence_list(own->pair_shares), IsEmpty()) << "its pairs are those of the share";
  ASSERT_EQ(own->pairs._length, 1u);
  EXPECT_EQ(own->pairs._buffer[0].object_b, 2u);
  EXPECT_THAT(sequence_list(own->separated_zones), ElementsAre(0)) << "those of the whole cell";

  const auto whole = make_catalogue(cell_in_shares(1), {}, CataloguePairs::kOfWholeCell);
  EXPECT_STREQ(whole->share, "odd");
  EXPECT_THAT(sequence_list(whole->pair_shares), ElementsAre(0, 1, 0));
  EXPECT_THAT(first_objects(*whole), ElementsAre(0, 0, 1));
}

}  // namespace
}  // namespace clearance
