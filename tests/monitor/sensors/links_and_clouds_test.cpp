// Pairs of what a sensor sees and links that joints move: speeds, the minimum, and few queries.
//
// Oracles: the forward kinematics of the three joints in closed form, and the distance of each
// point from a box or ball in long double, one by one.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "monitor/clouds/seen_cloud.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/monitor/tick/small_cells.hpp"

namespace clearance::links_and_clouds_test {
namespace {

using test::LongVec;

constexpr std::int64_t kStart = test::kStart, kStep = 2'000'000;  // between ticks, ns
constexpr long double kNever = std::numeric_limits<long double>::infinity();

double seconds(int steps) { return 1e-9 * static_cast<double>(kStep) * steps; }

// The joints have these positions and velocities at one time.
struct Joints {
  double shoulder = 0.0, elbow = 0.0, push = 0.0;
  double shoulder_speed = 0.0, elbow_speed = 0.0, push_speed = 0.0;
};

// Each joint swings, within its limits of position and speed.
Joints swing(double s) {
  return {std::sin(s), 1.5 * std::sin(0.9 * s + 1.0),  0.1 + 0.08 * std::sin(2.0 * s),
          std::cos(s), 1.35 * std::cos(0.9 * s + 1.0), 0.16 * std::cos(2.0 * s)};
}

// A link lies in the plane of the arm, turned by `angle`, and moves.
struct Place {
  long double angle = 0.0L, rate = 0.0L;
  LongVec at = LongVec::Zero(), velocity = LongVec::Zero();
};
// Returns the vector turned by a right angle about z.
LongVec across(const LongVec& v) { return {-v.y(), v.x(), 0.0L}; }

Place place_of(const std::string& link, const Joints& q) {
  if (link == "foot") return {};
  const long double a = q.shoulder, b = a + q.elbow;
  const long double a_rate = q.shoulder_speed, b_rate = a_rate + q.elbow_speed;
  if (link == "upper") return {.angle = a, .rate = a_rate};
  const LongVec elbow(std::cos(a), std::sin(a), 0.0L), along(std::cos(b), std::sin(b), 0.0L);
  const LongVec elbow_velocity = a_rate * across(elbow);
  if (link == "lower") return {b, b_rate, elbow, elbow_velocity};
  const long double length = 1.0L + q.push;
  return {b, b_rate, elbow + length * along,
          elbow_velocity + length * b_rate * across(along) + q.push_speed * along};
}

// Says which point of a link is nearest to another point.
struct Nearest {
  long double distance = kNever;  // signed
  LongVec on_link = LongVec::Zero();
};
Nearest nearest_on(const std::string& link, const Place& place, const LongVec& point) {
  const LongVec from = point - place.at;
  if (link == "finger") {
    const long double apart = from.norm();
    return {apart - 0.05L, place.at + 0.05L / apart * from};
  }
  const long double c = std::cos(place.angle), s = std::sin(place.angle);
  const LongVec middle = link == "foot" ? LongVec(0, 0, -1) : LongVec(0.5L, 0, 0);
  const LongVec half = link == "foot" ? LongVec(0.1L, 0.1L, 0.1L) : LongVec(0.4L, 0.05L, 0.05L);
  const LongVec local =
      LongVec(c * from.x() + s * from.y(), c * from.y() - s * from.x(), from.z()) - middle;
  const LongVec outside = local.cwiseAbs() - half;
  const LongVec on_box = middle + local.cwiseMax(-half).cwiseMin(half);
  return {outside.cwiseMax(0.0L).norm() + std::min(outside.maxCoeff(), 0.0L),
          place.at + LongVec(c * on_box.x() - s * on_box.y(), s * on_box.x() + c * on_box.y(),
                             on_box.z())};
}

// The path on which a link comes near to the nearest of all points.
struct Approach {
  double distance = kInfinity, speed = 0.0;
  bool is_unique = false;  // it is apart, and no other point is as near
};

// A ball stands in the world.
struct Ball {
  LongVec at;
  long double radius;
};

// The cell has an arm, a post and a sensor of points. The sensor is where its frames say.
class LinksAndClouds : public testing::Test {
 protected:
  void make(const std::string& sensor_keys, bool publish, std::uint32_t budget = 2000) {
    const test::ScratchFolder folder;
    test::write_text(folder / "scara.urdf", test::kScaraUrdf);
    const std::string published = publish ? "" : ", publish: false";
    scene = scene_of(
        "name: test\nunits: {length: m, angle: rad}\nrobots: [{name: arm, urdf: scara.urdf}]\n"
        "objects: [{name: post, fixed: true, pose: {xyz: [1.2, 1.5, 0.3]}, sphere: {radius: "
        "0.1}}]\nsensors: [{name: eye, points: /points, depth_error: {constant: 0.01}, range: "
        "[0.3, 4]" +
            sensor_keys + "}]\npairs:\n  - {between: [arm, eye]" + published +
            "}\n  - {between: [arm, post]" + published + "}\n",
        folder / "cell.yaml");
    EXPECT_EQ(scene.pairs.size(), 7u) << "the foot and the post do not move";
    scene.budget = budget;
    monitor.emplace(scene);
    now = kStart;
  }
  // Shows a frame of points that are about this far from the origin of the world.
  void show_points(double least, double greatest) {
    const Pose sensor = random.pose(1.0);
    std::vector<MeasuredPoint> points;
    seen.clear();
    for (int i = 0; i < 200; ++i) {
      const double distance = random.uniform(least, greatest);
      const Vec3 in_world = distance * random.direction();
      const Vec3 p = sensor.orientation.conjugate() * (in_world - sensor.position);
      points.push_back(
          {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()), 0.01F});
      const MeasuredPoint& kept = points.back();
      seen.push_back({test::exactly(sensor, LongVec(kept.x, kept.y, kept.z)), kept.radius});
    }
    SeenCloud& cloud = clouds.emplace_back(SeenCloud::of_points(points.size()));
    ASSERT_EQ(cloud.points()->build(points, {Vec3::Zero(), 8.0}), CloudBuild::kBuilt);
    ASSERT_TRUE(
        monitor->show(0, {.cloud = &cloud, .stamp_ns = now + kStep, .world_from_sensor = sensor}));
  }
  const Report& tick(const Joints& at) {
    now += kStep;
    joints = at;
    std::array<JointSample, 3> samples = test::joints(at.shoulder, at.elbow, at.push, now);
    samples[0].velocity = at.shoulder_speed;
    samples[1].velocity = at.elbow_speed;
    samples[2].velocity = at.push_speed;
    for (JointSample& each : samples) each.has_velocity = true;
    return monitor->tick({}, samples, now);
  }

