// The batch compared with single queries.
#include "core/batch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "core/shapes.hpp"
#include "tests/shared/allocation_count.hpp"
#include "tests/shared/distance_judge.hpp"
#include "tests/shared/hard_cases.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/vector_widths.hpp"

namespace clearance {
namespace {

std::string text_of(const DistanceResult& r) {
  std::ostringstream out;
  out << std::hexfloat << r.distance << " in [" << r.lower << ", " << r.upper << "], "
      << name(r.status);
  return out.str();
}

// Bodies in motion, and the pairs that are watched.
struct WatchedMotion {
  std::vector<ConvexBody> bodies;
  std::vector<BodyPair> pairs;
  std::vector<std::vector<Pose>> poses;  // indexed by [step][body]

  [[nodiscard]] std::vector<const ConvexBody*> shapes() const {
    std::vector<const ConvexBody*> all;
    for (const ConvexBody& body : bodies) all.push_back(&body);
    return all;
  }
  void watch_all_pairs() {
    for (std::uint32_t b = 1; b < bodies.size(); ++b) {
      for (std::uint32_t a = 0; a < b; ++a) pairs.push_back({a, b});
    }
  }
};

// Follows a motion with a batch and with a tracked query per pair. All answers must have the same
// bits.
void follow(const WatchedMotion& motion, const std::string& what) {
  const auto shapes = motion.shapes();
  DistanceBatch batch(shapes, motion.pairs);
  std::vector<TrackingState> states(motion.pairs.size());
  for (std::size_t step = 0; step < motion.poses.size(); ++step) {
    const std::vector<Pose>& poses = motion.poses[step];
    const auto answers = batch.evaluate(poses);
    for (std::size_t i = 0; i < motion.pairs.size(); ++i) {
      const auto [a, b] = motion.pairs[i];
      const DistanceResult expected =
          distance(*shapes[a], *shapes[b], relative_pose(poses[a], poses[b]), states[i]);
      const bool same_point = batch.point_on_b(i).cwiseEqual(states[i].b.point).all();
      if (same_bits(answers[i], expected) && same_point) continue;
      ADD_FAILURE() << what << ", step " << step << ", pair " << i << ": " << text_of(answers[i])
                    << ", not " << text_of(expected)
                    << (same_point ? "" : ", or another point of B");
      return;
    }
  }
}

Pose moved(const Pose& pose, Random& random, double step, double angle) {
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(random.uniform(0.0, angle), random.direction()));
  return {pose.position + random.in_box(step), (turn * pose.orientation).normalized()};
}

// Bodies of every kind. Some of them are parallel to the axes or to each other for a while, and
// occasionally one jumps.
WatchedMotion crowd(std::uint64_t seed) {
  Random random(seed);
  WatchedMotion motion;
  std::vector<Pose> poses;
  while (motion.bodies.size() < 20) {
    const hard::Body body = random.chance(0.1)    ? hard::unbounded(random)
                            : random.chance(0.1)  ? hard::rounded(random)
                            : random.chance(0.25) ? hard::box(Vec3(0.3, 0.4, 0.5))
                                                  : hard::any_bounded(random);
    ShapeResult shape = model(body);
    if (!std::holds_alternative<ConvexBody>(shape)) continue;
    motion.bodies.push_back(std::get<ConvexBody>(std::move(shape)));
    motion.bodies.back().radius += random.chance(0.1) ? 0.01 : 0.0;
    poses.push_back({random.in_box(10.0), random.rotation()});
  }
  motion.watch_all_pairs();
  for (int step = 0; step < 40; ++step) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      poses[i] = moved(poses[i], random, 0.01, 0.01);
      if (random.chance(0.01)) poses[i] = {random.in_box(10.0), random.rotation()};
      if (random.chance(0.03)) poses[i].orientation = poses[(i + 1) % poses.size()].orientation;
      if (random.chance(0.03)) poses[i].orientation = Eigen::Quaterniond(0.5, -0.5, 0.5, 0.5);
      if (random.chance(0.01)) {
        poses[i].orientation.coeffs() *= random.chance(0.5) ? 1.0 + 8e-7 : 1.5;
      }
    }
    motion.poses.push_back(poses);
    // For a few rounds one body has no valid position.
    if (step % 8 >= 5) {
      motion.poses.back()[3].position.setConstant(std::numeric_limits<double>::quiet_NaN());
    }
  }
  return motion;
}

