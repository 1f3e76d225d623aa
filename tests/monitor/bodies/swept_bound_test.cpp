// The bounds between two ticks that the poses at both ends give, compared with the interpolated
// motion in small steps.
//
// Oracle: cold queries of the core at many instants. Eigen interpolates positions and orientations.
#include "monitor/bodies/swept_bound.hpp"

#include <gtest/gtest.h>

#include <optional>

#include "monitor/tick/monitor.hpp"
#include "tests/monitor/tick/fresh_distance.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/shared/poses.hpp"

namespace clearance {
namespace {

using test::kStart;
using test::kTick;

// Two bodies, watched and published, tick by tick.
class Watched {
 public:
  Watched(Object a, Object b) : scene_(test::cell_of({std::move(a), std::move(b)})) {
    scene_.pairs[0].publish = true;
    monitor_.emplace(scene_);
  }
  const PairReport& tick(const Pose& a, const Pose& b) {
    from_ = to_;
    to_ = {a, b};
    now_ns_ += kTick;
    const std::array samples{test::sample(0, a, now_ns_), test::sample(1, b, now_ns_)};
    return monitor_->tick(samples, now_ns_).pairs[0];
  }
  // The true distance at the fraction `s` between the poses of the last tick and the present ones.
  [[nodiscard]] double truth(double s) const {
    return test::fresh_distance(scene_.objects[0], test::between(from_[0], to_[0], s),
                                scene_.objects[1], test::between(from_[1], to_[1], s))
        .upper;
  }

 private:
  Scene scene_;
  std::optional<Monitor> monitor_;
  std::array<Pose, 2> from_, to_;
  std::int64_t now_ns_ = kStart;
};

Object any_body(Random& random, int kind) {
  const Pose offset = random.pose(0.3);
  if (kind == 0) return test::moving("needle", {test::block({0.4, 0.004, 0.004}, offset)});
  if (kind == 1) return test::moving("plate", {test::block({0.2, 0.2, 0.002}, offset)});
  if (kind == 2) return test::moving("capsule", {test::capsule(0.4, 0.03, offset)});
  return test::moving("three", {test::block({0.1, 0.05, 0.08}, offset), test::ball(0.05),
                                test::capsule(0.5, 0.02, random.pose(0.2))});
}

// The velocity is constant, so that many consecutive ticks see a near miss from all sides.
struct Flight {
  Pose pose;
  Vec3 step, turn;
  void go() {
    pose.position += step;
    if (turn.norm() > 0.0) {
      pose.orientation = Eigen::AngleAxisd(turn.norm(), turn.normalized()) * pose.orientation;
    }
  }
};

TEST(SweptBound, NoInstantOfThePathIsNearerThanReported) {
  Random random(401);
  int paths = 0, close = 0;
  for (int i = 0; i < 240; ++i) {
    Watched pair(any_body(random, i % 4), any_body(random, i / 4 % 4));
    const double scale = std::pow(10.0, random.uniform(-3.5, -0.5));
    std::array<Flight, 2> flights;
    for (Flight& flight : flights) {
      flight = {random.pose(0.5), random.in_box(scale), random.in_box(i % 3 == 0 ? 0.0 : scale)};
    }
    double last = kInfinity;
    for (int t = 0; t < 12; ++t) {
      const PairReport& report = pair.tick(flights[0].pose, flights[1].pose);
      for (Flight& flight : flights) flight.go();
      for (int k = 0; k <= 20 && t > 0; ++k) {
        ASSERT_LE(report.swept_lower, pair.truth(0.05 * k) + 1e-12)
            << "case " << i << " tick " << t;
      }
      paths += t > 0 && report.lower > 0.0;
      close += t > 0 && report.swept_lower > std::min(last, report.lower) - 0.1 * scale;
      last = report.lower;
    }
  }
  EXPECT_GT(close, paths / 2) << "of " << paths << ": mostly hardly less than the nearer end";
}

// A distance of 5 cm at 2 m/s and 2 rad/s. The displacement alone would leave a millimetre
// undecided.
TEST(SweptBound, IsNoLooserThanTheBendOfThePathWhileTheSameFacetsFaceEachOther) {
  Watched pair(test::moving("a", {test::block({0.1, 0.1, 0.1})}),
               test::moving("b", {test::block({0.2, 0.2, 0.1})}));
  double last = 0.0;
  for (int t = 0; t < 50; ++t) {
    Pose a = test::at(0.001 * t, 0, 0), b = test::at(-0.001 * t, 0, 0.25 + 1e-4 * t);
    a.orientation = b.orientation = Eigen::AngleAxisd(0.002 * t, Vec3::UnitZ());
    const PairReport& report = pair.tick(a, b);
    if (t > 0) {
      ASSERT_GT(report.swept_lower, std::min(last, report.lower) - 1e-6) << "tick " << t;
    }
    last = report.lower;
  }
}

TEST(SweptBound, DirectionsTellWhatLinesBetweenTheEndsCannotGoBelow) {
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY();
  const Vec3 none = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_NEAR(lower_by_directions({x, 0.3}, {x, 0.2}, 0.1, 0.0), 0.2, 1e-14);
  EXPECT_NEAR(lower_by_directions({x, 0.3}, {x, 0.2}, 0.1, 0.05), 0.15, 1e-14);
  EXPECT_LE(lower_by_directions({x, 0.2}, {y, 0.2}, 0.1, 0.0), 0.2 - 0.25 * std::sqrt(2.0) * 0.1);
  EXPECT_EQ(lower_by_directions({x, 0.2}, {x, -0.1}, 0.3, 0.0), -kInfinity) << "they overlap";
  EXPECT_EQ(lower_by_directions({none, -kInfinity}, {x, 0.2}, 0.3, 0.0), -kInfinity);
  EXPECT_EQ(lower_by_directions({x, 0.2}, {none, -kInfinity}, 0.3, 0.0), -kInfinity);
  EXPECT_EQ(lower_by_directions({none, 0.2}, {x, 0.2}, 0.3, 0.0), -kInfinity);
  EXPECT_EQ(lower_by_directions({x, 0.2}, {x, 0.2}, kInfinity, kInfinity), -kInfinity);
}

TEST(SweptBound, DisplacementTellsHalfOfWhatItLeavesOpen) {
  EXPECT_NEAR(lower_by_ends(0.3, 0.2, 0.1), 0.2, 1e-14);
  EXPECT_NEAR(lower_by_ends(0.2, 0.2, 0.1), 0.15, 1e-14);
  EXPECT_EQ(lower_by_ends(0.2, 0.2, kInfinity), -kInfinity);
  EXPECT_NEAR(lower_by_ends(-kInfinity, 0.2, 0.1), 0.1, 1e-14);
}

}  // namespace
}  // namespace clearance