  [[nodiscard]] bool is_of_cloud(std::uint32_t pair) const {
    return scene.objects[scene.pairs[pair].first].is_seen() ||
           scene.objects[scene.pairs[pair].second].is_seen();
  }
  [[nodiscard]] std::string link_of(std::uint32_t pair) const {
    const std::string& first = scene.objects[scene.pairs[pair].first].name;
    return first == "eye" || first == "post" ? scene.objects[scene.pairs[pair].second].name : first;
  }
  // Returns what a pair's link may meet: all points, or the post.
  [[nodiscard]] std::vector<Ball> met_by(std::uint32_t pair) const {
    if (is_of_cloud(pair)) return seen;
    return {{LongVec(Vec3(1.2, 1.5, 0.3).cast<long double>()), 0.1L}};
  }
  [[nodiscard]] long double truth(std::uint32_t pair) const {
    const std::string link = link_of(pair);
    const Place place = place_of(link, joints);
    long double least = kNever;
    for (const Ball& ball : met_by(pair))
      least = std::min(least, nearest_on(link, place, ball.at).distance - ball.radius);
    return least;
  }
  [[nodiscard]] Approach approach_of(const std::string& link) const {
    const Place place = place_of(link, joints);
    Approach least;
    for (const Ball& ball : seen) {
      const Nearest nearest = nearest_on(link, place, ball.at);
      const auto distance = static_cast<double>(nearest.distance - ball.radius);
      const LongVec towards = (ball.at - nearest.on_link).normalized();
      const LongVec velocity = place.velocity + place.rate * across(nearest.on_link - place.at);
      const bool is_apart = distance > 1e-3 && std::abs(distance - least.distance) > 1e-6;
      if (distance < least.distance) {
        least = {distance, static_cast<double>(velocity.dot(towards)), is_apart};
      } else {
        least.is_unique = least.is_unique && is_apart;
      }
    }
    return least;
  }

