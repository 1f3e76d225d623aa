// A small camera on tf or on an object, whose samples and images come one after another.
#pragma once

#include <string>
#include <vector>

#include "tests/monitor/recording/ros_bags.hpp"
#include "tests/monitor/sensors/small_camera.hpp"

namespace clearance::sensors_test {

class MountedCamera : public SensorsTest {
 protected:
  static constexpr std::int64_t kMs = 1'000'000;

  void make_with_info(const std::string& mount, const std::string& ros = "world_frame: map") {
    make(kImage + ", mount: {" + mount + "}", "ros2: {" + ros + "}\n");
    add(Type::kCameraInfo, InfoText{}.cdr(), kStart);
  }
  void add_cart(double x, std::int64_t stamp_ns, std::int64_t came_ns) {
    sensors->add(std::vector{test::sample(0, test::at(x, 0, 0), stamp_ns)}, {}, came_ns);
  }
  void add_frame(const char* parent, const char* child, double x, std::int64_t stamp_ns,
                 std::int64_t came_ns, std::uint64_t writer = 1) {
    add(Type::kTransforms, test::transforms(came_ns, stamp_ns, {{parent, child, {x, 0, 0}}}).cdr,
        came_ns, writer);
  }
  void add_static(const char* parent, const char* child, double x, std::int64_t came_ns,
                  std::uint64_t writer = 1) {
    add(Type::kStaticTransforms,
        test::transforms(came_ns, came_ns, {{parent, child, {x, 0, 0}}}, "/tf_static").cdr, came_ns,
        writer);
  }
  void add_mast(double x, std::int64_t stamp_ns) {
    add_frame("map", "mast", x, stamp_ns, stamp_ns);
  }
  // The frames of an image with this stamp, after all that a frame waits for.
  std::vector<SensorFrame> see(std::int64_t stamp_ns, std::int64_t wait_ns = 60 * kMs,
                               std::int64_t late_ns = 0) {
    ImageText image = flat(0, static_cast<std::uint16_t>(1000 + ++images_));
    image.stamp_ns = stamp_ns;
    add(Type::kImage, image.cdr(), stamp_ns + late_ns);
    return settle(stamp_ns + late_ns + wait_ns);
  }

 private:
  int images_ = 0;
};

}  // namespace clearance::sensors_test
