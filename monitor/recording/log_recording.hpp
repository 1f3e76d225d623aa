// Recordings made of the logs of other programs: bags of ROS 2, joint positions as CSV
// (monitor/recording).
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/recording/input_log.hpp"
#include "monitor/recording/options.hpp"

namespace clearance {

// Times in ns, when the log was recorded.
struct LogRecordingResult {
  std::string error;   // empty: the recording is complete, as far as the log could be read
  std::string damage;  // not empty: where the log stopped making sense
  bool begun = false;  // `out` was written to: where there is an error, it is not complete
  std::uint64_t batches = 0;
  std::int64_t first_ns = 0, last_ns = 0;
  std::vector<std::string> notes;  // what was left out, and why
};

// Every message that moves something of the scene becomes a batch with the time at which it was
// recorded. So a replay of `out` makes the same reports as a replay of the log. `stop` is called
// before every message. If it returns true, the conversion ends with an error that names its
// progress.
[[nodiscard]] LogRecordingResult record_log(const std::filesystem::path& log,
                                            const std::filesystem::path& out, const Cell& cell,
                                            const InputLogOptions& log_options = {},
                                            const RecordingOptions& options = {},
                                            const std::function<bool()>& stop = {});

}  // namespace clearance
