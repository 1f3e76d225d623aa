// Constant positions of joints that a log does not contain.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/inputs/pose_batch.hpp"

namespace clearance {

class GivenJoints {
 public:
  // `positions` are by joint name. error() tells a name that the scene does not have.
  GivenJoints(const Scene& scene, const std::map<std::string, double>& positions);

  [[nodiscard]] const std::string& error() const noexcept { return error_; }
  [[nodiscard]] bool empty() const noexcept { return batch_.joints.empty(); }

  // Returns the next batch of the source 'given' with this stamp.
  [[nodiscard]] PoseBatch at(std::int64_t stamp_ns);

 private:
  PoseBatch batch_;
  std::string error_;
};

// Parses NAME=POSITION texts, rad or m, no name twice. Returns what is wrong, or an empty string.
[[nodiscard]] std::string read_joint_positions(const std::vector<std::string>& texts,
                                               std::map<std::string, double>& positions);

// The names of all variables, as joint states name them.
[[nodiscard]] std::vector<std::string> joint_names(const Scene& scene);

// Adds a sentence about the joints that were neither heard nor given, if there are any.
void note_unheard(const Scene& scene, const std::set<std::string>& heard,
                  const std::map<std::string, double>& given, std::vector<std::string>& notes);

}  // namespace clearance
