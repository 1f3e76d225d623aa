// What the tick takes in, as somebody else logged it: a ROS 2 bag, or joint positions as CSV.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/inputs/pose_batch.hpp"

namespace clearance {

// One message.
struct LoggedBatch {
  PoseBatch batch;
  std::int64_t log_ns = 0;  // when it was recorded
};

struct InputLogOptions {
  // Topics whose joint states are used; empty: all that are named joint_states, in any namespace.
  std::vector<std::string> joint_topics = {};
  // Positions of joints that nobody sends, by name: they hold at every message.
  std::map<std::string, double> joints = {};
};

// Not for several threads at once.
class InputLog {
 public:
  virtual ~InputLog() = default;
  // The next batch, of log times that never go back. False at the end, or where the log stops
  // making sense: then error() is not empty.
  [[nodiscard]] virtual bool next(LoggedBatch& batch) = 0;
  // A sentence with file, place and reason; empty for a sound log.
  [[nodiscard]] virtual const std::string& error() const noexcept = 0;
  // What was read before the error is sound; false: the log cannot be read at all.
  [[nodiscard]] virtual bool readable() const noexcept = 0;
  // Share that has been read, 0 to 1.
  [[nodiscard]] virtual double progress() const noexcept = 0;
  // What a person should know of what was read so far: what was used, what was left out and why, a
  // sentence each.
  [[nodiscard]] virtual std::vector<std::string> notes() const = 0;
};

// Whether this is such a log, by its first bytes: a bag without topics of ours, or a CSV table with
// other columns than a pose log. Files that cannot be read are none.
[[nodiscard]] bool is_input_log(const std::filesystem::path& path);

// The cell must outlive the log. Never null.
[[nodiscard]] std::unique_ptr<InputLog> open_input_log(const std::filesystem::path& path,
                                                       const Cell& cell,
                                                       const InputLogOptions& options = {});

}  // namespace clearance
