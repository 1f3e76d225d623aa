// Gradients of distances with respect to joint positions. Oracles: closed forms for an arm of two
// links and spheres; central differences of the monitor's own distances for joints of every type.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "monitor/interface/gradient_rows.hpp"
#include "monitor/tick/monitor.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/shared/allocation_count.hpp"
#include "tests/shared/random.hpp"

namespace clearance {
namespace {

using test::joint;
using test::joints;
using test::kStart;
using test::kTick;
using test::ScratchFolder;
using test::write_text;
using testing::ElementsAre;
using testing::IsEmpty;

// A SCARA robot with the cart among its pairs. Objects: wall, cart, foot, upper, lower, finger.
Scene scara_and_cart() {
  const ScratchFolder folder;
  write_text(folder / "scara.urdf", test::kScaraUrdf);
  return scene_of(
      "name: test\nunits: {length: m, angle: rad}\ngradients: true\n"
      "robots: [{name: arm, urdf: scara.urdf}]\n"
      "objects:\n"
      "  - {name: wall, fixed: true, half_space: {normal: [-1, 0, 0], offset: -5}}\n"
      "  - {name: cart, may_jump: true, sphere: {radius: 0.1}}\n"
      "pairs:\n"
      "  - between: [arm, wall]\n"
      "  - between: [cart, wall]\n"
      "  - between: [cart, arm]\n"
      "  - between: [arm, arm]\n",
      folder / "cell.yaml");
}

PoseSample cart_at(const Vec3& position, const Vec3& velocity, std::int64_t now) {
  PoseSample sample;
  sample.object = 1;
  sample.stamp_ns = now;
  sample.world_from_object.position = position;
  sample.twist.linear = velocity;
  sample.has_twist = true;
  return sample;
}

struct Row {
  std::vector<std::string> joints;
  std::vector<double> rates;
  double drift = 0.0;
};

// The gradient of the pair between these objects. The row has no joints if the pair has no
// gradient.
Row row_between(const Scene& scene, const Report& report, const std::string& a,
                const std::string& b) {
  const GradientRows rows = gradient_rows(scene);
  for (std::size_t r = 0; r < rows.rows.size(); ++r) {
    const ObjectPair& pair = scene.pairs[report.pairs[rows.rows[r].published].pair];
    const std::string &first = scene.objects[pair.first].name,
                      &second = scene.objects[pair.second].name;
    if (!((first == a && second == b) || (first == b && second == a))) continue;
    Row row{.joints = {}, .rates = {}, .drift = report.gradients.drifts[r]};
    for (std::uint32_t e = rows.rows[r].first; e < rows.rows[r].end; ++e) {
      row.joints.push_back(scene.variables[rows.variables[e]].name);
      row.rates.push_back(report.gradients.rates[e]);
    }
    return row;
  }
  return {};
}

// This also holds if the spheres overlap: the gradient is then that of the depth, along the normal.
TEST(Gradients, OfTwoLinksAndSpheresAreTheClosedForm) {
  const Scene cell = scara_and_cart();
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    const double a = random.uniform(-3.0, 3.0), b = random.uniform(-3.0, 3.0),
                 s = random.uniform(0.0, 0.2);
    const Vec3 tip(std::cos(a) + (1.0 + s) * std::cos(a + b),
                   std::sin(a) + (1.0 + s) * std::sin(a + b), 0.0);
    const Vec3 offset = random.direction() * (i % 4 == 0 ? 0.1 : random.uniform(0.3, 2.0));
    const Vec3 cart_velocity = random.in_box(1.0), u = offset.normalized();
    const std::array rates{random.uniform(-2.0, 2.0), random.uniform(-2.0, 2.0),
                           random.uniform(-0.4, 0.4)};
    auto samples = joints(a, b, s, kStart);
    for (std::size_t k = 0; k < 3; ++k) {
      samples[k].velocity = rates[k];
      samples[k].has_velocity = true;
    }
    Monitor monitor(cell);
    const Report& report =
        monitor.tick(std::array{cart_at(tip + offset, cart_velocity, kStart)}, samples, kStart);
    const Row row = row_between(cell, report, "cart", "finger");
    // The tip moves with all joints: both angles rotate it, and the finger's slide extends it.
    const Vec3 by_elbow((1.0 + s) * -std::sin(a + b), (1.0 + s) * std::cos(a + b), 0.0);
    const Vec3 by_shoulder = by_elbow + Vec3(-std::sin(a), std::cos(a), 0.0);
    const Vec3 by_push(std::cos(a + b), std::sin(a + b), 0.0);
    ASSERT_THAT(row.joints, ElementsAre("shoulder", "elbow", "push"));
    EXPECT_NEAR(row.rates[0], -u.dot(by_shoulder), 1e-12);
    EXPECT_NEAR(row.rates[1], -u.dot(by_elbow), 1e-12);
    EXPECT_NEAR(row.rates[2], -u.dot(by_push), 1e-12);
    EXPECT_NEAR(row.drift, u.dot(cart_velocity), 1e-12);
  }
}

TEST(Gradients, NameTheJointsBetweenTheTwoObjectsOnly) {
  const Scene cell = scara_and_cart();
  Monitor monitor(cell);
  const Report& report = monitor.tick(std::array{cart_at({3.0, 1.0, 0.0}, Vec3::Zero(), kStart)},
                                      joints(0.3, 0.4, 0.1, kStart), kStart);
  EXPECT_THAT(row_between(cell, report, "finger", "upper").joints, ElementsAre("elbow", "push"));
  EXPECT_THAT(row_between(cell, report, "upper", "wall").joints, ElementsAre("shoulder"));
  EXPECT_THAT(row_between(cell, report, "cart", "wall").joints, IsEmpty());
  EXPECT_THAT(row_between(cell, report, "cart", "foot").joints, IsEmpty());
}

TEST(Gradients, AreNotKnownWhereThePairIsLateOrUnknown) {
  const Scene cell = scara_and_cart();
  Monitor monitor(cell);
  const std::array without_push{joint(0, 0.1, kStart), joint(1, 0.2, kStart)};
  const Report& report = monitor.tick(std::array{cart_at({3.0, 1.0, 0.0}, Vec3::Zero(), kStart)},
                                      without_push, kStart);
  EXPECT_TRUE(std::isnan(row_between(cell, report, "cart", "finger").rates[0]));
  const Row known = row_between(cell, report, "cart", "lower");
  EXPECT_TRUE(std::isfinite(known.rates[0]) && std::isfinite(known.rates[1]));
  EXPECT_TRUE(std::isnan(known.drift)) << "nothing was said of the joints' velocities";
  monitor.tick({}, {}, kStart + 100 * kTick);
  const Row late = row_between(cell, report, "cart", "lower");
  EXPECT_TRUE(std::isnan(late.rates[0]) && std::isnan(late.rates[1]) && std::isnan(late.drift));
}

// A finger without end overlaps the wall in each direction.
TEST(Gradients, AreNotKnownWhereNoTranslationSeparatesTheTwo) {
  Scene cell = scara_and_cart();
  cell.objects[5].parts = {test::floor()};
  Monitor monitor(cell);
  const Report& report = monitor.tick({}, joints(0.3, 0.4, 0.1, kStart), kStart);
  const Row row = row_between(cell, report, "finger", "wall");
  ASSERT_EQ(row.rates.size(), 3u);
  for (const double rate : row.rates) EXPECT_TRUE(std::isnan(rate));
  EXPECT_TRUE(std::isfinite(row_between(cell, report, "lower", "wall").rates[0]));
}

TEST(Gradients, AreNotComputedUnlessTheSceneAsks) {
  Scene cell = scara_and_cart();
  cell.gradients = false;
  Monitor monitor(cell);
  const Report& report = monitor.tick({}, joints(0.3, 0.4, 0.1, kStart), kStart);
  EXPECT_THAT(report.gradients.rates, IsEmpty());
  EXPECT_THAT(report.gradients.drifts, IsEmpty());
}

TEST(Gradients, CostATickNoAllocationAndAreTheSameBitsAgain) {
  const Scene cell = scara_and_cart();
  Monitor monitor(cell), again(cell);
  for (int tick = 0; tick < 50; ++tick) {
    const std::int64_t now = kStart + tick * kTick;
    const std::array cart{cart_at({2.0, 0.01 * tick, 0.3}, {0.0, 10.0, 0.0}, now)};
    const auto samples = joints(0.001 * tick, -0.001 * tick, 0.1, now);
    const std::uint64_t before = allocations();
    const Report& report = monitor.tick(cart, samples, now);
    EXPECT_EQ(allocations(), before);
    const Report& other = again.tick(cart, samples, now);
    if (tick > 1) {
      EXPECT_EQ(report.gradients.rates, other.gradients.rates);
    }
  }
}

// All types of joints, mimic joints, and robots on a moving object and on another robot's link.
const char* const kEveryJoint = R"(<robot name="every">
  <link name="stand"/>
  <link name="platform"><collision><geometry><box size="0.3 0.2 0.1"/></geometry></collision></link>
  <link name="boom"><collision><origin xyz="0.3 0 0"/><geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="stick"><collision><origin xyz="0.1 0 0"/><geometry><cylinder radius="0.05" length="0.2"/></geometry></collision></link>
  <link name="wrist"><collision><origin xyz="0 0.1 0"/><geometry><sphere radius="0.06"/></geometry></collision></link>
  <link name="pod"><collision><geometry><box size="0.1 0.15 0.2"/></geometry></collision></link>
  <joint name="drive" type="planar"><origin xyz="0 0 0.2" rpy="0.1 0.2 0.3"/><parent link="stand"/><child link="platform"/><axis xyz="0 0 1"/></joint>
  <joint name="lift" type="revolute"><origin xyz="0.1 0 0.2" rpy="0.3 0 0"/><parent link="platform"/><child link="boom"/><axis xyz="0 1 0.2"/><limit lower="-3" upper="3" velocity="2"/></joint>
  <joint name="extend" type="prismatic"><origin xyz="0.5 0 0"/><parent link="boom"/><child link="stick"/><axis xyz="1 0.1 0"/><limit lower="-1" upper="1" velocity="0.5"/></joint>
  <joint name="follow" type="revolute"><origin xyz="0.3 0 0"/><parent link="stick"/><child link="wrist"/><axis xyz="0 0 1"/><limit lower="-9" upper="9" velocity="2"/><mimic joint="lift" multiplier="-1.5" offset="0.2"/></joint>
  <joint name="free" type="floating"><origin xyz="0 0 1"/><parent link="stand"/><child link="pod"/></joint>
</robot>
)";

