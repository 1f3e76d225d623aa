// The messages of a tracker of ROS4HRI (REP-155): the bodies that it sees, the place of each in tf,
// and its joints.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/pose.hpp"
#include "monitor/client/client.hpp"

namespace clearance::people {

struct Skeleton {
  Pose world_from_body;                                // between the hips, x forward and y left
  std::vector<std::pair<std::string, double>> angles;  // by names of joints without the id, rad
};

class RosTracker {
 public:
  // `list_topic`: of the list of bodies, in ROS 2's spelling; empty: ROS4HRI's own.
  RosTracker(client::Connection& connection, std::string world_frame,
             const std::string& list_topic);
  ~RosTracker();
  RosTracker(const RosTracker&) = delete;
  RosTracker& operator=(const RosTracker&) = delete;

  // Lists these bodies, and forgets all others.
  void list(const std::vector<std::string>& ids, std::int64_t stamp_ns);
  // Tells where this body is. Bodies have joints on a topic of their own.
  void tell(const std::string& id, const Skeleton& skeleton, std::int64_t stamp_ns);

 private:
  client::Connection& connection_;
  std::string world_frame_;
  dds_entity_t ids_, frames_;
  std::map<std::string, dds_entity_t> joints_;  // writers by body
};

}  // namespace clearance::people
