// Changes of a cell, one kind after another.
//
// Oracle: the ordinary reader, which reads the changed text as a file of its own.
#include "config/edit/cell_editor.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "tests/config/edit/edited_cell.hpp"
#include "tests/shared/places.hpp"
#include "tests/shared/poses.hpp"

namespace clearance {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST_F(CellEdits, WithoutChangesTheTextIsTheFile) {
  EXPECT_EQ(edit({}).yaml, kEditedCell);
  for (const char* name : {"two_arms.yaml", "mcintyre.yaml", "round_arm.yaml", "avoid.yaml"}) {
    const auto file = std::filesystem::path(test::places::sources()) / "config/cells" / name;
    const std::string text = test::read_text(file);
    auto opened = CellEditor::open(text, file);
    ASSERT_TRUE(std::holds_alternative<CellEditor>(opened)) << name;
    EXPECT_EQ(std::get<CellEditor>(opened).text(), text) << name;
  }
}

TEST_F(CellEdits, OtherEntriesKeepTheirTextAndComments) {
  const std::string text =
      edit({AddFromTemplate{"bin", "bin 1", {}, test::at(1.0, 2.0, 0.25)}}).yaml;
  std::string expected = kEditedCell;
  expected.insert(expected.find("pairs:\n"),
                  "  - {name: bin 1, template: bin, fixed: true, pose: {xyz: [1000, 2000, "
                  "250]}}\n");
  EXPECT_EQ(text, expected);
}

TEST_F(CellEdits, AnObjectIsAddedByItsTextOrFromATemplate) {
  const Cell cell = edit({AddObject{"{sphere: {radius: 0100.0}, name: ball, groups: [things]}"},
                          AddFromTemplate{"bin", "bin1", {}, test::at(1.0, 2.0, 0.25)}});
  EXPECT_EQ(named(cell, "ball").parts[0].shape.radius, 0.1);
  EXPECT_EQ(named(cell, "bin1").world_from_object.position, Vec3(1.0, 2.0, 0.25));
  EXPECT_EQ(named(cell, "bin1").margin, 0.005);
  EXPECT_THAT(cell.yaml, HasSubstr("- {name: ball, groups: [things], sphere: {radius: 100}}\n"));
}

TEST_F(CellEdits, AReplacedObjectKeepsItsPlaceAndTheRulesThatNameIt) {
  const Cell cell =
      edit({ReplaceObject{"{name: table, fixed: true, groups: [things], sphere: {radius: 100}}"}});
  EXPECT_EQ(cell.scene.objects[0].name, "table");
  EXPECT_EQ(named(cell, "table").parts[0].shape.radius, 0.1);
  EXPECT_EQ(named(cell, "table").world_from_object.position, Vec3::Zero());
  EXPECT_EQ(cell.scene.zones[0].pairs.size(), 1u);
  const EditRefusal unknown = refused({ReplaceObject{"{name: tables, sphere: {radius: 100}}"}});
  EXPECT_EQ(unknown.path, "objects");
}

TEST_F(CellEdits, AnExceptionIsTakenBackAloneWhileItsRuleStays) {
  edit({SetPair{"hand", "box", SetPair::Rule::kWatch}});
  const std::string before = editor_->text();
  const Cell left_out = edit({SetPair{"hand", "box", SetPair::Rule::kLeaveOut, "tested"}});
  EXPECT_EQ(pair(left_out, "hand", "box"), nullptr);
  const Cell cell = edit({SetPair{"box", "hand", SetPair::Rule::kNoException}});
  EXPECT_NE(pair(cell, "hand", "box"), nullptr);
  EXPECT_EQ(cell.yaml, before);
}

TEST_F(CellEdits, AMovedObjectIsWhereItWasSaidToBe) {
  const Pose turned(Vec3(0.1, 0.2, 0.3), Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5));
  const Cell cell = edit({Place{"table", turned}, Attach{"box", "tip", turned, {"cart"}}});
  EXPECT_EQ(named(cell, "table").world_from_object.position, turned.position);
  EXPECT_EQ(named(cell, "table").world_from_object.orientation.coeffs(),
            turned.orientation.coeffs());
  ASSERT_EQ(cell.scene.robots.size(), 2u);
  const RobotBase& base = cell.scene.robots[1].base;
  EXPECT_EQ(base.base_from_root.position, turned.position);
  EXPECT_EQ(base.base_from_root.orientation.coeffs(), turned.orientation.coeffs());
  EXPECT_EQ(pair(cell, "box", "cart"), nullptr);
  EXPECT_NE(pair(cell, "box", "table"), nullptr);
}

