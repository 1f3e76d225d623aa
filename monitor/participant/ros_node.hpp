// The node of ROS 2 that a participant is: `ros2 node list` and `ros2 topic info` name it with its
// endpoints. Nodes tell each other on the topic ros_discovery_info.
#pragma once

#include <dds/dds.h>

#include <functional>
#include <mutex>
#include <string>
#include <vector>

namespace clearance {

class RosNode {
 public:
  // The name has letters, digits and underscores. `make_writer` makes the writer of that topic when
  // the first endpoint is added, and may throw DdsError.
  RosNode(dds_entity_t participant, std::string name, std::function<dds_entity_t()> make_writer);
  RosNode(const RosNode&) = delete;
  RosNode& operator=(const RosNode&) = delete;

  // Tells other nodes about one more endpoint, and no more about those that were deleted since. Any
  // thread. Where DDS Security denies the topic, the program is no node, and all else goes on.
  void add_reader(dds_entity_t reader) { add(readers_, reader); }
  void add_writer(dds_entity_t writer) { add(writers_, writer); }

 private:
  void add(std::vector<dds_entity_t>& to, dds_entity_t endpoint);

  std::mutex mutex_;
  dds_entity_t participant_;
  std::string name_;
  std::function<dds_entity_t()> make_writer_;
  dds_entity_t writer_ = 0;
  std::vector<dds_entity_t> readers_, writers_;
};

// A name of these parts that a node may have: "clearanced_left".
[[nodiscard]] std::string ros_node_name(const std::vector<std::string>& parts);

}  // namespace clearance
