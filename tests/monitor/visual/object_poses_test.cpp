// Poses belong to the report that used them, whichever reports a viewer looks at.
#include "monitor/visual/object_poses.hpp"

#include <gtest/gtest.h>

#include "monitor/wire/convert.hpp"
#include "tests/monitor/small_cells.hpp"

namespace clearance::test {
namespace {

class ObjectPosesTest : public testing::Test {
 protected:
  // One batch: the hand at this height, with this stamp.
  void take(std::uint64_t number, double height, std::int64_t stamp_ns,
            std::string_view source = "arm") {
    PoseBatch batch{SourceName(source), number, scene.revision, {}};
    batch.samples.push_back(sample(0, at(0, 0, height), stamp_ns));
    Sample<clearance_msg_PoseBatch> wire = make_batch(1);
    to_wire(batch, *wire);
    poses.take(*wire);
  }
  // A report that used batches up to this one; 0: none in its tick.
  void use(std::uint64_t number, std::int64_t newest_ns) {
    Sample<clearance_msg_Distances> report = make_distances(scene);
    Report none;
    none.newest_pose_ns = newest_ns;
    const SourceUse used{SourceName("arm"), number};
    to_wire(none, {&used, number == 0 ? 0U : 1U}, 0, *report);
    poses.use(*report);
  }
  [[nodiscard]] double height() const { return poses.pose(0)->position.z(); }

  Scene scene = cell_of({moving("hand", {ball(0.1)}), fixed("box", {ball(0.1)}, at(0, 0, 7))});
  ObjectPoses poses{scene};
};

TEST_F(ObjectPosesTest, FixedObjectsAreThereAndOthersWhenTheyAreUsed) {
  EXPECT_EQ(poses.pose(1)->position.z(), 7.0);
  take(1, 0.1, 1000);
  EXPECT_FALSE(poses.pose(0));
  use(1, 1000);
  EXPECT_EQ(height(), 0.1);
}

TEST_F(ObjectPosesTest, LaterBatchesWaitForTheirReport) {
  for (std::uint64_t i = 1; i <= 5; ++i) {
    take(i, 0.1 * static_cast<double>(i), static_cast<std::int64_t>(1000 * i));
  }
  use(3, 3000);
  EXPECT_DOUBLE_EQ(height(), 0.3);
  use(5, 5000);
  EXPECT_DOUBLE_EQ(height(), 0.5);
}

// A viewer looks at 60 reports a second: that of the tick that used a batch may not be among them.
TEST_F(ObjectPosesTest, AReportThatNamesNoSourceSaysByItsNewestPoseWhatWasUsed) {
  take(1, 0.1, 1000);
  take(2, 0.2, 2000);
  take(3, 0.3, 3000);
  use(0, 2000);
  EXPECT_DOUBLE_EQ(height(), 0.2);
}

TEST_F(ObjectPosesTest, AnotherSourceDoesNotTakeAnObjectThatHasOne) {
  take(1, 0.1, 1000);
  take(1, 0.9, 1500, "rival");
  use(1, 2000);
  EXPECT_DOUBLE_EQ(height(), 0.1);
  take(2, 0.8, 2'000'000'000, "rival");
  use(0, 2'000'000'000);
  EXPECT_DOUBLE_EQ(height(), 0.8);
}

}  // namespace
}  // namespace clearance::test
