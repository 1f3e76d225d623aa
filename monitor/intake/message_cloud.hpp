// What the message of a sensor shows, in the frame of the sensor: what its stream is judged by, and
// the elements that a frame is built of.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "config/scene/sensor.hpp"
#include "core/pose.hpp"
#include "monitor/clouds/depth_cloud.hpp"
#include "monitor/clouds/point_cloud.hpp"
#include "monitor/intake/message_form.hpp"
#include "monitor/intake/sensor_messages.hpp"

namespace clearance {

// A class derived from it holds the decoded message, and views of that.
class MessageCloud {
 public:
  MessageCloud() = default;
  virtual ~MessageCloud() = default;
  MessageCloud(const MessageCloud&) = delete;
  MessageCloud& operator=(const MessageCloud&) = delete;

  FrameFault fault = FrameFault::kNoFault;  // why the message is no frame; else, all below holds
  std::int64_t stamp_ns = 0;
  bool is_stamped = true;  // false: the message has no stamp, and `stamp_ns` is its time of sending
  std::string frame;       // of tf, in which it was measured
  Pose frame_from_sensor;  // identity, but for maps of MoveIt
  MessageForm form;
  std::uint32_t columns = 0, rows = 0;  // of elements; one row: they have no neighbours

  // Pixels, of a depth image. Other messages have elements().
  [[nodiscard]] virtual const DepthImage* image() const noexcept { return nullptr; }
  // Replaces `out` by balls, or by cubes for a map. A missing one has NaN as its coordinates. Each
  // contains what was measured, and exceeds it by at most `excess`, m, and the rounding of a ball's
  // radius.
  [[nodiscard]] virtual FrameFault elements(const Sensor& sensor, std::vector<MeasuredPoint>& out,
                                            double& excess) const = 0;
  // True if the depth of an element is its distance from the sensor, not z.
  [[nodiscard]] virtual bool is_along_ray(const Sensor& sensor) const noexcept {
    return sensor.along_ray;
  }

  // True if its elements are all places of a picture, seen or not.
  [[nodiscard]] virtual bool is_picture() const noexcept { return true; }
  // True if it is made of many pictures, and may stay as it is while the scene does.
  [[nodiscard]] virtual bool is_map() const noexcept { return false; }
  // A digest of the depth of element i, row by row: equal depth has the same one, and depth that
  // differs has another one but by chance. 0: the element is missing.
  [[nodiscard]] virtual std::uint32_t depth_digest(std::size_t i) const noexcept = 0;
};

}  // namespace clearance
