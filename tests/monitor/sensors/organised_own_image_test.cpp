// Organised points of a robot's arm and of what is beside it. Oracles: the true surfaces, which the
// test makes, and the distance to the arm's box in closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "tests/monitor/sensors/small_camera.hpp"
#include "tests/shared/random.hpp"

namespace clearance::sensors_test {
namespace {

// The camera is 2 m above the arm. Its rays are
// 0.02 apart, and the error of a depth is 1 cm.
constexpr std::uint32_t kColumns = 8, kRows = 12;
constexpr double kRays = 0.02, kError = 0.01;

// In the frame of the sensor.
double to_upper_link(const Vec3& p) {
  const Vec3 outside = (p - Vec3(0.5, 0.0, 2.0)).cwiseAbs() - Vec3(0.4, 0.05, 0.05);
  return outside.cwiseMax(0.0).norm();
}
Vec3 ray(double row, double column) {
  return {0.25 + kRays * (column - 3.5), kRays * (row - 5.5), 1.0};
}

class OrganisedOwnImage : public SensorsTest {
 protected:
  // Depths are z, row by row; what is measured is off by up to the error.
  void take(const std::vector<double>& depths) {
    truth.clear();
    measured.clear();
    CloudText text;
    text.stamp_ns += frames_++ * kFrame;
    text.height = kRows;
    text.width = kColumns;
    text.row_step = 20 * kColumns;
    text.data.assign(std::size_t{20} * kRows * kColumns, 0);
    for (std::size_t i = 0; i < depths.size(); ++i) {
      const Vec3 along = ray(static_cast<double>(i / kColumns), static_cast<double>(i % kColumns));
      truth.push_back(depths[i] * along);
      const auto z = static_cast<float>(depths[i] + 0.999 * kError * random.uniform(-1.0, 1.0));
      measured.emplace_back(z * along);
      const std::array point = {static_cast<float>(measured[i].x()),
                                static_cast<float>(measured[i].y()), z};
      std::memcpy(&text.data[20 * i], &point, sizeof point);
    }
    add_joints(0.0, text.stamp_ns);
    add(Type::kPoints, text.cdr(), text.stamp_ns);
    const auto frames = settle(text.stamp_ns + 1000);
    ASSERT_EQ(frames.size(), 1u);
    radius.assign(truth.size(), 0.0);
    frames[0].cloud->for_each([&](std::size_t b, std::size_t lane, const Vec3&, double of) {
      radius[frames[0].cloud->points()->block(b).source[lane]] = of;
    });
    for (const HiddenNear& near : frames[0].cloud->hidden()) {
      if (cell.scene.objects[near.object].name == "upper") thickness = near.shell.thickness;
    }
  }
  [[nodiscard]] bool is_kept(std::size_t i) const { return radius[i] > 0.0; }

  std::vector<Vec3> truth, measured;
  std::vector<double> radius;  // 0: the element was left out
  double thickness = 0.0;      // of the blind shell
  Random random{11};

 private:
  int frames_ = 0;
};

// Rows 5 and 6 see the arm. Those beside it see what is 7 cm lower than its lower side: near enough
// to be neighbours, and half of the distance to the arm's points is 9 cm.
TEST_F(OrganisedOwnImage, APointBesideTheArmIsKeptAndItsBallDoesNotReachTowardsTheArm) {
  make(kPoints + ", spacing: neighbours" + kAbove);
  std::vector<double> depths(std::size_t{kRows} * kColumns, 2.12);
  for (std::size_t i = 0; i < depths.size(); ++i) {
    if (i / kColumns == 5 || i / kColumns == 6) depths[i] = 1.95;
  }
  take(depths);
  for (std::size_t i = 0; i < depths.size(); ++i) {
    EXPECT_EQ(is_kept(i), depths[i] > 2.0) << i;
    EXPECT_LT(radius[i], to_upper_link(measured[i]) + 1e-9)
        << "no ball of the frame touches the arm";
  }
}

// Each pixel beside the arm may see anything; over it, it sees the arm or something above it.
TEST_F(OrganisedOwnImage, IsLeftOutAsAWholeAndNothingThatIsSeenBesideItBeyondTheBlindShell) {
  make(kPoints + ", spacing: neighbours" + kAbove);
  std::size_t own_points = 0, foreign_beside = 0, samples = 0, in_shell = 0;
  for (int run = 0; run < 60; ++run) {
    std::vector<double> depths;
    std::vector<bool> is_own;
    const double above = run % 2 == 0 ? 0.17 : random.uniform(0.0, 0.17),
                 beside = random.uniform(0.0, 0.25);
    for (std::size_t i = 0; i < std::size_t{kRows} * kColumns; ++i) {
      const bool is_over = i / kColumns == 5 || i / kColumns == 6;
      is_own.push_back(is_over && random.uniform(0.0, 1.0) < 0.7);
      depths.push_back(is_own.back() ? 1.95
                       : is_over     ? 1.95 - above * random.uniform(0.95, 1.0)
                                     : 1.95 + beside * random.uniform(0.8, 1.0));
    }
    take(depths);
    // A pixel sees what is half of a diagonal wide.
    const auto least = [&](std::size_t i) {
      const double range = measured[i].norm();
      return (kError / measured[i].z() + kRays * std::sqrt(0.5)) * range;
    };
    for (std::size_t i = 0; i < depths.size(); ++i) {
      if (is_own[i]) {
        EXPECT_FALSE(is_kept(i)) << run << " " << i;
        ++own_points;
      } else if (to_upper_link(measured[i]) > least(i)) {
        EXPECT_TRUE(is_kept(i)) << run << " " << i;
        foreign_beside += to_upper_link(measured[i]) < 0.1 ? 1 : 0;
      }
    }
    // Surfaces are bilinear between points whose depths differ by no more than those of neighbours.
    for (std::size_t a = 0; a + kColumns + 1 < depths.size(); ++a) {
      const std::array cell_of{a, a + 1, a + kColumns, a + kColumns + 1};
      const auto [low, high] = std::ranges::minmax(cell_of, {}, [&](auto i) { return depths[i]; });
      if ((a + 1) % kColumns == 0 || depths[high] - depths[low] > 0.17) continue;
      for (int sample = 0; sample < 20; ++sample, ++samples) {
        const double s = random.uniform(0.0, 1.0), t = random.uniform(0.0, 1.0);
        const Vec3 at = (1 - t) * ((1 - s) * truth[cell_of[0]] + s * truth[cell_of[1]]) +
                        t * ((1 - s) * truth[cell_of[2]] + s * truth[cell_of[3]]);
        const bool is_contained = std::ranges::any_of(
            cell_of, [&](std::size_t i) { return (measured[i] - at).norm() <= radius[i] + 1e-6; });
        in_shell += is_contained ? 0 : 1;
        EXPECT_TRUE(is_contained || to_upper_link(at) <= thickness) << run << " " << a;
      }
    }
  }
  EXPECT_GT(own_points, 500u);
  EXPECT_GT(foreign_beside, 200u);
  EXPECT_GT(samples, 5'000u);
  EXPECT_GT(in_shell, 100u);
}

}  // namespace
}  // namespace clearance::sensors_test
