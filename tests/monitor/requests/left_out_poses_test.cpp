// Poses that a command leaves out: where the body is after the changes before it in the list.
//
// Oracle: the same changes, one command after another.
#include <gtest/gtest.h>

#include "tests/monitor/requests/commanded_cell.hpp"

namespace clearance {
namespace {

using test::at;

const std::string kPartElsewhere =
    "{name: part, groups: [things], fixed: true, pose: {xyz: [0.5, 0.7, 0]}, "
    "box: {size: [0.1, 0.1, 0.1]}}";

const Attach kWhereItIs{.object = "part", .to = "hand", .far = true};

class LeftOutPoses : public test::CommandedCell {
 protected:
  void begin() {
    start();
    poses->put({Vec3(0.5, 0, 0.2), test::turned(Vec3::UnitZ(), 0.5)});
    poses->settle();
  }
  // Does the list in one command, then one by one, and expects the part there. `part`: in the
  // world.
  void expect_part_at(const std::vector<CellChange>& list, const Vec3& part) {
    const std::string text = changer->cell().yaml;
    std::vector<CellChange> whole = list;
    whole.push_back(Detach{"part"});
    ASSERT_TRUE(execute(whole).done());
    EXPECT_LT((object("part").world_from_object.position - part).norm(), 1e-12);
    ASSERT_TRUE(execute({ReplaceCell{text}}).done());
    for (const CellChange& change : whole) {
      poses->settle();
      const CommandResult result = execute({change});
      ASSERT_TRUE(result.done()) << result.reason;
    }
    EXPECT_LT((object("part").world_from_object.position - part).norm(), 1e-12);
    ASSERT_TRUE(execute({ReplaceCell{text}}).done());
  }
};

TEST(PosesOfOneBodyInAnother, AreThatBodysOwnPlaceAndTurn) {
  const Pose a{{1, 2, 3}, Eigen::Quaterniond(0.5, 0.5, 0.5, 0.5)};
  const Pose b_in_a{{0.1, -0.2, 0.3}, Eigen::Quaterniond(0.6, 0.0, 0.8, 0.0)};
  const Pose b{a.position + a.orientation * b_in_a.position, a.orientation * b_in_a.orientation};
  const Pose found = a_from_b(a, b);
  EXPECT_LT((found.position - b_in_a.position).norm(), 1e-15);
  EXPECT_LT(found.orientation.angularDistance(b_in_a.orientation), 1e-7);
}

TEST_F(LeftOutPoses, AreThoseAfterTheChangesBefore) {
  begin();
  expect_part_at({ReplaceObject{kPartElsewhere}, kWhereItIs}, Vec3(0.5, 0.7, 0));
  expect_part_at({Place{"part", at(0.5, 0.6, 0)}, kWhereItIs}, Vec3(0.5, 0.6, 0));
  const Vec3 in_hand = Vec3(0.5, 0, 0.2) + test::turned(Vec3::UnitZ(), 0.5) * Vec3(0.3, 0, 0);
  expect_part_at({Attach{"part", "hand", at(0.3, 0, 0)}}, in_hand);
  expect_part_at(
      {Place{"part", at(3, 0, 0)}, Attach{"part", "hand", at(0.3, 0, 0)}, SetMargin{"part", 0.01}},
      in_hand);
}

TEST_F(LeftOutPoses, FollowCarriersThatTheChangesBeforeHaveMoved) {
  begin();
  expect_part_at({Attach{"part", "table", at(0, 0, 0.2)}, Place{"table", at(0, 3, 0)}},
                 Vec3(0, 3, 0.2));
  expect_part_at({AddFromTemplate{"bin", "bin_1", {}, at(3, 0, 0)},
                  Attach{"bin_1", "hand", at(0.3, 0, 0)}, Attach{"part", "bin_1", at(0, 0, 0.2)}},
                 Vec3(0.5, 0, 0.2) + test::turned(Vec3::UnitZ(), 0.5) * Vec3(0.3, 0, 0.2));
}

TEST_F(LeftOutPoses, OfWhatIsKnownToBeNowhereByThenAreRefused) {
  begin();
  const std::string moving = "{name: part, groups: [things], box: {size: [0.1, 0.1, 0.1]}}";
  for (const CellChange& before :
       {CellChange(SetAbsent{"part"}), CellChange(ReplaceObject{moving})}) {
    const CommandResult result =
        expect_refused({before, Attach{"part", "hand"}}, CommandStatus::kNoPose);
    EXPECT_EQ(result.change, 1u);
  }
  expect_refused({SetAbsent{"hand"}, Attach{"part", "hand"}}, CommandStatus::kNoPose);
}

// The bin stands 1 m from the hand, and is put into the part's place on it.
TEST_F(LeftOutPoses, AreThoseByWhichAnOverlapIsFoundToo) {
  begin();
  ASSERT_TRUE(execute({AddFromTemplate{"bin", "bin_1", {}, at(3, 0, 0)}}).done());
  const Attach part{"part", "hand", at(0.3, 0, 0)}, bin{"bin_1", "hand", at(0.3, 0, 0.05)};
  EXPECT_EQ(expect_refused({part, bin}, CommandStatus::kOverlap).change, 0u);
  EXPECT_TRUE(execute({part, Attach{"bin_1", "hand", at(0.3, 0, 0.2)}}).done());
}

// Only the scene to which the list leads comes into force.
TEST_F(LeftOutPoses, AreNotThoseOfAnOverlapWhereALaterChangePutsTheObjectElsewhere) {
  begin();
  const std::string text = changer->cell().yaml;
  const Attach deep{"part", "hand", Pose{}}, beside{"part", "hand", at(0.3, 0, 0)};
  const std::vector<CellChange> elsewhere = {
      beside, Detach{"part", at(3, 0, 0)}, ReplaceObject{kPartElsewhere},
      ReplaceObject{"{name: part, groups: [things], attached: {to: hand, pose: {xyz: [0.3, 0, 0]}},"
                    " box: {size: [0.1, 0.1, 0.1]}}"}};
  for (const CellChange& later : elsewhere) {
    const CommandResult result = execute({deep, later});
    EXPECT_TRUE(result.done()) << later.index() << result.reason;
    ASSERT_TRUE(execute({ReplaceCell{text}}).done());
  }
  EXPECT_EQ(expect_refused({beside, deep}, CommandStatus::kOverlap).change, 1u);
}

TEST_F(LeftOutPoses, AreThoseOfTheLastEntryByWhichAnOverlapIsFound) {
  begin();
  const Attach beside{"part", "hand", at(0.3, 0, 0)};
  const std::string into_hand =
      "{name: part, groups: [things], attached: {to: hand, pose: {xyz: [0.1, 0, 0]}},"
      " box: {size: [0.1, 0.1, 0.1]}}";
  const CommandResult result =
      expect_refused({beside, ReplaceObject{into_hand}}, CommandStatus::kOverlap);
  EXPECT_EQ(result.change, 0u);
  // The table is fixed, and its upper side is at -0.95 m.
  const Attach on_table{"part", "table", at(0, 0, 0.1)};
  EXPECT_TRUE(execute({on_table, SetMargin{"part", 0.01}}).done());
  const std::string into_table =
      "{name: part, groups: [things], attached: {to: table, pose: {xyz: [0, 0, 0.08]}},"
      " box: {size: [0.1, 0.1, 0.1]}}";
  EXPECT_EQ(expect_refused({on_table, ReplaceObject{into_table}}, CommandStatus::kOverlap).change,
            0u);
}

}  // namespace
}  // namespace clearance
