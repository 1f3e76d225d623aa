// The daemon as the nodes of ROS 2 see it.
#include <gtest/gtest.h>

#include <algorithm>

#include "limited_robot.hpp"

namespace clearance_control_test {
namespace {

TEST(DaemonAsANode, IsListedWithTheTopicsThatItReads) {
  LimitedRobot robot({});
  const rclcpp::Node& node = robot.node();
  const auto is_listed = [&] {
    const auto names = node.get_node_names();
    return std::ranges::count(names, "/clearanced") == 1;
  };
  const auto reads_joints = [&] {
    const auto readers = node.get_subscriptions_info_by_topic("/joint_states");
    return readers.size() == 1 && readers[0].node_name() == "clearanced" &&
           readers[0].node_namespace() == "/" &&
           readers[0].topic_type() == "sensor_msgs/msg/JointState";
  };
  EXPECT_TRUE(robot.step_until([] { return Values{}; },
                               [&] { return is_listed() && reads_joints(); }, 30.0));
}

}  // namespace
}  // namespace clearance_control_test
