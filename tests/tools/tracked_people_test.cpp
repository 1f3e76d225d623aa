// A person of a cell against the true body of a person whose motion was recorded in a BVH file.
//
// Oracle: the kinematics of BVH, and balls along the limbs (true_body.hpp). Neither uses what the
// monitor computes with.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "monitor/examples/arm/bvh.hpp"
#include "monitor/examples/arm/made_motion.hpp"
#include "monitor/examples/arm/person_fit.hpp"
#include "monitor/examples/arm/true_body.hpp"
#include "monitor/tick/monitor.hpp"
#include "tests/config/cells.hpp"

namespace clearance {
namespace {

using namespace people;

constexpr double kMetres = 0.01;  // the unit of the files
const TrueCapsule kPosts[] = {{{2.6, 0.0, 0.0}, {2.6, 0.0, 1.8}, 0.08},
                              {{0.7, 0.5, 0.3}, {0.7, 0.5, 1.0}, 0.05},
                              {{1.2, -0.8, 1.6}, {1.2, 0.8, 1.9}, 0.06}};

std::string cell_text(double error) {
  std::string text =
      "name: test\nunits: {length: m, angle: rad}\nros2: {world_frame: map}\nrobots:\n"
      "  - {name: anna, person: {stature: 1.75, error: " +
      std::to_string(error) + "}, age_limit_ms: 100}\nobjects:\n";
  const auto triple = [](const Vec3& v) {
    return "[" + std::to_string(v.x()) + ", " + std::to_string(v.y()) + ", " +
           std::to_string(v.z()) + "]";
  };
  for (std::size_t i = 0; i < std::size(kPosts); ++i) {
    text += "  - {name: post" + std::to_string(i) +
            ", groups: [posts], fixed: true, capsule: {from: " + triple(kPosts[i].from) +
            ", to: " + triple(kPosts[i].to) + ", radius: " + std::to_string(kPosts[i].radius) +
            "}}\n";
  }
  return text + "pairs: [{between: [anna, posts], publish: true}]\n";
}

// The joints of a skeleton as the samples of a tracker.
std::vector<JointSample> samples_of(const Skeleton& skeleton, const Scene& scene,
                                    std::int64_t stamp_ns) {
  std::vector<std::pair<std::string, double>> named;
  for (const auto& [name, angle] : skeleton.angles) named.emplace_back(name + "_anna", angle);
  const Vec3& p = skeleton.world_from_body.position;
  const Eigen::Quaterniond& q = skeleton.world_from_body.orientation;
  const std::pair<const char*, double> base[] = {
      {"trans_x", p.x()}, {"trans_y", p.y()}, {"trans_z", p.z()}, {"rot_x", q.x()},
      {"rot_y", q.y()},   {"rot_z", q.z()},   {"rot_w", q.w()}};
  for (const auto& [name, value] : base)
    named.emplace_back(std::string("anna_base/") + name, value);
  std::vector<JointSample> samples;
  for (const auto& [name, value] : named) {
    const auto variable = std::ranges::find(scene.variables, name, &JointVariable::name);
    EXPECT_NE(variable, scene.variables.end()) << name;
    if (variable == scene.variables.end()) continue;
    samples.push_back({.variable = static_cast<std::uint32_t>(variable - scene.variables.begin()),
                       .stamp_ns = stamp_ns,
                       .position = value});
  }
  return samples;
}

struct Compared {
  std::size_t pairs = 0, wrong = 0, unknown = 0;
  double least_distance = kInfinity;
  std::vector<double> below;  // truth less lower bound, in ascending order
};

// `shown`: the frame that the tracker shows at each frame of the truth.
template <class Shown>
Compared compare(const Bvh& motion, double error, const Shown& shown) {
  const Scene scene = scene_of(cell_text(error));
  Monitor monitor(scene);
  PersonFit fit;
  Compared compared;
  std::int64_t now = 1'700'000'000'000'000'000;
  for (std::size_t frame = 0; frame < motion.frames.size(); ++frame) {
    now += static_cast<std::int64_t>(1e9 * motion.frame_s);
    const Skeleton skeleton = fit.fit(keypoints_of(motion, shown(frame), kMetres));
    const Report& report = monitor.tick({}, samples_of(skeleton, scene, now), now);
    const std::vector<Limb> limbs = true_limbs(keypoints_of(motion, frame, kMetres));
    compared.unknown += report.unknown;
    std::size_t published = 0;
    for (const ObjectPair& pair : scene.pairs) {
      const PairReport& bounds = report.pairs[published++];
      const std::string& link = scene.objects[pair.second].name;
      double truth = kInfinity;
      for (const Limb& limb : limbs)
        if (std::string(limb.link) + "_anna" == link)
          truth = std::min(truth, true_distance(limb, kPosts[pair.first]));
      EXPECT_LT(truth, kInfinity) << link << " has a true body";
      ++compared.pairs;
      compared.wrong += bounds.lower > truth;
      compared.below.push_back(truth - bounds.lower);
      compared.least_distance = std::min(compared.least_distance, truth);
    }
  }
  std::ranges::sort(compared.below);
  return compared;
}

TEST(TrackedPeople, AreNeverNearerThanTheLowerBoundsOfTheirLimbs) {
  for (const std::uint32_t seed : {1u, 2u, 3u, 4u, 5u, 6u}) {
    const Bvh motion = read_bvh(walking_and_reaching(seed, 500));
    const Compared compared = compare(motion, 0.1, [](std::size_t frame) { return frame; });
    EXPECT_EQ(compared.wrong, 0u) << seed;
    EXPECT_EQ(compared.unknown, 0u) << seed << ": no joint leaps";
    EXPECT_EQ(compared.pairs, 500u * 12u * std::size(kPosts));
    EXPECT_LT(compared.least_distance, 0.3) << "the hand comes near";
    EXPECT_LT(compared.below[compared.below.size() / 2], 0.35) << "and bounds are not idle";
  }
}

TEST(TrackedPeople, AreFoundElsewhereByTheTruthIfTheTrackerIsWrong) {
  const Bvh motion = read_bvh(walking_and_reaching(1, 500));
  const Compared late =
      compare(motion, 0.1, [](std::size_t frame) { return frame < 40 ? 0 : frame - 40; });
  EXPECT_GT(late.wrong, 100u);
}

TEST(TrackedPeople, OfAFileAreUprightAndHaveTheirLeftOnTheLeft) {
  const Bvh motion = read_bvh(walking_and_reaching(1, 3));
  const Keypoints points = keypoints_of(motion, 0, kMetres);
  // Upright, arms down, at the start: the head above the hips, left to the left.
  EXPECT_GT(points.head_top.z(), 1.6);
  EXPECT_LT(points.head_top.z(), 1.8);
  EXPECT_GT(points.hip[0].y(), points.hip[1].y());
  EXPECT_LT(points.wrist[0].z(), points.elbow[0].z());
  EXPECT_GT(points.toe[0].x(), points.ankle[0].x());
}

// By hand: a thigh of 40 that swings forward by 90 degrees, and a shin of 30 that hangs; then both
// to the left, by a turn about z that comes after one about y.
TEST(Bvh, PlacesJointsByTheProductOfItsRotationsInTheirOrder) {
  const Bvh motion = read_bvh(
      "HIERARCHY ROOT a { OFFSET 1 2 3 CHANNELS 6 Xposition Yposition Zposition Zrotation "
      "Xrotation "
      "Yrotation JOINT b { OFFSET 0 -40 0 CHANNELS 3 Zrotation Xrotation Yrotation End Site { "
      "OFFSET "
      "0 -30 0 } } } MOTION Frames: 2 Frame Time: 0.5\n"
      "10 20 30 0 -90 0  0 90 0\n0 0 0 90 0 90  0 0 0\n");
  ASSERT_EQ(motion.joints.size(), 3u);
  EXPECT_EQ(motion.joints[2].name, "b_end");
  EXPECT_EQ(motion.frame_s, 0.5);
  const auto expect = [&](std::size_t frame, const Vec3& knee, const Vec3& ankle) {
    const std::vector<Vec3> places = places_of(motion, frame);
    EXPECT_LT((places[1] - knee).norm(), 1e-12) << frame;
    EXPECT_LT((places[2] - ankle).norm(), 1e-12) << frame;
  };
  expect(0, {11, 22, 73}, {11, -8, 73});
  expect(1, {41, 2, 3}, {71, 2, 3});
  EXPECT_THROW(static_cast<void>(keypoints_of(motion, 0, 1.0)), std::invalid_argument);
}

TEST(Bvh, RefusesWhatIsNone) {
  const std::string good = walking_and_reaching(1, 2);
  EXPECT_NO_THROW(static_cast<void>(read_bvh(good)));
  const std::vector<std::string> bad = {
      "", good.substr(0, good.size() / 2), good.substr(10), good.substr(0, good.size() - 8),
      "HIERARCHY ROOT a { CHANNELS 1 Xscale } MOTION Frames: 1 Frame Time: 1 1"};
  for (const std::string& text : bad)
    EXPECT_THROW(static_cast<void>(read_bvh(text)), std::invalid_argument) << text.substr(0, 60);
}

}  // namespace
}  // namespace clearance