TEST_F(CellEdits, AnObjectThatReturnsToItsPlaceGivesTheFormerText) {
  edit({Attach{"box", "hand", test::at(0.1, 0, 0)}});
  EXPECT_FALSE(edit({SetAbsent{"cart"}, SetMargin{"cart", 0.2}}).yaml == kEditedCell);
  edit({Detach{"box", test::at(0, 0, 1.5)}});
  EXPECT_EQ(edit({SetMargin{"cart", std::nullopt}, SetAbsent{"cart", false}}).yaml, kEditedCell);
}

TEST_F(CellEdits, TheOrderOfChangesOfDifferentObjectsDoesNotShow) {
  const CellChange a = SetMargin{"table", 0.01}, b = Attach{"box", "hand", Pose{}},
                   c = SetPair{"hand", "table", SetPair::Rule::kPublish}, d = SetAbsent{"table"};
  const std::string text = edit({a, b, c, d}).yaml;
  editor_.emplace(open(kEditedCell));
  EXPECT_EQ(edit({d, c, b, a}).yaml, text);
  editor_.emplace(open(kEditedCell));
  edit({b});
  edit({d, a});
  EXPECT_EQ(edit({c}).yaml, text);
}

TEST_F(CellEdits, LimitsAndThresholdsAreSetInMetresAndNanoseconds) {
  const Cell cell =
      edit({SetMaxSpeed{"spare", 2.5}, SetMargin{"spare", 0.0125}, SetAgeLimit{"spare", 12'500'000},
            SetSource{"spare", "tracker"}, SetZoneThresholds{"stop", 0.0403, 0.07}});
  EXPECT_EQ(named(cell, "spare").max_speed, 2.5);
  EXPECT_EQ(named(cell, "spare").margin, 0.0125);
  EXPECT_EQ(named(cell, "spare").age_limit_ns, 12'500'000);
  EXPECT_EQ(named(cell, "spare").source, "tracker");
  EXPECT_EQ(cell.scene.zones[0].enter_below, 0.0403);
  EXPECT_EQ(cell.scene.zones[0].leave_above, 0.07);
  EXPECT_EQ(named(edit({SetAgeLimit{"spare", std::nullopt}}), "spare").age_limit_ns, 20'000'000);
}

TEST_F(CellEdits, AMarginOfALinkIsThatOfItsRobotAgainWhenItIsTakenAway) {
  EXPECT_EQ(named(edit({SetMargin{"hand", 0.02}}), "hand").margin, 0.02);
  EXPECT_EQ(named(edit({SetMargin{"base", 0.01}, SetMargin{"hand", 0.03}}), "hand").margin, 0.03);
  EXPECT_EQ(named(edit({}), "base").margin, 0.01);
  const EditRefusal refusal = refused({SetMargin{"hant", 0.02}});
  EXPECT_EQ(refusal.path, "margins[hant].name");
  EXPECT_THAT(refusal.reason, HasSubstr("'hand'"));
  EXPECT_EQ(edit({SetMargin{"hand", std::nullopt}, SetMargin{"base", std::nullopt}}).yaml,
            kEditedCell);
}

TEST_F(CellEdits, PairsAreWatchedPublishedAndLeftOut) {
  EXPECT_FALSE(pair(edit({}), "hand", "cart")->publish);
  EXPECT_TRUE(
      pair(edit({SetPair{"cart", "hand", SetPair::Rule::kPublish}}), "hand", "cart")->publish);
  EXPECT_FALSE(
      pair(edit({SetPair{"hand", "cart", SetPair::Rule::kWatch}}), "hand", "cart")->publish);
  EXPECT_EQ(
      pair(edit({SetPair{"hand", "cart", SetPair::Rule::kLeaveOut, "it docks"}}), "hand", "cart"),
      nullptr);
  EXPECT_NE(pair(edit({SetPair{"hand", "cart", SetPair::Rule::kPublish}}), "hand", "cart"),
            nullptr);
  EXPECT_EQ(edit({SetPair{"hand", "cart", SetPair::Rule::kUnstated}}).yaml, kEditedCell);
}

