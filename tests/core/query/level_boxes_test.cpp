// Boxes whose faces or edges stay parallel while they slide, spin about a common axis or lie flush,
// in any frame; and queries from a relative pose. Oracles: the exact distance, closed forms, and
// the query from two poses.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "tests/shared/distance_judge.hpp"
#include "tests/shared/hard_bodies.hpp"
#include "tests/shared/poses.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/repeats.hpp"
#include "tests/shared/vector_widths.hpp"

namespace clearance {
namespace {

using Quat = Eigen::Quaterniond;
using test::turned;

const std::uint64_t kSeeds = repeats(40);
constexpr int kBoxSteps = 120;
constexpr double kStep = 0.01, kTurn = 0.013;  // m, rad

// The last two: an edge of B slides above an edge of A, or B turns about a corner of its own, which
// is above a corner of A. No face of B is over a face of A.
enum class Motion { kSliding, kAlongFlushEdges, kSpinning, kEdgeOverEdge, kCornerOverCorner };
constexpr Motion kMotions[] = {Motion::kSliding, Motion::kAlongFlushEdges, Motion::kSpinning,
                               Motion::kEdgeOverEdge, Motion::kCornerOverCorner};

// Box B moves above box A, which stands still. Its lower face is parallel to A's upper one.
struct LevelBoxes {
  Vec3 half_a, half_b;
  double gap;  // m
  std::vector<std::pair<Pose, Pose>> poses;
  double most_per_step;  // m: no point of B that faces A moves farther

  [[nodiscard]] DistanceJudge judge() const { return {hard::box(half_a), hard::box(half_b)}; }
};

// With a gap of 0 the boxes rest on each other, up to the rounding of their poses.
LevelBoxes level_boxes(Motion motion, std::uint64_t seed, bool rest = false) {
  Random random(seed);
  const auto half = [&] { return random.uniform(0.1, 0.5); };
  LevelBoxes made{{half(), half(), half()}, {half(), half(), half()}, 0.0, {}, kStep};
  if (motion == Motion::kAlongFlushEdges) made.half_b.x() = made.half_a.x();
  made.gap = rest ? 0.0 : random.log_uniform(1e-3, 0.3);
  const Pose a = random.pose(2.0);
  const double angle = random.uniform(0.0, 6.3);
  const bool along_edges = motion == Motion::kAlongFlushEdges || motion == Motion::kEdgeOverEdge;
  const Vec3 direction = along_edges ? Vec3(0, 1, 0) : Vec3(std::cos(angle), std::sin(angle), 0);
  const double up = made.half_a.z() + made.half_b.z() + made.gap;
  for (int k = 0; k < kBoxSteps; ++k) {
    Vec3 centre = kStep * (k - kBoxSteps / 2) * direction;
    Quat turn = Quat::Identity();
    if (motion == Motion::kSpinning) {
      centre = 0.05 * direction;  // the middle of either face lies within the other one
      turn = turned(Vec3::UnitZ(), kTurn * k + angle);
    } else if (motion == Motion::kEdgeOverEdge) {
      centre.x() = made.half_a.x() + made.half_b.x();
    } else if (motion == Motion::kCornerOverCorner) {
      turn = turned(Vec3::UnitZ(), kTurn * (k % 100));
      centre = Vec3(made.half_a.x(), made.half_a.y(), 0.0) + turn * made.half_b;
    }
    centre.z() = up;
    made.poses.push_back({a, {a.position + a.orientation * centre, a.orientation * turn}});
  }
  if (motion == Motion::kSpinning) made.most_per_step = kTurn * made.half_b.head<2>().norm();
  return made;
}

template <class Visit>
void for_each_motion(const Visit& visit) {
  for (const Motion motion : kMotions) {
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) visit(level_boxes(motion, seed), seed);
  }
}

TEST(LevelBoxes, WitnessesMoveNoFasterThanTheBodies) {
  for_each_motion([](const LevelBoxes& boxes, std::uint64_t seed) {
    const DistanceJudge judge = boxes.judge();
    TrackingState state;
    Vec3 last = Vec3::Zero();
    for (std::size_t k = 0; k < boxes.poses.size(); ++k) {
      const auto& [a, b] = boxes.poses[k];
      const Vec3 found = judge.ask(a, b, state).point_on_a;
      if (k > 0) {
        EXPECT_LE((found - last).norm(), boxes.most_per_step + 1e-13)
            << "seed " << seed << " step " << k;
      }
      last = found;
    }
  });
}

TEST(LevelBoxes, BoundsHoldTrackedAndCold) {
  for_each_motion([](const LevelBoxes& boxes, std::uint64_t seed) {
    DistanceJudge judge = boxes.judge();
    TrackingState tracked;
    for (std::size_t k = 0; k < boxes.poses.size(); ++k) {
      const auto& [a, b] = boxes.poses[k];
      const DistanceResult kept = judge.ask(a, b, tracked);
      if (k % 40 != seed) continue;
      TrackingState cold;
      const oracle::ExactDistance truth = judge.truth(a, b);
      for (const DistanceResult& result : {kept, judge.ask(a, b, cold)}) {
        EXPECT_EQ(result.status, DistanceStatus::kConverged) << "seed " << seed << " step " << k;
        for (const std::string& fault : judge.faults(result, truth, a, b)) {
          ADD_FAILURE() << "seed " << seed << " step " << k << ": " << fault;
        }
      }
    }
  });
}

TEST(LevelBoxes, AreTrackedWhereverTheyMeet) {
  for (const Motion motion : kMotions) {
    int all = 0, tracked = 0;
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      const LevelBoxes boxes = level_boxes(motion, seed);
      const DistanceJudge judge = boxes.judge();
      TrackingState state;
      for (const auto& [a, b] : boxes.poses) {
        ++all;
        tracked += judge.ask(a, b, state).path == DistancePath::kFeatureTracking;
      }
    }
    EXPECT_GT(tracked, 0.98 * all) << "motion " << static_cast<int>(motion);
  }
}