TEST(DistanceBatch, GivesTheBitsOfSingleQueriesInACrowd) {
  for (const std::int64_t target : vector_widths()) {
    const OnlyWith only(target);
    for (std::uint64_t seed = 0; seed < 3; ++seed)
      follow(crowd(seed), "crowd " + std::to_string(seed));
  }
}

// All motions of one family at once, each with its own pair of bodies.
WatchedMotion motions_of(const hard::MotionFamily& family) {
  WatchedMotion motion;
  for (std::uint64_t seed = 0; seed < 11; ++seed) {
    Random random(seed);
    const hard::HardMotion m = family.make(random, 40);
    const auto index = static_cast<std::uint32_t>(motion.bodies.size());
    motion.bodies.push_back(test::made(m.a));
    motion.bodies.push_back(test::made(m.b));
    motion.pairs.push_back({index, index + 1});
    motion.pairs.push_back({index + 1, index});
    motion.poses.resize(m.poses.size());
    for (std::size_t step = 0; step < m.poses.size(); ++step) {
      motion.poses[step].push_back(m.poses[step].first);
      motion.poses[step].push_back(m.poses[step].second);
    }
  }
  return motion;
}

TEST(DistanceBatch, GivesTheBitsOfSingleQueriesAlongHardMotions) {
  for (const hard::MotionFamily& family : hard::motion_families()) {
    const WatchedMotion motion = motions_of(family);
    for (const std::int64_t target : vector_widths()) {
      const OnlyWith only(target);
      follow(motion, family.name);
    }
  }
}

// For distant bodies, rounding moves witness points off their facets, and the projection back to
// the facet is rounded as well. The error is 1e-8 m when the boxes have returned.
TEST(DistanceBatch, GivesTheBitsOfSingleQueriesOfWhatComesBackFromFarAway) {
  Mat3 turn;  // exactly three times a rotation
  turn << 2.0, -1.0, 2.0, 2.0, 2.0, -1.0, -1.0, 2.0, 2.0;
  WatchedMotion motion;
  for (std::uint32_t i = 0; i < 2; ++i) {
    std::vector<Vec3> corners;
    for (int k = 0; k < 8; ++k) {
      corners.push_back(turn * Vec3(k & 1 ? 0.5 : -0.5, k & 2 ? 0.5 : -0.5, k & 4 ? 0.5 : -0.5));
    }
    motion.bodies.push_back(test::made(polyhedron_from_vertices(corners)));
  }
  motion.watch_all_pairs();
  Random random(5);
  for (int round = 0; round < 200; ++round) {
    const Vec3 direction = turn.col(round % 3);
    const double far = random.log_uniform(1e12, 1e30);
    for (const double apart : {2.0, 2.0, 2.0, 2.0, 2.0, far, 2.0}) {
      motion.poses.push_back({Pose{}, {apart * direction}});
    }
  }
  for (const std::int64_t target : vector_widths()) {
    const OnlyWith only(target);
    follow(motion, "far away and back");
  }
}

TEST(DistanceBatch, StartsColdAgainWhenItForgets) {
  const WatchedMotion motion = crowd(7);
  const auto shapes = motion.shapes();
  DistanceBatch used(shapes, motion.pairs), fresh(shapes, motion.pairs);
  for (const auto& poses : motion.poses) (void)used.evaluate(poses);
  used.forget();
  const auto again = used.evaluate(motion.poses[0]), first = fresh.evaluate(motion.poses[0]);
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_TRUE(same_bits(again[i], first[i])) << i;
}

TEST(DistanceBatch, AllocatesNothing) {
  const WatchedMotion motion = crowd(8);
  const auto shapes = motion.shapes();
  DistanceBatch batch(shapes, motion.pairs);
  const std::uint64_t before = allocations();
  for (const auto& poses : motion.poses) (void)batch.evaluate(poses);
  batch.forget();
  EXPECT_EQ(allocations(), before);
}

TEST(DistanceBatch, OfNoPairsGivesNoResults) {
  DistanceBatch batch({}, {});
  EXPECT_TRUE(batch.evaluate({}).empty());
}

}  // namespace
}  // namespace clearance
