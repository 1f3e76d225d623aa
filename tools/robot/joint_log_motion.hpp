// The motion of a cell's robots along a log of their joints.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/inputs/joint_batch.hpp"

namespace clearance {

// Positions from a CSV: t_ns and one column per joint, with its name in the cell. Other columns are
// ignored. Positions between rows are interpolated. Joints without a column stay as near to 0 as
// their limits allow.
class JointLogMotion {
 public:
  JointLogMotion(const std::filesystem::path& file, const Scene& scene);

  // The fault in the file as "FILE:LINE: ..."; empty: none.
  [[nodiscard]] const std::string& error() const noexcept { return error_; }
  // The columns that no joint of the cell has, and the joints without a column; empty: none.
  [[nodiscard]] const std::string& note() const noexcept { return note_; }
  [[nodiscard]] double seconds() const noexcept;  // from its first row to its last
  // The same as JointSweep::at. The joints stand still before the first row and after the last.
  void at(double t_s, std::vector<JointSample>& joints);

 private:
  struct Row {
    std::int64_t t_ns;
    std::vector<double> positions;  // by column
  };
  void note_columns(const std::vector<std::string>& header, const Scene& scene);

  std::vector<std::uint32_t> variables_;  // by column
  std::vector<double> resting_;           // by variable
  std::vector<Row> rows_;
  std::size_t at_ = 0;  // the row before the last requested time
  std::string error_, note_;
};

}  // namespace clearance
