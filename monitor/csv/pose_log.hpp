// Pose logs kept as CSV, and recordings made of them.
//
// The first line names the columns; t_ns, object, px, py, pz, qw, qx, qy, qz are found by name in
// any order, others are ignored. Poses are world_from_object in metres; times in whole nanoseconds,
// not going back; rows of equal time are one sample. Plain or gzip.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "config/scene.hpp"
#include "core/pose.hpp"
#include "monitor/csv/table.hpp"

namespace clearance {

struct CsvPose {
  std::int64_t t_ns = 0;
  std::string object;
  Pose world_from_object;
};

class CsvPoseLog {
 public:
  explicit CsvPoseLog(const std::filesystem::path& file);

  // False at the end, and at the first thing wrong: then error() reads "FILE:LINE: ...".
  [[nodiscard]] bool next(CsvPose& pose);
  [[nodiscard]] const std::string& error() const noexcept { return table_.error(); }
  // "FILE:LINE: what", for what a caller finds wrong with the row just read.
  [[nodiscard]] std::string located(const std::string& what) const { return table_.located(what); }

 private:
  CsvTable table_;
};

struct CsvRecordingResult {
  std::string error;   // empty: the recording is complete
  bool begun = false;  // `out` was written to: where there is an error, it is not complete
  std::size_t rows = 0, samples = 0;
  std::vector<std::string> objects;        // in the order of their first row
  std::vector<std::string> fixed_objects;  // fixed in the cell: their rows were left out
  std::int64_t first_ns = 0, last_ns = 0;
};

// `scene`: its ids are used, and every object of the log must be in it. Without one, ids are given
// in the order of appearance and the recording names them. The log is checked whole before `out` is
// written. `stop` is asked every 1,024 rows: true ends it, with an error that says how far it came.
[[nodiscard]] CsvRecordingResult record_csv(const std::filesystem::path& csv,
                                            const std::filesystem::path& out, const Scene* scene,
                                            const std::function<bool()>& stop = {});

}  // namespace clearance
