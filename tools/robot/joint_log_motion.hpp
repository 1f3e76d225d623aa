// How the robots of a cell move after a log of their joints.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/inputs/joint_batch.hpp"

namespace clearance {

// Positions from a CSV: t_ns and one column a joint, by its name in the cell; others are ignored.
// In between on a straight line. Joints without a column stand still, as near to 0 as they can.
class JointLogMotion {
 public:
  JointLogMotion(const std::filesystem::path& file, const Scene& scene);

  // What is wrong with the file: "FILE:LINE: ..."; empty: nothing.
  [[nodiscard]] const std::string& error() const noexcept { return error_; }
  [[nodiscard]] double seconds() const noexcept;  // from its first row to its last
  // As JointSweep::at; before the first row and after the last they stand.
  void at(double t_s, std::vector<JointSample>& joints);

 private:
  struct Row {
    std::int64_t t_ns;
    std::vector<double> positions;  // by column
  };
  std::vector<std::uint32_t> variables_;  // of each column
  std::vector<double> resting_;           // by variable
  std::vector<Row> rows_;
  std::size_t at_ = 0;  // the row before the last time asked for
  std::string error_;
};

}  // namespace clearance
