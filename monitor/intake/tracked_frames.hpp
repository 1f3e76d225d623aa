// The followers of a cell: objects that name a tf frame, and robots whose base does.
//
// A frame's pose in the cell's world becomes a sample of its object. For a robot it becomes samples
// of the seven variables of the floating joint that carries it. A robot that stands in the world
// has a root link whose pose the cell knows. If the path of a frame contains such a link, it starts
// at that pose.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/inputs/pose_batch.hpp"
#include "monitor/intake/tf_tree.hpp"

namespace clearance {

class TrackedFrames {
 public:
  // kYes: moving objects that name no frame follow the frame of their own name, except links and
  // what a sensor sees.
  enum class ByName : std::uint8_t { kNo, kYes };

  // The cell must outlive this.
  explicit TrackedFrames(const Cell& cell, ByName by_name = ByName::kNo);

  struct Follower {
    std::string frame;
    std::string name;           // name of the object or the robot
    std::uint32_t index = 0;    // index into Scene::objects or Scene::robots
    bool is_base = false;       // the follower is the base of a robot
    std::int64_t age_limit_ns;  // of its pose
  };
  [[nodiscard]] const std::vector<Follower>& followers() const noexcept { return followers_; }
  [[nodiscard]] bool any() const noexcept { return !followers_.empty(); }

  // Returns the pose of a frame in the cell's world. Returns nothing if there is no such frame, if
  // its transforms form a cycle, or if they do not lead to the cell's world. In the last case
  // `root` gets the frame to which they lead.
  [[nodiscard]] std::optional<TfTree::Place> find(const TfTree& tree, const std::string& frame,
                                                  std::string* root = nullptr,
                                                  const TfTree::Instead* instead = nullptr,
                                                  const TfTree::Earlier& earlier = {}) const;

  // Adds the sample of a follower's frame at this time: a pose of an object, or positions of a
  // robot. All positions of a batch have one stamp, so a batch of positions belongs to one robot.
  // Velocities are added if they are known and recent.
  void add(std::size_t follower, const TfTree::Place& world_from_frame, std::int64_t stamp_ns,
           PoseBatch& batch);

  // True if the frame is the root link of a robot that stands in the world.
  [[nodiscard]] bool is_root_link(const std::string& frame) const {
    return world_from_root_link_.contains(frame);
  }

 private:
  const Scene* scene_;
  const std::string* world_frame_;  // RosSettings::world_frame
  std::vector<Follower> followers_;
  std::vector<Eigen::Quaterniond> last_;  // the orientation added last, by follower
  std::map<std::string, Pose> world_from_root_link_;
};

}  // namespace clearance
