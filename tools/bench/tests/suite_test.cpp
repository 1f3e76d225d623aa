// The cases of `clearance-bench --suite` and its adapters. The distances of the cases follow from
// their construction; the oracles here work on the bodies and poses as given: exact rationals for
// polyhedra with radii, 50 digits for curved bodies.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <string>

#include "core/shapes.hpp"
#include "tests/shared/child_process.hpp"
#include "tests/shared/curved_oracle.hpp"
#include "tests/shared/exact_depth.hpp"
#include "tests/shared/exact_oracle.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/scratch_folder.hpp"
#include "tools/bench/suite/cases.hpp"
#include "tools/bench/suite/plain_body.hpp"
#include "tools/bench/suite/planar_faces.hpp"
#include "tools/bench/suite/race.hpp"
#include "tools/bench/suite/rivals.hpp"

namespace clearance::bench {
namespace {

constexpr double kOracleTolerance = 1e-17;  // m

oracle::CurvedBody curved(const ConvexBody& body) {
  oracle::CurvedBody out;
  for (const Vertex& v : body.vertices) out.points.push_back(v.position);
  out.shape = body.curved;
  out.radius = body.radius;
  return out;
}

oracle::Body hull(const ConvexBody& body) {
  oracle::Body out;
  for (const Vertex& v : body.vertices) out.points.push_back(v.position);
  return out;
}

void expect_exact(const SuiteCase& c, std::size_t k) {
  const auto& [pose_a, pose_b] = c.motion.poses[k];
  const ConvexBody &a = *c.motion.a, &b = *c.motion.b;
  const double said = c.exact[k];
  SCOPED_TRACE(c.kind + ", separation " + std::to_string(c.separation) + ", pose " +
               std::to_string(k));
  if (said >= 0.0 || a.radius + b.radius > 0.0) {
    const oracle::CurvedBody body_a = curved(a), body_b = curved(b);
    const oracle::RealBounds truth =
        oracle::curved_truth({&body_a, pose_a}, {&body_b, pose_b}, kOracleTolerance);
    // If the cores meet, the oracle knows only that the distance is at most minus the radii.
    if (static_cast<double>(truth.lower) > -1e300) {
      EXPECT_NEAR(said, static_cast<double>(truth.lower), kRoundedPoses);
      return;
    }
    EXPECT_LE(said, static_cast<double>(truth.upper) + kRoundedPoses);
  }
  // The exact depth tries all triples of vertices.
  if (a.vertices.size() != 8 || b.vertices.size() != 8) return;
  const auto squared = oracle::exact_squared_depth(hull(a), pose_a, hull(b), pose_b);
  ASSERT_TRUE(squared.has_value());
  EXPECT_NEAR(std::max(0.0, -said), std::sqrt(squared->get_d()), kRoundedPoses);
}

class SuiteCases : public testing::TestWithParam<std::string> {};

TEST_P(SuiteCases, HaveTheDistanceOfTheOracleAtTheFirstMiddleAndLastPose) {
  for (const SuiteCase& c : suite_cases(GetParam(), 2, 7)) {
    ASSERT_EQ(c.exact.size(), c.motion.poses.size());
    for (const std::size_t k : {0u, 3u, 6u}) expect_exact(c, k);
  }
}

// The depths of curved bodies in the table: the direction of the table's top proves that B comes
// free by that translation. No direction proves a shorter one, as the next test samples.
TEST(SuiteDepths, AreThoseAlongTheTopOfTheTable) {
  for (const SuiteCase& c : suite_cases("deep", 6, 3)) {
    const oracle::CurvedBody a = curved(*c.motion.a), b = curved(*c.motion.b);
    for (std::size_t k = 0; k < c.exact.size(); ++k) {
      const auto& [pose_a, pose_b] = c.motion.poses[k];
      const Vec3 up = pose_a.orientation * Vec3::UnitZ();
      const double along =
          static_cast<double>(oracle::apart_along({&a, pose_a}, {&b, pose_b}, up)) / up.norm();
      EXPECT_NEAR(c.exact[k], along, kRoundedPoses) << c.separation;
    }
  }
}

TEST(SuiteDepths, AreNotLessInAnySampledDirection) {
  Random random(11);
  for (const SuiteCase& c : suite_cases("deep", 6, 2)) {
    const oracle::CurvedBody a = curved(*c.motion.a), b = curved(*c.motion.b);
    const auto& [pose_a, pose_b] = c.motion.poses[0];
    for (int i = 0; i < 50; ++i) {
      const Vec3 n = random.direction();
      const double along =
          static_cast<double>(oracle::apart_along({&a, pose_a}, {&b, pose_b}, n)) / n.norm();
      EXPECT_LE(along, c.exact[0] + kRoundedPoses) << c.separation;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Of, SuiteCases, testing::ValuesIn(suite_kinds()), [](const auto& name) {
  std::string word = name.param;
  std::replace_if(
      word.begin(), word.end(), [](unsigned char c) { return !std::isalnum(c); }, '_');
  return word;
});

// ---- adapters

ConvexBody made(ShapeResult shape) { return std::get<ConvexBody>(std::move(shape)); }

struct Known {
  const char* what;
  ConvexBody a, b;
  double exact;  // m: B's origin is 3 m along z above A's, turned by a quarter about x
};

// Along z: A reaches 0.5 m up, and B 1 m down, because it is turned by a quarter about x.
std::vector<Known> known_cases() {
  const auto cube = [] { return made(box({1.5, 1.5, 0.5})); };
  const std::vector<Vec3> roof{{-0.5, -1.0, -0.5}, {0.5, -1.0, -0.5}, {0.0, -1.0, 0.5},
                               {-0.5, 1.0, -0.5},  {0.5, 1.0, -0.5},  {0.0, 1.0, 0.5}};
  std::vector<Known> all;
  all.push_back({"boxes", cube(), made(box({0.2, 1.0, 0.3})), 1.5});
  all.push_back({"hulls", cube(), made(polyhedron_from_vertices(roof)), 1.5});
  all.push_back({"spheres", made(point(Vec3::Zero(), 0.5)), made(point(Vec3::Zero(), 1.0)), 1.5});
  all.push_back({"capsule", cube(), made(segment({0, 0, -2.0}, {0, 0, 2.0}, 1.0)), 1.5});
  all.push_back({"cylinder", cube(), made(cylinder(1.0, 0.25)), 1.5});
  all.push_back({"ellipsoid", cube(), made(ellipsoid({0.3, 1.0, 0.5})), 1.5});
  all.push_back({"cone", cube(), made(cone(1.0, 0.6)), 1.5});
  return all;
}

Pose turned(double height) {
  const Eigen::AngleAxisd about_x(0.5 * std::numbers::pi, Vec3::UnitX());
  return {{0.0, 0.0, height}, Eigen::Quaterniond(about_x)};
}

TEST(SuiteRivals, IncludeClearanceAndWhatThisBuildFound) {
  const std::vector<Rival> rivals = all_rivals();
  ASSERT_FALSE(rivals.empty());
  EXPECT_EQ(rivals[0].name, "Clearance");
}

// Floats and default tolerances of 1e-4 pass; a mistaken axis, half length or frame does not.
TEST(SuiteRivals, AnswerKnownCasesTrackedAndCold) {
  constexpr double kTolerance = 2e-4;
  const std::vector<Known> cases = known_cases();
  for (const Rival& rival : all_rivals()) {
    int answered = 0;
    for (const Known& known : cases) {
      SCOPED_TRACE(rival.name + ": " + known.what);
      const PlainBody a = plain_body(known.a), b = plain_body(known.b);
      const auto pair = rival.pair(a, b);
      if (!pair) continue;
      ++answered;
      for (const double height : {3.0, 3.0, 3.5}) {
        const double said = pair->distance(plain_pose({}), plain_pose(turned(height)));
        const double exact = known.exact + height - 3.0;
        // Libraries that only say yes or no answer with infinity.
        EXPECT_TRUE(said == kInfinity || std::abs(said - exact) < kTolerance) << said;
      }
      pair->forget();
      if (!rival.has_depth) continue;
      const double said = pair->distance(plain_pose({}), plain_pose(turned(1.4)));
      EXPECT_NEAR(said, -0.1, 0.01);
    }
    EXPECT_GE(answered, 2) << rival.name;
  }
}

TEST(SuiteJudge, CountsMissingAndWrongAnswersAsFailures) {
  const double nan = std::nan("");
  EXPECT_TRUE(judge(nan, 1.0, 1.0, true).failed);
  EXPECT_TRUE(judge(1.1, 1.0, 1.0, true).failed);
  EXPECT_FALSE(judge(1.0 + 1e-7, 1.0, 1.0, true).failed);
  EXPECT_DOUBLE_EQ(judge(0.75, 1.0, 1.0, true).error, 0.25);
  EXPECT_TRUE(judge(-0.1, 0.0, 1.0, true).failed);
  EXPECT_FALSE(judge(-0.1, 0.0, 1.0, false).failed) << "it knows no depth, and they touch";
  EXPECT_FALSE(judge(kInfinity, 1.0, 1.0, true).failed) << "disjoint is right, and all it says";
  EXPECT_TRUE(judge(kInfinity, -0.1, 1.0, true).failed);
}

TEST(SuitePlanarFaces, MergeHalvesOfQuadrilateralsAndKeepTheirSense) {
  const std::vector<Numbers3> points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}};
  const std::vector<std::vector<int>> faces{{0, 2, 1}, {0, 3, 2}, {0, 1, 4},
                                            {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  std::vector<std::vector<int>> merged = planar_faces(points, faces);
  ASSERT_EQ(merged.size(), 5u);
  const auto quad = std::ranges::find(merged, 4u, &std::vector<int>::size);
  ASSERT_NE(quad, merged.end());
  std::ranges::rotate(*quad, std::ranges::find(*quad, 0));
  EXPECT_EQ(*quad, (std::vector<int>{0, 3, 2, 1}));
}

// ---- the program

TEST(SuiteProgram, WritesTableFiguresAndPicture) {
  const test::ScratchFolder folder;
  test::ChildProcess bench(CLEARANCE_BENCH_BIN "/clearance-bench",
                           {"--suite", "--out", (folder / "out").string(), "--class", "boxes",
                            "--class", "deep", "--passes", "1", "--motions", "2", "--steps", "3"});
  ASSERT_EQ(bench.wait(), 0) << bench.output();
  const std::string page = test::read_text(folder / "out" / "suite.md");
  EXPECT_THAT(page, testing::ContainsRegex("[|] boxes [|] Clearance [|] [0-9]+ / [0-9]+ [|] 1.00"));
  EXPECT_THAT(page, testing::ContainsRegex("[|] deep [|] Clearance .* 0 of"));
  const std::string csv = test::read_text(folder / "out" / "suite.csv");
  EXPECT_THAT(csv, testing::HasSubstr("\n\"boxes\",1e-06,\"Clearance\",cold,"));
  EXPECT_THAT(test::read_text(folder / "out" / "suite.svg"), testing::HasSubstr("</svg>"));
}

TEST(SuiteProgram, RefusesWhatItDoesNotKnow) {
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"--suite", "--class", "teapots"},
        {"--suite", "--rival", "solid_9"},
        {"--suite", "--steps", "1"},
        {"--suite", "--faster"}}) {
    test::ChildProcess bench(CLEARANCE_BENCH_BIN "/clearance-bench", words);
    EXPECT_EQ(bench.wait(), 2) << words.back() << "\n" << bench.output();
  }
}

}  // namespace
}  // namespace clearance::bench
