// The balls of organised points. Oracles: the definition, point by point; and samples of the true
// surface, which the test makes. Some of them need nothing of the definition.
#include "monitor/sensors/organised_points.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <optional>

#include "tests/monitor/sensors/small_camera.hpp"
#include "tests/shared/random.hpp"

namespace clearance::sensors_test {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

// A picture whose rays are 1/focal apart. Depths are z.
struct Picture {
  std::uint32_t width = 24, height = 18;
  double focal = 100.0, error = 0.0;
  std::vector<Vec3> truth = {};
  std::vector<MeasuredPoint> points = {};

  [[nodiscard]] Vec3 at(std::size_t u, std::size_t v, double z) const {
    return {(static_cast<double>(u) - 0.5 * width) * z / focal,
            (static_cast<double>(v) - 0.5 * height) * z / focal, z};
  }
  // Points are off along their rays by up to the error, and some are missing.
  template <class Depth>
  void make(const Depth& depth, double missing, Random& random) {
    truth.clear();
    points.clear();
    for (std::size_t v = 0; v < height; ++v) {
      for (std::size_t u = 0; u < width; ++u) {
        truth.push_back(at(u, v, depth(u, v)));
        const double range = truth.back().norm();
        const double most = error * (1.0 + 0.3 * static_cast<double>(u % 3));
        const Vec3 p = truth.back() * (1.0 + 0.999 * most * random.uniform(-1.0, 1.0) / range);
        const bool is_missing = random.uniform(0.0, 1.0) < missing;
        points.push_back({is_missing ? kNone : static_cast<float>(p.x()), static_cast<float>(p.y()),
                          static_cast<float>(p.z()), static_cast<float>(most)});
      }
    }
  }
  [[nodiscard]] bool is_there(std::size_t i) const { return std::isfinite(points[i].x); }
  [[nodiscard]] Vec3 point(std::size_t i) const { return {points[i].x, points[i].y, points[i].z}; }
};

// The definition, for one point and without any order of work.
class Definition {
 public:
  explicit Definition(const Picture& of) : of_(of) {
    for (std::size_t i = 0; i < of.points.size(); ++i) {
      for (const std::size_t k : {i + 1, i + of.width}) {
        const bool is_beside = k < of.points.size() && (k != i + 1 || k % of.width != 0);
        if (is_beside && chord(i, k)) widest_ = std::max(widest_, *chord(i, k));
      }
    }
  }
  [[nodiscard]] double radius(std::size_t i) const {
    const auto u = static_cast<int>(i % of_.width), v = static_cast<int>(i / of_.width);
    double reach = std::sqrt(0.5) * widest_ * of_.point(i).norm();
    double error = of_.points[i].radius;
    for (const int right : {-1, 1}) {
      for (const int down : {-1, 1}) {
        Vec3 sum = of_.point(i);
        int count = 1;
        for (const auto& [du, dv] :
             {std::pair(right, 0), std::pair(0, down), std::pair(right, down)}) {
          if (u + du < 0 || v + dv < 0 || u + du >= static_cast<int>(of_.width) ||
              v + dv >= static_cast<int>(of_.height))
            continue;
          const auto k = static_cast<std::size_t>((v + dv) * static_cast<int>(of_.width) + u + du);
          if (!is_neighbour(i, k)) continue;
          reach = std::max(reach, 0.5 * (of_.point(k) - of_.point(i)).norm());
          error = std::max(error, double{of_.points[k].radius});
          sum += of_.point(k);
          ++count;
        }
        // A cell lacks its far corners at the edge of the picture, where it is none.
        const bool is_cell = u + right >= 0 && v + down >= 0 &&
                             u + right < static_cast<int>(of_.width) &&
                             v + down < static_cast<int>(of_.height);
        if (is_cell) reach = std::max(reach, (sum / count - of_.point(i)).norm());
      }
    }
    return reach + error;
  }
  [[nodiscard]] bool is_neighbour(std::size_t i, std::size_t k) const {
    const auto found = chord(i, k);
    if (!found || *found > kWidestNeighbour) return false;
    const double a = of_.point(i).norm(), b = of_.point(k).norm();
    const double jump = std::abs(a - b) - of_.points[i].radius - of_.points[k].radius;
    return jump <= std::min(kSteepest * *found, kWidestNeighbour) * std::min(a, b);
  }

