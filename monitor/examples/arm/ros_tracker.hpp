// The messages of a tracker of ROS4HRI (REP-155): the bodies that it sees, the place of each in tf,
// and its joints.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "monitor/client/client.hpp"
#include "monitor/examples/arm/person_fit.hpp"

namespace clearance::people {

class RosTracker {
 public:
  RosTracker(client::Connection& connection, std::string world_frame);
  ~RosTracker();
  RosTracker(const RosTracker&) = delete;
  RosTracker& operator=(const RosTracker&) = delete;

  // Lists these bodies.
  void list(const std::vector<std::string>& ids, std::int64_t stamp_ns);
  // Tells where this body is. Bodies have joints on a topic of their own.
  void tell(const std::string& id, const Skeleton& skeleton, std::int64_t stamp_ns);

 private:
  client::Connection& connection_;
  std::string world_frame_, joints_of_;  // of this body
  dds_entity_t ids_, frames_, joints_ = 0;
};

}  // namespace clearance::people
