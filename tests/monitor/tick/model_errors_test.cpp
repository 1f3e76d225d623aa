// The stated errors of the model are part of every bound. The oracle is a machine whose bodies are
// displaced by errors within the stated ones, joint by joint, and fresh queries of its bodies.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "monitor/tick/monitor.hpp"
#include "tests/config/cells.hpp"
#include "tests/monitor/tick/fresh_distance.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/monitor/tick/true_bodies.hpp"
#include "tests/shared/places.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/repeats.hpp"

namespace clearance {
namespace {

using test::drawn_errors;
using test::DrawnErrors;
using test::fresh_distance;
using test::joint;
using test::kStart;
using test::kTick;
using test::ScratchFolder;
using test::true_poses;
using test::write_text;

// The oracle rounds poses that errors have displaced.
constexpr double kOracle = 1e-9;

// An arm on a table that holds a part; a vice that stands on the table; a cart with a robot; a
// sliding finger; a floor without end.
std::string workshop(const std::string& errors) {
  return "name: workshop\nunits: {length: mm, angle: deg}\n"
         "objects:\n"
         "  - {name: floor, fixed: true, half_space: {normal: [0, 0, 1], offset: -1500}}\n"
         "  - {name: table, fixed: true, box: {size: [1200, 800, 50]}, pose: {xyz: [300, 0, "
         "-400]}}\n"
         "  - {name: vice, box: {size: [100, 150, 120]}, attached: {to: table, pose: {xyz: [400, "
         "100, 85]}}}\n"
         "  - {name: cart, may_jump: true, box: {size: [600, 400, 200]}}\n"
         "  - {name: part, cylinder: {radius: 40, length: 150}, attached: {to: a_finger, pose: "
         "{xyz: "
         "[0, 0, -120]}}}\n"
         "robots:\n"
         "  - {name: a, urdf: scara.urdf, prefix: a_, base: {on: table, pose: {xyz: [-300, 0, "
         "600]}}}\n"
         "  - {name: b, urdf: scara.urdf, prefix: b_, base: {on: cart, pose: {xyz: [0, 0, 700]}}}\n"
         "pairs: [{between: [a, a]}, {between: [b, b]}, {between: [a, b]}, {between: [part, "
         "vice]}, "
         "{between: [a, vice]}, {between: [a, floor]}, {between: [b, floor]}, {between: [b, "
         "table]}, "
         "{between: [cart, vice]}, {between: [cart, floor]}, {between: [part, b]}, {between: "
         "[part, "
         "floor]}]\n" +
         errors;
}

const std::string kErrors =
    "errors:\n"
    "  joints: {position: 0.05, slide: 0.4, translation: 0.3, rotation: 0.02}\n"
    "  bases: {translation: 1, rotation: 0.1}\n"
    "  fixed: {translation: 2, rotation: 0.1}\n"
    "  poses: {translation: 3, rotation: 0.3}\n"
    "  attached: {translation: 1.5, rotation: 0.5}\n"
    "  except: [{object: floor, translation: 1, rotation: 0}, {joint: b_elbow, position: 0.5}]\n";

Scene workshop_scene(const std::string& errors) {
  const ScratchFolder folder;
  write_text(folder / "scara.urdf", test::kScaraUrdf);
  return scene_of(workshop(errors), folder / "cell.yaml");
}

std::string text_in(const std::string& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

Scene two_arms_with(const std::string& errors) {
  const std::string file = test::places::sources() + "/config/cells/seven_joint_arms.yaml";
  return scene_of(text_in(file) + errors, file);
}

// A cell whose joints and objects wander, and the machine behind it.
class Wandering {
 public:
  Wandering(const Scene& scene, std::uint64_t seed)
      : scene_(scene), random_(seed), monitor_(scene), sent_(scene.objects.size()) {
    for (const JointVariable& variable : scene.variables) {
      const double low = std::max(variable.lower, -3.0), high = std::min(variable.upper, 3.0);
      positions_.push_back(random_.uniform(low, high));
    }
    for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
      if (scene.objects[i].name == "cart") sent_[i] = random_.pose(1.2);
    }
  }

  const Report& tick() {
    now_ += kTick;
    std::vector<JointSample> joints;
    for (std::uint32_t v = 0; v < positions_.size(); ++v) {
      const JointVariable& of = scene_.variables[v];
      const double step = random_.uniform(-1e-3, 1e-3) * std::min(1.0, of.plausible_speed());
      positions_[v] = std::clamp(positions_[v] + step, of.lower, of.upper);
      joints.push_back(joint(v, positions_[v], now_));
    }
    std::vector<PoseSample> poses;
    for (std::uint32_t i = 0; i < scene_.objects.size(); ++i) {
      if (scene_.objects[i].name != "cart") continue;
      sent_[i].position += random_.in_box(1e-3);
      poses.push_back(test::sample(i, sent_[i], now_));
    }
    return monitor_.tick(poses, joints, now_);
  }

  [[nodiscard]] std::vector<Pose> truth(const DrawnErrors& errors) const {
    return true_poses(scene_, positions_, sent_, errors);
  }
  [[nodiscard]] Random& random() noexcept { return random_; }
  [[nodiscard]] const Monitor& monitor() const noexcept { return monitor_; }

 private:
  const Scene& scene_;
  Random random_;
  Monitor monitor_;
  std::vector<double> positions_;
  std::vector<Pose> sent_;
  std::int64_t now_ = kStart;
};

// How many true distances were compared with bounds.
std::size_t compare(const Scene& scene, std::uint64_t seed, int ticks, int machines) {
  Wandering cell(scene, seed);
  std::size_t compared = 0;
  for (int t = 0; t < ticks; ++t) {
    const Report& report = cell.tick();
    for (int m = 0; m < machines; ++m) {
      const std::vector<Pose> poses = cell.truth(drawn_errors(scene, cell.random()));
      double least = kInfinity;
      for (std::uint32_t p = 0; p < scene.pairs.size(); ++p) {
        const PairReport pair = cell.monitor().pair(p);
        if (!(pair.status < PairStatus::kUnknown)) {
          ADD_FAILURE() << "pair " << p << " is not known";
          return compared;
        }
        const auto [a, b] = std::pair(scene.pairs[p].first, scene.pairs[p].second);
        const auto truth = fresh_distance(scene.objects[a], poses[a], scene.objects[b], poses[b]);
        least = std::min(least, truth.upper);
        EXPECT_LE(pair.lower, truth.upper + kOracle)
            << scene.objects[a].name << " - " << scene.objects[b].name << ", seed " << seed;
        EXPECT_GE(pair.upper, truth.lower - kOracle)
            << scene.objects[a].name << " - " << scene.objects[b].name << ", seed " << seed;
        EXPECT_LE(pair.swept_lower, pair.lower);
        compared += 1;
        if (testing::Test::HasFailure()) return compared;
      }
      EXPECT_LE(report.lower_all, least + kOracle);
    }
  }
  return compared;
}

TEST(ModelErrors, NoMachineWithinTheStatedErrorsLeavesTheBounds) {
  const Scene scene = workshop_scene(kErrors);
  std::size_t compared = 0;
  for (std::uint64_t seed = 0; seed < repeats(40) && !HasFailure(); ++seed)
    compared += compare(scene, seed, 4, 10);
  RecordProperty("compared", static_cast<int>(compared));
  EXPECT_GE(compared, 4'000u);
}

TEST(ModelErrors, NoPairOfArmsWithinTheirErrorsLeavesTheBounds) {
  const Scene scene = two_arms_with(
      "errors:\n  joints: {position: 0.0002, translation: 0.0003, rotation: 0.0001}\n"
      "  bases: {translation: 0.001, rotation: 0.0005}\n  fixed: {translation: 0.001}\n");
  std::size_t compared = 0;
  for (std::uint64_t seed = 0; seed < repeats(8) && !HasFailure(); ++seed)
    compared += compare(scene, seed, 3, 4);
  EXPECT_GE(compared, 2'000u);
}

// The errors that bring two objects nearest: every single one is as large as it may be, against the
// gradient of their distance.
DrawnErrors worst_errors(const Scene& scene, const Wandering& cell, const ObjectPair& pair) {
  constexpr double kStep = 1e-6;
  Random none(0);
  DrawnErrors errors = drawn_errors(Scene(scene), none);
  for (auto& place : errors.bases) place = {};
  for (auto& place : errors.objects) place = {};
  for (auto& joints : errors.frames) std::ranges::fill(joints, DrawnErrors::Place{});
  for (auto& joints : errors.positions) std::ranges::fill(joints, 0.0);
  const DrawnErrors exact = errors;
  const auto distance_with = [&](const DrawnErrors& some) {
    const std::vector<Pose> poses = cell.truth(some);
    return fresh_distance(scene.objects[pair.first], poses[pair.first], scene.objects[pair.second],
                          poses[pair.second])
        .upper;
  };
  const auto slope = [&](DrawnErrors& some, double& number) {
    number = kStep;
    const double up = distance_with(some);
    number = -kStep;
    const double down = distance_with(some);
    number = 0.0;
    return (up - down) / (2.0 * kStep);
  };
  DrawnErrors probe = exact;
  const auto choose = [&](Vec3& at, Vec3& chosen, double most) {
    if (most == 0.0) return;
    Vec3 gradient;
    for (int i = 0; i < 3; ++i) gradient[i] = slope(probe, at[i]);
    if (gradient.norm() > 1e-9) chosen = -most * gradient.normalized();
  };
  const auto choose_place = [&](DrawnErrors::Place& at, DrawnErrors::Place& chosen,
                                const PlaceError& most) {
    choose(at.shift, chosen.shift, most.translation);
    choose(at.turn, chosen.turn, most.rotation);
  };
  for (std::size_t i = 0; i < scene.objects.size(); ++i)
    choose_place(probe.objects[i], errors.objects[i], scene.objects[i].place_error);
  for (std::size_t r = 0; r < scene.robots.size(); ++r) {
    choose_place(probe.bases[r], errors.bases[r], scene.robots[r].base_error);
    for (std::size_t j = 0; j < scene.robots[r].joints.size(); ++j) {
      const RobotJoint& joint = scene.robots[r].joints[j];
      choose_place(probe.frames[r][j], errors.frames[r][j], joint.error.frame);
      const double most =
          joint.type == JointType::kPrismatic ? joint.error.slide : joint.error.position;
      const double falls = slope(probe, probe.positions[r][j]);
      errors.positions[r][j] = falls > 0.0 ? -most : most;
    }
  }
  return errors;
}

// Of all pairs that are apart, in random postures: the model error that is reported, over the
// largest that a machine has.
std::vector<double> excesses(const Scene& scene, std::uint64_t seeds) {
  std::vector<double> ratios;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    Wandering cell(scene, seed);
    for (int t = 0; t < 2; ++t) cell.tick();
    for (std::uint32_t p = 0; p < scene.pairs.size(); ++p) {
      const PairReport pair = cell.monitor().pair(p);
      if (pair.status != PairStatus::kConverged || pair.distance < 0.005) continue;
      const std::vector<Pose> poses = cell.truth(worst_errors(scene, cell, scene.pairs[p]));
      const auto [a, b] = std::pair(scene.pairs[p].first, scene.pairs[p].second);
      const double truth =
          fresh_distance(scene.objects[a], poses[a], scene.objects[b], poses[b]).lower;
      EXPECT_LE(pair.lower, truth + kOracle)
          << scene.objects[a].name << " - " << scene.objects[b].name << ", seed " << seed;
      if (pair.distance - truth > 1e-6)
        ratios.push_back(pair.model_error / (pair.distance - truth));
    }
  }
  std::ranges::sort(ratios);
  return ratios;
}

TEST(ModelErrors, OfTwoArmsAreAtMostAFewPercentAboveTheWorstMachine) {
  Scene scene = two_arms_with("errors: {joints: {position: 0.0002, translation: 0.0003}}\n");
  scene.evaluate_all = true;
  const std::vector<double> ratios = excesses(scene, repeats(40));
  ASSERT_GT(ratios.size(), 500u);
  EXPECT_LT(ratios[ratios.size() / 2], 1.02);
  EXPECT_LT(ratios[ratios.size() * 99 / 100], 1.15);
}

// Two bodies that turn together about one place: the direction between them turns, too.
TEST(ModelErrors, BodiesThatTurnTogetherAreNeverNearerThanTheSweptBound) {
  const ScratchFolder folder;
  write_text(folder / "wrist.urdf",
             "<robot name=\"wrist\"><link name=\"foot\"/><link name=\"tool\"><collision><geometry>"
             "<sphere radius=\"0.2\"/></geometry></collision></link><joint name=\"turn\" "
             "type=\"continuous\"><origin xyz=\"10 0 0\"/><parent link=\"foot\"/><child "
             "link=\"tool\"/><axis xyz=\"0 0 1\"/><limit velocity=\"60\"/></joint></robot>");
  const double e = 1e-3, length = 10.0, radius = 0.2, step = 0.05;
  const Scene scene = scene_of(
      "name: wrist\nunits: {length: m, angle: rad}\nrobots: [{name: arm, urdf: wrist.urdf}]\n"
      "objects: [{name: cart, may_jump: true, sphere: {radius: 0.2, centre: [0.41, 0, 0]}}]\n"
      "pairs: [{between: [arm, cart], publish: true}]\nerrors: {bases: {rotation: 0.001}}\n",
      folder / "cell.yaml");
  Monitor monitor(scene);
  const auto cart = static_cast<std::uint32_t>(scene.objects[0].name == "cart" ? 0 : 1);
  std::int64_t now = kStart;
  const Report* report = nullptr;
  for (int tick = 6; tick >= 0; --tick) {
    now += kTick;
    const double angle = step * tick;
    const Pose pose{.position = Vec3(length, 0, 0),
                    .orientation = Eigen::Quaterniond(Eigen::AngleAxisd(angle, Vec3::UnitZ()))};
    report = &monitor.tick(std::vector{test::sample(cart, pose, now)},
                           std::vector{joint(0, angle, now)}, now);
  }
  // At the start of the tick, the base is turned so that the tool comes towards the cart.
  const Vec3 tool(length * std::cos(e), length * std::sin(e), 0.0);
  const Vec3 at(length + 0.41 * std::cos(step), 0.41 * std::sin(step), 0.0);
  EXPECT_LE(report->pairs[0].swept_lower, (at - tool).norm() - 2.0 * radius + 1e-12);
}

// A beam whose end beside the joint is the lower one, by less than the joint's error: the other end
// may be nearer to the floor.
TEST(ModelErrors, OfABodyThatIsNearlyParallelMayBringItsFarEndNearest) {
  const ScratchFolder folder;
  write_text(folder / "beam.urdf",
             "<robot name=\"beam\"><link name=\"foot\"/><link name=\"beam\"><collision><origin "
             "xyz=\"1 0 0\" rpy=\"0.5 0 0\"/><geometry><box size=\"2 0.1 0.1\"/></geometry>"
             "</collision></link><joint name=\"turn\" type=\"continuous\"><parent link=\"foot\"/>"
             "<child link=\"beam\"/><axis xyz=\"0 1 0\"/></joint></robot>");
  const double error = 0.01;
  const Scene scene = scene_of(
      "name: beam\nunits: {length: m, angle: rad}\nrobots: [{name: arm, urdf: beam.urdf}]\n"
      "objects: [{name: floor, fixed: true, half_space: {normal: [0, 0, 1], offset: -1}}]\n"
      "pairs: [{between: [arm, floor], publish: true}]\nerrors: {joints: {position: 0.01}}\n",
      folder / "cell.yaml");
  const double half = 0.05 * (std::cos(0.5) + std::sin(0.5));  // of the beam's height
  for (const double at : {-0.02, -0.008, -0.005, -0.002, 0.005}) {
    Monitor monitor(scene);
    for (int t = 0; t < 2; ++t)
      static_cast<void>(
          monitor.tick({}, std::vector{joint(0, at, kStart + t * kTick)}, kStart + t * kTick));
    const PairReport pair = monitor.pair(0);
    double truth = kInfinity;
    for (const double angle : {at - error, at + error}) {
      for (const double x : {0.0, 2.0})
        truth = std::min(truth, 1.0 - x * std::sin(angle) - half * std::cos(angle));
    }
    EXPECT_LE(pair.lower, truth + kOracle) << at;
    EXPECT_GT(pair.lower, truth - 0.003) << at;
  }
}

TEST(ModelErrors, WithoutAnyTheReportIsTheSame) {
  const Scene with = workshop_scene("errors: {joints: {position: 0}}\n"),
              without = workshop_scene("");
  Wandering one(with, 3), other(without, 3);
  for (int t = 0; t < 5; ++t) {
    const Report &a = one.tick(), &b = other.tick();
    EXPECT_EQ(a.lower_all, b.lower_all);
    EXPECT_EQ(a.minimum.upper, b.minimum.upper);
    EXPECT_EQ(b.minimum.model_error, 0.0);
  }
}

}  // namespace
}  // namespace clearance
