// The state of the daemon's own recording, for the health topic.
#pragma once

#include <fmt/format.h>

#include <atomic>
#include <cstdint>
#include <string>
#include <utility>

namespace clearance {

// The recording thread writes it, the publishing thread reads it; neither waits for the other.
class RecordingHealth {
 public:
  // Called before any tick.
  void begin(const std::string& file) { begun_ = fmt::format("recording {}", file); }
  // Called at most once, by one thread.
  void fail(std::string why) {
    failure_ = std::move(why);
    failed_.store(true, std::memory_order_release);
  }
  void set_missing(std::uint64_t count) noexcept { missing_ = count; }

  [[nodiscard]] bool failed() const noexcept { return failed_.load(std::memory_order_acquire); }
  // "recording FILE", or the failure; empty without a recording.
  [[nodiscard]] const std::string& state() const noexcept { return failed() ? failure_ : begun_; }
  // Reports and batches that are not in the file.
  [[nodiscard]] std::uint64_t missing() const noexcept { return missing_; }

 private:
  std::string begun_, failure_;
  std::atomic<bool> failed_{false};
  std::atomic<std::uint64_t> missing_{0};
};

}  // namespace clearance
