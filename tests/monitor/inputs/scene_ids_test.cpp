// The ids that samples get which were made for a scene before the one in force.
#include "monitor/inputs/scene_ids.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace clearance {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr std::uint32_t kNoCounterpart = SceneMap::kNone;

Scene scene_of_size(std::size_t objects, std::size_t variables, std::uint64_t revision = 1) {
  Scene scene;
  scene.revision = revision;
  scene.objects.resize(objects);
  scene.variables.resize(variables);
  return scene;
}

// The samples that come of a batch with three objects and two joints.
class HeardIds {
 public:
  // False: the batch was refused.
  bool hear(SceneIds& ids, std::uint64_t revision) {
    PoseBatch batch{SourceName("arm"), 1, revision, std::vector<PoseSample>(3)};
    for (std::uint32_t i = 0; i < 3; ++i) batch.samples[i].object = i;
    batch.joints.resize(2);
    batch.joints[1].variable = 1;
    poses_.assign(1, {});
    joints_.assign(1, {});
    poses_[0].object = joints_[0].variable = 9;
    const bool is_good = ids.append(batch, poses_, joints_);
    EXPECT_EQ(poses_.front().object, 9u) << "what was there stays";
    EXPECT_EQ(joints_.front().variable, 9u);
    return is_good;
  }
  [[nodiscard]] std::vector<std::uint32_t> objects() const {
    std::vector<std::uint32_t> all;
    for (std::size_t i = 1; i < poses_.size(); ++i) all.push_back(poses_[i].object);
    return all;
  }
  [[nodiscard]] std::vector<std::uint32_t> variables() const {
    std::vector<std::uint32_t> all;
    for (std::size_t i = 1; i < joints_.size(); ++i) all.push_back(joints_[i].variable);
    return all;
  }

 private:
  std::vector<PoseSample> poses_;
  std::vector<JointSample> joints_;
};

void change_to(SceneIds& ids, std::uint64_t revision, std::vector<std::uint32_t> objects_now,
               std::vector<std::uint32_t> variables_now) {
  SceneMap map;
  map.objects_now = std::move(objects_now);
  map.variables_now = std::move(variables_now);
  ids.change(revision, map);
}

TEST(SceneIds, AreThoseOfTheSamplesWhileTheSceneIsTheFirst) {
  SceneIds ids(scene_of_size(3, 2));
  HeardIds heard;
  for (const std::uint64_t revision : {0u, 1u}) {
    EXPECT_TRUE(heard.hear(ids, revision));
    EXPECT_THAT(heard.objects(), ElementsAre(0, 1, 2));
    EXPECT_THAT(heard.variables(), ElementsAre(0, 1));
  }
  EXPECT_FALSE(heard.hear(ids, 2));
  EXPECT_THAT(heard.objects(), IsEmpty());
}

// Object 2 came after the map was made: it has no id either.
TEST(SceneIds, OfFormerScenesLeadToThoseOfTheSceneInForce) {
  SceneIds ids(scene_of_size(3, 2));
  HeardIds heard;
  change_to(ids, 2, {1, kNoCounterpart}, {kNoCounterpart, 0});
  EXPECT_EQ(ids.revision(), 2u);
  EXPECT_TRUE(heard.hear(ids, 1));
  EXPECT_THAT(heard.objects(), ElementsAre(1));
  EXPECT_THAT(heard.variables(), ElementsAre(0));
  EXPECT_TRUE(heard.hear(ids, 2));
  EXPECT_THAT(heard.objects(), ElementsAre(0, 1, 2));
  EXPECT_FALSE(heard.hear(ids, 0)) << "it does not say which scene it is of";

  change_to(ids, 3, {2, 5}, {});
  EXPECT_TRUE(heard.hear(ids, 1));
  EXPECT_THAT(heard.objects(), ElementsAre(5)) << "by both changes";
  EXPECT_THAT(heard.variables(), IsEmpty());
  change_to(ids, 3, {7, 7, 7}, {7, 7});
  EXPECT_TRUE(heard.hear(ids, 2));
  EXPECT_THAT(heard.objects(), ElementsAre(2, 5)) << "a scene does not follow itself";
}

TEST(SceneIds, KnowTheLastEightScenes) {
  SceneIds ids(scene_of_size(3, 2));
  HeardIds heard;
  for (std::uint64_t revision = 2; revision <= 9; ++revision) {
    change_to(ids, revision, {0, 1, 2}, {0, 1});
    EXPECT_TRUE(heard.hear(ids, 1)) << revision;
  }
  change_to(ids, 10, {0, 1, 2}, {0, 1});
  EXPECT_FALSE(heard.hear(ids, 1));
  EXPECT_TRUE(heard.hear(ids, 2));
}

TEST(SceneIds, ThatWereSavedGoOnAndAreRefusedIfTheyLeadBeyondTheScene) {
  SceneIds ids(scene_of_size(3, 2));
  change_to(ids, 2, {1, kNoCounterpart, 2}, {kNoCounterpart, 1});
  std::vector<std::byte> bytes;
  StateWriter out(bytes);
  ids.save_former(out);
  struct Restored {
    std::size_t objects, variables;
    bool is_good;
  };
  for (const Restored& each : {Restored{3, 2, true}, {2, 2, false}, {3, 1, false}}) {
    const Scene scene = scene_of_size(each.objects, each.variables, 2);
    SceneIds restored(scene);
    StateReader in(bytes);
    restored.restore_former(in, scene);
    EXPECT_EQ(in.complete(), each.is_good) << each.objects << ", " << each.variables;
    if (!each.is_good) continue;
    HeardIds heard;
    EXPECT_TRUE(heard.hear(restored, 1));
    EXPECT_THAT(heard.objects(), ElementsAre(1, 2));
    EXPECT_THAT(heard.variables(), ElementsAre(1));
    EXPECT_FALSE(heard.hear(restored, 0));
  }
}

}  // namespace
}  // namespace clearance
