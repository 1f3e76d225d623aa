// MoveIt's messages to two daemons that are partners: both hear them, and the leader alone does
// them.
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "monitor/wire/moveit_types.hpp"
#include "tests/monitor/intake/moveit_messages.hpp"
#include "tests/shared/byte_writer.hpp"
#include "tests/tools/running_partners.hpp"

namespace clearance::test {
namespace {

using moveit::CollisionObject;
using moveit::Operation;

std::string cell_with_moveit() {
  std::string text = cell_at_rate();
  const std::string rule = "  - {between: [left, right], publish: true}\n";
  return text.insert(text.find(rule), "  - {between: [arm, moveit]}\n") +
         "ros2: {collision_object: true, planning_scene: true}\n";
}

class MoveItPartners : public Partners {
 protected:
  MoveItPartners() : Partners(cell_with_moveit()) { count_apart = true; }
  void start_both() {
    for (const char* name : {"left", "right"}) {
      start(name);
      ASSERT_TRUE(read_until([this] { return came > 20; })) << logs();
    }
    ASSERT_TRUE(agree()) << logs();
    writer = writer_of(kRosCollisionObject, "collision_object", sphere(0));
  }
  template <class Message>
  std::unique_ptr<ByteWriter> writer_of(const RosType& type, const std::string& topic,
                                        const Message& message) {
    auto made = std::make_unique<ByteWriter>(sender, dds.partition, *type.descriptor, "rt/" + topic,
                                             moveit::cdr_of(message));
    EXPECT_TRUE(read_until([&] { return matched_readers(made->writer()) == daemons.size(); }))
        << logs();
    for (const auto& [name, daemon] : daemons)
      EXPECT_TRUE(meets_writers_of(sender, *daemon)) << name << logs();
    return made;
  }
  // One more sphere of the object, far from everything that moves. Done twice, it would be there
  // twice.
  static CollisionObject sphere(int number) {
    CollisionObject object = moveit::sphere_object("heap", "world", {0, 0, 0.5});
    object.primitive_poses = {at(0.3 * number, 0, 0)};
    object.operation =
        static_cast<std::uint8_t>(number == 0 ? Operation::kAdd : Operation::kAppend);
    return object;
  }
  void send(const CollisionObject& message) {
    writer->set(moveit::cdr_of(message));
    writer->send();
  }
  // The spheres of the object in the cell that a daemon has in force.
  std::size_t spheres() {
    catalogue.update();
    const std::string text = catalogue.message() == nullptr ? "" : catalogue.message()->cell_yaml;
    const std::size_t begin = text.find("name: heap"), end = text.find("name:", begin + 1);
    std::size_t count = 0;
    for (auto at = text.find("sphere", begin); at < end; at = text.find("sphere", at + 1)) ++count;
    return begin == std::string::npos ? 0 : count;
  }
  bool have(std::size_t count) {
    return read_until([&] { return spheres() == count; }, 40);
  }

  Participant sender{dds};
  std::unique_ptr<ByteWriter> writer;
};

TEST_F(MoveItPartners, HaveTheSameSceneAfterManyMessagesAndDoEachOnce) {
  start_both();
  constexpr int kMessages = 40;
  for (int i = 0; i < kMessages; ++i) send(sphere(i));
  EXPECT_TRUE(have(kMessages)) << spheres() << logs();
  EXPECT_TRUE(agree()) << logs();
  EXPECT_EQ(states[PartnerState::kDifferent] + states[PartnerState::kCorrupt], 0) << logs();
  EXPECT_EQ(spheres(), std::size_t{kMessages});
  for (const char* name : {"left", "right"}) EXPECT_FALSE(daemons[name]->told("moveit-refused"));
  // A partner that goes on alone has the same scene, and does none of them again.
  const std::uint64_t revision = reports->scene_revision;
  daemons["left"]->signal(SIGKILL);
  EXPECT_TRUE(read_until([this] { return states[PartnerState::kMissing] > 40; })) << logs();
  EXPECT_EQ(reports->scene_revision, revision) << logs();
  send(sphere(kMessages));
  EXPECT_TRUE(have(kMessages + 1)) << spheres() << logs();
}

// Some of the messages were done, some were being done, and some waited.
TEST_F(MoveItPartners, LoseNoMessageAndDoNoneTwiceWhenTheLeaderIsKilled) {
  start_both();
  constexpr int kMessages = 40;
  for (int i = 0; i < kMessages; ++i) send(sphere(i));
  ASSERT_TRUE(read_until([&] { return spheres() >= 3; })) << logs();
  daemons["left"]->signal(SIGKILL);
  EXPECT_TRUE(have(kMessages)) << spheres() << logs();
  read_until([] { return false; }, 1);
  EXPECT_EQ(spheres(), std::size_t{kMessages}) << logs();
  start("left");
  EXPECT_TRUE(agree()) << logs();
}

// The frame came in a message to the first leader, and is in no cell.
TEST_F(MoveItPartners, TheNextLeaderKnowsTheFramesOfEarlierMessages) {
  start_both();
  moveit::PlanningScene scene;
  scene.is_diff = scene.robot_state_is_diff = true;
  scene.fixed_frame_transforms = {{"bench", "world", {{3, 0, 0}, Eigen::Quaterniond::Identity()}}};
  writer_of(kRosPlanningScene, "planning_scene", scene)->send();
  send(sphere(0));
  ASSERT_TRUE(have(1)) << logs();
  ASSERT_TRUE(agree()) << logs();
  daemons["left"]->signal(SIGKILL);
  EXPECT_TRUE(read_until([this] { return states[PartnerState::kMissing] > 40; })) << logs();
  CollisionObject on_bench = sphere(1);
  on_bench.frame_id = "bench";
  on_bench.pose.position.x() = -3;  // where the object is: other poses are refused
  send(on_bench);
  EXPECT_TRUE(have(2)) << logs();
}

// On a busy machine the lead may change at any time: then the next try counts.
TEST_F(MoveItPartners, TheCellOfTheLeaderIsReadAgainAndNotThatOfTheOtherOne) {
  start_both();
  const auto follows = [&](const std::string& name) {
    const std::string log = daemons[name]->output();
    const auto at = log.rfind("[partner-stands]");
    return at != std::string::npos && log.rfind("following", at) > log.rfind('\n', at);
  };
  const auto is_refused = [&](const std::string& name) {
    return daemons[name]->told("scene-refused", {"partner"});
  };
  bool refused = false;
  for (int attempt = 0; attempt < 20 && !refused; ++attempt) {
    const std::string follower = follows("right") ? "right" : "left";
    daemons[follower]->signal(SIGHUP);
    refused = read_until([&] { return is_refused(follower); }, 1);
  }
  EXPECT_TRUE(refused) << logs();
  std::ofstream(file.path(), std::ios::app) << "# another text\n";
  const std::uint64_t after = file.cell().scene.revision;
  const auto is_read = [&] { return reports->scene_revision == after; };
  const auto both_have_read = [&] { return read_until(is_read, 1) && agree() && is_read(); };
  for (int attempt = 0; attempt < 20 && !both_have_read(); ++attempt) {
    for (const char* name : {"left", "right"}) daemons[name]->signal(SIGHUP);
  }
  EXPECT_TRUE(agree()) << logs();
  EXPECT_EQ(reports->scene_revision, after);
}

}  // namespace
}  // namespace clearance::test
