// Pose logs kept as CSV.
//
// The first line names the columns; t_ns, object, px, py, pz, qw, qx, qy, qz are found by name in
// any order, others are ignored. Poses are world_from_object in metres; times in whole nanoseconds,
// not going back; rows of equal time are one sample. Plain or gzip.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/pose.hpp"
#include "monitor/files/table.hpp"

namespace clearance {

// One row. The quaternion is as written: who uses it refuses those that are not unit.
struct CsvPose {
  std::int64_t t_ns = 0;
  std::string object;
  Pose world_from_object;
};

class CsvPoseLog {
 public:
  explicit CsvPoseLog(const std::filesystem::path& file);

  // False at the end and at the first mistake. After a mistake error() reads "FILE:LINE: ...".
  [[nodiscard]] bool next(CsvPose& pose);
  [[nodiscard]] const std::string& error() const noexcept { return table_.error(); }
  // "FILE:LINE: what", for what a caller finds wrong with the row just read.
  [[nodiscard]] std::string located(const std::string& what) const { return table_.located(what); }

 private:
  CsvTable table_;
};

}  // namespace clearance
