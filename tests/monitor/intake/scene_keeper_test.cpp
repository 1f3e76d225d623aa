// MoveIt's messages as bytes.
//
// Oracle: CDR by its rules (moveit_messages.hpp).
#include "monitor/intake/scene_keeper.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "tests/monitor/intake/heard.hpp"
#include "tests/monitor/intake/moveit_cell.hpp"
#include "tests/monitor/intake/moveit_messages.hpp"
#include "tests/shared/forged_bytes.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/repeats.hpp"

namespace clearance::moveit {
namespace {

// A box 0.1 x 0.2 x 0.3 m, a prism and a tetrahedron, with a subframe.
CollisionObject some_object(const std::string& id) {
  CollisionObject object;
  object.frame_id = "map";
  object.id = id;
  object.pose = {{1, 2, 3}, {0.8, 0, 0, 0.6}};
  object.primitives = {{SolidPrimitive::kBox, {0.1, 0.2, 0.3}},
                       {SolidPrimitive::kPrism, {0.4}, {{0, 0}, {1, 0}, {0, 1}}}};
  object.primitive_poses = {test::at(0.5, 0, 0)};
  object.meshes = {
      {{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
  object.subframe_names = {"top"};
  object.subframe_poses = {test::at(0, 0, 0.25)};
  return object;
}

PlanningScene some_scene() {
  PlanningScene scene;
  scene.is_diff = scene.robot_state_is_diff = true;
  scene.attached = {{"hand", some_object("held"), {"finger", "tip"}}};
  scene.fixed_frame_transforms = {{"bench", "map", test::at(4, 5, 6)}};
  scene.allowed_collision_matrix = {
      {"hand", "table"}, {{false, true}, {true, false}}, {"finger"}, {false}};
  scene.link_padding = {{"hand", 0.01}};
  scene.link_scale = {{"hand", 1.5}};
  scene.collision_objects = {some_object("shelf")};
  scene.has_octomap = true;
  return scene;
}

class KeptScene : public MoveItCell {
 protected:
  SceneKeeper::Work take(RawScene::Type type, const std::vector<std::byte>& bytes) {
    return keeper_.take({type, "/topic", bytes}, cell_, [this](const std::string& body) {
      const auto found = poses_.find(body);
      return found == poses_.end() ? std::nullopt : std::optional(found->second);
    });
  }
  SceneKeeper keeper_;
};

std::string yaml_of(const CellChange& change) {
  const auto* added = std::get_if<AddObject>(&change);
  return added == nullptr ? "" : added->yaml;
}

TEST_F(KeptScene, AnObjectOnTheWireIsTheObjectThatWasSent) {
  const auto work = take(RawScene::Type::kCollisionObject, cdr_of(some_object("shelf")));
  const Translation expected = translator_.translate(
      some_object("shelf"), known_scene(cell_), [](const std::string&) { return std::nullopt; });
  ASSERT_EQ(work.changes.size(), 1u);
  ASSERT_EQ(expected.changes.size(), 1u);
  EXPECT_NE(yaml_of(work.changes[0]), "");
  EXPECT_EQ(yaml_of(work.changes[0]), yaml_of(expected.changes[0]));
  ASSERT_EQ(work.files.size(), 1u);
  EXPECT_EQ(work.files[0].bytes, expected.files.at(0).bytes);
  EXPECT_TRUE(work.news.empty());
}

TEST_F(KeptScene, ASceneOnTheWireIsTheSceneThatWasSent) {
  const auto work = take(RawScene::Type::kPlanningScene, cdr_of(some_scene()));
  const Translation expected = translator_.translate(
      some_scene(), known_scene(cell_),
      [this](const std::string& body) { return std::optional(poses_.at(body)); });
  ASSERT_EQ(work.changes.size(), 3u);
  ASSERT_EQ(expected.changes.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(yaml_of(work.changes[i]), yaml_of(expected.changes[i]));
  ASSERT_NE(std::get_if<SetMargin>(&work.changes[1]), nullptr);
  EXPECT_EQ(std::get<SetMargin>(work.changes[1]).object, "hand");
  EXPECT_EQ(std::get<SetMargin>(work.changes[1]).m, 0.01);
  EXPECT_THAT(work.news, testing::ElementsAre("/topic: link_scale of 'hand' is not used",
                                              "/topic: world.octomap is not used"));
  // The matrix allows hand against table.
  const std::vector<CellChange> exceptions = keeper_.complete(cell_.scene);
  ASSERT_EQ(exceptions.size(), 1u);
  EXPECT_EQ(std::get<SetPair>(exceptions[0]).a, "hand");
  EXPECT_EQ(std::get<SetPair>(exceptions[0]).b, "table");
  // The frame was kept, and each sentence is said once.
  EXPECT_TRUE(take(RawScene::Type::kPlanningScene, cdr_of(some_scene())).news.empty());
}

TEST_F(KeptScene, BytesThatAreCutOffAreRefused) {
  for (const auto& [type, bytes] :
       {std::pair(RawScene::Type::kCollisionObject, cdr_of(some_object("shelf"))),
        std::pair(RawScene::Type::kPlanningScene, cdr_of(some_scene()))}) {
    for (std::size_t size = 0; size + 4 < bytes.size(); ++size) {
      const auto work = take(type, {bytes.begin(), bytes.begin() + static_cast<long>(size)});
      EXPECT_TRUE(work.changes.empty()) << size;
    }
  }
}

TEST_F(KeptScene, IntakeHandsOnTheTopicsThatTheCellNames) {
  std::vector<RawScene> came;
  test::Heard heard(cell_, {.use_scene = [&](RawScene message) { came.push_back(message); }});
  const auto sent = [](const std::string& topic, const std::string& type) {
    return test::RosMessage{topic, "moveit_msgs/msg/" + type, 0, cdr_of(some_object("shelf"))};
  };
  EXPECT_TRUE(heard.intake.hears_ros());
  EXPECT_TRUE(heard.take(sent("/collision_object", "CollisionObject")));
  EXPECT_FALSE(heard.take(sent("/collision_object", "PlanningScene")));
  EXPECT_FALSE(heard.take(sent("/other", "CollisionObject")));
  ASSERT_EQ(came.size(), 1u);
  EXPECT_EQ(came[0].type, RawScene::Type::kCollisionObject);
  EXPECT_EQ(came[0].cdr, cdr_of(some_object("shelf")));
  EXPECT_EQ(heard.told(lines::kTopicHeard.code), 1u);

  // A log names the topic, and does not use it.
  test::Heard log(cell_, {.is_log = true});
  EXPECT_FALSE(log.take(sent("/collision_object", "CollisionObject")));
  ASSERT_EQ(log.news.size(), 1u);
  EXPECT_TRUE(log.news[0].level == LogLevel::kWarn);
}

TEST_F(KeptScene, WithoutAPublisherIsMissedOnceAndOnlyByADaemon) {
  const auto ignore = [](const RawScene&) {};
  const test::RosMessage sent{"/collision_object", "moveit_msgs/msg/CollisionObject", 0,
                              cdr_of(some_object("shelf"))};
  const auto times_told = [&](IntakeOptions options, bool has_publisher) {
    test::Heard heard(cell_, std::move(options));
    if (has_publisher) {
      EXPECT_TRUE(heard.take(sent));
    }
    heard.settle();
    heard.pass(MoveItMessages::kMissingNs - 1);
    heard.settle();
    EXPECT_EQ(heard.told(lines::kMoveItSilent.code), 0u);
    for (int i = 0; i < 3; ++i) {
      heard.pass(MoveItMessages::kMissingNs);
      heard.settle();
    }
    return heard.told(lines::kMoveItSilent.code);
  };
  EXPECT_EQ(times_told({.use_scene = ignore}, false), 1u);
  test::Heard heard(cell_, {.use_scene = ignore});
  EXPECT_LT(heard.intake.patience_ns(), MoveItMessages::kMissingNs);
  heard.settle();
  heard.pass(MoveItMessages::kMissingNs);
  heard.settle();
  EXPECT_GT(heard.intake.patience_ns(), MoveItMessages::kMissingNs) << "it is told once";
  EXPECT_EQ(times_told({.use_scene = ignore}, true), 0u);
  EXPECT_EQ(times_told({.is_log = true, .use_scene = ignore}, false), 0u);
  EXPECT_EQ(times_told({}, false), 0u) << "the scene has no user";
}

// The other keeper has not heard the scene. Frames, subframes, margins and the matrix are in no
// cell.
TEST_F(KeptScene, ASecondKeeperGoesOnWithWhatTheFirstOneKept) {
  static_cast<void>(take(RawScene::Type::kPlanningScene, cdr_of(some_scene())));
  std::vector<std::byte> bytes;
  keeper_.save(bytes);
  SceneKeeper second;
  ASSERT_TRUE(second.restore(bytes));
  std::vector<std::byte> again;
  second.save(again);
  EXPECT_EQ(again, bytes);
  PlanningScene next;
  next.is_diff = next.robot_state_is_diff = true;
  next.collision_objects = {sphere_object("ball", "bench", {1, 0, 0})};
  const auto poses = [this](const std::string& body) { return std::optional(poses_.at(body)); };
  const RawScene raw{RawScene::Type::kPlanningScene, "/topic", cdr_of(next)};
  const auto expected = keeper_.take(raw, cell_, poses), found = second.take(raw, cell_, poses);
  ASSERT_EQ(expected.changes.size(), 1u);
  ASSERT_EQ(found.changes.size(), 1u);
  EXPECT_EQ(yaml_of(found.changes[0]), yaml_of(expected.changes[0]));
  EXPECT_EQ(second.complete(cell_.scene).size(), 1u) << "the matrix allows hand against table";
  EXPECT_FALSE(SceneKeeper().take(raw, cell_, poses).news.empty()) << "it does not know the frame";
}

TEST_F(KeptScene, BytesOfSomethingElseChangeNothing) {
  static_cast<void>(take(RawScene::Type::kPlanningScene, cdr_of(some_scene())));
  std::vector<std::byte> bytes, after;
  keeper_.save(bytes);
  for (const std::size_t length : {std::size_t{0}, std::size_t{7}, bytes.size() / 2}) {
    EXPECT_FALSE(keeper_.restore(std::span(bytes).first(length))) << length;
  }
  keeper_.save(after);
  EXPECT_EQ(after, bytes);
}

// A stranger in the partition forges what a partner has kept.
TEST_F(KeptScene, ForgedBytesAreRefusedOrLeadToNothingThatACellFileCouldNotSay) {
  static_cast<void>(take(RawScene::Type::kPlanningScene, cdr_of(some_scene())));
  send(some_scene());
  std::vector<std::byte> genuine;
  keeper_.save(genuine);
  PlanningScene next;
  next.is_diff = next.robot_state_is_diff = true;
  next.collision_objects = {sphere_object("ball", "bench", {1, 0, 0}),
                            sphere_object("knob", "held/top", {0, 0, 0})};
  next.link_padding = {{"hand", 0.0}};
  const RawScene raw{RawScene::Type::kPlanningScene, "/topic", cdr_of(next)};
  const auto poses = [this](const std::string& body) { return std::optional(poses_.at(body)); };
  Random random(64);
  std::uint64_t refused = 0, restored = 0, accepted = 0;
  const std::uint64_t forgeries = repeats(20'000, 32);
  for (std::uint64_t forgery = 0; forgery < forgeries; ++forgery) {
    SceneKeeper keeper;
    if (!keeper.restore(test::forged(genuine, random))) {
      ++refused;
      continue;
    }
    ++restored;
    std::vector<std::byte> kept, again;
    keeper.save(kept);
    ASSERT_TRUE(keeper.restore(kept)) << forgery;
    keeper.save(again);
    ASSERT_EQ(again, kept) << forgery;
    SceneKeeper::Work work = keeper.take(raw, cell_, poses);
    for (const CellChange& change : work.changes) {
      const std::string yaml = yaml_of(change);
      ASSERT_EQ(yaml.find("nan"), yaml.npos) << forgery << " " << yaml;
      ASSERT_EQ(yaml.find("inf"), yaml.npos) << forgery << " " << yaml;
    }
    auto result = editor_->propose(work.changes,
                                   [&](const Scene& changed) { return keeper.complete(changed); });
    const auto* cell = std::get_if<Cell>(&result);
    if (cell == nullptr) continue;
    editor_->take_back();
    ++accepted;
    for (const Object& object : cell->scene.objects) {
      ASSERT_TRUE(object.world_from_object.position.allFinite()) << forgery << " " << object.name;
    }
  }
  EXPECT_GT(refused, forgeries / 10);
  EXPECT_GT(restored, forgeries / 10);
  EXPECT_GT(accepted, forgeries / 10);
}

TEST_F(KeptScene, APoseThatIsNotUsableIsRefused) {
  static_cast<void>(take(RawScene::Type::kPlanningScene, cdr_of(some_scene())));
  std::vector<std::byte> bytes;
  keeper_.save(bytes);
  // These values are the height of 'bench', the height of 'top', and w of a pose without rotation.
  for (const auto& [value, least] : {std::pair(6.0, 1), std::pair(0.25, 1), std::pair(1.0, 2)}) {
    int places = 0;
    for (std::size_t at = 0; at + 8 <= bytes.size(); ++at) {
      if (std::memcmp(bytes.data() + at, &value, 8) != 0) continue;
      for (const double hostile : {std::nan(""), kInfinity, -kInfinity, 1e300, 0.0}) {
        if (hostile == 0.0 && value != 1.0) continue;
        std::vector<std::byte> forged = bytes;
        std::memcpy(forged.data() + at, &hostile, 8);
        EXPECT_FALSE(SceneKeeper().restore(forged)) << hostile << " at byte " << at;
      }
      ++places;
    }
    EXPECT_GE(places, least) << value;
  }
}

TEST_F(KeptScene, TheFilesOfAMessageAreThoseThatItsChangesName) {
  const RawScene raw{RawScene::Type::kPlanningScene, "/topic", cdr_of(some_scene())};
  const auto files = keeper_.files_of(raw, cell_);
  const auto work = take(raw.type, raw.cdr);
  ASSERT_EQ(work.files.size(), 1u) << "both objects have the same mesh";
  ASSERT_FALSE(files.empty());
  for (const MeshFile& file : files) {
    EXPECT_EQ(file.name, work.files[0].name);
    EXPECT_EQ(file.bytes, work.files[0].bytes);
  }
}

TEST_F(KeptScene, AMessageIsKnownByItsContentItsTopicAndItsTime) {
  const RawScene message{RawScene::Type::kPlanningScene, "/topic", cdr_of(some_scene())};
  RawScene other = message;
  EXPECT_EQ(other.identity(), message.identity());
  other.sent_ns = 1;
  EXPECT_NE(other.identity(), message.identity());
  other = message;
  other.topic = "/other";
  EXPECT_NE(other.identity(), message.identity());
  other = message;
  other.cdr.back() ^= std::byte{1};
  EXPECT_NE(other.identity(), message.identity());
}

}  // namespace
}  // namespace clearance::moveit
