// The batch compared with single queries: at any vector width, the two may differ only in speed.
#include "core/batch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "core/model/rotation_between.hpp"
#include "core/shapes.hpp"
#include "tests/shared/allocation_count.hpp"
#include "tests/shared/distance_judge.hpp"
#include "tests/shared/hard_cases.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/vector_widths.hpp"

namespace clearance {
namespace {

std::string text(const DistanceResult& r) {
  std::ostringstream out;
  out << std::hexfloat << r.distance << " in [" << r.lower << ", " << r.upper << "], "
      << name(r.status);
  return out.str();
}

// Bodies in motion, and the pairs that are watched.
struct Motion {
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

struct Difference {
  std::size_t answers = 0, single_queries = 0;
};

// Fewer pairs with the same kinds of features are queried singly.
constexpr std::size_t kLeastPairs = 4;

// Each pair as often as lanes need it.
std::vector<BodyPair> repeated(const std::vector<BodyPair>& pairs) {
  std::vector<BodyPair> all;
  for (std::size_t copy = 0; copy < kLeastPairs; ++copy) {
    all.insert(all.end(), pairs.begin(), pairs.end());
  }
  return all;
}

// Follows a motion with a batch and with a tracked query per pair. All answers must have the same
// bits.
Difference follow(const Motion& motion, const std::string& what) {
  const auto shapes = motion.shapes();
  const std::vector<BodyPair> pairs = repeated(motion.pairs);
  DistanceBatch batch(shapes, pairs);
  std::vector<TrackingState> states(motion.pairs.size());
  Difference seen;
  for (std::size_t step = 0; step < motion.poses.size(); ++step) {
    const std::vector<Pose>& poses = motion.poses[step];
    const auto answers = batch.evaluate(poses);
    seen.single_queries += batch.single_queries();
    std::vector<DistanceResult> expected;
    for (std::size_t i = 0; i < motion.pairs.size(); ++i) {
      const auto [a, b] = motion.pairs[i];
      expected.push_back(
          distance(*shapes[a], *shapes[b], relative_pose(poses[a], poses[b]), states[i]));
    }
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const std::size_t of = i % motion.pairs.size();
      ++seen.answers;
      const bool same_point = batch.point_on_b(i).cwiseEqual(states[of].b.point).all();
      if (same_bits(answers[i], expected[of]) && same_point) continue;
      ADD_FAILURE() << what << ", " << DistanceBatch::instruction_set() << ", step " << step
                    << ", pair " << i << ": " << text(answers[i]) << ", not " << text(expected[of])
                    << (same_point ? "" : ", or another point of B");
      return seen;
    }
  }
  return seen;
}

Pose moved(const Pose& pose, Random& random, double step, double angle) {
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(random.uniform(0.0, angle), random.direction()));
  return {pose.position + random.in_box(step), (turn * pose.orientation).normalized()};
}

// Bodies of every kind. Some of them are parallel to the axes or to each other for a while, and
// occasionally one jumps.
Motion crowd(std::uint64_t seed) {
  Random random(seed);
  Motion motion;
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
    for (std::uint64_t seed = 0; seed < 3; ++seed) {
      const Difference seen = follow(crowd(seed), "crowd " + std::to_string(seed));
      // The claim concerns vector code, so most answers must come from it.
      EXPECT_LT(2 * seen.single_queries, seen.answers) << DistanceBatch::instruction_set();
    }
  }
}

// All motions of one family at once, each with its own pair of bodies.
Motion motions_of(const hard::MotionFamily& family) {
  Motion motion;
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
    const Motion motion = motions_of(family);
    for (const std::int64_t target : vector_widths()) {
      const OnlyWith only(target);
      follow(motion, family.name);
    }
  }
}

TEST(DistanceBatch, GivesTheBitsOfSingleQueriesOnHardCases) {
  for (const hard::CaseFamily& family : hard::case_families()) {
    Motion motion;
    std::vector<Pose> poses;
    for (std::uint64_t seed = 300; seed < 310; ++seed) {
      Random random(seed);
      const hard::HardCase c = family.make(random);
      const auto index = static_cast<std::uint32_t>(motion.bodies.size());
      motion.bodies.push_back(test::made(c.a));
      motion.bodies.push_back(test::made(c.b));
      motion.pairs.push_back({index, index + 1});
      poses.push_back(c.pose_a);
      poses.push_back(c.pose_b);
    }
    motion.poses.assign(3, poses);
    for (const std::int64_t target : vector_widths()) {
      const OnlyWith only(target);
      follow(motion, family.name);
    }
  }
}

