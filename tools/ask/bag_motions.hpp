// The motions of a ROS 2 bag: each trajectory_msgs/JointTrajectory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace clearance {

struct BagMotion {
  std::string id;  // "/arm/joint_trajectory at 12.345 s": the time since the first message
  std::string topic;
  std::vector<std::byte> cdr;
  std::int64_t log_ns = 0;
  std::int64_t clock_ns = 0;  // of the last message of /clock before it; 0: there is none

  // When it came, in the time of the cell's ticks.
  [[nodiscard]] std::int64_t time_ns(bool use_sim_time) const noexcept {
    return use_sim_time && clock_ns > 0 ? clock_ns : log_ns;
  }
};

// Adds the motions of a bag in the order of their times. Returns an empty text, or what is wrong
// with the bag; the motions before that are there.
[[nodiscard]] std::string read_motions(const std::filesystem::path& bag,
                                       std::vector<BagMotion>& motions);

}  // namespace clearance
