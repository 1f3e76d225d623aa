// Announces the endpoints of a participant on ros_discovery_info, so that `ros2 node list` and
// `ros2 topic info` show it as a node.
#pragma once

#include <dds/dds.h>

#include <functional>
#include <string>
#include <vector>

#include "monitor/interface/mutex.hpp"

namespace clearance {

class RosNode {
 public:
  // The name has letters, digits and underscores. `make_writer` makes the writer of that topic when
  // the first endpoint is added, and may throw DdsError.
  RosNode(dds_entity_t participant, std::string name, std::function<dds_entity_t()> make_writer);
  RosNode(const RosNode&) = delete;
  RosNode& operator=(const RosNode&) = delete;

  // Announces one more endpoint, and drops those that were deleted since. Any thread may call this.
  // If DDS Security denies the topic, nothing is announced, and all else goes on.
  void add_reader(dds_entity_t reader) { add(&RosNode::readers_, reader); }
  void add_writer(dds_entity_t writer) { add(&RosNode::writers_, writer); }

 private:
  void add(std::vector<dds_entity_t> RosNode::*to, dds_entity_t endpoint);

  Mutex mutex_;
  const dds_entity_t participant_;
  const std::string name_;
  GUARDED_BY(mutex_) std::function<dds_entity_t()> make_writer_;
  GUARDED_BY(mutex_) dds_entity_t writer_ = 0;
  GUARDED_BY(mutex_) std::vector<dds_entity_t> readers_, writers_;
};

// A name of these parts that a node may have: "clearanced_left".
[[nodiscard]] std::string ros_node_name(const std::vector<std::string>& parts);

}  // namespace clearance