// A radius of zero must not change anything, not even a zero's sign.
TEST(DistanceBatch, KeepsTheSignsOfZeros) {
  Motion motion;
  motion.bodies.push_back(test::made({{}, {Vec3(-1.0, -0.0, -0.0), Vec3::UnitX()}, 0.0}));
  motion.bodies.push_back(test::made({{}, {Vec3::Zero()}, 0.0}));
  motion.pairs = {{0, 1}};
  motion.poses.assign(3, {Pose{}, Pose{.position = Vec3(-3.0, 1.0, 1.0)}});
  for (const std::int64_t target : vector_widths()) {
    const OnlyWith only(target);
    const Difference seen = follow(motion, "zeros");
    EXPECT_LT(seen.single_queries, seen.answers);
  }
}

// Boxes at a distance of two, rotated so that the given feature of each is closest (0: vertex, 1:
// edge, 2: face).
Pose turned_to(int feature, double x) {
  const Vec3 closest[] = {{1.0, 1.0, 1.0}, {1.0, 1.0, 0.02}, {1.0, 0.03, 0.02}};
  const Vec3 to = x < 0.0 ? Vec3::UnitX() : Vec3(-Vec3::UnitX());
  const Eigen::Quaterniond turn = rotation_between(closest[feature], to);
  const Eigen::Quaterniond about(Eigen::AngleAxisd(x < 0.0 ? 0.3 : 1.1, to));
  return {Vec3(x, 0.0, 0.0), about * turn};
}

// All pairs move from the blocks of one kind of features to those of another, repeatedly.
TEST(DistanceBatch, GivesTheBitsOfSingleQueriesWhenAllFeaturesChangeAtOnce) {
  Motion motion;
  for (std::uint32_t i = 0; i < 150; ++i) {
    motion.bodies.push_back(test::cube());
    motion.bodies.push_back(test::cube());
    motion.pairs.push_back({2 * i, 2 * i + 1});
  }
  for (const auto& [a, b] : {std::pair{0, 0}, {0, 1}, {1, 0}, {0, 2}, {2, 0}, {1, 1}, {0, 0}}) {
    std::vector<Pose>& poses = motion.poses.emplace_back();
    while (poses.size() < motion.bodies.size()) {
      poses.push_back(turned_to(a, -1.0));
      poses.push_back(turned_to(b, 1.0));
    }
  }
  for (const std::int64_t target : vector_widths()) {
    const OnlyWith only(target);
    const Difference seen = follow(motion, "all at once");
    EXPECT_EQ(seen.single_queries, seen.answers);
  }
}

TEST(DistanceBatch, AsksNoSingleQueryWhileFeaturesStay) {
  const ConvexBody cube = test::cube();
  const ConvexBody* const bodies[] = {&cube, &cube};
  const std::vector<BodyPair> pairs = repeated({{0, 1}});
  for (const auto& [a, b] : {std::pair{0, 0}, {0, 1}, {1, 0}, {0, 2}, {2, 0}, {1, 1}}) {
    DistanceBatch batch(bodies, pairs);
    std::vector<Pose> poses{turned_to(a, -1.0), turned_to(b, 1.0)};
    // One round finds the features, and the next one that there are enough such pairs.
    for (int round = 0; round < 2; ++round) {
      (void)batch.evaluate(poses);
      EXPECT_EQ(batch.single_queries(), kLeastPairs) << a << b;
    }
    for (int step = 0; step < 5; ++step) {
      poses[0].position.x() -= 1e-3;
      (void)batch.evaluate(poses);
      EXPECT_EQ(batch.single_queries(), 0U) << a << b << " step " << step;
    }
  }
}

// A cube stands on edge above another cube's face and above a floor, all of them rotated
// arbitrarily. Rounding tilts the edge against the face, in either direction as seen from the sides
// of the face.
TEST(DistanceBatch, JudgesEdgesThatSlideOverFacesInLanes) {
  Motion motion;
  motion.bodies = {test::cube(), test::cube(), test::half_space(Vec3::UnitX(), -1.0)};
  motion.pairs = {{0, 1}, {1, 0}, {0, 2}, {2, 0}};
  Random random(12);
  const Pose world{random.in_box(1.0), random.rotation()};
  const Eigen::Quaterniond on_edge(Eigen::AngleAxisd(std::numbers::pi / 4.0, Vec3::UnitZ()));
  constexpr int kSteps = 60;
  for (int step = 0; step < kSteps; ++step) {
    const double phase = 0.1 * step;
    const Pose upper{Vec3(1.5, 0.2 * std::sin(phase), 0.7 * std::cos(phase)), on_edge};
    motion.poses.push_back({compose(world, upper), world, world});
  }
  for (const std::int64_t target : vector_widths()) {
    const OnlyWith only(target);
    const Difference seen = follow(motion, "on edge");
    EXPECT_LT(seen.single_queries, seen.answers / 20) << DistanceBatch::instruction_set();
  }
}