TEST_F(CellEdits, RulesThatOthersMakeVoidAreRefused) {
  EXPECT_EQ(refused({SetMargin{"box", 0.1}, SetPair{"spare", "cart", SetPair::Rule::kPublish},
                     SetPair{"arm", "things", SetPair::Rule::kPublish},
                     SetPair{"hand", "cart", SetPair::Rule::kWatch}})
                .change,
            3u);
  edit({SetPair{"arm", "cart", SetPair::Rule::kLeaveOut, "they dock"}});
  const EditRefusal refusal = refused({SetPair{"hand", "cart", SetPair::Rule::kWatch}});
  EXPECT_EQ(refusal.path, "pairs[hand, cart]");
}

TEST_F(CellEdits, AListIsDoneWhollyOrNotAtAll) {
  const EditRefusal refusal = refused(
      {RemoveObject{"box"}, Attach{"table", "hand", Pose{}}, AddFromTemplate{"bin", "b", {}, {}},
       SetPair{"hand", "cart", SetPair::Rule::kLeaveOut, "it docks"}, ReplaceCell{kEditedCell},
       RemoveObject{"cart"}});
  EXPECT_EQ(refusal.change, 5u);
  EXPECT_EQ(edit({}).yaml, kEditedCell);
}

TEST_F(CellEdits, ADryRunSaysTheSameAndChangesNothing) {
  const std::array<CellChange, 1> change{RemoveObject{"box"}};
  const auto result = editor_->dry_run(change);
  ASSERT_TRUE(std::holds_alternative<Cell>(result));
  EXPECT_EQ(editor_->text(), kEditedCell);
  EXPECT_EQ(edit({change[0]}).yaml, std::get<Cell>(result).yaml);
}

TEST_F(CellEdits, AWholeCellReplacesThisOne) {
  std::string other = kEditedCell;
  other.replace(other.find("name: test"), 10, "name: next");
  EXPECT_EQ(edit({RemoveObject{"box"}, ReplaceCell{other}, SetAbsent{"cart"}}).scene.name, "next");
  EXPECT_EQ(refused({ReplaceCell{"name: [1"}}).change, 0u);
  const EditRefusal refusal = refused({SetAbsent{"table"}, ReplaceCell{"name: test\n"}});
  EXPECT_EQ(refusal.change, 1u);
  EXPECT_EQ(edit({}).scene.name, "next");
}

