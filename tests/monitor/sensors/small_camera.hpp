// A cell with a robot of three joints, a cart and a camera of 8 x 6 pixels, and its messages.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "monitor/sensors/sensors.hpp"
#include "tests/monitor/intake/camera_texts.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/monitor/tick/small_cells.hpp"

namespace clearance::sensors_test {

using test::camera::CloudText;
using test::camera::ImageText;
using test::camera::InfoText;
using Type = RawSensorMessage::Type;

inline constexpr std::int64_t kStart = test::camera::kStart, kFrame = test::camera::kFrame;

// `objects` contains further ones: ", {name: ...}"; `pairs` lines of their pairs.
inline Cell cell_with(const std::string& sensor, const std::string& ros = "",
                      const std::string& objects = "", const std::string& pairs = "") {
  const test::ScratchFolder folder;
  test::write_text(folder / "scara.urdf", test::kScaraUrdf);
  return read_good(
      "name: test\nunits: {length: m, angle: rad}\n" + ros +
          "robots: [{name: arm, urdf: scara.urdf}]\nobjects: [{name: cart, sphere: {radius: "
          "0.1}}" +
          objects + "]\nsensors:\n  - {name: eye, " + sensor +
          "}\npairs:\n  - {between: [arm, eye]}\n  - {between: [cart, eye]}\n" + pairs,
      folder / "cell.yaml");
}
inline const std::string kImage =
    "depth_image: /cam/image, size: [8, 6], depth_error: {constant: 0.01}, range: [0.3, 4]";
inline const std::string kPoints =
    "points: /cam/points, depth_error: {constant: 0.01}, range: [0.3, 4]";
// The camera looks down from 2 m above the origin of the world.
inline const std::string kAbove =
    ", mount: {pose: {xyz: [0, 0, 2], rpy: [3.141592653589793, 0, 0]}}";

// All pixels have this depth, mm.
inline ImageText flat(int number, std::uint16_t depth) {
  ImageText text;
  text.stamp_ns += number * kFrame;
  for (std::size_t i = 0; i < text.data.size(); i += 2) {
    text.data[i] = static_cast<std::uint8_t>(depth & 0xFF);
    text.data[i + 1] = static_cast<std::uint8_t>(depth >> 8);
  }
  return text;
}

// Gives a pixel another depth, mm.
inline void put(ImageText& image, std::size_t pixel, std::uint16_t depth) {
  image.data[2 * pixel] = static_cast<std::uint8_t>(depth & 0xFF);
  image.data[2 * pixel + 1] = static_cast<std::uint8_t>(depth >> 8);
}

// Pixels are a fortieth as wide: at 2 m, 5 mm.
inline InfoText narrow() {
  InfoText info;
  info.k = {400, 0, 3.5, 0, 400, 2.5, 0, 0, 1};
  info.p = {400, 0, 3.5, 0, 0, 400, 2.5, 0, 0, 0, 1, 0};
  return info;
}

class SensorsTest : public testing::Test {
 protected:
  void make(const std::string& sensor, const std::string& ros = "", const std::string& objects = "",
            const std::string& pairs = "") {
    cell = cell_with(sensor, ros, objects, pairs);
    sensors = std::make_unique<Sensors>(cell, SensorsOptions{.is_log = false});
  }
  void add(Type type, const std::vector<std::byte>& cdr, std::int64_t sent_ns,
           std::uint64_t writer = 1) {
    static const std::map<Type, std::string> topics = {{Type::kImage, "/cam/image"},
                                                       {Type::kCameraInfo, "/cam/camera_info"},
                                                       {Type::kPoints, "/cam/points"}};
    const auto topic = topics.find(type);
    sensors->add({.type = type,
                  .topic = topic == topics.end() ? "" : topic->second,
                  .sent_ns = sent_ns,
                  .writer = writer,
                  .cdr = cdr},
                 {.realtime_ns = sent_ns, .monotonic_ns = sent_ns});
  }
  void add(const ImageText& image) { add(Type::kImage, image.cdr(), image.stamp_ns + 1000); }
  void add_joints(double shoulder, std::int64_t stamp_ns) {
    sensors->add({}, test::joints(shoulder, 0.0, 0.0, stamp_ns), stamp_ns);
  }
  // Returns the frames that are built by this time.
  std::vector<SensorFrame> settle(std::int64_t now_ns) {
    std::vector<SensorFrame> frames;
    sensors->settle(
        now_ns, [](const SeenCloud*) { return false; },
        [&](std::uint32_t, const SensorFrame& frame) { frames.push_back(frame); });
    return frames;
  }
  // The elements of the frame that is made of an image; 0: no frame.
  std::size_t elements(const ImageText& image) {
    add(image);
    const auto frames = settle(image.stamp_ns + 25'000'000);
    return frames.empty() ? 0 : frames[0].cloud->size();
  }
  [[nodiscard]] std::uint64_t count(FrameFault fault) const {
    return sensors->status(0).counts[static_cast<std::size_t>(fault)];
  }

  Cell cell;
  std::unique_ptr<Sensors> sensors;
};

}  // namespace clearance::sensors_test
