// The frames of sensors in a recording, in their order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include "monitor/mcap/reader.hpp"
#include "monitor/sensors/built_frames.hpp"
#include "monitor/wire/cdr.hpp"

namespace clearance {

// Reads the files beside the reader of everything else, and only where their summaries say that
// they have frames.
class FrameFeed {
 public:
  explicit FrameFeed(std::vector<std::filesystem::path> files, const McapWindow& window = {})
      : files_(std::move(files)), window_(window) {}

  // The next frame; null at the end or the damage. Valid until pop().
  [[nodiscard]] const clearance_msg_SensorFrame* front();
  // Its log time, ns.
  [[nodiscard]] std::int64_t front_ns() const noexcept { return log_ns_; }
  void pop() noexcept { is_there_ = false; }

 private:
  [[nodiscard]] bool read_one();

  std::vector<std::filesystem::path> files_;
  McapWindow window_;
  std::int64_t log_ns_ = 0;
  std::size_t next_file_ = 0;
  std::unique_ptr<McapReader> reader_;
  CdrDecoder decoder_;
  Sample<clearance_msg_SensorFrame> frame_;
  bool is_there_ = false;
};

}  // namespace clearance