TEST_F(CellEdits, AContactIsAllowedReplacedAndWithdrawn) {
  AllowContact change{"lift", "box", "hand", 0.002, {}, "planner", "it is grasped"};
  change.end = {.distance = 0.01,
                .duration_ns = 1'500'000,
                .time_ns = 1'700'000'000'123'456'789,
                .last_cycle = 9'007'199'254'740'993};
  const Cell cell = edit({change});
  EXPECT_THAT(cell.yaml, HasSubstr("contacts:\n  - name: lift\n"));
  ASSERT_EQ(cell.scene.contacts.size(), 1u);
  const AllowedContact& contact = cell.scene.contacts[0];
  EXPECT_EQ(contact.depth, 0.002);
  EXPECT_TRUE(contact.end == change.end);
  EXPECT_EQ(contact.by, "planner");
  ASSERT_EQ(contact.pairs.size(), 1u);
  EXPECT_EQ(cell.scene.pairs[contact.pairs[0]].publish, true);
  EXPECT_THAT(refused({RemoveObject{"box"}}).reason, HasSubstr("contacts[lift]"));

  change.end = {};
  change.depth = 0.003;
  const Cell replaced = edit({change});
  ASSERT_EQ(replaced.scene.contacts.size(), 1u);
  EXPECT_EQ(replaced.scene.contacts[0].depth, 0.003);
  EXPECT_TRUE(replaced.scene.contacts[0].end == ContactEnd{});
  EXPECT_EQ(edit({WithdrawContact{"lift"}}).yaml, kEditedCell);
  EXPECT_EQ(refused({WithdrawContact{"lift"}}).path, "contacts");
}

TEST_F(CellEdits, AContactThatTheLoaderRefusesIsRefused) {
  const AllowContact good{"lift", "box", "hand", 0.002, {}, "planner", "it is grasped"};
  AllowContact change = good;
  change.depth = 0.0;
  EXPECT_EQ(refused({change}).path, "contacts[lift].depth");
  change = good;
  change.b = "table";
  const EditRefusal refusal = refused({SetAbsent{"cart"}, change});
  EXPECT_EQ(refusal.change, 1u) << "both are fixed";
  EXPECT_EQ(refusal.path, "contacts[lift]");
  change = good;
  change.contact = "again";
  EXPECT_EQ(refused({good, change}).path, "contacts[again]") << "one contact for a pair";
}

// While the box is attached, it has the pairs of its carrier, and none with it.
TEST_F(CellEdits, WhatAClientHasSaidOfAPairForbidsNoLaterAttachOrDetach) {
  for (const SetPair::Rule rule :
       {SetPair::Rule::kPublish, SetPair::Rule::kWatch, SetPair::Rule::kLeaveOut}) {
    for (const char* other : {"hand", "table", "cart"}) {
      editor_.emplace(open(kEditedCell));
      const SetPair set{"box", other, rule, "tested"};
      const std::vector<CellChange> before = {set};
      if (std::holds_alternative<EditRefusal>(editor_->edit(before))) continue;
      edit({Attach{"box", "hand", test::at(0.1, 0, 0)}});
      edit({Detach{"box", test::at(0, 0, 1.5)}});
      const std::vector<CellChange> again = {Attach{"box", "hand", test::at(0.1, 0, 0)}};
      edit(again);
      if (std::holds_alternative<EditRefusal>(editor_->edit(before))) continue;
      edit({Detach{"box", test::at(0, 0, 1.5)}});
    }
  }
}

TEST_F(CellEdits, WhatOthersNameIsNotRemoved) {
  EXPECT_THAT(refused({RemoveObject{"cart"}}).reason, HasSubstr("pairs[spare, cart]"));
  EXPECT_THAT(refused({RemoveObject{"table"}}).reason, HasSubstr("zones[stop]"));
  edit({Attach{"box", "cart", Pose{}}, SetPair{"spare", "cart", SetPair::Rule::kUnstated},
        SetPair{"spare", "base", SetPair::Rule::kWatch}});
  const EditRefusal refusal = refused({SetAbsent{"cart"}, RemoveObject{"cart"}});
  EXPECT_THAT(refusal.reason, HasSubstr("objects[box]"));
  EXPECT_EQ(refusal.change, 1u);
  EXPECT_EQ(refusal.path, "objects[cart]");
  EXPECT_THAT(edit({RemoveObject{"box"}, RemoveObject{"cart"}}).yaml, Not(HasSubstr("cart")));
}

TEST_F(CellEdits, ARefusalNamesTheChangeTheFieldAndTheReason) {
  EditRefusal refusal =
      refused({SetAbsent{"box"}, Attach{"box", "hnd", Pose{}}, SetAbsent{"cart"}});
  EXPECT_EQ(refusal.change, 1u);
  EXPECT_EQ(refusal.path, "objects[box].attached.to");
  EXPECT_THAT(refusal.reason, HasSubstr("hand"));
  EXPECT_THAT(refusal.reason, Not(HasSubstr("cell.yaml")));

  refusal = refused({SetMargin{"cart", 0.1}, SetMargin{"cart", -0.1}});
  EXPECT_EQ(refusal.path, "objects[cart].margin");
  EXPECT_EQ(refusal.change, 1u);

  refusal =
      refused({SetAbsent{"box"}, AddObject{"{name: box, sphere: {radius: 1}, groups: [things]}"}});
  EXPECT_EQ(refusal.change, 1u);

  refusal = refused({SetAbsent{"box"}, SetZoneThresholds{"stop", 0.2, 0.1}});
  EXPECT_EQ(refusal.path, "zones[stop].leave_above");
  EXPECT_EQ(refusal.change, 1u);
}

// The mistake stands elsewhere than the change that made it.
TEST_F(CellEdits, AChangeThatMakesAnotherEntryWrongIsNamed) {
  const EditRefusal refusal =
      refused({SetAbsent{"box"}, SetPair{"spare", "cart", SetPair::Rule::kUnstated},
               SetMargin{"box", 0.1}});
  EXPECT_EQ(refusal.path, "objects[spare].name");
  EXPECT_EQ(refusal.change, 1u);
}

TEST_F(CellEdits, EachImpossibleChangeIsRefused) {
  const std::vector<CellChange> impossible = {
      AddObject{"[1, 2]"},
      AddObject{"{name: "},
      AddObject{"{sphere: {radius: 1}}"},
      AddObject{"{name: lonely, sphere: {radius: 1}}"},
      AddObject{"{name: odd, groups: [things], sphere: {radius: -1}}"},
      AddObject{"{name: odd, groups: [unused, things], sphere: {radius: 1}}"},
      AddFromTemplate{"bun", "b", {}, {}},
      AddFromTemplate{"bin", "box", {}, {}},
      AddFromTemplate{"bin", "a,b", {}, {}},
      RemoveObject{"nothing"},
      RemoveObject{"hand"},
      SetAbsent{"hand"},
      Attach{"hand", "cart", Pose{}},
      Attach{"box", "box", Pose{}},
      Attach{"box", "nowhere", Pose{}},
      Attach{"box", "hand", Pose{}, {"nothing"}},
      Attach{"box", "hand", Pose(Vec3(1e9, 0, 0), Eigen::Quaterniond::Identity())},
      Attach{"box", "hand", Pose(Vec3(kInfinity, 0, 0), Eigen::Quaterniond::Identity())},
      Attach{"box", "hand", Pose(Vec3::Zero(), Eigen::Quaterniond(2, 1, 0, 0))},
      Detach{"box", Pose{}},
      Attach{"box", "hand"},
      Detach{"box"},
      ReadCellAgain{},
      Place{"cart", {}},
      SetMaxSpeed{"box", 1.0},
      SetMaxSpeed{"cart", -1.0},
      SetMargin{"box", std::nan("")},
      SetAgeLimit{"cart", -1},
      SetSource{"cart", "a name that is longer than a batch can carry"},
      SetPair{"hand", "hand", SetPair::Rule::kPublish},
      SetPair{"hand", "nothing", SetPair::Rule::kPublish},
      SetPair{"table", "box", SetPair::Rule::kPublish},
      SetPair{"hand", "cart", SetPair::Rule::kLeaveOut, ""},
      SetZoneThresholds{"stap", 0.1, 0.2},
      SetZoneThresholds{"stop", 0.1, 0.05},
  };
  for (std::size_t i = 0; i < impossible.size(); ++i) {
    SCOPED_TRACE(i);
    EXPECT_EQ(refused({impossible[i]}).change, 0u);
    EXPECT_EQ(refused({SetAbsent{"cart"}, impossible[i]}).change, 1u);
  }
}

TEST_F(CellEdits, CirclesOfAttachedObjectsAreRefused) {
  edit({Attach{"box", "cart", Pose{}}});
  EXPECT_THAT(refused({Attach{"cart", "box", Pose{}}}).reason, HasSubstr("circle"));
}

// The first of the two marks a value for the second one.
TEST_F(CellEdits, AnchorsAreWrittenOutWhereTheirValueIsChanged) {
  const std::string shared =
      "name: test\nunits: {length: m, angle: deg}\nobjects:\n"
      "  - {name: a, fixed: true, sphere: &ball {radius: 1}}\n"
      "  - {name: b, sphere: *ball} # as a\n"
      "  - {name: c, sphere: {radius: 2}}\n"
      "pairs: [{between: [b, a]}, {between: [c, b]}]\n";
  editor_.emplace(open(shared));
  EXPECT_THAT(edit({SetMargin{"c", 0.1}}).yaml, HasSubstr("*ball} # as a"));
  const std::string text = edit({SetMargin{"a", 0.1}}).yaml;
  EXPECT_THAT(text, HasSubstr("- {name: b, sphere: {radius: 1}}\n"));
  EXPECT_THAT(text, Not(HasSubstr("*")));
  EXPECT_EQ(edit({SetMargin{"a", std::nullopt}, SetMargin{"c", std::nullopt}}).yaml, shared);
}

TEST_F(CellEdits, CellsThatAreWrittenOnOneLineGetLines) {
  editor_.emplace(
      open("{name: test, units: {length: m, angle: deg}, objects: [{name: a, sphere: {radius: 1}}, "
           "{name: b, sphere: {radius: 1}}], pairs: [{between: [a, b]}]}"));
  EXPECT_EQ(edit({SetMargin{"a", 0.1}}).yaml,
            "name: test\nunits: {length: m, angle: deg}\nobjects:\n"
            "  - {name: a, sphere: {radius: 1}, margin: 0.1}\n"
            "  - {name: b, sphere: {radius: 1}}\npairs:\n  - {between: [a, b]}\n");
}

}  // namespace
}  // namespace clearance
