// Gradients of the distance to what a camera sees.
//
// Oracle: central differences of the monitor's own distances.
#include <gtest/gtest.h>

#include <cmath>

#include "monitor/interface/gradient_rows.hpp"
#include "tests/monitor/sensors/small_camera.hpp"

namespace clearance::sensors_test {
namespace {

class CloudGradients : public SensorsTest {
 protected:
  // A pixel whose cone is beside the arm at its height; all others are far below.
  SensorFrame frame() {
    make(kImage + kAbove);
    cell.scene.gradients = true;
    for (ObjectPair& pair : cell.scene.pairs) pair.publish = true;
    add(Type::kCameraInfo, InfoText{}.cdr(), kStart);
    ImageText image = flat(0, 3900);
    image.data[2 * 6] = 2000 & 0xFF;
    image.data[2 * 6 + 1] = 2000 >> 8;
    add(image);
    const auto frames = settle(kStart + 1000);
    EXPECT_EQ(frames.size(), 1u);
    return frames.at(0);
  }
  // The report with the joints at these positions.
  Report report(const SensorFrame& seen, const std::array<double, 3>& q) {
    Monitor monitor(cell.scene);
    EXPECT_TRUE(monitor.show(0, seen));
    return monitor.tick(std::vector{test::sample(0, test::at(0, 0, 50), kStart)},
                        test::joints(q[0], q[1], q[2], kStart), kStart + 1'000'000);
  }
};

TEST_F(CloudGradients, AreTheDifferencesOfTheDistance) {
  const SensorFrame seen = frame();
  const GradientRows rows = gradient_rows(cell.scene);
  int rates = 0;
  for (const double shoulder : {-0.3, 0.1, 0.4}) {
    const std::array<double, 3> q{shoulder, 0.5, 0.1};
    const Report at = report(seen, q);
    for (std::size_t r = 0; r < rows.rows.size(); ++r) {
      const std::uint32_t published = rows.rows[r].published;
      const PairReport& pair = at.pairs[published];
      const ObjectPair& objects = cell.scene.pairs[pair.pair];
      if (!cell.scene.objects[objects.first].is_seen() &&
          !cell.scene.objects[objects.second].is_seen()) {
        continue;
      }
      ASSERT_EQ(pair.status, PairStatus::kConverged);
      for (std::uint32_t e = rows.rows[r].first; e < rows.rows[r].end; ++e) {
        constexpr double kStep = 1e-6;
        std::array<double, 3> more = q, less = q;
        more[rows.variables[e]] += kStep;
        less[rows.variables[e]] -= kStep;
        const double difference = (report(seen, more).pairs[published].distance -
                                   report(seen, less).pairs[published].distance) /
                                  (2.0 * kStep);
        EXPECT_NEAR(at.gradients.rates[e], difference, 2e-5) << pair.pair;
        rates += std::abs(difference) > 0.1 ? 1 : 0;
      }
      EXPECT_NE(at.gradients.alternatives[r].status, GradientStatus::kUnique)
          << "another element may be as near";
    }
  }
  EXPECT_GT(rates, 5);
}

// A question's own queries of the picture.
TEST_F(CloudGradients, BelongToDistancesThatACloserLookConfirms) {
  const SensorFrame seen = frame();
  Monitor monitor(cell.scene);
  ASSERT_TRUE(monitor.show(0, seen));
  monitor.tick(std::vector{test::sample(0, test::at(0, 0, 50), kStart)},
               test::joints(0.1, 0.5, 0.1, kStart), kStart + 1'000'000);
  for (std::uint32_t p = 0; p < cell.scene.pairs.size(); ++p) {
    const PairReport known = monitor.pair(p);
    const PairReport closer = monitor.pair_at_least(p, kInfinity);
    EXPECT_GE(closer.lower, known.lower) << p;
    EXPECT_LE(closer.upper, known.upper) << p;
    EXPECT_LE(closer.lower, known.upper) << p;
  }
}

}  // namespace
}  // namespace clearance::sensors_test