  Scene scene;
  std::optional<Monitor> monitor;
  std::deque<SeenCloud> clouds;
  std::vector<Ball> seen;
  Joints joints;
  std::int64_t now = kStart;
  Random random{20261126};
};

// The sensor is elsewhere with each frame, as one in a hand that moves. What it sees is at rest.
TEST_F(LinksAndClouds, CloseAtTheSpeedOfTheLinkTowardsTheNearestElement) {
  for (const std::string speed : {"", ", max_speed: 1.5"}) {
    make(speed, true);
    std::map<std::string, int> approaching, receding;
    for (int t = 0; t < 2000; ++t) {
      if (t % 10 == 0) show_points(0.3, 2.6);
      const Report& report = tick(swing(seconds(t)));
      for (const PairReport& pair : report.pairs) {
        if (!is_of_cloud(pair.pair)) continue;
        const std::string link = link_of(pair.pair);
        const Approach approach = approach_of(link);
        if (!approach.is_unique) continue;
        ASSERT_NEAR(pair.closing_speed, approach.speed, 1e-6) << link << ", tick " << t;
        if (approach.speed > 0.1) {
          ++approaching[link];
          ASSERT_NEAR(pair.time_to_contact, approach.distance / approach.speed, 1e-3);
        } else if (approach.speed < -0.1) {
          ++receding[link];
          ASSERT_EQ(pair.time_to_contact, kInfinity);
        }
      }
    }
    EXPECT_EQ(approaching["foot"] + receding["foot"], 0) << "nothing moves it";
    for (const char* const link : {"upper", "lower", "finger"}) {
      EXPECT_GT(approaching[link], 100) << link;
      EXPECT_GT(receding[link], 100) << link;
    }
  }
}

TEST_F(LinksAndClouds, HaveNoClosingSpeedWhileTheJointsAreLate) {
  make("", true);
  show_points(0.3, 2.6);
  tick(swing(0.0));
  now += 30'000'000;
  show_points(0.3, 2.6);
  now += kStep;
  std::size_t late = 0;
  for (const PairReport& pair : monitor->tick({}, {}, now).pairs) {
    if (!is_of_cloud(pair.pair) || link_of(pair.pair) == "foot") continue;
    ++late;
    EXPECT_EQ(pair.status, PairStatus::kStale);
    EXPECT_TRUE(std::isnan(pair.closing_speed));
    EXPECT_TRUE(std::isnan(pair.time_to_contact) || pair.distance <= 0.0);
  }
  EXPECT_EQ(late, 3u);
}

// Points are around the arm in one frame, and far away in the next: then the post is nearest.
TEST_F(LinksAndClouds, HaveACertifiedMinimumThatNoElementAndNoOtherPairIsNearerThan) {
  for (const bool publish : {true, false}) {
    make("", publish);
    EXPECT_FALSE(tick(swing(0.0)).minimum_certified) << "nothing is seen yet";
    int of_cloud = 0, of_post = 0;
    for (int t = 1; t < 1000; ++t) {
      if (t % 20 == 1) show_points(0.3, 2.6);
      if (t % 20 == 11) show_points(4.0, 4.5);
      const Report& report = tick(swing(seconds(t)));
      ASSERT_TRUE(report.minimum_certified) << "tick " << t;
      long double least = kNever;
      for (std::uint32_t pair = 0; pair < scene.pairs.size(); ++pair)
        least = std::min(least, truth(pair));
      ASSERT_LE(report.minimum.lower, least);
      ASSERT_GE(report.minimum.upper, least);
      ASSERT_LE(report.minimum.upper - report.minimum.lower, 1e-8);
      ASSERT_LE(report.lower_all, least);
      ASSERT_NEAR(static_cast<double>(truth(report.minimum.pair) - least), 0.0, 1e-8);
      ++(is_of_cloud(report.minimum.pair) ? of_cloud : of_post);
    }
    EXPECT_GT(of_cloud, 300);
    EXPECT_GT(of_post, 300);
    now += 150'000'000;
    EXPECT_FALSE(tick(swing(seconds(1000))).minimum_certified) << "the frame is too old";
  }
}

// After each frame, nothing is known but that all points are somewhere in the range. Then one pair
// after another has its turn, and the motion of the links widens the bounds of the others.
TEST_F(LinksAndClouds, HaveTrueBoundsThatAreCarriedWhereTheBudgetIsTooSmall) {
  for (const std::uint32_t budget : {1u, 3u}) {
    for (const bool publish : {true, false}) {
      make(", age_limit_ms: 1000", publish, budget);
      int carried = 0;
      std::map<std::string, int> close, evaluated;
      for (int t = 0; t < 1500; ++t) {
        if (t % 100 == 0) show_points(0.3, 2.6);
        if (t % 100 == 50) show_points(2.5, 4.5);
        const Report& report = tick(swing(seconds(t)));
        ASSERT_LE(report.queries, budget);
        for (std::uint32_t pair = 0; pair < scene.pairs.size(); ++pair) {
          const PairReport found = monitor->pair(pair);
          const long double exact = truth(pair);
          ASSERT_LE(found.lower, exact) << link_of(pair) << ", tick " << t;
          ASSERT_GE(found.upper, exact) << link_of(pair) << ", tick " << t;
          if (!is_of_cloud(pair)) continue;
          if (found.status != PairStatus::kCarried) {
            ++evaluated[link_of(pair)];
            continue;
          }
          ++carried;
          close[link_of(pair)] += found.upper - found.lower < 0.05 ? 1 : 0;
        }
      }
      EXPECT_GT(carried, 2000);
      for (const char* const link : {"upper", "lower", "finger"}) {
        EXPECT_GT(evaluated[link], 50) << link;
        EXPECT_GT(close[link], 50) << link << ": the bounds of a query were carried";
      }
    }
  }
}

}  // namespace
}  // namespace clearance::links_and_clouds_test
