// Stops of robots beside others: with stops of other times, carried, not known, absent, in contact.
// Oracles: closed forms for fingers that circle about the axes of two robots 5 m apart, at 2 m.
#include <cmath>
#include <string>
#include <vector>

#include "tests/monitor/ask/stopping_scara.hpp"
#include "tests/shared/allocation_count.hpp"

namespace clearance {
namespace {

using test::kStopTolerance;

constexpr double kFacing = 0.9;  // m: the distance of the fingers where both joints are at 0

std::string stopping(const std::string& reaction_ms, const std::string& time_ms,
                     const std::string& more = "") {
  return ", stopping: {reaction_ms: " + reaction_ms + ", path: kept, time_ms: " + time_ms + more +
         "}";
}
std::string robot(const std::string& name, const std::string& more) {
  return "  - {name: " + name + ", urdf: scara.urdf, prefix: " + name +
         "_, age_limit_ms: 20, joints: {elbow: {velocity: 2}}" + more + "}\n";
}
const std::string kOpposite = ", base: {pose: {xyz: [5, 0, 0], rpy: [0, 0, 3.141592653589793]}}";

Scene cell(const std::string& robots, const std::string& objects, const std::string& pairs) {
  const test::ScratchFolder folder;
  test::write_text(folder / "scara.urdf", test::finger_urdf());
  return scene_of(
      "name: test\nunits: {length: m, angle: rad}\nrate_hz: 1000\nros2: {world_frame: "
      "map}\nrobots:\n" +
          robots +
          "objects:\n  - {name: ball, fixed: true, sphere: {radius: 0.1}, pose: {xyz: "
          "[0, 9, 0]}}\n" +
          objects + "pairs:\n" + pairs,
      folder / "cell.yaml");
}
std::string pair_of(const std::string& a, const std::string& b) {
  return "  - {between: [" + a + ", " + b + "]}\n";
}

// Joints stand at 0, but for one shoulder. Robots that `silent` names say nothing.
std::vector<JointSample> said(const Scene& scene, std::int64_t now, const std::string& moving = "",
                              double at = 0.0, double velocity = 0.0,
                              const std::string& silent = "-") {
  std::vector<JointSample> samples;
  for (std::uint32_t v = 0; v < scene.variables.size(); ++v) {
    const std::string& name = scene.variables[v].name;
    if (name.starts_with(silent)) continue;
    const bool moves = name == moving + "_shoulder";
    samples.push_back(test::joint(v, moves ? at : 0.0, now));
    samples.back().has_velocity = true;
    samples.back().velocity = moves ? velocity : 0.0;
  }
  return samples;
}

const RobotStop& stop_of(const Scene& scene, const Report& report, const std::string& name) {
  const auto found = std::ranges::find_if(
      report.stops, [&](const RobotStop& stop) { return scene.robots[stop.robot].name == name; });
  static const RobotStop kNone;
  EXPECT_NE(found, report.stops.end()) << name;
  return found == report.stops.end() ? kNone : *found;
}
double stop_lower(const Scene& scene, const Report& report, const std::string& a,
                  const std::string& b) {
  for (const PairReport& pair : report.pairs) {
    const std::string& first = scene.objects[scene.pairs[pair.pair].first].name;
    const std::string& second = scene.objects[scene.pairs[pair.pair].second].name;
    if ((first == a && second == b) || (first == b && second == a)) return pair.stop_lower;
  }
  ADD_FAILURE() << a << ", " << b;
  return -kInfinity;
}

// The slow robot needs half a second to where the fingers face each other, and stops beyond that.
// The quick one stands after 31 ms. The zone's margin is a little less than that distance.
TEST(SeveralStops, OfTwoTimesHoldUntilBothStandWhicheverIsFirst) {
  const double margin = 0.85;
  const std::string zone =
      "zones:\n  - {name: near, between: [quick, slow], stops: {margin: 0.85}}\n";
  for (const bool curves : {false, true}) {
    const std::string quick = robot("quick", stopping("10", "20"));
    const std::string slow = robot(
        "slow", kOpposite + stopping("40", "1000",
                                     curves ? ", joints: {shoulder: {acceleration: 0.25}}" : ""));
    // An absent robot, which sends no joints, takes nothing from the bounds of others.
    const std::string away = robot("away", ", absent: true" + stopping("40", "100"));
    std::vector<double> found;
    for (const std::string& robots : {quick + slow + away, slow + quick + away}) {
      const Scene scene = cell(
          robots, "",
          pair_of("quick", "slow") + pair_of("quick", "ball") + pair_of("away", "ball") + zone);
      Monitor monitor(scene);
      const Report& report =
          monitor.tick({}, said(scene, test::kStart, "slow", -0.5, 1.0, "away"), test::kStart);
      found.push_back(stop_lower(scene, report, "quick_finger", "slow_finger"));
      EXPECT_LE(found.back(), kFacing + 1e-6);
      for (const char* const name : {"quick", "slow"}) {
        const RobotStop& stop = stop_of(scene, report, name);
        EXPECT_LE(stop.clearance, kFacing - margin + 1e-6) << name;
        if (!curves) {
          EXPECT_GE(stop.clearance, kFacing - margin - 2.0 * kStopTolerance) << name;
          EXPECT_EQ(stop.scaling, 1.0) << name;
        }
      }
    }
    EXPECT_NEAR(found.at(0), found.at(1), kStopTolerance);
  }
}

// Within a second, the other robot may swing to where its part faces the finger.
TEST(SeveralStops, CountTheMotionOfWhatCarriesAPartOrATool) {
  const std::string robots =
      robot("own", stopping("500", "1000")) + robot("other", kOpposite) +
      "  - {name: tool, urdf: scara.urdf, prefix: tool_, joints: {elbow: {velocity: 2}}, attached: "
      "{to: other_upper, pose: {xyz: [1, 0, 0]}}}\n";
  const std::string part =
      "  - {name: part, attached: {to: other_finger}, sphere: {radius: 0.08}}\n";
  const std::string others =
      pair_of("other", "ball") + pair_of("tool", "ball") + pair_of("part", "ball");
  for (const std::string carried : {"part", "tool_finger"}) {
    const Scene scene = cell(robots, part, pair_of("own", carried) + others);
    Monitor monitor(scene);
    const Report& report =
        monitor.tick({}, said(scene, test::kStart, "other", -0.5, 0.0), test::kStart);
    EXPECT_LE(stop_lower(scene, report, "own_finger", carried), kFacing + 1e-6) << carried;
    EXPECT_LE(stop_of(scene, report, "own").clearance, kFacing + 1e-6) << carried;
  }
}

// A person walks for as long as the arm needs that carries the tool, and not only for the tool's.
TEST(SeveralStops, OfAToolAndItsCarrierHoldForTheLongerTime) {
  const std::string robots = robot("arm", stopping("40", "1000")) +
                             robot("tool", ", attached: {to: arm_finger}" + stopping("40", "20"));
  const Scene scene =
      cell(robots, "  - {name: person, max_speed: 1.6, sphere: {radius: 0.3}}\n",
           pair_of("arm", "person") + pair_of("tool", "person") + pair_of("arm", "ball"));
  Monitor monitor(scene);
  std::uint32_t person = 0;
  while (scene.objects.at(person).name != "person") ++person;
  const std::vector<PoseSample> there{test::sample(person, test::at(12, 0, 0), test::kStart)};
  const Report& report = monitor.tick(there, said(scene, test::kStart), test::kStart);
  const double now = 12.0 - 4.0 - 0.35;
  EXPECT_LE(stop_lower(scene, report, "tool_finger", "person"), now - 1.6 * 0.041 + 1e-6);
  EXPECT_LE(stop_lower(scene, report, "tool_finger", "person"),
            stop_lower(scene, report, "arm_finger", "person") + 1e-6)
      << "it reaches farther, on the same arm";
}

// A joint of the tool, of the other arm, or the cart below the arm was never heard.
TEST(SeveralStops, AreNotKnownWhileWhatMovesAPairWasNeverHeard) {
  const std::string own = robot("own", stopping("40", "100"));
  const std::string tool = robot("tool", ", attached: {to: own_finger}");
  const std::string other = robot("other", kOpposite);
  const std::string on_cart = robot("own", ", base: {on: cart}" + stopping("40", "100"));
  const std::string cart = "  - {name: cart, max_speed: 1, sphere: {radius: 0.1}}\n";
  const std::vector<Scene> scenes = {
      cell(own + tool, "", pair_of("own", "ball") + pair_of("tool", "ball")),
      cell(own + other, "", pair_of("own", "ball") + pair_of("own", "other")),
      cell(on_cart, cart, pair_of("own", "ball") + pair_of("cart", "ball"))};
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    Monitor monitor(scenes[i]);
    const Report& report = monitor.tick(
        {}, said(scenes[i], test::kStart, "", 0.0, 0.0, i == 0 ? "tool" : "other"), test::kStart);
    const RobotStop& stop = stop_of(scenes[i], report, "own");
    EXPECT_EQ(stop.validity, SeparationValidity::kUnknown) << i;
    EXPECT_EQ(stop.scaling, 0.0) << i;
    EXPECT_EQ(stop.clearance, -kInfinity) << i;
  }
}

// Both positions of a shoulder cannot be true.
TEST(SeveralStops, AreNotKnownWhileAnotherRobotContradictsItself) {
  const Scene scene = cell(robot("own", stopping("40", "100")) + robot("other", kOpposite), "",
                           pair_of("own", "other") + pair_of("own", "ball"));
  Monitor monitor(scene);
  std::int64_t now = test::kStart;
  for (int ms = 0; ms < 20; ++ms, now += test::kTick) {
    const Report& report = monitor.tick({}, said(scene, now, "other", -0.5, 0.0), now);
    EXPECT_EQ(report.stops.at(0).validity, SeparationValidity::kMeasured) << ms;
  }
  const Report& report = monitor.tick({}, said(scene, now, "other", 2.0, 0.0), now);
  EXPECT_EQ(report.stops.at(0).validity, SeparationValidity::kUnknown);
  EXPECT_EQ(report.stops.at(0).scaling, 0.0);
  EXPECT_EQ(stop_lower(scene, report, "own_finger", "other_finger"), -kInfinity);
}

// The pedestal of an arm on tf drives on while the arm stops: no stop of the arm bounds that.
TEST(SeveralStops, HaveNoBoundForWhatTheirJointsDoNotMove) {
  const std::string on_tf = ", base: {frame: odom, max_speed: 1, max_turn_speed: 1}";
  const Scene scene =
      cell(robot("own", on_tf + stopping("40", "100")) + robot("other", kOpposite),
           "  - {name: pedestal, attached: {to: own_foot}, sphere: {radius: 0.1}}\n",
           pair_of("pedestal", "ball") + pair_of("own", "ball") + pair_of("own", "other"));
  Monitor monitor(scene);
  std::vector<JointSample> samples = said(scene, test::kStart);
  for (JointSample& sample : samples)
    if (scene.variables[sample.variable].name.ends_with("rot_w")) sample.position = 1.0;
  const Report& report = monitor.tick({}, samples, test::kStart);
  EXPECT_TRUE(std::isnan(stop_lower(scene, report, "pedestal", "ball")));
  EXPECT_LT(stop_lower(scene, report, "own_finger", "ball"), std::hypot(9.0, 2.0) - 0.15 - 0.14);
  EXPECT_EQ(stop_of(scene, report, "own").validity, SeparationValidity::kMeasured);
}

// The base of the absent robot on tf was never heard.
TEST(SeveralStops, AreKnownBesideAnAbsentRobotOnTf) {
  const Scene scene = cell(
      robot("own", stopping("40", "100")) + robot("other", kOpposite) +
          robot("away", ", absent: true, base: {frame: odom, max_speed: 1, max_turn_speed: 1}"),
      "", pair_of("own", "ball") + pair_of("own", "other") + pair_of("own", "away"));
  Monitor monitor(scene);
  const std::vector<JointSample> samples = said(scene, test::kStart, "own", 0.3, 1.0, "away");
  const std::uint64_t before = allocations();
  const Report& report = monitor.tick({}, samples, test::kStart);
  EXPECT_EQ(allocations(), before) << "the first search finds its room";
  EXPECT_EQ(stop_of(scene, report, "own").validity, SeparationValidity::kMeasured);
  EXPECT_GT(stop_lower(scene, report, "own_finger", "other_finger"), 0.0);
}

TEST(SeveralStops, OfAnAbsentRobotLimitNothing) {
  const Scene scene = cell(robot("own", stopping("40", "100")) +
                               robot("away", ", absent: true" + kOpposite + stopping("40", "100")),
                           "", pair_of("own", "ball") + pair_of("own", "away"));
  Monitor monitor(scene);
  const Report& report =
      monitor.tick({}, said(scene, test::kStart, "", 0.0, 0.0, "away"), test::kStart);
  const RobotStop& away = stop_of(scene, report, "away");
  EXPECT_EQ(away.validity, SeparationValidity::kAbsent);
  EXPECT_EQ(away.scaling, 1.0);
  EXPECT_EQ(away.share, 1.0);
  EXPECT_EQ(away.clearance, kInfinity);
  EXPECT_EQ(stop_of(scene, report, "own").validity, SeparationValidity::kMeasured);
  EXPECT_EQ(stop_of(scene, report, "own").scaling, 1.0);
}

// The finger is 15 cm deep in the ball.
TEST(SeveralStops, CountAContactThatIsDeeperThanAllowed) {
  const auto contact = [](const std::string& depth) {
    return "contacts:\n  - {name: press, between: [finger, ball], depth: " + depth +
           ", by: me, reason: it presses}\n";
  };
  for (const bool allowed : {true, false}) {
    test::StoppingTicks ticks(
        test::scene_of_scara({.at = 0.0, .rest = contact(allowed ? "0.2" : "0.1")}));
    EXPECT_EQ(ticks.tick(0.0, 0.0).stops.at(0).scaling, allowed ? 1.0 : 0.0);
  }
}

}  // namespace
}  // namespace clearance
