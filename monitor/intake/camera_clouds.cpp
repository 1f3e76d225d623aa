#include "monitor/intake/camera_clouds.hpp"

#include <cstddef>
#include <span>

#include "monitor/intake/digest.hpp"
#include "monitor/intake/layout.hpp"
#include "monitor/intake/measured_points.hpp"
#include "monitor/intake/stamp_check.hpp"
#include "monitor/intake/tf_tree.hpp"

namespace clearance {
namespace {

// Reads what images and points have in common, and judges their layout.
template <class Message, class Seen>
void read_grid(const Message& message, const Sensor& sensor, Seen& seen, MessageCloud& cloud) {
  cloud.stamp_ns = stamp_ns(message.header);
  cloud.frame = frame_name(message.header.frame_id);
  cloud.fault = view(message, sensor.most_points, seen);
  cloud.form = form_of(cloud.frame, seen);
  cloud.columns = seen.width;
  cloud.rows = seen.height;
}

}  // namespace

bool ImageCloud::read(const RawSensorMessage&, const Sensor& sensor) {
  read_grid(*sample, sensor, image_, *this);
  return true;
}

std::uint32_t ImageCloud::depth_digest(std::size_t i) const noexcept {
  const std::size_t row = i / image_.width * image_.step, column = i % image_.width;
  if (image_.format == DepthImage::Format::kMillimetres16)
    return number_at<std::uint16_t>(image_.bytes.data() + row + 2 * column);
  return digest_of_depth(number_at<float>(image_.bytes.data() + row + 4 * column));
}

bool PointsCloud::read(const RawSensorMessage&, const Sensor& sensor) {
  read_grid(*sample, sensor, points_, *this);
  return true;
}

FrameFault PointsCloud::elements(const Sensor& sensor, std::vector<MeasuredPoint>& out,
                                 double& excess) const {
  excess = 0.0;
  return measured_points(points_, sensor, out);
}

// Only of where the point is: a camera whose depth stands still may go on with its colours.
std::uint32_t PointsCloud::depth_digest(std::size_t i) const noexcept {
  const std::size_t point =
      i / points_.width * points_.row_step + i % points_.width * points_.point_step;
  std::uint32_t digest = 0;
  for (const std::size_t field : {points_.x, points_.y, points_.z})
    digest = 31 * digest + digest_of_depth(number_at<float>(points_.bytes.data() + point + field));
  return digest;
}

}  // namespace clearance
