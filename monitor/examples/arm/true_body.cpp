#include "monitor/examples/arm/true_body.hpp"

#include <algorithm>
#include <utility>

#include "core/convex_body.hpp"

namespace clearance::people {
namespace {

constexpr int kBalls = 400;  // of a limb: at most 2 mm apart

Vec3 between(const Vec3& a, const Vec3& b, double part) { return (1.0 - part) * a + part * b; }

}  // namespace

// Radii of means: thighs of 60 cm girth, calves of 38, upper arms of 33, wrists of 17.
std::vector<Limb> true_limbs(const Keypoints& person) {
  std::vector<Limb> limbs = {
      {"p_head", between(person.neck, person.head_top, 0.35),
       between(person.neck, person.head_top, 0.65), 0.085, 0.095},
      {"torso", between(person.shoulder[0], person.shoulder[1], 0.5), person.neck, 0.06, 0.06},
      {"torso", person.shoulder[0], person.shoulder[1], 0.07, 0.07},
      {"body", person.hip[0], person.hip[1], 0.11, 0.11}};
  for (const double part : {0.35, 0.65}) {
    limbs.push_back({"waist", between(person.hip[0], person.hip[1], part),
                     between(person.shoulder[0], person.shoulder[1], part), 0.11, 0.11});
  }
  for (const std::size_t side : {0, 1}) {
    const bool left = side == 0;
    limbs.push_back({left ? "l_shoulder" : "r_shoulder", person.shoulder[side], person.elbow[side],
                     0.053, 0.045});
    limbs.push_back(
        {left ? "l_elbow" : "r_elbow", person.elbow[side], person.wrist[side], 0.045, 0.028});
    limbs.push_back(
        {left ? "l_elbow" : "r_elbow", person.wrist[side], person.fingertip[side], 0.028, 0.01});
    limbs.push_back({left ? "l_hip" : "r_hip", person.hip[side], person.knee[side], 0.095, 0.06});
    limbs.push_back(
        {left ? "l_knee" : "r_knee", person.knee[side], person.ankle[side], 0.06, 0.038});
    limbs.push_back({left ? "l_knee" : "r_knee", person.ankle[side], person.toe[side], 0.04, 0.02});
  }
  return limbs;
}

double true_distance(const Limb& limb, const TrueCapsule& capsule) {
  const Vec3 along = capsule.to - capsule.from;
  const double squared = along.squaredNorm();
  double least = kInfinity;
  for (int i = 0; i <= kBalls; ++i) {
    const double part = static_cast<double>(i) / kBalls;
    const Vec3 centre = between(limb.from, limb.to, part);
    const double at =
        squared > 0.0 ? std::clamp((centre - capsule.from).dot(along) / squared, 0.0, 1.0) : 0.0;
    const double distance = (centre - capsule.from - at * along).norm() - capsule.radius -
                            (1.0 - part) * limb.from_radius - part * limb.to_radius;
    least = std::min(least, distance);
  }
  return least;
}

}  // namespace clearance::people
