// Shows viewers what the sensors of a cell saw, from the frames in a recording.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include "monitor/recording/reading_place.hpp"
#include "monitor/visual/seen_frames.hpp"

namespace clearance {

class FrameFeed;

class RecordedSensors {
 public:
  explicit RecordedSensors(std::filesystem::path file);
  ~RecordedSensors();

  // The cell at the time of the view; it must outlive this, or the next call.
  void change(const Cell& cell);
  // Hands on the newest frames up to this time. After a step back or far ahead it begins anew, a
  // little before.
  void show(std::int64_t time_ns, const SeenFrames::Use& use);
  // Tells that nothing which was handed on is of this time any more; once.
  [[nodiscard]] bool have_begun_anew() noexcept { return std::exchange(anew_, false); }
  [[nodiscard]] std::vector<SeenState> states() const;

 private:
  [[nodiscard]] std::vector<BuiltFrame> frames_until(std::int64_t time_ns);

  std::filesystem::path file_;
  const Cell* cell_ = nullptr;
  std::unique_ptr<SeenFrames> seen_;  // null: the cell has no sensors
  // Frames may be recorded as seldom as once in this time.
  ReadingPlace place_{2'000'000'000};
  std::unique_ptr<FrameFeed> feed_;
  bool anew_ = false;
};

}  // namespace clearance
