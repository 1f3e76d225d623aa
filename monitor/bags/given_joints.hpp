// Joints that a log does not have, and where they stay.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/inputs/pose_batch.hpp"

namespace clearance {

class GivenJoints {
 public:
  // Positions by the joints' names; a name that the scene does not have is told in error().
  GivenJoints(const Scene& scene, const std::map<std::string, double>& positions);

  [[nodiscard]] const std::string& error() const noexcept { return error_; }
  [[nodiscard]] bool empty() const noexcept { return batch_.joints.empty(); }

  // The next batch of their source, 'given'.
  [[nodiscard]] PoseBatch at(std::int64_t stamp_ns);

 private:
  PoseBatch batch_;
  std::string error_;
};

// NAME=POSITION each, rad or m, no name twice. Returns what is wrong with one; empty: nothing.
[[nodiscard]] std::string read_joint_positions(const std::vector<std::string>& texts,
                                               std::map<std::string, double>& positions);

// Of all variables, as joint states name them.
[[nodiscard]] std::vector<std::string> joint_names(const Scene& scene);

// A sentence about the joints that were neither heard (by variable) nor given, if there are some.
void note_unheard(const Scene& scene, const std::vector<bool>& heard,
                  const std::map<std::string, double>& given, std::vector<std::string>& notes);

}  // namespace clearance
