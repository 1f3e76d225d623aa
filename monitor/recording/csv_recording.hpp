// Recordings made of pose logs (monitor/files/pose_log.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/recording/options.hpp"

namespace clearance {

// The result of a conversion. Times are in ns, as in the log.
struct CsvRecordingResult {
  std::string error;   // empty: the recording is complete
  bool begun = false;  // `out` was written to: where there is an error, it is not complete
  std::size_t rows = 0, samples = 0;
  std::vector<std::string> objects;        // in the order of their first row
  std::vector<std::string> fixed_objects;  // fixed in the cell: their rows were left out
  std::int64_t first_ns = 0, last_ns = 0;
};

// `cell`: its ids are used, and every object of the log must be in it. Without one, ids are given
// in the order of appearance and the recording names them. The log is checked whole before `out` is
// written. `stop` is called every 1,024 rows. If it returns true, the conversion ends with an error
// that names its progress.
[[nodiscard]] CsvRecordingResult record_csv(const std::filesystem::path& csv,
                                            const std::filesystem::path& out, const Cell* cell,
                                            const RecordingOptions& options = {},
                                            const std::function<bool()>& stop = {});

}  // namespace clearance
