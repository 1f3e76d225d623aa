// Commands that attach robots to flanges and detach them, and what is refused.
//
// Oracle: the places of the arm by the sum of angles (tests/shared/tool_cell.hpp).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/monitor/requests/commanded_cell.hpp"
#include "tests/shared/tool_cell.hpp"

namespace clearance {
namespace {

using test::at;
using testing::HasSubstr;

class ToolCommands : public test::CommandedCell {
 protected:
  // The flange begins at the gripper in its dock, to within a millimetre.
  void begin(std::string text = test::kToolCell) {
    text.replace(text.find("objects:"), 0, "defaults: {age_limit_ms: 60000}\n");
    test::write_tools(folder, text);
    start(text);
    move_to(in_dock_);
  }
  void move_to(const test::ToolArm& arm, double finger = 0.01) {
    poses->put_joints({arm.shoulder, arm.elbow, arm.roll, finger});
    poses->settle();
  }
  [[nodiscard]] const Robot& robot(const std::string& name) const {
    const auto& robots = changer->cell().scene.robots;
    return *std::ranges::find(robots, name, &Robot::name);
  }
  [[nodiscard]] const JointVariable& variable(const std::string& name) const {
    const auto& variables = changer->cell().scene.variables;
    return *std::ranges::find(variables, name, &JointVariable::name);
  }
  void expect_base(const std::string& name, const Pose& pose) const {
    const Pose& base = robot(name).base.base_from_root;
    EXPECT_LT((base.position - pose.position).norm(), 1e-12);
    EXPECT_LT(base.orientation.angularDistance(pose.orientation), 1e-7);
  }
  // Attaches the gripper where it is.
  void attach() {
    const CommandResult result = execute({AttachRobot{.robot = "gripper", .to = "flange"}});
    ASSERT_TRUE(result.done()) << result.path << ": " << result.reason;
  }

