// Places behind a robot are unseen for other robots.
//
// Oracle: rays of the pixels' middles, cast onto boxes and a floor by closed forms. A place on a
// ray beyond its first hit is unseen for a link, unless the link's own robot was hit.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "tests/monitor/sensors/small_camera.hpp"
#include "tests/shared/random.hpp"

namespace clearance::sensors_test::shadows {
namespace {

constexpr std::uint32_t kColumns = 48, kRows = 36;
constexpr double kFocal = 30.0, kHeight = 3.5;  // pixels; m, the camera looks down from there
constexpr double kGreatest = 4.0, kError = 0.01, kFloor = -0.45;
const Vec3 kCamera(0.4, 0.3, kHeight);

struct BeamPose {
  double angle = 0.0;  // rad, of its joint
  Vec3 base = Vec3::Zero();
};

// The only body of either robot: a box from 0.1 m to 0.9 m along its turned x axis.
const Vec3 kMiddle(0.5, 0.0, 0.0), kHalf(0.4, 0.05, 0.05);

Vec3 in_beam(const BeamPose& beam, const Vec3& p) {
  const double c = std::cos(beam.angle), s = std::sin(beam.angle);
  const Vec3 d = p - beam.base;
  return Vec3(c * d.x() + s * d.y(), -s * d.x() + c * d.y(), d.z()) - kMiddle;
}
double distance_to(const BeamPose& beam, const Vec3& p) {
  return (in_beam(beam, p).cwiseAbs() - kHalf).cwiseMax(0.0).norm();
}
// The depth at which a ray from the camera meets the box; infinity: it does not.
double hit(const BeamPose& beam, const Vec3& direction) {
  const Vec3 from = in_beam(beam, kCamera), to = in_beam(beam, kCamera + direction) - from;
  double first = 0.0, last = kInfinity;
  for (int k = 0; k < 3; ++k) {
    const double a = (-kHalf[k] - from[k]) / to[k], b = (kHalf[k] - from[k]) / to[k];
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  }
  return first <= last ? first : kInfinity;
}
// A step along it is a metre of depth.
Vec3 ray(std::uint32_t u, std::uint32_t v) {
  const double x = (u - 0.5 * (kColumns - 1)) / kFocal, y = (v - 0.5 * (kRows - 1)) / kFocal;
  return {x, -y, -1.0};
}

constexpr std::array<const char*, 2> kNames = {"left_beam", "right_beam"};
using Beams = std::array<BeamPose, 2>;

class OtherRobotsShadow : public SensorsTest {
 protected:
  static std::string keys(const BeamPose& beam) {
    return ", base: {pose: {xyz: [" + std::to_string(beam.base.x()) + ", " +
           std::to_string(beam.base.y()) + ", " + std::to_string(beam.base.z()) + "]}}}";
  }
  void make_cell(const Beams& beams, const std::string& of_sensor) {
    const test::ScratchFolder folder;
    test::write_text(
        folder / "beam.urdf",
        "<robot name='beam'><link name='root'/><link name='beam'><collision><origin xyz='0.5 0 "
        "0'/><geometry><box size='0.8 0.1 0.1'/></geometry></collision></link><joint name='turn' "
        "type='revolute'><parent link='root'/><child link='beam'/><axis xyz='0 0 1'/><limit "
        "lower='-3.1' upper='3.1' velocity='2'/></joint></robot>");
    cell = read_good(
        "name: test\nunits: {length: m, angle: rad}\nrobots:\n"
        "  - {name: left, urdf: beam.urdf, prefix: left_" +
            keys(beams[0]) + "\n  - {name: right, urdf: beam.urdf, prefix: right_" +
            keys(beams[1]) +
            "\nsensors:\n  - {name: eye, depth_image: /cam/image, size: [48, 36], depth_error: "
            "{constant: 0.01}, range: [0.3, 4], unseen: true, mount: {pose: {xyz: [0.4, 0.3, "
            "3.5], rpy: [3.141592653589793, 0, 0]}}" +
            of_sensor + "}\npairs: [{between: [left, eye]}, {between: [right, eye]}]\n",
        folder / "cell.yaml");
    sensors = std::make_unique<Sensors>(cell, SensorsOptions{.is_log = false});
  }
  // Returns the bound of each robot's beam for the frame of a floor and the beams. Writes the
  // distance to the nearest place that the oracle finds.
  std::array<double, 2> unseen(const Beams& beams, std::array<double, 2>& truth) {
    InfoText info;
    info.width = kColumns;
    info.height = kRows;
    const double cx = 0.5 * (kColumns - 1), cy = 0.5 * (kRows - 1);
    info.k = {kFocal, 0, cx, 0, kFocal, cy, 0, 0, 1};
    info.p = {kFocal, 0, cx, 0, 0, kFocal, cy, 0, 0, 0, 1, 0};
    add(Type::kCameraInfo, info.cdr(), kStart);
    sensors->add(
        {},
        std::array{test::joint(0, beams[0].angle, kStart), test::joint(1, beams[1].angle, kStart)},
        kStart);
    ImageText image;
    image.width = kColumns;
    image.height = kRows;
    image.step = 2 * kColumns;
    image.data.assign(std::size_t{2} * kColumns * kRows, 0);
    truth.fill(kInfinity);
    for (std::uint32_t v = 0; v < kRows; ++v) {
      for (std::uint32_t u = 0; u < kColumns; ++u) {
        const Vec3 direction = ray(u, v);
        const std::array hits = {hit(beams[0], direction), hit(beams[1], direction)};
        const double depth = std::min({hits[0], hits[1], kHeight - kFloor});
        put(image, v * kColumns + u, static_cast<std::uint16_t>(std::lround(1000.0 * depth)));
        for (std::size_t of = 0; of < 2; ++of) {
          if (depth == hits[of]) continue;
          for (double z = depth + kError + 0.001; z <= kGreatest; z += 0.002)
            truth[of] = std::min(truth[of], distance_to(beams[of], kCamera + z * direction));
        }
      }
    }
    add(image);
    EXPECT_EQ(settle(kStart + 50'000'000).size(), 1u);
    std::array<double, 2> found{};
    for (const OwnImageStatus& link : sensors->status(0).own) {
      for (std::size_t of = 0; of < 2; ++of) {
        if (cell.scene.objects[link.object].name == kNames[of]) found[of] = link.unseen;
      }
    }
    return found;
  }
};

TEST_F(OtherRobotsShadow, IsUnseenAndThatOfTheOwnRobotIsNot) {
  Random random(20261);
  int shadowed = 0, clear = 0;
  for (int i = 0; i < 80; ++i) {
    // The right beam is above the left one, and they do not come near each other.
    const Beams beams = {BeamPose{random.uniform(-0.5, 0.5), Vec3(0.0, 0.0, 0.0)},
                         BeamPose{random.uniform(-2.0, 2.0),
                                  Vec3{random.uniform(-0.3, 0.6), random.uniform(-0.2, 0.7),
                                       random.uniform(0.3, 1.2)}}};
    make_cell(beams, "");
    std::array<double, 2> truth{};
    const std::array<double, 2> found = unseen(beams, truth);
    for (std::size_t of = 0; of < 2; ++of) {
      EXPECT_LE(found[of], truth[of]) << i << " " << kNames[of];
      // Half a pixel beside a ray and the slab of a pixel that the oracle gives to another body.
      const double pixel = (kHeight - kFloor) / kFocal;
      EXPECT_GE(found[of], truth[of] == 0.0 ? -1.0 : truth[of] - 1.5 * pixel - 2.0 * kError)
          << i << " " << kNames[of];
    }
    shadowed += truth[0] == 0.0 ? 1 : 0;
    clear += truth[0] > 0.05 ? 1 : 0;
  }
  EXPECT_GT(shadowed, 5);
  EXPECT_GT(clear, 5);
}

// The right beam lies on the left one. Each pixel of it is within the shell of both, so it may show
// either: the place behind it is unseen for both.
TEST_F(OtherRobotsShadow, IsUnseenForBothIfAPixelMayShowEither) {
  const Beams beams = {BeamPose{0.0, Vec3(0.0, 0.0, 0.0)}, BeamPose{0.0, Vec3(0.0, 0.0, 0.11)}};
  make_cell(beams, ", own_shell: 0.15");
  std::array<double, 2> truth{};
  const std::array<double, 2> found = unseen(beams, truth);
  EXPECT_EQ(truth[0], 0.0);
  EXPECT_LE(found[0], 0.0);
  EXPECT_LE(found[1], 0.0);
}

}  // namespace
}  // namespace clearance::sensors_test::shadows