TEST(LevelBoxes, ThatRestOnEachOtherTouchAndTheirFeaturesCertifyIt) {
  int all = 0, at_once = 0;
  for (const Motion motion : kMotions) {
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      const LevelBoxes boxes = level_boxes(motion, seed, true);
      DistanceJudge judge = boxes.judge();
      TrackingState state;
      for (std::size_t k = 0; k < boxes.poses.size(); ++k) {
        const auto& [a, b] = boxes.poses[k];
        const DistanceResult result = judge.ask(a, b, state);
        const bool touch = result.status == DistanceStatus::kTouching;
        all += touch;
        at_once += touch && result.path == DistancePath::kPenetration;
        if (k % 40 != seed) continue;
        for (const std::string& fault : judge.faults(result, judge.truth(a, b), a, b)) {
          ADD_FAILURE() << "seed " << seed << " step " << k << ": " << fault;
        }
      }
    }
  }
  // The others are the first query of each motion, and those whose features change.
  EXPECT_GT(all, static_cast<int>(repeats(10'000)));
  EXPECT_GT(at_once, 0.8 * all);
}

// The 24 rotations that permute the axes.
std::vector<Quat> axis_rotations() {
  std::vector<Quat> all;
  for (int axis = 0; axis < 3; ++axis) {
    for (int quarters = 0; quarters < 8; ++quarters) {
      const Quat about_x = turned(Vec3::UnitX(), 0.5 * std::numbers::pi * (quarters % 4));
      const Quat flip = quarters < 4 ? Quat::Identity() : turned(Vec3::UnitZ(), std::numbers::pi);
      const Quat cycle = turned({1, 1, 1}, 2.0 * std::numbers::pi / 3.0 * axis);
      all.push_back((cycle * flip * about_x).normalized());
    }
  }
  return all;
}

// Closed form: the gaps along the axes. One box has its origin outside.
TEST(LevelBoxes, WithParallelAxesStartColdAtTheFeaturesThatFaceEachOther) {
  const Vec3 half_a(0.5, 0.4, 0.3), low_b(1.0, -0.2, 0.1), high_b(1.2, 0.4, 0.9);
  oracle::Body off_centre;
  for (int corner = 0; corner < 8; ++corner) {
    off_centre.points.push_back({(corner & 1) != 0 ? high_b.x() : low_b.x(),
                                 (corner & 2) != 0 ? high_b.y() : low_b.y(),
                                 (corner & 4) != 0 ? high_b.z() : low_b.z()});
  }
  DistanceJudge judge(hard::box(half_a), off_centre);
  ASSERT_EQ(judge.refusal(), "");
  Random random(5);
  for (const Quat& rotation : axis_rotations()) {
    const Vec3 half_b = (rotation * (0.5 * (high_b - low_b))).cwiseAbs();
    for (int direction = 0; direction < 27; ++direction) {
      const Vec3 sign(direction % 3 - 1, direction / 3 % 3 - 1, direction / 9 - 1);
      if (sign.isZero()) continue;
      const Vec3 gap(0.11, 0.23, 0.37);
      const Vec3 centre = sign.cwiseProduct(half_a + half_b + gap) + Vec3(0.01, -0.02, 0.03);
      const Pose a = random.pose(2.0);
      const Pose b = {a.position + a.orientation * (centre - rotation * (0.5 * (low_b + high_b))),
                      a.orientation * rotation};
      const double expected =
          (gap + sign.cwiseProduct(Vec3(0.01, -0.02, 0.03))).cwiseProduct(sign).norm();
      TrackingState state;
      const DistanceResult result = judge.ask(a, b, state);
      EXPECT_NEAR(result.distance, expected, 1e-13) << direction;
      EXPECT_EQ(result.path, DistancePath::kFeatureTracking) << direction;
      EXPECT_EQ(result.iterations, 1) << direction;
      for (const std::string& fault : judge.faults(result, judge.truth(a, b), a, b))
        ADD_FAILURE() << direction << ": " << fault;
    }
  }
}

// B passes through A from one side to the other, spun about the common axis or not.
TEST(LevelBoxes, ThatOverlapDeeplyHaveTheDepthOfTheirPrisms) {
  int all = 0, by_features = 0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    Random random(seed);
    const auto half = [&] { return random.uniform(0.1, 0.5); };
    const Vec3 half_a(half(), half(), half()), half_b(half(), half(), half());
    DistanceJudge judge(hard::box(half_a), hard::box(half_b));
    const Pose a = random.pose(2.0);
    const Quat turn =
        axis_rotations()[seed % 24] *
        (seed % 2 == 0 ? Quat::Identity() : turned(Vec3::UnitZ(), random.uniform(0.0, 1.5)));
    const Vec3 direction = random.direction(), beside = 0.1 * random.direction();
    TrackingState tracked;
    for (int k = 0; k < kBoxSteps; ++k) {
      const Vec3 centre = 0.02 * (k - kBoxSteps / 2) * direction + beside;
      const Pose b = {a.position + a.orientation * centre, a.orientation * turn};
      TrackingState cold;
      const DistanceResult kept = judge.ask(a, b, tracked), found = judge.ask(a, b, cold);
      if (!(found.upper < -1e-9)) continue;
      ++all;
      by_features += kept.path == DistancePath::kPenetration && kept.iterations < 4 ? 1 : 0;
      if (static_cast<std::uint64_t>(k) % 16 != seed % 16) continue;
      const oracle::ExactDistance truth = judge.truth(a, b);
      for (const DistanceResult& result : {kept, found}) {
        EXPECT_EQ(result.status, DistanceStatus::kOverlapping) << "seed " << seed << " step " << k;
        for (const std::string& fault : judge.faults(result, truth, a, b))
          ADD_FAILURE() << "seed " << seed << " step " << k << ": " << fault;
      }
    }
  }
  EXPECT_GT(all, static_cast<int>(repeats(1'000)));
  EXPECT_GT(by_features, all / 2);
}

TEST(LevelBoxes, ARelativePoseGivesTheBitsOfTwoPoses) {
  for_each_motion([](const LevelBoxes& boxes, std::uint64_t seed) {
    const DistanceJudge judge = boxes.judge();
    TrackingState by_poses, by_relative, without_depth;
    for (const auto& [a, b] : boxes.poses) {
      const RelativePose a_from_b = relative_pose(a, b);
      const DistanceResult expected = judge.ask(a, b, by_poses);
      EXPECT_TRUE(same_bits(distance(judge.a(), judge.b(), a_from_b, by_relative), expected))
          << "seed " << seed;
      EXPECT_TRUE(same_bits(
          distance(judge.a(), judge.b(), a_from_b, without_depth, {.depth = false}), expected))
          << "seed " << seed;
      EXPECT_TRUE(by_relative.a.point == by_poses.a.point &&
                  by_relative.b.point == by_poses.b.point)
          << "seed " << seed;
    }
  });
}

// Each of the twelve numbers in turn, from features of each kind; 1e13 m is farther than any frame.
TEST(LevelBoxes, ARelativePoseWithOneBadNumberIsRefused) {
  const DistanceJudge judge(hard::box({0.5, 0.4, 0.3}), hard::box({0.3, 0.4, 0.5}));
  const RelativePose good = relative_pose(Pose{}, {{0.1, 0.2, 2.0}, turned({1, 2, 3}, 0.7)});
  constexpr double kInf = std::numeric_limits<double>::infinity();
  for (const double bad : {std::nan(""), kInf, -kInf, 1e13}) {
    for (int number = std::isfinite(bad) ? 9 : 0; number < 12; ++number) {
      for (std::uint8_t kinds = 0; kinds < 9; ++kinds) {
        RelativePose pose = good;
        (number < 9 ? pose.rotation.data()[number] : pose.translation[number - 9]) = bad;
        TrackingState state{{static_cast<FeatureKind>(kinds % 3), false, 0},
                            {static_cast<FeatureKind>(kinds / 3), false, 0}};
        const DistanceResult result = distance(judge.a(), judge.b(), pose, state);
        EXPECT_EQ(result.status, DistanceStatus::kBadPose) << bad << " at " << number;
        EXPECT_EQ(state.a.kind, FeatureKind::kUnknown) << bad << " at " << number;
      }
    }
  }
}

}  // namespace
}  // namespace clearance