const char* const kEveryCell = R"(name: test
units: {length: m, angle: rad}
gradients: true
objects:
  - {name: wall, fixed: true, box: {size: [0.2, 3, 3]}, pose: {xyz: [4, 0, 1]}}
  - {name: cart, may_jump: true, sphere: {radius: 0.1}}
robots:
  - {name: first, urdf: every.urdf, prefix: a_}
  - {name: second, urdf: every.urdf, prefix: b_, base: {on: cart, pose: {xyz: [0, 0.2, 0.3], rpy: [0.2, 0, 0]}}}
  - {name: third, urdf: every.urdf, prefix: c_, base: {on: a_stick, pose: {xyz: [0, 0, 0.4]}}}
pairs:
  - between: [first, wall]
  - between: [cart, wall]
  - between: [first, second]
  - between: [first, third]
  - between: [second, third]
  - between: [first, first]
)";

std::vector<double> random_positions(Random& random, const Scene& scene) {
  std::vector<double> positions(scene.variables.size());
  for (double& position : positions) position = random.uniform(-0.9, 0.9);
  for (const Robot& robot : scene.robots) {
    for (const RobotJoint& joint : robot.joints) {
      if (joint.type != JointType::kFloating) continue;
      const Eigen::Quaterniond turn = random.rotation();
      for (int k = 0; k < 4; ++k) positions[joint.variable + 3 + k] = turn.coeffs()[k];
    }
  }
  return positions;
}

