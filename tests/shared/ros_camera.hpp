// A camera that publishes made pictures in ROS 2's format, as drivers do: best effort.
//
// The scene is in the camera's frame (z forward, x right, y down): a wall across its axis, and a
// sphere before it. Depths are those of the rays through the centres of the pixels, by closed
// forms in double.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/vec.hpp"
#include "monitor/participant/participant.hpp"
#include "monitor/wire/camera_types.hpp"
#include "monitor/wire/dds_sample.hpp"
#include "tests/shared/loopback.hpp"

namespace clearance::test {

struct MadeScene {
  double wall = 2.0;  // its depth, m
  struct Ball {
    Vec3 centre;
    double radius;
  };
  std::optional<Ball> ball = {};
};

// A pinhole whose axis passes through the centre of a pixel.
struct MadeCamera {
  std::uint32_t width = 65, height = 49;
  double focal = 60.0;  // px

  [[nodiscard]] Vec3 ray(std::uint32_t u, std::uint32_t v) const {
    return {(u - 0.5 * (width - 1)) / focal, (v - 0.5 * (height - 1)) / focal, 1.0};
  }
  // The depth along the axis at which the ray of a pixel meets the scene first.
  [[nodiscard]] double depth(const MadeScene& scene, std::uint32_t u, std::uint32_t v) const {
    if (!scene.ball) return scene.wall;
    const Vec3 along = ray(u, v);
    const double a = along.squaredNorm(), b = along.dot(scene.ball->centre);
    const double c = scene.ball->centre.squaredNorm() - scene.ball->radius * scene.ball->radius;
    const double root = b * b - a * c;
    return root < 0.0 ? scene.wall : std::min(scene.wall, (b - std::sqrt(root)) / a);
  }
};

class RosCamera {
 public:
  // Each frame differs from the 699 before it in the depth of its last rows, which are behind the
  // wall.
  RosCamera(Participant& participant, const MadeCamera& the_made, const std::string& ns = "/cam")
      : made(the_made),
        image_(participant.ros_writer(kRosImage, ros_dds_name(ns + "/image"))),
        info_(participant.ros_writer(kRosCameraInfo, ros_dds_name(ns + "/camera_info"))),
        points_(participant.ros_writer(kRosPointCloud2, ros_dds_name(ns + "/points"))) {}
  ~RosCamera() {
    for (const dds_entity_t writer : {image_, info_, points_}) dds_delete(writer);
  }
  RosCamera(const RosCamera&) = delete;
  RosCamera& operator=(const RosCamera&) = delete;

  [[nodiscard]] bool is_heard() const {
    return eventually([this] {
      return matched_readers(image_) + matched_readers(points_) > 0 &&
             (matched_readers(image_) == 0 || matched_readers(info_) > 0);
    });
  }

  // Millimetres if `encoding` is 16UC1, else metres.
  void send_image(const MadeScene& scene, std::int64_t stamp_ns) {
    send_info(stamp_ns);
    Sample<sensor_msgs_msg_dds__Image_> message;
    fill(message->header, stamp_ns);
    message->width = made.width;
    message->height = made.height;
    message->encoding = dds_string_dup(encoding.c_str());
    const std::size_t pixel = encoding == "16UC1" ? 2 : 4;
    message->step = static_cast<std::uint32_t>(made.width * pixel);
    reserve_sequence(message->data, made.height * message->step);
    message->data._length = made.height * message->step;
    std::uint8_t* out = message->data._buffer;
    for (std::uint32_t v = 0; v < made.height; ++v) {
      for (std::uint32_t u = 0; u < made.width; ++u, out += pixel) {
        const double depth = depth_of(scene, u, v);
        const auto metres = static_cast<float>(depth);
        const auto millimetres = static_cast<std::uint16_t>(std::lround(1000.0 * depth));
        std::memcpy(out, pixel == 2 ? static_cast<const void*>(&millimetres) : &metres, pixel);
      }
    }
    next();
    if (change_image) change_image(*message);
    ASSERT_EQ(dds_write(image_, &*message), DDS_RETCODE_OK);
  }
  void send_image(const MadeScene& scene) { send_image(scene, dds_time()); }

  void send_info(std::int64_t stamp_ns) {
    Sample<sensor_msgs_msg_dds__CameraInfo_> message;
    fill(message->header, stamp_ns);
    message->width = made.width;
    message->height = made.height;
    message->distortion_model = dds_string_dup("plumb_bob");
    const double cx = 0.5 * (made.width - 1), cy = 0.5 * (made.height - 1), f = made.focal;
    const double k[9] = {f, 0, cx, 0, f, cy, 0, 0, 1}, r[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    const double p[12] = {f, 0, cx, 0, 0, f, cy, 0, 0, 0, 1, 0};
    std::memcpy(message->k, k, sizeof k);
    std::memcpy(message->r, r, sizeof r);
    std::memcpy(message->p, p, sizeof p);
    ASSERT_EQ(dds_write(info_, &*message), DDS_RETCODE_OK);
  }

  // The points of the same rays, organised, as float32.
  void send_points(const MadeScene& scene, std::int64_t stamp_ns) {
    Sample<sensor_msgs_msg_dds__PointCloud2_> message;
    fill(message->header, stamp_ns);
    message->width = made.width;
    message->height = made.height;
    message->point_step = 12;
    message->row_step = 12 * made.width;
    reserve_sequence(message->fields, 3);
    for (const char* const name : {"x", "y", "z"}) {
      auto& field = message->fields._buffer[message->fields._length];
      field.name = dds_string_dup(name);
      field.offset = 4 * message->fields._length++;
      field.datatype = 7;
      field.count = 1;
    }
    reserve_sequence(message->data, made.height * message->row_step);
    message->data._length = made.height * message->row_step;
    std::uint8_t* out = message->data._buffer;
    for (std::uint32_t v = 0; v < made.height; ++v) {
      for (std::uint32_t u = 0; u < made.width; ++u, out += 12) {
        const Eigen::Vector3f point = (depth_of(scene, u, v) * made.ray(u, v)).cast<float>();
        std::memcpy(out, point.data(), 12);
      }
    }
    next();
    ASSERT_EQ(dds_write(points_, &*message), DDS_RETCODE_OK);
  }
  void send_points(const MadeScene& scene) { send_points(scene, dds_time()); }

  MadeCamera made;
  std::string frame = "camera", encoding = "32FC1";
  bool is_frozen = false;  // frames repeat bit for bit
  std::function<void(sensor_msgs_msg_dds__Image_&)> change_image = {};

 private:
  [[nodiscard]] double depth_of(const MadeScene& scene, std::uint32_t u, std::uint32_t v) const {
    const bool is_last = v + std::max(2U, made.height / 20) >= made.height;
    return is_last ? scene.wall + 0.5 + 0.001 * (frames_ % 700) : made.depth(scene, u, v);
  }
  void next() {
    if (!is_frozen) ++frames_;
  }
  template <class Header>
  void fill(Header& header, std::int64_t stamp_ns) const {
    header.stamp.sec = static_cast<std::int32_t>(stamp_ns / 1'000'000'000);
    header.stamp.nanosec = static_cast<std::uint32_t>(stamp_ns % 1'000'000'000);
    header.frame_id = dds_string_dup(frame.c_str());
  }

  dds_entity_t image_, info_, points_;
  int frames_ = 0;
};

}  // namespace clearance::test