// The closest features are vertex and edge alternately; then the pair rests.
TEST(DistanceBatch, AsksARestlessPairSinglyUntilItKeepsItsFeatures) {
  const ConvexBody cube = test::cube();
  const ConvexBody* const bodies[] = {&cube, &cube};
  const std::vector<BodyPair> pairs = repeated({{0, 1}});
  DistanceBatch batch(bodies, pairs);
  for (int step = 0; step < 100; ++step) {
    const Pose poses[] = {turned_to(step % 2, -1.0), turned_to(0, 1.0)};
    (void)batch.evaluate(poses);
    EXPECT_EQ(batch.single_queries(), kLeastPairs) << "step " << step;
  }
  const Pose still[] = {turned_to(1, -1.0), turned_to(0, 1.0)};
  (void)batch.evaluate(still);
  EXPECT_EQ(batch.single_queries(), kLeastPairs);
  for (int step = 0; step < 40; ++step) (void)batch.evaluate(still);
  EXPECT_EQ(batch.single_queries(), 0U);
}

// A vector takes as long for one pair as for several.
TEST(DistanceBatch, AsksTooFewPairsOfTheSameFeaturesSingly) {
  const ConvexBody cube = test::cube();
  const std::vector<const ConvexBody*> bodies(2 * kLeastPairs, &cube);
  std::vector<BodyPair> pairs;
  std::vector<Pose> poses;
  for (std::uint32_t i = 0; i < kLeastPairs; ++i) {
    pairs.push_back({2 * i, 2 * i + 1});
    poses.push_back(turned_to(i == 0 ? 1 : 0, -1.0));
    poses.push_back(turned_to(0, 1.0));
  }
  DistanceBatch batch(bodies, pairs);
  const auto rounds = [&] {
    for (int round = 0; round < 60; ++round) (void)batch.evaluate(poses);
    return batch.single_queries();
  };
  EXPECT_EQ(rounds(), kLeastPairs) << "three of one kind, and one of another";
  poses[0] = turned_to(0, -1.0);
  EXPECT_EQ(rounds(), 0U) << "all of one kind";
  poses[0] = poses[2] = turned_to(1, -1.0);
  EXPECT_EQ(rounds(), kLeastPairs) << "two of each kind";
}

// For distant bodies, rounding moves witness points off their facets, and the projection back to
// the facet is rounded as well. The error is 1e-8 m when the boxes have returned.
TEST(DistanceBatch, GivesTheBitsOfSingleQueriesOfWhatComesBackFromFarAway) {
  Mat3 turn;  // exactly three times a rotation
  turn << 2.0, -1.0, 2.0, 2.0, 2.0, -1.0, -1.0, 2.0, 2.0;
  Motion motion;
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
    const Vec3 way = turn.col(round % 3);
    const double far = random.log_uniform(1e12, 1e30);
    for (const double apart : {2.0, 2.0, 2.0, 2.0, 2.0, far, 2.0}) {
      motion.poses.push_back({Pose{}, {apart * way}});
    }
  }
  for (const std::int64_t target : vector_widths()) {
    const OnlyWith only(target);
    follow(motion, "far away and back");
  }
}

TEST(DistanceBatch, StartsColdAgainWhenItForgets) {
  const Motion motion = crowd(7);
  const auto shapes = motion.shapes();
  DistanceBatch used(shapes, motion.pairs), fresh(shapes, motion.pairs);
  for (const auto& poses : motion.poses) (void)used.evaluate(poses);
  used.forget();
  const auto again = used.evaluate(motion.poses[0]), first = fresh.evaluate(motion.poses[0]);
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_TRUE(same_bits(again[i], first[i])) << i;
}

TEST(DistanceBatch, AllocatesNothing) {
  const Motion motion = crowd(8);
  const auto shapes = motion.shapes();
  DistanceBatch batch(shapes, motion.pairs);
  const std::uint64_t before = allocations();
  for (const auto& poses : motion.poses) (void)batch.evaluate(poses);
  batch.forget();
  EXPECT_EQ(allocations(), before);
}

// Sanitizer builds omit some instruction sets (core/CMakeLists.txt).
TEST(DistanceBatch, RunsOneLaneAndWiderOnesHere) {
  std::set<std::string> names;
  for (const std::int64_t target : vector_widths()) {
    const OnlyWith only(target);
    names.insert(DistanceBatch::instruction_set());
  }
  EXPECT_GE(names.size(), std::min<std::size_t>(2, vector_widths().size()));
}

}  // namespace
}  // namespace clearance
