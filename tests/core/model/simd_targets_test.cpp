// A query must return the same bits from every caller, with every instruction set and in every
// build.
#include "tests/shared/vector_widths.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <vector>

#include "core/enclosing_polyhedron.hpp"
#include "tests/shared/distance_judge.hpp"
#include "tests/shared/hard_cases.hpp"
#include "tests/shared/made.hpp"

namespace clearance {
namespace {

constexpr std::uint64_t kFirstSeed = 300, kWidthSeeds = 6;

struct Walk {
  ConvexBody a, b;
  std::vector<std::pair<Pose, Pose>> poses;
  std::string name;
};

// Hard motions, and hard cases treated as motions of one step.
template <class Visit>
void for_each_walk(const Visit& visit) {
  for (std::uint64_t seed = kFirstSeed; seed < kFirstSeed + kWidthSeeds; ++seed) {
    for (const hard::MotionFamily& family : hard::motion_families()) {
      Random random(seed);
      const hard::HardMotion motion = family.make(random, 60);
      visit(Walk{test::made(motion.a), test::made(motion.b), motion.poses,
                 family.name + std::string(" seed ") + std::to_string(seed)});
    }
    for (const hard::CaseFamily& family : hard::case_families()) {
      Random random(seed);
      const hard::HardCase c = family.make(random);
      visit(Walk{test::made(c.a),
                 test::made(c.b),
                 {{c.pose_a, c.pose_b}, {c.pose_a, c.pose_b}},
                 family.name + std::string(" seed ") + std::to_string(seed)});
    }
  }
}

std::vector<DistanceResult> follow(const Walk& walk) {
  std::vector<DistanceResult> results;
  TrackingState state;
  for (const auto& [a, b] : walk.poses) results.push_back(distance(walk.a, walk.b, a, b, state));
  return results;
}

TEST(Distance, OfTwoPosesIsThatOfTheirRelativePoseToTheBit) {
  for_each_walk([](const Walk& walk) {
    TrackingState state, other;
    for (const auto& [a, b] : walk.poses) {
      EXPECT_TRUE(same_bits(distance(walk.a, walk.b, a, b, state),
                            distance(walk.a, walk.b, relative_pose(a, b), other)))
          << walk.name;
    }
  });
}

TEST(Distance, HasTheSameBitsAtEveryVectorWidth) {
  for_each_walk([](const Walk& walk) {
    const std::vector<DistanceResult> expected = follow(walk);
    for (const std::int64_t width : vector_widths()) {
      const OnlyWith only(width);
      const std::vector<DistanceResult> found = follow(walk);
      for (std::size_t k = 0; k < found.size(); ++k) {
        EXPECT_TRUE(same_bits(found[k], expected[k])) << walk.name << ", step " << k;
      }
    }
  });
}

// All bits of some results as one number: FNV-1a (Fowler, Noll, Vo 1991), by words of 64 bits.
class Fingerprint {
 public:
  void add(const DistanceResult& r) {
    for (const double value : {r.distance, r.lower, r.upper})
      add(std::bit_cast<std::uint64_t>(value));
    for (const Vec3& v : {r.normal, r.point_on_a, r.point_on_b}) {
      for (const double value : v) add(std::bit_cast<std::uint64_t>(value));
    }
    add(static_cast<std::uint64_t>(r.status));
    add(static_cast<std::uint64_t>(r.path));
    add(static_cast<std::uint64_t>(r.iterations));
  }
  void add(const ConvexBody& body) {
    for (const Facet& facet : body.facets) {
      for (const double value : facet.normal) add(std::bit_cast<std::uint64_t>(value));
      add(std::bit_cast<std::uint64_t>(facet.offset));
    }
    add(std::bit_cast<std::uint64_t>(body.position_error));
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  void add(std::uint64_t word) { value_ = (value_ ^ word) * 0x100000001b3ULL; }

  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

// Shapes and poses of sums, products and square roots alone, which are the same in every build. On
// a lattice, bodies rest on each other with parallel faces and edges, and corners meet edges.
class Drawn {
 public:
  Drawn(std::uint64_t seed, bool on_lattice) : random_(seed), on_lattice_(on_lattice) {}

  ConvexBody shape(int kind) {
    const double a = size(), b = size(), c = size();
    switch (kind) {
      case 0:
        return test::made(box({a, b, c}));
      case 1:
        return test::made(point({a, b, c}, 0.125));
      case 2:
        return test::made(segment({a, b, c}, {-b, c, a}, 0.0625));
      case 3:
        return test::made(ellipsoid({a, b, c}));
      case 4:
        return test::made(cylinder(a, b, 0.0));
      case 5:
        return test::made(truncated_cone(a, b, c));
      case 6:
        return test::half_space({a, -b, c}, 0.0);
      case 7:
        return test::made(polyhedron_from_halfspaces(
            std::vector<HalfSpace>{{{1, 0, 0}, a}, {{0, 0, -1}, b}, {{-1, c, 1}, c}}));
      default:
        break;
    }
    std::vector<Vec3> points;
    for (int i = 0; i < 5 * kind - 34; ++i) points.push_back(place(0.75));
    for (int i = 0; i < 4; ++i) points.push_back(Vec3::Unit(i % 3) * (i == 3 ? -a : b));
    return test::made(polyhedron_from_vertices(points));
  }

  Eigen::Quaterniond orientation() {
    const Vec3 v = random_.in_box(1.0);
    if (!on_lattice_) return Eigen::Quaterniond(1.5, v.x(), v.y(), v.z()).normalized();
    return v.x() < 0.0 ? Eigen::Quaterniond::Identity() : Eigen::Quaterniond(0.5, 0.5, 0.5, 0.5);
  }
  Vec3 place(double half) {
    const Vec3 found = random_.in_box(half);
    return on_lattice_ ? Vec3((found * 16.0).array().round() / 16.0) : found;
  }

 private:
  double size() {
    const double found = random_.uniform(0.125, 1.0);
    return on_lattice_ ? std::round(found * 8.0) / 8.0 : found;
  }

  Random random_;
  bool on_lattice_;
};

std::uint64_t fingerprint_of_walks(bool on_lattice) {
  constexpr int kShapes = 11, kSteps = 40;
  Drawn drawn(400, on_lattice);
  Fingerprint all;
  for (int pair = 0; pair < kShapes * kShapes; ++pair) {
    const ConvexBody a = drawn.shape(pair / kShapes), b = drawn.shape(pair % kShapes);
    TrackingState state;
    Pose pose;
    Vec3 step = drawn.place(0.125);
    for (int k = 0; k < kSteps; ++k) {
      if (k % 10 == 0) pose = {drawn.place(0.25), drawn.orientation()};
      if (k % 10 == 5) step = drawn.place(0.0625);
      pose.position += step;
      all.add(distance(a, b, Pose{}, pose, state));
    }
  }
  return all.value();
}

// Bodies overlap, at the origin and 1.4 km from it, and each query begins anew. A polyhedron
// encloses them, and another one encloses that.
std::uint64_t fingerprint_of_overlaps() {
  constexpr int kShapes = 11, kPlaces = 16;
  Drawn drawn(401, false);
  Fingerprint all;
  for (int pair = 0; pair < kShapes * kShapes; ++pair) {
    const ConvexBody a = drawn.shape(pair / kShapes), b = drawn.shape(pair % kShapes);
    for (int k = 0; k < kPlaces; ++k) {
      const Vec3 away = k % 2 == 0 ? Vec3(0, 0, 0) : Vec3(600, -800, 1000);
      const Pose at_a{away, drawn.orientation()};
      const Pose at_b{away + drawn.place(0.0625 * k), drawn.orientation()};
      TrackingState state;
      all.add(distance(a, b, at_a, at_b, state));
      if (k > 1) continue;
      const std::vector<PlacedShape> both = {{&a, at_a}, {&b, at_b}};
      const auto around = enclosing_polyhedron(both, {.facets = 12});
      if (!around) continue;
      all.add(*around);
      const std::vector<PlacedShape> again = {{&*around, at_b}};
      all.add(enclosing_polyhedron(again, {.facets = 8}).value());
    }
  }
  return all.value();
}

// Recorded by g++ 12 on x86-64: every compiler, level of optimisation and processor has to find the
// same.
TEST(Distance, HasTheSameBitsInEveryBuild) {
  EXPECT_EQ(fingerprint_of_walks(false), 5568175261542292506U);
  EXPECT_EQ(fingerprint_of_walks(true), 11566883438384784417U);
  EXPECT_EQ(fingerprint_of_overlaps(), 6559131133699548316U);
}

}  // namespace
}  // namespace clearance
