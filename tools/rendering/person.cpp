#include "tools/rendering/person.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <sstream>

#include "core/shapes.hpp"

namespace clearance {
namespace {

using std::numbers::pi;

// A limb hangs from a joint of the body, whose frame has x forward, y to the left, z up and the
// floor at z = 0. It ends `length` below the joint. Swings are about y. Lengths in m, angles in
// rad.
struct Hanging {
  Vec3 joint;
  double length, radius;
  double stride;  // its swing while the person walks; negative: against the other side
  double reach;   // its swing when the hand is reached out
};
constexpr double kStride = 0.3, kReach = -1.45;
const Hanging kLimbs[] = {
    {{0.0, 0.0, 1.68}, 0.10, 0.11, 0.0, 0.0},           // head
    {{0.0, 0.0, 1.36}, 0.42, 0.16, 0.0, 0.0},           // trunk
    {{0.0, 0.1, 0.90}, 0.82, 0.08, kStride, 0.0},       // left leg
    {{0.0, -0.1, 0.90}, 0.82, 0.08, -kStride, 0.0},     // right leg
    {{0.0, 0.21, 1.38}, 0.58, 0.05, -kStride, 0.0},     // left arm
    {{0.0, -0.21, 1.38}, 0.58, 0.05, kStride, kReach},  // right arm
};
constexpr double kStepsPerMetre = 0.7;  // swings to and fro
constexpr double kTurnSpeed = 1.5;      // rad/s
constexpr double kReachSpeed = 0.9;     // rad/s
constexpr double kReachHold_s = 1.5;
constexpr double kArmRadius = 0.3;  // m: of a point that hangs down, from the vertical axis

double heading_of(const Vec3& from, const Vec3& to) {
  return std::atan2(to.y() - from.y(), to.x() - from.x());
}
double length_of(const Hanging& limb) { return limb.length + limb.radius; }
double reach_length_s() { return 2.0 * std::abs(kReach) / kReachSpeed + kReachHold_s; }

}  // namespace

std::variant<WalkingPath, std::string> read_walking_path(const std::string& text) {
  WalkingPath path;
  std::istringstream points(text);
  for (std::string each; std::getline(points, each, ':');) {
    std::istringstream numbers(each);
    std::vector<double> read;
    for (std::string number; std::getline(numbers, number, ',');) {
      char* end = nullptr;
      const double value = std::strtod(number.c_str(), &end);
      const bool is_number = !number.empty() && *end == '\0' && std::abs(value) <= 1e3;
      read.push_back(is_number ? value : std::nan(""));
    }
    const bool is_point = (read.size() == 2 || read.size() == 3) &&
                          std::ranges::all_of(read, [](double x) { return !std::isnan(x); });
    if (!is_point)
      return fmt::format("found the point '{}'; expected X,Y or X,Y,Z in m, up to 1000", each);
    path.emplace_back(read[0], read[1], read.size() == 3 ? read[2] : 0.0);
    if (path.size() > 1 && (path.back() - path[path.size() - 2]).head<2>().norm() < 0.01)
      return fmt::format("found two points in a row at '{}'; expected at least 1 cm between", each);
  }
  if (path.size() < 2)
    return fmt::format("found {} points in '{}'; expected at least two: 2,0:0.8,0", path.size(),
                       text);
  return path;
}

WalkingPerson::WalkingPerson(WalkingPath path, double speed) : speed_(speed) {
  for (const Hanging& limb : kLimbs) {
    const Vec3 end(0.0, 0.0, -limb.length);
    limbs_.push_back({std::get<ConvexBody>(segment(Vec3::Zero(), end, limb.radius)), {}});
  }
  add_walk(path);
  const double heading = heading_of(path[path.size() - 2], path.back());
  add(Action::kReach, reach_length_s(), path.back(), path.back(), heading, 0.0);
  add(Action::kTurn, pi / kTurnSpeed, path.back(), path.back(), heading, pi);
  const double begin = heading_of(path[0], path[1]);
  std::ranges::reverse(path);
  add_walk(path);
  add(Action::kTurn, pi / kTurnSpeed, path.back(), path.back(), begin + pi, pi);
  place(0.0);
}

void WalkingPerson::add(Action action, double length_s, const Vec3& from, const Vec3& to,
                        double heading, double turn) {
  stretches_.push_back({action, period_s_, length_s, from, to, heading, turn});
  period_s_ += length_s;
}

// A person turns at corners, on the spot.
void WalkingPerson::add_walk(const WalkingPath& path) {
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const double heading = heading_of(path[i], path[i + 1]);
    if (i > 0) {
      const double before = heading_of(path[i - 1], path[i]);
      const double turn = std::remainder(heading - before, 2.0 * pi);
      if (turn != 0.0)
        add(Action::kTurn, std::abs(turn) / kTurnSpeed, path[i], path[i], before, turn);
    }
    add(Action::kWalk, (path[i + 1] - path[i]).norm() / speed_, path[i], path[i + 1], heading, 0.0);
  }
}

void WalkingPerson::place(double t_s) {
  const double t = t_s - period_s_ * std::floor(t_s / period_s_);
  const auto after = std::ranges::upper_bound(stretches_, t, {}, &Stretch::begin_s);
  const Stretch& now = *std::prev(after);
  const double share = std::clamp((t - now.begin_s) / now.length_s, 0.0, 1.0);
  double swing = 0.0, reached = 0.0;  // shares of `stride` and `reach`
  if (now.action == Action::kWalk) {
    // The limbs hang down at both ends of a stretch: a whole number of swings.
    const double metres = now.length_s * speed_;
    const double swings = std::max(1.0, std::floor(kStepsPerMetre * metres));
    swing = std::sin(2.0 * pi * swings * share);
  } else if (now.action == Action::kReach) {
    const double since = t - now.begin_s, until = now.length_s - since;
    reached = std::min(1.0, std::min(since, until) * kReachSpeed / std::abs(kReach));
  }
  const Eigen::Quaterniond heading(
      Eigen::AngleAxisd(now.heading + share * now.turn, Vec3::UnitZ()));
  const Pose world_from_person{now.from + share * (now.to - now.from), heading};
  for (std::size_t i = 0; i < limbs_.size(); ++i) {
    const Hanging& limb = kLimbs[i];
    const double angle = swing * limb.stride + reached * limb.reach;
    limbs_[i].world_from_limb =
        compose(world_from_person,
                {limb.joint, Eigen::Quaterniond(Eigen::AngleAxisd(angle, Vec3::UnitY()))});
  }
}

// A stretch of L metres has at most one swing, or kStepsPerMetre L: at its speed, so many rad/s.
double WalkingPerson::max_speed() const noexcept {
  double fastest = kTurnSpeed * (kArmRadius + 0.05);
  for (const Stretch& stretch : stretches_) {
    if (stretch.action != Action::kWalk) continue;
    const double metres = stretch.length_s * speed_;
    const double swings = std::max(1.0, std::floor(kStepsPerMetre * metres));
    const double rate = 2.0 * pi * swings / stretch.length_s * kStride;
    for (const Hanging& limb : kLimbs)
      fastest = std::max(fastest, speed_ + (limb.stride != 0.0 ? rate * length_of(limb) : 0.0));
  }
  for (const Hanging& limb : kLimbs)
    if (limb.reach != 0.0) fastest = std::max(fastest, kReachSpeed * length_of(limb));
  return fastest;
}

}  // namespace clearance
