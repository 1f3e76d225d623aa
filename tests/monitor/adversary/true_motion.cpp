#include "tests/monitor/adversary/true_motion.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "tests/shared/random.hpp"

namespace clearance::test::lies {
namespace {

using Real = long double;
constexpr Real kYawRate = 1.0L;   // of balls, rad/s
constexpr Real kSpinRate = 1.2L;  // of continuous joints, rad/s
// position = centre + amplitude sin(rate t + phase), but for the continuous joint
constexpr std::array<Real, kJoints> kCentre{0.0L, 0.2L, 0.0L, 0.2L};
constexpr std::array<Real, kJoints> kAmplitude{0.9L, 0.8L, 0.0L, 0.18L};
constexpr std::array<Real, kJoints> kRate{1.3L, 1.4L, 0.0L, 2.1L};

Real in_seconds(std::int64_t t) { return static_cast<Real>(t) * 1e-9L; }

TruePose translation(Real x, Real y, Real z) {
  TruePose pose = TruePose::Identity();
  pose.col(3) << x, y, z, 1;
  return pose;
}

// A rotation about the coordinate axis 0, 1 or 2.
TruePose rotation(int axis, Real angle) {
  TruePose pose = TruePose::Identity();
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  pose(i, i) = pose(j, j) = std::cos(angle);
  pose(i, j) = -std::sin(angle);
  pose(j, i) = std::sin(angle);
  return pose;
}

TruePoint moved(const TruePose& pose, Real x, Real y, Real z) {
  return (pose * Eigen::Matrix<Real, 4, 1>(x, y, z, 1)).head<3>();
}

TruePoint point(const std::array<double, 3>& p) { return {p[0], p[1], p[2]}; }

// The centres of a robot's links, by the origins of its description. Returns the frame of its tip.
TruePose add_links(const TruePose& world_from_foot, const std::array<TrueJoint, kJoints>& joints,
                   std::size_t first, std::array<TruePoint, kBodies>& centres) {
  TruePose link = world_from_foot;
  centres[first] = moved(link, 0, 0, 0);
  link = link * translation(0, 0, 0.4L) * rotation(2, joints[0].position);
  centres[first + 1] = moved(link, 0.4L, 0, 0);
  link = link * translation(0.7L, 0, 0) * rotation(1, joints[1].position);
  centres[first + 2] = moved(link, 0.3L, 0, 0);
  link = link * translation(0.6L, 0, 0) * rotation(0, joints[2].position);
  centres[first + 3] = moved(link, 0.1L, 0.15L, 0);
  link = link * translation(0.2L + joints[3].position, 0, 0);
  centres[first + 4] = moved(link, 0.1L, 0.1L, 0);
  return link;
}

// From a point to the part of the plate that is in the picture.
Real distance_to_plate(const TruePoint& from, Real depth) {
  const TruePoint off = from - point(kLensPlace);
  const Real beside_x = std::abs(off.x()) - 0.5L * kColumns / kFocal * depth;
  const Real beside_y = std::abs(off.y()) - 0.5L * kRows / kFocal * depth;
  return TruePoint(std::max(beside_x, 0.0L), std::max(beside_y, 0.0L), off.z() + depth).norm();
}

}  // namespace

TrueMotion::TrueMotion(std::uint64_t seed, bool far) {
  Random random(seed + 1000);
  const auto around = [&](Real x, Real y, Real z) {
    const Vec3 off = random.in_box(0.25);
    return TruePoint(x + off.x(), y + off.y(), z + 0.3L * off.z());
  };
  const auto phase = [&] { return static_cast<Real>(random.uniform(0.0, 6.28)); };
  const auto tilt = [&] { return static_cast<Real>(random.uniform(-0.5, 0.5)); };
  // Speeds of 1.3 to 1.55 m/s, and 0.15 m/s more by the turning.
  orbits_[0] = {around(1.3L, -0.8L, 0.6L), 1.0L, 1.5L, phase(), tilt()};
  orbits_[1] = {around(2.2L, 1.7L, 0.7L), 1.1L, -1.4L, phase(), tilt()};
  orbits_[2] = {around(-1.3L, 1.1L, 0.5L), 0.9L, 1.6L, phase(), tilt()};
  orbits_[3] = {around(-0.6L, -1.9L, 0.5L), 0.8L, -1.65L, phase(), tilt()};
  for (auto& robot : phases_) {
    for (Real& each : robot) each = phase();
  }
  base_phase_ = phase();
  turned_ = far ? 80000.0L * std::numbers::pi_v<Real> : 0.0L;
}

TruePoint TrueMotion::on(const Orbit& orbit, std::int64_t t) const {
  const Real angle = orbit.rate * in_seconds(t) + orbit.phase;
  const Real x = orbit.radius * std::cos(angle), y = orbit.radius * std::sin(angle);
  return orbit.centre + TruePoint(x, y * std::cos(orbit.tilt), y * std::sin(orbit.tilt));
}

TruePose TrueMotion::pose(Channel channel, std::int64_t t) const {
  const Real s = in_seconds(t);
  if (channel == Channel::kOdom) {
    return translation(0.05L * std::sin(0.7L * s), 0.05L * std::cos(0.6L * s), 0) *
           rotation(2, 0.03L * std::sin(0.5L * s));
  }
  if (channel == Channel::kBase) {
    return translation(0.3L * std::sin(0.9L * s + base_phase_), 0.3L * std::cos(0.7L * s), 0.05L) *
           rotation(2, 0.2L * std::sin(0.8L * s + base_phase_));
  }
  if (channel == Channel::kEye) {
    return translation(1.2L + 0.3L * std::sin(0.9L * s), -0.8L + 0.3L * std::cos(0.7L * s), 1.5L) *
           rotation(2, 0.4L * std::sin(0.8L * s + base_phase_)) *
           rotation(1, 0.3L * std::sin(0.6L * s));
  }
  const std::size_t orbit = is_ball(channel) ? static_cast<std::size_t>(channel) : kFollowerBody;
  const TruePoint p = on(orbits_[orbit], t);
  return translation(p.x(), p.y(), p.z()) * rotation(2, kYawRate * s);
}

Twist TrueMotion::twist(Channel channel, std::int64_t t) const {
  const Orbit& orbit = orbits_[static_cast<std::size_t>(channel)];
  const Real angle = orbit.rate * in_seconds(t) + orbit.phase;
  const Real x = -orbit.radius * orbit.rate * std::sin(angle);
  const Real y = orbit.radius * orbit.rate * std::cos(angle);
  const TruePoint linear(x, y * std::cos(orbit.tilt), y * std::sin(orbit.tilt));
  return {.linear = linear.cast<double>(), .angular = {0, 0, static_cast<double>(kYawRate)}};
}

std::array<TrueJoint, kJoints> TrueMotion::joints(Channel robot, std::int64_t t) const {
  const auto& phases = phases_[robot == Channel::kArm ? 0 : 1];
  std::array<TrueJoint, kJoints> joints;
  for (std::size_t i = 0; i < kJoints; ++i) {
    const Real angle = kRate[i] * in_seconds(t) + phases[i];
    joints[i] = {kCentre[i] + kAmplitude[i] * std::sin(angle),
                 kAmplitude[i] * kRate[i] * std::cos(angle)};
  }
  joints[2] = {turned_ + phases[2] + kSpinRate * in_seconds(t), kSpinRate};
  return joints;
}

// Nothing else is higher than 1.7 m.
const std::array<TruePoint, kSeenPoints>& TrueMotion::seen_points() {
  static const std::array<TruePoint, kSeenPoints> kPoints{
      TruePoint{0.6L, -0.3L, 1.9L}, TruePoint{1.8L, -1.4L, 1.85L}, TruePoint{0.8L, -1.6L, 2.0L},
      TruePoint{1.7L, 0.1L, 1.9L}};
  return kPoints;
}

Real TrueMotion::plate_depth(std::int64_t t) {
  return 2.9L + 0.35L * std::sin(0.9L * in_seconds(t));
}

TruePoint TrueMotion::walker(std::int64_t t) {
  const Real s = in_seconds(t);
  return {-3.3L + 0.2L * std::sin(1.1L * s), 0.5L * std::sin(0.8L * s), 0.65L};
}

TrueMotion::Centres TrueMotion::centres(std::int64_t t) const {
  Centres centres;
  for (std::size_t i = 0; i < 3; ++i) {
    centres[i] = moved(pose(static_cast<Channel>(i), t), 0.15L, 0, 0);
  }
  const TruePose odom = pose(Channel::kOdom, t);
  centres[kFollowerBody] = moved(odom * pose(Channel::kFollower, t), 0.15L, 0, 0);
  centres[kRockBody] = {1.0L, 1.3L, 0.3L};
  centres[kEyeBody] = seen_points()[0];
  const TruePose tip =
      add_links(odom * pose(Channel::kBase, t), joints(Channel::kArm, t), kArmBody, centres);
  static_cast<void>(
      add_links(translation(2.6L, 0.4L, 0), joints(Channel::kPost, t), kPostBody, centres));
  centres[kLensBody] = point(kLensPlace) - TruePoint(0, 0, plate_depth(t));
  centres[kMapBody] = walker(t);
  centres[kPartBody] = point(kPartPlace);
  if (carries(t)) centres[kPartBody] = moved(tip, kTipFromPart[0], kTipFromPart[1], 0);
  if (carried_to_ > 0 && t >= carried_to_) centres[kPartBody] = put_down_;
  return centres;
}

void TrueMotion::carry(std::int64_t from, std::int64_t to) {
  carried_from_ = from, carried_to_ = to + 1;
  put_down_ = centres(to)[kPartBody];
  carried_to_ = to;
}

Real TrueMotion::distance(std::size_t a, std::size_t b, const Centres& centres) {
  const Real radii = radius(a) + radius(b);
  if (a == kEyeBody || a == kLensBody) std::swap(a, b);
  if (b == kLensBody) return distance_to_plate(centres[a], kLensPlace[2] - centres[b].z()) - radii;
  if (b != kEyeBody) return (centres[a] - centres[b]).norm() - radii;
  Real least = std::numeric_limits<Real>::infinity();
  for (const TruePoint& seen : seen_points())
    least = std::min(least, (centres[a] - seen).norm() - radii);
  return least;
}

double TrueMotion::radius(std::size_t body) {
  constexpr std::array<double, kLinks> kRadii{0.12, 0.1, 0.09, 0.08, 0.06};
  if (body < kRockBody) return 0.1;
  if (body == kPartBody) return 0.05;
  if (body >= kEyeBody) return 0.0;
  return body == kRockBody ? 0.2 : kRadii[(body - kArmBody) % kLinks];
}

// Sums of the speeds of what carries a link: the base, and each joint by its lever.
double TrueMotion::fastest(std::size_t body) {
  constexpr std::array<double, kLinks> kByJoints{0.0, 0.5, 2.3, 3.7, 4.7};
  if (body < kRockBody) return kBallSpeed;
  if (body == kRockBody || body == kPostBody || (body >= kEyeBody && body != kPartBody)) return 0.0;
  if (body == kPartBody) return kBaseSpeed + 5.3;  // the part is farther out than the tip
  return (body < kPostBody ? kBaseSpeed : 0.0) + kByJoints[(body - kArmBody) % kLinks];
}

Pose as_pose(const TruePose& pose) {
  const Eigen::Quaternion<Real> q(Eigen::Matrix<Real, 3, 3>(pose.topLeftCorner<3, 3>()));
  return {pose.col(3).head<3>().cast<double>(), q.cast<double>()};
}

}  // namespace clearance::test::lies
