#include "monitor/intake/camera_clouds.hpp"

#include <cstddef>
#include <cstring>
#include <span>

#include "monitor/intake/digest.hpp"
#include "monitor/intake/measured_points.hpp"
#include "monitor/intake/stamp_check.hpp"
#include "monitor/intake/tf_tree.hpp"

namespace clearance {
namespace {

template <class Number>
Number read_number(std::span<const std::byte> bytes, std::size_t at) noexcept {
  Number number{};
  std::memcpy(&number, bytes.data() + at, sizeof number);
  return number;
}

}  // namespace

bool ImageCloud::read(const RawSensorMessage&, const Sensor& sensor) {
  stamp_ns = clearance::stamp_ns(sample->header);
  frame = frame_name(sample->header.frame_id);
  fault = view(*sample, sensor.most_points, image_);
  form = form_of(frame, image_);
  columns = image_.width;
  rows = image_.height;
  return true;
}

std::uint32_t ImageCloud::depth_digest(std::size_t i) const noexcept {
  const std::size_t row = i / image_.width * image_.step, column = i % image_.width;
  if (image_.format == DepthImage::Format::kMillimetres16)
    return read_number<std::uint16_t>(image_.bytes, row + 2 * column);
  return digest_of_depth(read_number<float>(image_.bytes, row + 4 * column));
}

bool PointsCloud::read(const RawSensorMessage&, const Sensor& sensor) {
  stamp_ns = clearance::stamp_ns(sample->header);
  frame = frame_name(sample->header.frame_id);
  fault = view(*sample, sensor.most_points, points_);
  form = form_of(frame, points_);
  columns = points_.width;
  rows = points_.height;
  return true;
}

FrameFault PointsCloud::elements(const Sensor& sensor, std::vector<MeasuredPoint>& out,
                                 double& excess) const {
  excess = 0.0;
  return measured_points(points_, sensor, out) ? FrameFault::kNoFault : FrameFault::kCannotBuild;
}

// Only of where the point is: a camera whose depth stands still may go on with its colours.
std::uint32_t PointsCloud::depth_digest(std::size_t i) const noexcept {
  const std::size_t point =
      i / points_.width * points_.row_step + i % points_.width * points_.point_step;
  std::uint32_t digest = 0;
  for (const std::size_t field : {points_.x, points_.y, points_.z})
    digest = 31 * digest + digest_of_depth(read_number<float>(points_.bytes, point + field));
  return digest;
}

}  // namespace clearance
