#include "monitor/examples/arm/person_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/convex_body.hpp"

namespace clearance::people {
namespace {

constexpr double kStraight = 0.05;  // the sine of an angle below which a limb counts as straight

// The unit vector from one point to another, in the body.
Vec3 direction(const Vec3& from, const Vec3& to, const Mat3& world_from_body) {
  return world_from_body.transpose() * (to - from).normalized();
}

// The part of `v` across the unit vector `axis`.
Vec3 across(const Vec3& v, const Vec3& axis) { return v - v.dot(axis) * axis; }

double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

// The turn by whole turns of `angle` that is next to `last`.
double next_to(double last, double angle) {
  return angle + 2.0 * std::numbers::pi * std::round((last - angle) / (2.0 * std::numbers::pi));
}

// Axes as columns: z against the limb, x to where its outer joint bends.
Mat3 limb_frame(const Vec3& along, const Vec3& bends_to) {
  Mat3 frame;
  frame.col(2) = -along;
  frame.col(0) = across(bends_to, along).normalized();
  frame.col(1) = frame.col(2).cross(frame.col(0));
  return frame;
}

void fit_leg(std::size_t side, const Keypoints& person, const Mat3& world_from_body,
             Skeleton& skeleton) {
  const double left = side == 0 ? 1.0 : -1.0;
  const std::string name = side == 0 ? "l_" : "r_";
  const Vec3 thigh = direction(person.hip[side], person.knee[side], world_from_body);
  const Vec3 shin = direction(person.knee[side], person.ankle[side], world_from_body);
  const Vec3 back = across(shin, thigh);
  const bool is_bent = back.norm() > kStraight;
  const Vec3 ahead = std::abs(thigh.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitZ();
  const Mat3 frame = limb_frame(thigh, is_bent ? Vec3(-back) : ahead);
  // frame = Rz(yaw) Rx(pitch) Ry(roll)
  const double pitch = std::asin(std::clamp(frame(2, 1), -1.0, 1.0));
  const double yaw = std::atan2(-frame(0, 1), frame(1, 1));
  const double roll = std::atan2(-frame(2, 0), frame(2, 2));
  skeleton.angles.insert(skeleton.angles.end(),
                         {{name + "y_hip", -yaw},
                          {name + "p_hip", left * pitch},
                          {name + "r_hip", -roll},
                          {name + "knee", is_bent ? -angle_between(thigh, shin) : 0.0}});
}

}  // namespace

// The elbow bends about -y, so that the forearm comes forward.
void PersonFit::fit_arm(std::size_t side, const Keypoints& person, const Mat3& world_from_body,
                        Skeleton& skeleton) {
  const double left = side == 0 ? 1.0 : -1.0;
  const std::string name = side == 0 ? "l_" : "r_";
  Arm& last = arms_[side];
  const Vec3 upper = direction(person.shoulder[side], person.elbow[side], world_from_body);
  const Vec3 fore = direction(person.elbow[side], person.wrist[side], world_from_body);
  const Vec3 bends = across(fore, upper);
  if (bends.norm() > kStraight) last.forward = bends.normalized();
  if (across(last.forward, upper).norm() < kStraight) last.forward = upper.unitOrthogonal();
  const Mat3 frame = limb_frame(upper, last.forward);
  // frame = Rz(yaw) Rx(pitch) Rz(roll), or with the opposite pitch and half turns of both others
  const double pitch = std::acos(std::clamp(frame(2, 2), -1.0, 1.0));
  Arm best;
  double nearest = kInfinity;
  for (const double sign : {1.0, -1.0}) {
    Arm arm = last;
    arm.pitch = sign * pitch;
    arm.yaw = next_to(last.yaw, std::atan2(sign * frame(0, 2), -sign * frame(1, 2)));
    arm.roll = next_to(last.roll, std::atan2(sign * frame(2, 0), sign * frame(2, 1)));
    if (std::sin(pitch) < 1e-6) {  // both turns are about one axis: only their sum is known
      arm.yaw = last.yaw;
      arm.roll = next_to(last.roll, std::atan2(frame(1, 0), frame(0, 0)) - arm.yaw);
    }
    const double turn = std::abs(arm.yaw - last.yaw) + std::abs(arm.pitch - last.pitch);
    if (turn >= nearest) continue;
    nearest = turn;
    best = arm;
  }
  last = best;
  skeleton.angles.insert(
      skeleton.angles.end(),
      {{name + "y_shoulder", -left * best.yaw},
       {name + "p_shoulder", left * best.pitch},
       {name + "r_shoulder", left * best.roll},
       {name + "elbow", bends.norm() > kStraight ? angle_between(upper, fore) : 0.0}});
}

Skeleton PersonFit::fit(const Keypoints& person) {
  Skeleton skeleton;
  const Vec3 hips = 0.5 * (person.hip[0] + person.hip[1]);
  const Vec3 shoulders = 0.5 * (person.shoulder[0] + person.shoulder[1]);
  const Vec3 up = (shoulders - hips).normalized();
  const Vec3 to_left = (person.hip[0] - person.hip[1]).normalized() +
                       (person.shoulder[0] - person.shoulder[1]).normalized();
  Mat3 body;
  body.col(2) = up;
  body.col(1) = across(to_left, up).normalized();
  body.col(0) = body.col(1).cross(up);
  Eigen::Quaterniond turn = Eigen::Quaterniond(body).normalized();
  if (turn.dot(last_turn_) < 0.0) turn.coeffs() = -turn.coeffs();
  last_turn_ = turn;
  skeleton.world_from_body = {hips, turn};
  // Rx(roll) Ry(-pitch) turns z to the head.
  const Vec3 head = direction(person.neck, person.head_top, body);
  skeleton.angles = {{"waist", 0.0},
                     {"r_head", std::atan2(-head.y(), head.z())},
                     {"y_head", 0.0},
                     {"p_head", -std::asin(std::clamp(head.x(), -1.0, 1.0))}};
  for (const std::size_t side : {0, 1}) {
    fit_arm(side, person, body, skeleton);
    fit_leg(side, person, body, skeleton);
  }
  return skeleton;
}

}  // namespace clearance::people
