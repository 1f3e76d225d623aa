// What of a cell follows frames of tf: objects that name one, and robots whose base does.
//
// A frame's pose in the cell's world becomes a sample of its object, or samples of the seven
// variables of the floating joint that carries its robot. Where the way leads over the root link of
// a robot that stands in the world, it begins where the cell has that.
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

// What the bases of robots come from, beside the poses of a source of transforms: the numbers of a
// source count its samples of one kind.
[[nodiscard]] inline std::string base_source(const std::string& source) {
  return source + ":bases";
}

class TrackedFrames {
 public:
  // Whether moving objects that name no frame, and are no links, follow the frame of their name.
  enum class ByName : std::uint8_t { kNo, kYes };

  // The cell must outlive this.
  explicit TrackedFrames(const Cell& cell, ByName by_name = ByName::kNo);

  struct Follower {
    std::string frame;
    std::string name;           // of the object, or of the robot
    std::uint32_t index = 0;    // into Scene::objects, or Scene::robots
    bool is_base = false;       // of a robot
    std::int64_t age_limit_ns;  // of its pose
  };
  [[nodiscard]] const std::vector<Follower>& followers() const noexcept { return followers_; }
  [[nodiscard]] bool any() const noexcept { return !followers_.empty(); }

  // The frame in the cell's world. Nothing: there is no such frame, its transforms go round in a
  // circle, or they do not lead to the world that the cell names; `root` then says where they lead.
  [[nodiscard]] std::optional<TfTree::Place> find(const TfTree& tree, const std::string& frame,
                                                  std::string* root = nullptr) const;

  // Adds what a follower's frame says at this time: of an object a pose, of a robot positions.
  // Batches of positions have one stamp, so each is of one robot.
  void add(std::size_t follower, const Pose& world_from_frame, std::int64_t stamp_ns,
           PoseBatch& batch);

  // Whether the frame is the root link of a robot that stands in the world.
  [[nodiscard]] bool is_root_link(const std::string& frame) const {
    return world_from_root_link_.contains(frame);
  }

 private:
  const Scene& scene_;
  const std::string& world_frame_;  // RosSettings::world_frame
  std::vector<Follower> followers_;
  std::vector<Eigen::Quaterniond> last_;  // orientation that was added last, by follower
  std::map<std::string, Pose> world_from_root_link_;
};

}  // namespace clearance