 private:
  [[nodiscard]] std::optional<double> chord(std::size_t i, std::size_t k) const {
    if (!of_.is_there(i) || !of_.is_there(k)) return std::nullopt;
    return (of_.point(i).normalized() - of_.point(k).normalized()).norm();
  }

  const Picture& of_;
  double widest_ = 0.0;
};

TEST(OrganisedPoints, HaveTheRadiusOfTheirDefinitionRoundedUp) {
  Random random(3);
  OrganisedPoints organised;
  for (int run = 0; run < 40; ++run) {
    Picture picture{.focal = random.uniform(14.2, 300.0), .error = random.uniform(0.0, 0.03)};
    const double slope = random.uniform(-0.2, 0.2), step = random.uniform(0.0, 1.0);
    picture.make(
        [&](std::size_t u, std::size_t v) {
          return 2.0 + slope * static_cast<double>(v) / picture.height + (u > 11 ? step : 0.0);
        },
        0.2, random);
    const Definition definition(picture);
    std::vector<MeasuredPoint> widened = picture.points;
    ASSERT_EQ(organised.widen(picture.width, picture.height, widened), FrameFault::kNoFault);
    for (std::size_t i = 0; i < widened.size(); ++i) {
      EXPECT_EQ(std::isfinite(widened[i].x), picture.is_there(i));
      if (!picture.is_there(i)) continue;
      EXPECT_GE(widened[i].radius, definition.radius(i) * (1.0 - 1e-12)) << run << " " << i;
      EXPECT_LE(widened[i].radius, definition.radius(i) * (1.0 + 1e-6)) << run << " " << i;
      EXPECT_EQ(widened[i].z, picture.points[i].z);
    }
  }
}

// Between the four true points of a cell, the surface is bilinear.
TEST(OrganisedPoints, ContainTheSurfaceBetweenTrueNeighboursWhateverTheErrors) {
  Random random(4);
  OrganisedPoints organised;
  int samples = 0;
  for (int run = 0; run < 60; ++run) {
    Picture picture{.focal = random.uniform(30.0, 300.0), .error = random.uniform(0.0, 0.05)};
    const double along = random.uniform(-0.08, 0.08), across = random.uniform(-0.08, 0.08);
    const double rough = run % 2 == 0 ? 0.0 : 0.02;
    picture.make(
        [&](std::size_t u, std::size_t v) {
          return 3.0 + along * static_cast<double>(u) + across * static_cast<double>(v) +
                 rough * random.uniform(-1.0, 1.0);
        },
        0.0, random);
    const Definition definition(picture);
    std::vector<MeasuredPoint> widened = picture.points;
    ASSERT_EQ(organised.widen(picture.width, picture.height, widened), FrameFault::kNoFault);
    for (std::size_t v = 0; v + 1 < picture.height; ++v) {
      for (std::size_t u = 0; u + 1 < picture.width; ++u) {
        const std::size_t a = v * picture.width + u, c = a + picture.width;
        const std::array cell{a, a + 1, c, c + 1};
        bool is_whole = true;
        for (const std::size_t i : cell) {
          for (const std::size_t k : cell)
            is_whole = is_whole && (i == k || definition.is_neighbour(i, k));
        }
        if (!is_whole) continue;
        for (int sample = 0; sample < 4; ++sample) {
          const double s = random.uniform(0.0, 1.0), t = random.uniform(0.0, 1.0);
          const Vec3 at = (1 - t) * ((1 - s) * picture.truth[a] + s * picture.truth[a + 1]) +
                          t * ((1 - s) * picture.truth[c] + s * picture.truth[c + 1]);
          ++samples;
          EXPECT_TRUE(std::ranges::any_of(
              cell,
              [&](std::size_t i) { return (picture.point(i) - at).norm() <= widened[i].radius; }))
              << run << " " << u << " " << v;
        }
      }
    }
  }
  EXPECT_GT(samples, 20'000);
}

// A box of 0.3 m before a wall: their balls leave the space between them free.
TEST(OrganisedPoints, DoNotSpanTheEdgesOfBodies) {
  Random random(5);
  Picture picture{.error = 0.005};
  const auto is_box = [](std::size_t u, std::size_t v) { return u > 6 && u < 15 && v > 4; };
  picture.make([&](std::size_t u, std::size_t v) { return is_box(u, v) ? 1.0 : 1.3; }, 0.0, random);
  OrganisedPoints organised;
  ASSERT_EQ(organised.widen(picture.width, picture.height, picture.points), FrameFault::kNoFault);
  for (const MeasuredPoint& p : picture.points) {
    // Half of a pixel's diagonal, the error, and what the errors add to the distance to a
    // neighbour.
    EXPECT_LE(p.radius, 0.75 * 0.013 + 0.008 + 0.5 * 0.017) << p.z;
    EXPECT_GE(p.radius, 0.005 + 0.7 * 0.0098) << p.z;
  }
}

TEST(OrganisedPoints, ReachNoFartherThanTheViewOfTheirSensor) {
  Random random(6);
  OrganisedPoints organised;
  const Cell cell = cell_with(kPoints + ", spacing: neighbours" + kAbove);
  const Sensor& sensor = cell.scene.sensors[0];
  for (int run = 0; run < 20; ++run) {
    Picture picture{.focal = random.uniform(14.2, 25.0), .error = sensor.error_at(4.0)};
    picture.make([&](std::size_t, std::size_t) { return random.uniform(3.4, 4.0); }, 0.1, random);
    ASSERT_EQ(organised.widen(picture.width, picture.height, picture.points), FrameFault::kNoFault);
    for (std::size_t i = 0; i < picture.points.size(); ++i) {
      if (!picture.is_there(i)) continue;
      EXPECT_LE(picture.point(i).norm() + picture.points[i].radius, sensor.extent());
    }
  }
}

// A plane is given by its unit normal. No step of the definition says here which cells count.
TEST(OrganisedPoints, ContainEachPlaneUpToTheStatedSteepnessOrRefuseItsFrame) {
  Random random(7);
  OrganisedPoints organised;
  int samples = 0, steep = 0, refused = 0;
  for (int run = 0; run < 400; ++run) {
    Picture picture{.width = 9, .height = 7, .focal = 1.0 / random.uniform(0.005, 0.15)};
    const double turn = random.uniform(0.0, 6.3), tilt = random.uniform(0.0, 1.39);
    const Vec3 normal(std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn),
                      std::cos(tilt));
    const auto along = [&](std::size_t i) {
      return normal.dot(picture.at(i % picture.width, i / picture.width, 1.0).normalized());
    };
    picture.make(
        [&](std::size_t u, std::size_t v) {
          const double facing = normal.dot(picture.at(u, v, 1.0));
          return facing > 0.02 ? 2.0 / facing : 100.0;
        },
        0.0, random);
    std::vector<MeasuredPoint> widened = picture.points;
    if (organised.widen(picture.width, picture.height, widened) == FrameFault::kWideRays) {
      ++refused;
      EXPECT_GT(std::sqrt(2.0) / picture.focal, 0.1);
      continue;
    }
    for (std::size_t a = 0; a + picture.width + 1 < picture.points.size(); ++a) {
      if ((a + 1) % picture.width == 0) continue;
      const std::array cell{a, a + 1, a + picture.width, a + picture.width + 1};
      const auto length = [&](std::size_t i, std::size_t k) {
        return (picture.truth[i].normalized() - picture.truth[k].normalized()).norm();
      };
      const double diagonal = std::max(length(cell[0], cell[3]), length(cell[1], cell[2]));
      const double steepest = std::min(80.0 * std::numbers::pi / 180.0, std::atan(0.1 / diagonal));
      const double incidence = std::acos(std::ranges::min(
          std::array{along(cell[0]), along(cell[1]), along(cell[2]), along(cell[3])}));
      if (!(incidence < 0.9999 * steepest)) continue;
      steep += incidence > 0.8 * steepest ? 1 : 0;
      for (int sample = 0; sample < 20; ++sample, ++samples) {
        const double s = random.uniform(0.0, 1.0), t = random.uniform(0.0, 1.0);
        const Vec3 ray = (1 - t) * ((1 - s) * picture.at(a % 9, a / 9, 1.0) +
                                    s * picture.at(a % 9 + 1, a / 9, 1.0)) +
                         t * ((1 - s) * picture.at(a % 9, a / 9 + 1, 1.0) +
                              s * picture.at(a % 9 + 1, a / 9 + 1, 1.0));
        const Vec3 at = ray * (2.0 / normal.dot(ray));
        EXPECT_TRUE(std::ranges::any_of(cell,
                                        [&](std::size_t i) {
                                          return (picture.point(i) - at).norm() <=
                                                 widened[i].radius + 1e-6;
                                        }))
            << run << " " << a << " " << 1.0 / picture.focal;
      }
    }
  }
  EXPECT_GT(samples, 20'000);
  EXPECT_GT(steep, 200);
  EXPECT_GT(refused, 50);
}

class OrganisedFrames : public SensorsTest {
 protected:
  // A frame of a scanner whose rows and columns are these angles apart. No range: NaN.
  template <class Range>
  std::vector<SensorFrame> take(std::uint32_t rows, std::uint32_t columns, double row,
                                double column, const Range& range) {
    CloudText cloud;
    cloud.stamp_ns += frames_++ * kFrame;
    cloud.height = rows;
    cloud.width = columns;
    cloud.row_step = 20 * columns;
    cloud.data.assign(std::size_t{20} * rows * columns, 0);
    for (std::uint32_t v = 0; v < rows; ++v) {
      for (std::uint32_t u = 0; u < columns; ++u) {
        const double far = range(v, u);
        const Vec3 p =
            far * direction((v - 0.5 * (rows - 1)) * row, (u - 0.5 * (columns - 1)) * column);
        const std::array point = {static_cast<float>(p.x()), static_cast<float>(p.y()),
                                  static_cast<float>(p.z())};
        std::memcpy(&cloud.data[std::size_t{20} * (v * columns + u)], &point, sizeof point);
      }
    }
    add(Type::kPoints, cloud.cdr(), cloud.stamp_ns);
    return settle(cloud.stamp_ns + 1000);
  }
  static Vec3 direction(double up, double right) {
    return {std::cos(up) * std::sin(right), std::sin(up), std::cos(up) * std::cos(right)};
  }

  std::int64_t frames_ = 0;
};

constexpr double kDegree = std::numbers::pi / 180.0;

// A hand is before a wall that is out of range. The rows are 2 degrees apart, the columns 0.2.
TEST_F(OrganisedFrames, AHandThatOneRowHitsIsContainedUpToTheMiddleBetweenTheRows) {
  make(kPoints + ", spacing: neighbours" + kAbove);
  const auto frames = take(16, 40, 2 * kDegree, 0.2 * kDegree, [](std::size_t v, std::size_t u) {
    return v == 9 && u >= 15 && u < 22 ? 1.5 : 6.0;
  });
  ASSERT_EQ(frames.size(), 1u);
  ASSERT_EQ(frames[0].cloud->size(), 7u);
  const PointCloud::Block& block = frames[0].cloud->points()->block(0);
  for (double up = 2.02; up < 4.0; up += 0.04) {
    for (double right = -0.95; right < 0.4; right += 0.05) {
      const Vec3 at = 1.5 * direction(up * kDegree, right * kDegree);
      bool is_contained = false;
      for (std::size_t i = 0; i < 7; ++i) {
        const Vec3 centre(block.x[i], block.y[i], block.z[i]);
        is_contained = is_contained || (centre - at).norm() <= block.radius[i];
      }
      EXPECT_TRUE(is_contained) << up << " " << right;
    }
  }
}

TEST_F(OrganisedFrames, AreRefusedIfNothingShowsHowFarApartTheRowsOrColumnsAre) {
  make(kPoints + ", spacing: neighbours" + kAbove);
  EXPECT_TRUE(take(16, 40, 0.03, 0.003, [](std::size_t v, std::size_t) {
                return v == 9 ? 1.5 : kNone;
              }).empty());
  EXPECT_EQ(count(FrameFault::kUnknownRays), 1u) << "one row";
  EXPECT_TRUE(take(16, 40, 0.03, 0.003, [](std::size_t v, std::size_t u) {
                return v % 2 == 0 && u == 9 ? 1.5 : kNone;
              }).empty());
  EXPECT_EQ(count(FrameFault::kUnknownRays), 2u) << "every point is alone";
  EXPECT_TRUE(take(16, 40, 0.03, 0.003, [](std::size_t, std::size_t) { return kNone; }).empty());
  EXPECT_EQ(count(FrameFault::kNothingSeen), 1u) << "no point at all";
  EXPECT_EQ(take(16, 40, 0.03, 0.003, [](std::size_t, std::size_t) { return 1.5; }).size(), 1u);
}

// The first is a ranging chip with four by four zones; the others are lidars.
TEST_F(OrganisedFrames, AreRefusedIfTheirRaysAreTooFarApartWhetherOrNotTheyAreWithinTheRange) {
  const auto make_one = [&] { make(kPoints + ", spacing: neighbours" + kAbove); };
  make_one();
  EXPECT_TRUE(
      take(4, 4, 11 * kDegree, 11 * kDegree, [](std::size_t, std::size_t) { return 1.0; }).empty());
  EXPECT_EQ(count(FrameFault::kWideRays), 1u);
  make_one();
  EXPECT_TRUE(take(8, 40, 6 * kDegree, 0.2 * kDegree, [](std::size_t v, std::size_t u) {
                return v == 4 && u == 20 ? 1.0 : 6.0;
              }).empty());
  EXPECT_EQ(count(FrameFault::kWideRays), 1u);
  EXPECT_EQ(
      take(8, 40, 5 * kDegree, 0.2 * kDegree, [](std::size_t, std::size_t) { return 1.0; }).size(),
      1u);
}

TEST_F(SensorsTest, MakeBallsOfOrganisedPointsThatReachToTheirNeighbours) {
  make(kPoints + ", spacing: neighbours" + kAbove);
  CloudText cloud;
  cloud.width = cloud.height = 2;
  cloud.row_step = 40;
  cloud.data.assign(80, 0);
  const std::array<std::array<float, 3>, 4> points = {
      {{0.0F, 0.0F, 1.0F}, {0.05F, 0.0F, 1.0F}, {0.0F, 0.05F, 1.0F}, {0.05F, 0.05F, 1.0F}}};
  for (std::size_t i = 0; i < 4; ++i) std::memcpy(&cloud.data[20 * i], &points[i], 12);
  add(Type::kPoints, cloud.cdr(), kStart);
  const auto frames = settle(kStart + 1000);
  ASSERT_EQ(frames.size(), 1u);
  ASSERT_EQ(frames[0].cloud->size(), 4u);
  for (std::size_t lane = 0; lane < 4; ++lane)
    EXPECT_NEAR(frames[0].cloud->points()->block(0).radius[lane], 0.05 / std::sqrt(2) + 0.01, 1e-4);
  cloud.stamp_ns += kFrame;
  cloud.height = 1;
  cloud.width = 4;
  cloud.row_step = 80;
  cloud.data[0] ^= 1;
  add(Type::kPoints, cloud.cdr(), cloud.stamp_ns);
  EXPECT_TRUE(settle(cloud.stamp_ns + 1000).empty());
  EXPECT_EQ(count(FrameFault::kFormChanged), 1u) << "in mid-stream";
  make(kPoints + ", spacing: neighbours" + kAbove);
  add(Type::kPoints, cloud.cdr(), cloud.stamp_ns);
  EXPECT_TRUE(settle(cloud.stamp_ns + 1000).empty()) << "nothing says which points are neighbours";
  EXPECT_EQ(count(FrameFault::kNotOrganised), 1u);
}

}  // namespace
}  // namespace clearance::sensors_test