// Evaluates all published pairs with a new monitor.
const Report& tick_at(const std::vector<double>& positions, const Vec3& cart, Monitor& monitor) {
  std::vector<JointSample> samples;
  for (std::uint32_t i = 0; i < positions.size(); ++i) {
    samples.push_back(joint(i, positions[i], kStart));
  }
  return monitor.tick(std::array{cart_at(cart, Vec3::Zero(), kStart)}, samples, kStart);
}

// If the one-sided slopes differ, the closest feature or part changes in between, and no gradient
// is expected. If they differ much, the report must say that a second pair of points is near.
TEST(Gradients, AreTheCentralDifferencesOfOurDistancesForJointsOfEveryType) {
  const ScratchFolder folder;
  write_text(folder / "every.urdf", kEveryJoint);
  const Scene cell = scene_of(kEveryCell, folder / "cell.yaml");
  const GradientRows rows = gradient_rows(cell);
  constexpr double kStep = 1e-5;
  Random random(11);
  int compared = 0, kinks = 0, overlaps = 0;
  for (int round = 0; round < 6; ++round) {
    const std::vector<double> positions = random_positions(random, cell);
    const Vec3 cart = random.in_box(1.5);
    Monitor monitor(cell);
    const Report& here = tick_at(positions, cart, monitor);
    std::vector<std::vector<double>> numeric(cell.variables.size());  // by variable and pair
    std::vector<std::vector<bool>> smooth(cell.variables.size()), kinked(cell.variables.size());
    for (std::size_t v = 0; v < positions.size(); ++v) {
      std::vector<double> moved = positions;
      moved[v] += kStep;
      Monitor up(cell), down(cell);
      const Report& above = tick_at(moved, cart, up);
      moved[v] = positions[v] - kStep;
      const Report& below = tick_at(moved, cart, down);
      for (std::size_t p = 0; p < here.pairs.size(); ++p) {
        const double at = here.pairs[p].distance;
        const double rise = above.pairs[p].distance - at, fall = at - below.pairs[p].distance;
        numeric[v].push_back((rise + fall) / (2.0 * kStep));
        smooth[v].push_back(std::abs(rise - fall) < 30.0 * kStep * kStep);
        kinked[v].push_back(std::abs(rise - fall) > 0.05 * kStep);
      }
    }
    for (std::size_t r = 0; r < rows.rows.size(); ++r) {
      const GradientRow& row = rows.rows[r];
      const GradientAlternative& second = here.gradients.alternatives[r];
      const bool is_near = second.farther < 20.0 * kStep || second.tilt < 20.0 * kStep;
      overlaps += here.pairs[row.published].status == PairStatus::kOverlapping;
      std::vector<double> rates(cell.variables.size(), 0.0);
      for (std::uint32_t e = row.first; e < row.end; ++e) {
        rates[rows.variables[e]] = here.gradients.rates[e];
      }
      // Joints that are not in the row change nothing, and are therefore included.
      for (std::size_t v = 0; v < rates.size(); ++v) {
        if (!smooth[v][row.published]) {
          ++kinks;
          EXPECT_TRUE(!kinked[v][row.published] || is_near ||
                      second.status == GradientStatus::kPartsCompared)
              << cell.variables[v].name << ", round " << round;
          continue;
        }
        ++compared;
        const ObjectPair& pair = cell.pairs[here.pairs[row.published].pair];
        EXPECT_NEAR(rates[v], numeric[v][row.published], 1e-6)
            << cell.objects[pair.first].name << " - " << cell.objects[pair.second].name << " by "
            << cell.variables[v].name << ", round " << round;
      }
    }
  }
  EXPECT_GT(compared, 5000);
  EXPECT_LT(kinks, compared / 50);
  EXPECT_GT(overlaps, 0);
}

}  // namespace
}  // namespace clearance
