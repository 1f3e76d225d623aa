// Whether a picture repeats one of the last ones: then its camera, or the driver, has stopped.
//
// The noise of a camera changes the depth of most elements from picture to picture, also of a still
// scene. A picture in which nearly all elements have the same depth as in one of the last ones is
// frozen, however little of it goes on. A driver that hangs may send the buffers of its ring in
// turn, so as many pictures are kept as a ring has.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "monitor/intake/message_cloud.hpp"

namespace clearance {

class LastDepths {
 public:
  static constexpr std::size_t kKept = 32;        // pictures: a second of a camera at 30 Hz
  static constexpr std::size_t kElements = 1024;  // of each, spread evenly
  // A share of unchanged elements that noise does not leave. With a noise of a tenth of the step
  // between two depths (standard deviation), one element in nine changes.
  static constexpr double kFrozenShare = 0.98;

  // True if the cloud repeats one of those that were added. Elements that are missing do not count.
  [[nodiscard]] bool has(const MessageCloud& cloud);
  // Adds the cloud of the last has().
  void add();

 private:
  std::array<std::vector<std::uint32_t>, kKept> pictures_;  // depth_digest() of elements
  std::vector<std::uint32_t> newest_;
  std::uint64_t added_ = 0;
};

}  // namespace clearance
