// The key `partner:` of a cell.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/config/cells.hpp"
#include "tests/shared/mistake_at.hpp"

namespace clearance {
namespace {

using test::mistake_at;

std::string with_partner(const std::string& partner) { return cell_text(partner + kBoxes); }

TEST(PartnerOfACell, IsNoneUnlessTheCellNamesOne) {
  EXPECT_EQ(read_good(with_partner("")).partner, "");
  EXPECT_EQ(read_good(with_partner("partner: left\n")).partner, "left");
  EXPECT_EQ(read_good(with_partner("partner: 'left-2'  # this machine\n")).partner, "left-2");
}

TEST(PartnerOfACell, IsRefusedWithItsPlaceWhereItIsNoName) {
  EXPECT_THAT(errors_of(with_partner("partner: the left\n")), mistake_at("4:10", "without blanks"));
  EXPECT_THAT(errors_of(with_partner("partner: ''\n")), mistake_at("4:10", "1 to 32"));
  EXPECT_THAT(errors_of(with_partner("partner: " + std::string(33, 'n') + "\n")),
              mistake_at("4:10", "32"));
  EXPECT_THAT(errors_of(with_partner("partner: [left]\n")), mistake_at("4:10"));
  EXPECT_THAT(errors_of(with_partner("partners: left\n")), mistake_at("4:1", "partner"));
}

// Sources and clients name the revision, and are the same for both partners.
TEST(PartnerOfACell, IsNoPartOfTheRevisionInALineOfItsOwn) {
  const auto revision = [](const std::string& text) { return scene_of(text).revision; };
  const std::uint64_t none = revision(with_partner(""));
  EXPECT_EQ(revision(with_partner("partner: left\n")), none);
  EXPECT_EQ(revision(with_partner("partner: \"right\" # as on the door\n")), none);
  EXPECT_EQ(revision(cell_text(kBoxes + "partner: left\n")), none);
  EXPECT_EQ(revision(cell_text(kBoxes + "partner: left")), none);
  EXPECT_NE(revision(with_partner("budget: 1999\npartner: left\n")), none);
  EXPECT_NE(revision(with_partner("partner: left\n\n")), none) << "another line is part of it";
}

TEST(PartnerOfACell, IsReadInFlowStyleToo) {
  const std::string text =
      "{name: test, units: {length: m, angle: deg}, partner: left, objects: "
      "[{name: a, sphere: {radius: 1}}, {name: b, sphere: {radius: 1}}], "
      "pairs: [{between: [a, b]}]}\n";
  EXPECT_EQ(read_good(text).partner, "left");
}

TEST(PartnerOfACell, MayHaveSensors) {
  const std::string text =
      with_partner(
          "partner: left\nsensors: [{name: eye, points: /points, depth_error: {constant: 0.001}, "
          "range: [0.25, 4]}]\n") +
      "  - {between: [arm, eye]}\n";
  EXPECT_EQ(read_good(text).partner, "left");
}

}  // namespace
}  // namespace clearance
