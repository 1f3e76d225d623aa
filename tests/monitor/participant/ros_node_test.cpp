// A participant tells the nodes of ROS 2 its name and endpoints. DDS's own discovery says which
// endpoints there are.
#include "monitor/participant/ros_node.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "monitor/client/sequence_view.hpp"
#include "monitor/participant/participant.hpp"
#include "tests/shared/loopback.hpp"

namespace clearance {
namespace {

using Info = rmw_dds_common_msg_dds__ParticipantEntitiesInfo_;
using Ids = std::set<std::vector<std::uint8_t>>;

std::vector<std::uint8_t> id(dds_entity_t entity) {
  dds_guid_t guid;
  check_dds(dds_get_guid(entity, &guid), "asking for an id");
  return {std::begin(guid.v), std::end(guid.v)};
}
Ids ids(const auto& sequence) {
  Ids found;
  for (const auto& each : client::list(sequence))
    found.emplace(std::begin(each.data), std::end(each.data));
  return found;
}

DdsOptions in_default_partition() {
  DdsOptions dds = test::own_dds();
  dds.partition.clear();
  return dds;
}

// The value of ROS_DISTRO while this lives; null: none.
class Distribution {
 public:
  explicit Distribution(const char* name) {
    if (const char* const text = std::getenv("ROS_DISTRO")) before_ = text;
    set(name);
  }
  ~Distribution() { set(before_ ? before_->c_str() : nullptr); }
  Distribution(const Distribution&) = delete;
  Distribution& operator=(const Distribution&) = delete;

 private:
  static void set(const char* name) {
    name != nullptr ? ::setenv("ROS_DISTRO", name, 1) : ::unsetenv("ROS_DISTRO");
  }
  std::optional<std::string> before_;
};

class RosNodeTest : public testing::Test {
 protected:
  // The last message of this participant; false if none comes that is so.
  bool tells(const std::function<bool(const Info&)>& is_so,
             std::chrono::seconds limit = std::chrono::seconds(20)) {
    return test::eventually(
        [&] {
          void* pointer = &*message;
          dds_sample_info_t info{};
          while (dds_take(reader, &pointer, &info, 1, 1) > 0) {
            std::vector<std::uint8_t> from(std::begin(message->gid.data),
                                           std::end(message->gid.data));
            if (info.valid_data && from == id(node.handle()) && is_so(*message)) return true;
          }
          return false;
        },
        limit);
  }

  Distribution distribution{"jazzy"};
  DdsOptions dds = in_default_partition();
  Participant node{dds, "clearanced_left"};
  Participant other{dds};
  dds_entity_t reader = other.ros_reader(kRosEntities, "ros_discovery_info");
  Sample<Info> message;
};

TEST_F(RosNodeTest, NamesItsEndpointsOfRosTopicsAndForgetsDeletedOnesWithTheNextOne) {
  const dds_entity_t joints = node.ros_reader(kRosJointState, "rt/joint_states");
  const dds_entity_t number = node.ros_writer(kRosFloat64, "rt/clearance/minimum_distance");
  EXPECT_TRUE(tells([&](const Info& info) {
    const auto& nodes = info.node_entities_info_seq;
    return nodes._length == 1 && std::string(nodes._buffer[0].node_name) == "clearanced_left" &&
           std::string(nodes._buffer[0].node_namespace) == "/" &&
           ids(nodes._buffer[0].reader_gid_seq) == Ids{id(joints)} &&
           ids(nodes._buffer[0].writer_gid_seq) == Ids{id(number)};
  }));
  dds_delete(number);
  const dds_entity_t next = node.ros_writer(kRosFloat64, "rt/clearance/speed_scaling");
  EXPECT_TRUE(tells([&](const Info& info) {
    return ids(info.node_entities_info_seq._buffer[0].writer_gid_seq) == Ids{id(next)};
  }));
}

// A node that comes later hears of it, too.
TEST_F(RosNodeTest, IsToldToThoseThatComeLater) {
  node.ros_reader(kRosJointState, "rt/joint_states");
  ASSERT_TRUE(tells([](const Info&) { return true; }));
  Participant late(dds);
  reader = late.ros_reader(kRosEntities, "ros_discovery_info");
  EXPECT_TRUE(tells([](const Info&) { return true; }));
}

TEST_F(RosNodeTest, IsNoneWithoutTopicsOfRos) {
  node.writer(TopicKind::kPoses, "poses");
  EXPECT_EQ(test::matched_writers(reader), 0u);
}

TEST(RosNode, IsNoneInAPartitionThatRosDoesNotKnow) {
  const Distribution distribution("jazzy");
  const DdsOptions dds = test::own_dds();
  Participant node(dds, "clearanced"), other(dds);
  const dds_entity_t reader = other.ros_reader(kRosEntities, "ros_discovery_info");
  const dds_entity_t joints = other.ros_reader(kRosJointState, "rt/joint_states");
  node.ros_writer(kRosJointState, "rt/joint_states");
  ASSERT_TRUE(test::eventually([&] { return test::matched_writers(joints) == 1; }));
  EXPECT_EQ(test::matched_writers(reader), 0u);
}

// The number of writers of ros_discovery_info that a daemon has beside nodes of a distribution.
std::uint32_t nodes_beside(const char* name) {
  const Distribution distribution(name);
  const DdsOptions dds = in_default_partition();
  Participant node(dds, "clearanced"), other(dds);
  const dds_entity_t reader = other.ros_reader(kRosEntities, "ros_discovery_info");
  const dds_entity_t joints = other.ros_reader(kRosJointState, "rt/joint_states");
  node.ros_writer(kRosJointState, "rt/joint_states");
  EXPECT_TRUE(test::eventually([&] { return test::matched_writers(joints) == 1; }));
  return test::matched_writers(reader);
}

TEST(RosNode, IsNoneBesideNodesThatWouldMisreadItOrMay) {
  for (const char* name : {"iron", "jazzy", "kilted", "rolling"})
    EXPECT_EQ(nodes_beside(name), 1u) << name;
  for (const char* name : {"foxy", "galactic", "humble", "noetic", ""})
    EXPECT_EQ(nodes_beside(name), 0u) << name;
  EXPECT_EQ(nodes_beside(nullptr), 0u);
}

TEST(RosNode, HasANameThatRosAllows) {
  EXPECT_EQ(ros_node_name({"clearanced", "", "left"}), "clearanced_left");
  EXPECT_EQ(ros_node_name({"clearance-robot", "hall 7"}), "clearance_robot_hall_7");
}

}  // namespace
}  // namespace clearance