  const test::ToolArm in_dock_{0.9, -0.9, 0.0};
};

TEST_F(ToolCommands, WithoutAPoseAttachAToolWhereItIsInTheFlange) {
  begin();
  attach();
  EXPECT_EQ(robot("gripper").base.kind, RobotBase::Kind::kLink);
  const Pose flange = in_dock_.flange();
  const Eigen::Quaterniond back = flange.orientation.conjugate();
  expect_base("gripper", {back * (Vec3(1.6716, 0.7833, 0) - flange.position), back});
  EXPECT_FALSE(variable("g_finger").is_held());
  EXPECT_THAT(object("g_left").groups, testing::ElementsAre("gripper", "arm"));
}

TEST_F(ToolCommands, DetachAToolWhereItIsAndItsJointsStandThere) {
  begin();
  attach();
  const test::ToolArm elsewhere{0.902, -0.901, 0.01};
  move_to(elsewhere, 0.012);
  const Pose on_flange = robot("gripper").base.base_from_root;
  ASSERT_TRUE(execute({DetachRobot{.robot = "gripper"}}).done());
  expect_base("gripper", compose(elsewhere.flange(), on_flange));
  EXPECT_EQ(robot("gripper").base.kind, RobotBase::Kind::kWorld);
  EXPECT_EQ(variable("g_finger").held, 0.012);
  EXPECT_THAT(object("g_left").groups, testing::ElementsAre("gripper"));
}

TEST_F(ToolCommands, AreRefusedWhileAJointThatIsToStandMoves) {
  begin();
  attach();
  std::atomic<bool> is_open{false};
  std::thread opening([&] {
    for (double finger = 0.01; finger < 0.04 && !is_open; finger += 5e-5) {
      poses->put_joints({in_dock_.shoulder, in_dock_.elbow, in_dock_.roll, finger});
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  });
  CommandResult result;
  for (int i = 0; i < 100 && result.status == CommandStatus::kDone; ++i)
    result = execute(Command{.dry_run = true, .changes = {DetachRobot{.robot = "gripper"}}});
  is_open = true;
  opening.join();
  EXPECT_EQ(result.status, CommandStatus::kNoPose) << result.reason;
  EXPECT_THAT(result.reason, HasSubstr("found that 'finger' moves by"));
}

TEST_F(ToolCommands, DetachAToolWithPowerWhoseJointsAreReadOn) {
  begin();
  attach();
  const CommandResult both = expect_refused(
      {DetachRobot{.robot = "gripper", .joints = {{"finger", 0.01}}, .powered = true}},
      CommandStatus::kRefused);
  EXPECT_EQ(both.path, "robots[gripper].joints");
  ASSERT_TRUE(execute({DetachRobot{.robot = "gripper", .powered = true}}).done());
  EXPECT_FALSE(variable("g_finger").is_held());
}

TEST_F(ToolCommands, MakeAToolAbsentAndPresentAgain) {
  begin();
  attach();
  ASSERT_TRUE(execute({DetachRobot{.robot = "gripper", .absent = true}}).done());
  EXPECT_TRUE(object("g_palm").absent && object("g_left").absent);
  EXPECT_FALSE(object("t_tip").absent);
  const CommandResult nowhere =
      expect_refused({AttachRobot{.robot = "gripper", .to = "flange"}}, CommandStatus::kNoPose);
  EXPECT_THAT(nowhere.reason, HasSubstr("absent"));
  ASSERT_TRUE(
      execute({AttachRobot{.robot = "gripper", .to = "flange", .carrier_from_root = Pose{}}})
          .done());
  EXPECT_FALSE(object("g_palm").absent);
  ASSERT_TRUE(execute({SetAbsent{"torch"}}).done());
  EXPECT_TRUE(object("t_tip").absent);
  expect_refused({AttachRobot{.robot = "torch", .to = "flange"}}, CommandStatus::kNoPose);
}

TEST_F(ToolCommands, ChangeOneToolForAnotherInOneList) {
  begin();
  attach();
  const CommandResult result = execute(
      {DetachRobot{.robot = "gripper"},
       AttachRobot{.robot = "torch", .to = "flange", .carrier_from_root = Pose{}, .far = true}});
  ASSERT_TRUE(result.done()) << result.reason;
  EXPECT_EQ(robot("gripper").base.kind, RobotBase::Kind::kWorld);
  EXPECT_EQ(robot("torch").base.kind, RobotBase::Kind::kLink);
}

TEST_F(ToolCommands, AreRefusedByTheNameThatIsUnknown) {
  begin();
  const CommandResult no_robot =
      expect_refused({AttachRobot{.robot = "griper", .to = "flange", .carrier_from_root = Pose{}}},
                     CommandStatus::kRefused);
  EXPECT_THAT(no_robot.reason, HasSubstr("did you mean 'gripper'"));
  const CommandResult no_link =
      expect_refused({AttachRobot{.robot = "gripper", .to = "flnge", .carrier_from_root = Pose{}}},
                     CommandStatus::kRefused);
  EXPECT_EQ(no_link.path, "robots[gripper].attached.to");
  EXPECT_THAT(no_link.reason, HasSubstr("did you mean 'flange'"));
  EXPECT_THAT(
      expect_refused({AttachRobot{.robot = "gripper", .to = "flnge"}}, CommandStatus::kRefused)
          .reason,
      HasSubstr("did you mean 'flange'"));
  EXPECT_THAT(expect_refused({DetachRobot{.robot = "gripper"}}, CommandStatus::kRefused).reason,
              HasSubstr("not attached"));
}

TEST_F(ToolCommands, AreRefusedForAToolThatIsCarried) {
  begin();
  attach();
  const CommandResult held =
      expect_refused({AttachRobot{.robot = "gripper", .to = "wrist", .carrier_from_root = Pose{}}},
                     CommandStatus::kRefused);
  EXPECT_THAT(held.reason, HasSubstr("attached to 'flange'"));
}

TEST_F(ToolCommands, AreRefusedForAToolThatIsFarAwayUnlessThatIsMeant) {
  begin();
  AttachRobot torch{.robot = "torch", .to = "flange", .carrier_from_root = Pose{}};
  const CommandResult far = expect_refused({torch}, CommandStatus::kRefused);
  EXPECT_THAT(far.reason, HasSubstr("1.567 m from where 'flange' would carry it"));
  torch.far = true;
  EXPECT_TRUE(execute({torch}).done());
}

TEST_F(ToolCommands, AreRefusedForAToolThatOverlapsWhatCarriesIt) {
  begin();
  AttachRobot deep{.robot = "gripper", .to = "flange", .carrier_from_root = at(-0.06, 0, 0)};
  const CommandResult result = expect_refused({deep}, CommandStatus::kOverlap);
  EXPECT_THAT(result.reason, HasSubstr("overlaps 'wrist' by 0.06 m"));
  deep.overlap = 0.07;
  EXPECT_TRUE(execute({deep}).done());
}

TEST_F(ToolCommands, AreRefusedWhileAJointThatIsToStandIsNotKnown) {
  std::string text = test::kToolCell;
  const std::string dock =
      "base: {pose: {xyz: [1.6716, -0.7833, 0]}}\n    joints: {tilt: {position: 0.2}}";
  text.replace(text.find(dock), dock.size(), "attached: {to: flange}");
  begin(text);
  const DetachRobot away{.robot = "torch", .world_from_root = Pose{}, .absent = true};
  const CommandResult result = expect_refused(
      {DetachRobot{.robot = "torch", .world_from_root = Pose{}}}, CommandStatus::kNoPose);
  EXPECT_EQ(result.path, "robots[torch].joints");
  EXPECT_TRUE(execute({away}).done());
}

}  // namespace
}  // namespace clearance
