// A command changes the scene of a running loop, or is refused with a reason.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "monitor/requests/kept_scene.hpp"
#include "tests/monitor/requests/commanded_cell.hpp"

namespace clearance {
namespace {

using test::at;
using test::write_text;
using testing::HasSubstr;

using SceneCommands = test::CommandedCell;

const std::string kTetrahedron =
    "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";

TEST_F(SceneCommands, AreInForceWithTheirResult) {
  start();
  const std::uint64_t before = revision();
  const CommandResult result =
      execute({AddFromTemplate{"bin", "bin_1", {}, at(0, 2, 0)}, SetMargin{"table", 0.01}});
  ASSERT_TRUE(result.done()) << result.reason;
  EXPECT_EQ(result.client, "planner");
  EXPECT_EQ(result.request, 1u);
  EXPECT_NE(result.scene_revision, before);
  EXPECT_EQ(result.scene_revision, revision());
  EXPECT_GT(result.in_force_from, 0u);
  EXPECT_EQ(object("bin_1").world_from_object.position, Vec3(0, 2, 0));
  EXPECT_EQ(object("table").margin, 0.01);
}

TEST_F(SceneCommands, AreDoneWhollyOrNotAtAll) {
  start();
  const CommandResult result = expect_refused(
      {SetMargin{"table", 0.01}, SetMargin{"nothing", 0.01}, SetMargin{"part", 0.02}},
      CommandStatus::kRefused);
  EXPECT_EQ(result.change, 1u);
  EXPECT_EQ(result.path, "objects");
  EXPECT_EQ(changes, 0);
}

TEST_F(SceneCommands, ThatChangeNothingAreDoneAndKeepTheScene) {
  start();
  ASSERT_TRUE(execute({SetMargin{"table", 0.01}}).done());
  const CommandResult first = execute({SetMargin{"table", 0.01}}), none = execute(Command{});
  for (const CommandResult& result : {first, none}) {
    EXPECT_TRUE(result.done()) << result.reason;
    EXPECT_EQ(result.scene_revision, revision());
    EXPECT_GT(result.in_force_from, 0u);
  }
}

TEST_F(SceneCommands, InADryRunAnswerTheSameAndChangeNothing) {
  start();
  const std::uint64_t before = revision();
  const std::vector<CellChange> list = {AddFromTemplate{"bin", "bin_1", {}, at(0, 2, 0)}};
  const CommandResult dry = execute(Command{.dry_run = true, .changes = list});
  EXPECT_TRUE(dry.done());
  EXPECT_EQ(dry.in_force_from, 0u);
  EXPECT_EQ(revision(), before);
  EXPECT_EQ(changes, 0);
  EXPECT_EQ(execute(list).scene_revision, dry.scene_revision);
  EXPECT_EQ(revision(), dry.scene_revision);
}

TEST_F(SceneCommands, ForAnotherRevisionAreRefused) {
  start();
  const std::vector<CellChange> list = {SetMargin{"table", 0.01}};
  const std::uint64_t first = revision();
  ASSERT_TRUE(execute(Command{.scene_revision = first, .changes = list}).done());
  expect_refused(Command{.scene_revision = first, .changes = {SetMargin{"table", 0.02}}},
                 CommandStatus::kOtherRevision);
}

// The hand is turned by a quarter turn, so that a confusion of the two frames shows.
TEST_F(SceneCommands, AttachWhereTheObjectIsAndDetachWhereItIsThen) {
  start();
  poses->put({Vec3(0.5, 0, 0.2), test::turned(Vec3::UnitZ(), std::numbers::pi / 2)});
  poses->settle();
  ASSERT_TRUE(execute({Attach{"part", "hand"}}).done());
  poses->put({Vec3(0.75, 0, 0.2), test::turned(Vec3::UnitZ(), std::numbers::pi)});
  poses->settle();
  const CommandResult result = execute({Detach{"part"}});
  ASSERT_TRUE(result.done()) << result.reason;
  EXPECT_TRUE(object("part").fixed);
  // The part was 0.5 m beside the hand along x and 0.2 m below: now along y.
  EXPECT_LT((object("part").world_from_object.position - Vec3(0.75, 0.5, 0)).norm(), 1e-12);
}

TEST_F(SceneCommands, AttachWithoutAPoseOfTheCarrierIsRefused) {
  start();
  const CommandResult unknown = expect_refused({Attach{"part", "hand"}}, CommandStatus::kNoPose);
  EXPECT_EQ(unknown.change, 0u);
  EXPECT_THAT(unknown.path, HasSubstr("hand"));
  poses->put(at(0.5, 0, 0));
  poses->settle();
  EXPECT_TRUE(execute({Attach{"part", "hand"}}).done());
  expect_refused({SetMargin{"table", 0.1}, Attach{"table", "finger"}}, CommandStatus::kNoPose);
  const CommandResult misspelt = expect_refused({Attach{"part", "hnd"}}, CommandStatus::kRefused);
  EXPECT_THAT(misspelt.reason, HasSubstr("did you mean 'hand'"));
}

TEST_F(SceneCommands, AttachWhereAnEarlierChangeOfTheSameCommandHasPutTheObject) {
  start();
  poses->put(at(0.5, 0, 0));
  poses->settle();
  ASSERT_TRUE(
      execute({AddFromTemplate{"bin", "bin_1", {}, at(0.5, 0.4, 0)}, Attach{"bin_1", "hand"}})
          .done());
  ASSERT_TRUE(execute({Detach{"bin_1"}}).done());
  EXPECT_LT((object("bin_1").world_from_object.position - Vec3(0.5, 0.4, 0)).norm(), 1e-12);
}

// The cube of 0.1 m in the middle of one of 0.2 m has to move by 0.15 m to leave it.
TEST_F(SceneCommands, AttachingTooDeepIsRefusedWithTheDepthUnlessThatIsStated) {
  start();
  const CommandResult result =
      expect_refused({Attach{"part", "hand", Pose{}}}, CommandStatus::kOverlap);
  EXPECT_THAT(result.reason, HasSubstr("'hand' by 0.15 m"));
  EXPECT_THAT(result.path, HasSubstr("part"));
  expect_refused({Attach{"part", "hand", Pose{}, {}, 0.149}}, CommandStatus::kOverlap);
  EXPECT_TRUE(execute({Attach{"part", "hand", Pose{}, {}, 0.151}}).done());
}

// Cubes of 0.2 and 0.1 m: their surfaces are 0.15 m nearer than their centres.
TEST_F(SceneCommands, AttachingWhatLiesFarAwayIsRefusedUnlessThatIsStated) {
  start();
  EXPECT_TRUE(execute({Attach{"part", "hand", at(0.6, 0, 0)}}).done());
  const CommandResult result =
      expect_refused({Attach{"part", "hand", at(1.05, 0, 0)}}, CommandStatus::kRefused);
  EXPECT_THAT(result.reason, HasSubstr("0.9 m from 'hand'"));
  EXPECT_THAT(result.path, HasSubstr("part"));
  EXPECT_TRUE(execute({Attach{"part", "hand", at(1.05, 0, 0), {}, std::nullopt, true}}).done());
}

TEST_F(SceneCommands, AttachingALittleDeepIsNot) {
  start();
  EXPECT_TRUE(execute({Attach{"part", "hand", at(0.15 - 0.0009, 0, 0)}}).done());
  expect_refused({Attach{"part", "hand", at(0.15 - 0.0011, 0, 0)}}, CommandStatus::kOverlap);
}

TEST_F(SceneCommands, AttachingIntoWhatMayBeTouchedIsRefused) {
  start();
  poses->put(at(0.5, 0, 0));
  poses->settle();
  const Attach into_table{"part", "hand", at(-0.5, 0, -1), {"table"}};
  EXPECT_THAT(expect_refused({into_table}, CommandStatus::kOverlap).reason, HasSubstr("'table'"));
  Attach far = into_table;
  far.far = true;
  EXPECT_TRUE(execute({Place{"table", at(0, 3, -1)}, far}).done());
}

TEST_F(SceneCommands, BeyondTheCapacityAreRefusedWithItsKey) {
  start();
  const auto bin = [](const std::string& name) {
    return AddFromTemplate{"bin", name, {}, at(0, 2, 0)};
  };
  ASSERT_TRUE(execute({bin("a"), bin("b")}).done());
  EXPECT_THAT(expect_refused({bin("c")}, CommandStatus::kBeyondCapacity).reason,
              HasSubstr("objects"));
  EXPECT_TRUE(execute({RemoveObject{"b"}, bin("c")}).done());
  const std::string sphere = "{sphere: {radius: 1}, name: s";
  EXPECT_THAT(expect_refused({RemoveObject{"c"},
                              AddObject{"{name: many, groups: [things], fixed: true, parts: [" +
                                        sphere + "1}, " + sphere + "2}, " + sphere + "3}]}"}},
                             CommandStatus::kBeyondCapacity)
                  .reason,
              HasSubstr("parts"));
  EXPECT_THAT(expect_refused({ReplaceCell{changer->cell().yaml + "# " + std::string(20'001, 'x')}},
                             CommandStatus::kBeyondCapacity)
                  .reason,
              HasSubstr("bytes"));
}

TEST_F(SceneCommands, ThatTakeARestartAreRefused) {
  start();
  std::string text = test::kCommandedCell;
  text.replace(text.find("rate_hz: 500"), 12, "rate_hz: 400");
  EXPECT_THAT(expect_refused({ReplaceCell{text}}, CommandStatus::kNeedsRestart).reason,
              HasSubstr("rate"));
  text = test::kCommandedCell;
  text.replace(text.find("[planner]"), 9, "[planner, x]");
  expect_refused({ReplaceCell{text}}, CommandStatus::kNeedsRestart);
}

TEST_F(SceneCommands, NameFilesOfStatedFoldersOnlyAndSendThem) {
  start();
  std::filesystem::create_directories(folder / "allowed");
  write_text(folder / "allowed" / "a.obj", kTetrahedron);
  write_text(folder / "secret.obj", kTetrahedron);
  const auto object_of = [](const std::string& file, const std::string& name) {
    return AddObject{"{name: " + name + ", groups: [things], fixed: true, mesh: {file: \"" + file +
                     "\"}}"};
  };
  for (const char* file : {"secret.obj", "allowed/../secret.obj", "sent:a.obj"}) {
    const CommandResult result = execute({object_of(file, "m")});
    EXPECT_FALSE(result.done()) << file;
  }
  expect_refused({object_of("secret.obj", "m")}, CommandStatus::kFileRefused);
  std::string reasons[2];
  for (const int there : {0, 1}) {
    const std::string file = there == 1 ? "secret.obj" : "nothing.obj";
    std::string& reason = reasons[there];
    reason = expect_refused({object_of(file, "m")}, CommandStatus::kFileRefused).reason;
    reason.replace(reason.find(file), file.size(), "FILE");
  }
  EXPECT_EQ(reasons[0], reasons[1]) << "the answer does not tell what exists";
  std::filesystem::create_symlink(folder / "secret.obj", folder / "allowed" / "link.obj");
  expect_refused({object_of("allowed/link.obj", "m")}, CommandStatus::kFileRefused);
  EXPECT_TRUE(execute({object_of("allowed/a.obj", "m")}).done());
  const CommandResult sent = execute(Command{.changes = {object_of("sent:b.obj", "n")},
                                             .files = {{"b.obj", kTetrahedron + "# b\n"}}});
  ASSERT_TRUE(sent.done()) << sent.reason;
  write_text(folder / "later.yaml", changer->cell().yaml);
  const auto later = read_cell(folder / "later.yaml");
  ASSERT_TRUE(std::holds_alternative<Cell>(later)) << "the text can be read again";
  EXPECT_EQ(std::get<Cell>(later).scene.revision, revision());
}

TEST_F(SceneCommands, KeepSentFilesAsLongAsACellOfTheLastEightNamesThem) {
  start();
  const auto add = [&](const std::string& name) {
    const std::string file = name + ".obj";
    return execute(Command{.changes = {AddObject{"{name: " + name +
                                                 ", groups: [things], fixed: true, mesh: {file: "
                                                 "\"sent:" +
                                                 file + "\"}}"}},
                           .files = {{file, kTetrahedron + "# " + name + "\n"}}});
  };
  const auto kept = [&] {
    std::size_t files = 0;
    for ([[maybe_unused]] const auto& file :
         std::filesystem::directory_iterator(folder / "clearance.sent"))
      ++files;
    return files;
  };
  ASSERT_TRUE(add("n").done());
  EXPECT_EQ(kept(), 1u);
  // Commands that change nothing take nothing back but their own files.
  EXPECT_FALSE(execute({RemoveObject{"nothing"}}).done());
  EXPECT_TRUE(execute(Command{.dry_run = true, .changes = {RemoveObject{"n"}}}).done());
  EXPECT_EQ(kept(), 1u);
  EXPECT_FALSE(add("n").done());
  EXPECT_EQ(kept(), 1u);
  // A client may add and remove meshes all day.
  ASSERT_TRUE(execute({RemoveObject{"n"}}).done());
  for (int i = 0; i < 3 * static_cast<int>(SentFiles::kScenes); ++i) {
    const std::string name = "m" + std::to_string(i);
    ASSERT_TRUE(add(name).done()) << i;
    ASSERT_TRUE(execute({RemoveObject{name}}).done()) << i;
    EXPECT_LE(kept(), SentFiles::kScenes) << i;
  }
  ASSERT_TRUE(add("last").done());
  write_text(folder / "later.yaml", changer->cell().yaml);
  EXPECT_TRUE(std::holds_alternative<Cell>(read_cell(folder / "later.yaml")));
}

// An object of MoveIt that comes again is replaced.
TEST_F(SceneCommands, ReplaceAnObjectByOneWhoseMeshIsSentAlong) {
  start();
  const CommandResult result = execute(
      Command{.changes = {ReplaceObject{"{name: part, groups: [things], fixed: true, mesh: {file: "
                                        "\"sent:part.obj\"}}"}},
              .files = {{"part.obj", kTetrahedron}}});
  EXPECT_TRUE(result.done()) << result.reason;
}

TEST_F(SceneCommands, ReadTheCellAgainFromItsFileOrFromAStatedFolder) {
  start();
  std::filesystem::create_directories(folder / "allowed");
  std::string text = test::kCommandedCell;
  text.replace(text.find("enter_below: 0.1,"), 17, "enter_below: 0.12,");
  write_text(folder / "cell.yaml", text);
  ASSERT_TRUE(execute({ReadCellAgain{}}).done());
  EXPECT_EQ(changer->cell().scene.zones[0].enter_below, 0.12);
  text.replace(text.find("enter_below: 0.12,"), 18, "enter_below: 0.13,");
  write_text(folder / "other.yaml", text);
  write_text(folder / "allowed" / "other.yaml", text);
  expect_refused({ReadCellAgain{"other.yaml"}}, CommandStatus::kFileRefused);
  expect_refused({ReadCellAgain{"allowed/none.yaml"}}, CommandStatus::kFileRefused);
  ASSERT_TRUE(execute({ReadCellAgain{"allowed/other.yaml"}}).done());
  EXPECT_EQ(changer->cell().scene.zones[0].enter_below, 0.13);
  EXPECT_TRUE(execute(Command{.changes = {ReadCellAgain{"other.yaml"}}}, true).done());
}

TEST_F(SceneCommands, KeepWhatTheCommandLineAdds) {
  start(test::kCommandedCell, {.finish = [](Cell& made) { made.scene.gradients = true; }});
  ASSERT_TRUE(execute({SetMargin{"table", 0.01}}).done());
  EXPECT_TRUE(changer->cell().scene.gradients);
}

TEST_F(SceneCommands, AreKeptInAFileWithTheRevisionFromWhichTheyBegan) {
  const auto file = folder / "kept.yaml";
  start(test::kCommandedCell, {.keep_scene = file});
  const std::uint64_t first = revision();
  ASSERT_TRUE(execute({SetMargin{"table", 0.01}}).done());
  auto kept = std::get<0>(read_kept_scene(file));
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->began_with, first);
  EXPECT_EQ(kept->yaml, changer->cell().yaml);
  expect_refused({Attach{"part", "hand", Pose{}}}, CommandStatus::kOverlap);
  EXPECT_EQ(std::get<0>(read_kept_scene(file))->yaml, changer->cell().yaml);
  write_text(folder / "cell.yaml", test::kCommandedCell + "# another\n");
  ASSERT_TRUE(execute({ReadCellAgain{}, SetMargin{"table", 0.03}}).done());
  kept = std::get<0>(read_kept_scene(file));
  EXPECT_EQ(kept->began_with, std::get<Cell>(read_cell(folder / "cell.yaml")).scene.revision);
  EXPECT_EQ(kept->yaml, changer->cell().yaml);
}

TEST_F(SceneCommands, ThatCannotBeKeptAreRefused) {
  start(test::kCommandedCell, {.keep_scene = folder / "none" / "kept.yaml"});
  expect_refused({SetMargin{"table", 0.01}}, CommandStatus::kFailed);
  std::filesystem::create_directory(folder / "none");
  EXPECT_TRUE(execute({SetMargin{"table", 0.01}}).done());
}

TEST_F(SceneCommands, AreRefusedWhenTheLoopHasEnded) {
  start();
  may_change = false;
  expect_refused({SetMargin{"table", 0.01}}, CommandStatus::kEnding);
  may_change = true;
  end_loop();
  expect_refused({SetMargin{"table", 0.01}}, CommandStatus::kEnding);
  expect_refused({Attach{"part", "hand"}}, CommandStatus::kEnding);
}

// The sender of poses has the ids of the first scene, and 41 changes later it still has them.
TEST_F(SceneCommands, ThatCannotFollowTheLoopAreRefusedAsTooSlow) {
  start(test::kCommandedCell, {}, {.ticks = 4, .poses = 4, .joints = 4});
  poses->put(test::at(0, 0, 0));
  poses->repeat(5);
  poses->settle();
  expect_refused({SetAbsent{"part"}}, CommandStatus::kTooSlow);
  poses->repeat(4);
  poses->settle();
  EXPECT_TRUE(execute({SetAbsent{"part"}}).done());
}

TEST_F(SceneCommands, ThatAttachAndDetachAgainAndAgainKeepTheSendersOfPosesInUse) {
  start();
  poses->put(at(0.5, 0, 0));
  poses->settle();
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(execute({Attach{"part", "hand", at(0, 0, 0.2)}}).done());
    ASSERT_TRUE(execute({Detach{"part", at(1, 0, 0)}}).done());
  }
  ASSERT_TRUE(execute({Attach{"part", "hand", at(0, 0, 0.2)}}).done());
  poses->put(at(0.7, 0, 0));
  poses->settle();
  ASSERT_TRUE(execute({Detach{"part"}}).done());
  EXPECT_LT((object("part").world_from_object.position - Vec3(0.7, 0, 0.2)).norm(), 1e-12);
}

// Adds and removes one object again and again, with a refused change in between.
TEST_F(SceneCommands, GoOnAfterARefusalWhereTheyWere) {
  start();
  for (int i = 0; i < 10; ++i) {
    ASSERT_TRUE(execute({AddFromTemplate{"bin", "bin_1", {}, at(0, 2, 0)}}).done());
    expect_refused({RemoveObject{"bin_1"}, RemoveObject{"bin_1"}}, CommandStatus::kRefused);
    ASSERT_TRUE(execute({RemoveObject{"bin_1"}}).done());
    EXPECT_EQ(changer->cell().yaml, test::kCommandedCell);
  }
}

}  // namespace
}  // namespace clearance
