// Frames that were built, on their path from the building thread into a recording, and as messages.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "frames.h"
#include "monitor/interface/mutex.hpp"
#include "monitor/sensors/sensors.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance {

template <>
[[nodiscard]] inline const dds_topic_descriptor_t&
topic_descriptor<clearance_msg_SensorFrame>() noexcept {
  return clearance_msg_SensorFrame_desc;
}

class BuiltFrames {
 public:
  // The messages that wait have at most this many bytes; the oldest go first.
  static constexpr std::size_t kMostBytes = std::size_t{64} << 20;

  // Building thread.
  void put(BuiltFrame frame);
  // Another thread: the frames of this sensor up to this stamp, in the order in which they were
  // built. The one with the stamp is not among them if it was dropped.
  [[nodiscard]] std::vector<BuiltFrame> take(std::uint32_t sensor, std::int64_t stamp_ns);

 private:
  Mutex mutex_;
  GUARDED_BY(mutex_) std::deque<BuiltFrame> frames_;
  GUARDED_BY(mutex_) std::size_t bytes_ = 0;
};

// Names frames by all that they are built of: those of one name are the same to the bit. To be told
// of every frame that a Sensors builds, since its persistence depends on former ones.
class FrameNames {
 public:
  explicit FrameNames(const Scene& scene);
  // Never 0.
  [[nodiscard]] std::uint64_t name(const BuiltFrame& frame);

 private:
  // The frames before that still count, the newest first; by sensor.
  std::vector<std::deque<std::uint64_t>> former_;
};

// `cycle`: of the tick that was shown it; 0: of none. `with_message`: false leaves its content out.
[[nodiscard]] Sample<clearance_msg_SensorFrame> to_wire(const BuiltFrame& frame,
                                                        std::uint64_t cycle, bool with_message);
[[nodiscard]] BuiltFrame from_wire(const clearance_msg_SensorFrame& message);

}  // namespace clearance
