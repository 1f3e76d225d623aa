#include <cmath>
#include <cstdio>
#include <numbers>
#include <sstream>

#include "tests/shared/exact_oracle.hpp"
#include "tests/shared/hard_cases.hpp"
#include "tests/shared/poses.hpp"
#include "tests/shared/sharp_cases.hpp"

namespace clearance::hard {
namespace {

using Quat = Eigen::Quaterniond;

HardMotion pair_of(Random& random, const char* note) {
  return {note, any_bounded(random), any_bounded(random), {}};
}

Pose pose_at(const Vec3& position, const Quat& orientation = {1, 0, 0, 0}) {
  return {position, orientation};
}

// B passes A on a straight line while both rotate slowly.
HardMotion flyby(Random& random, int steps) {
  HardMotion m = pair_of(random, "flyby");
  const double reach = extent(m.a) + extent(m.b);
  const Vec3 direction = random.direction(), axis_a = random.direction(),
             axis_b = random.direction();
  const Vec3 across = direction.cross(random.direction());
  const Vec3 beside = across * reach * random.uniform(0.5, 3.0);
  for (int k = 0; k < steps; ++k) {
    const double t = 2.0 * k / steps - 1.0;
    m.poses.emplace_back(
        pose_at(Vec3::Zero(), test::turned(axis_a, t)),
        pose_at(beside + direction * (4 * reach * t), test::turned(axis_b, 2 * t)));
  }
  return m;
}

// The body rotates by half a radian per step.
HardMotion spin(Random& random, int steps) {
  HardMotion m = pair_of(random, "spin");
  const Vec3 axis = random.direction();
  const Vec3 at = random.direction() * (extent(m.a) + extent(m.b)) * 2.0;
  for (int k = 0; k < steps; ++k) {
    m.poses.emplace_back(pose_at(Vec3::Zero(), test::turned(axis, 0.5 * k)),
                         pose_at(at, test::turned(axis, -0.37 * k)));
  }
  return m;
}

// Every fifth step moves B to any place, sometimes very far away or deep inside. The steps between
// are small.
HardMotion teleport(Random& random, int steps) {
  HardMotion m = pair_of(random, "teleport");
  const double reach = extent(m.a) + extent(m.b);
  Pose a, b;
  for (int k = 0; k < steps; ++k) {
    if (k % 5 == 0) {
      b.position = random.direction() * reach;
      b.position *= random.chance(0.2) ? 1e6 : random.chance(0.2) ? 0.01 : random.uniform(0.5, 3.0);
      b.orientation = random.rotation();
      a.orientation = random.rotation();
    }
    b.position += random.in_box(1e-3 * reach);
    m.poses.emplace_back(a, b);
  }
  return m;
}

// Boxes with parallel faces slide over each other, are flush at times, and are tilted towards the
// end.
HardMotion slide(Random& random, int steps) {
  const Vec3 half = Vec3::Constant(0.2) + random.in_box(0.5).cwiseAbs();
  HardMotion m{"slide", box(half), box(Vec3::Constant(0.25)), {}};
  const Quat world = random.chance(0.5) ? random.rotation() : Quat(1, 0, 0, 0);
  const double gap = random.chance(0.3) ? 0.0 : random.log_uniform(1e-15, 0.1);
  for (int k = 0; k < steps; ++k) {
    const double t = 4.0 * k / steps - 2.0;
    const double tilt = k > steps / 2 ? 1e-12 * (k - steps / 2) : 0.0;
    const Vec3 at(t * (half.x() + 0.25), 0.25 * t, half.z() + 0.25 + gap);
    m.poses.emplace_back(pose_at(Vec3::Zero(), world),
                         pose_at(world * at, world * test::turned(Vec3::UnitY(), tilt)));
  }
  return m;
}

// The motion rests for long, moves by the last bits, and continues.
HardMotion stationary(Random& random, int steps) {
  HardMotion m = pair_of(random, "stationary");
  const double reach = extent(m.a) + extent(m.b);
  Pose a, b;
  b.position = random.direction() * reach * 1.5;
  b.orientation = random.rotation();
  for (int k = 0; k < steps; ++k) {
    const int phase = k * 6 / steps;
    if (phase % 3 == 1) b.position += random.in_box(1e-16 * reach);
    if (phase % 3 == 2) b.position += random.in_box(0.05 * reach);
    m.poses.emplace_back(a, b);
  }
  return m;
}

// The bodies move into contact, through each other, and out again.
HardMotion through(Random& random, int steps) {
  HardMotion m = pair_of(random, "through");
  const double reach = 1.2 * (extent(m.a) + extent(m.b));
  const Vec3 direction = random.direction(), axis = random.direction();
  const Quat turn = random.rotation();
  for (int k = 0; k < steps; ++k) {
    const double t = 2.0 * k / steps - 1.0;
    m.poses.emplace_back(pose_at(Vec3::Zero(), turn),
                         pose_at(direction * (reach * t), test::turned(axis, 0.3 * t)));
  }
  return m;
}

// The gap falls to the last bits of a double and grows again.
HardMotion graze(Random& random, int steps) {
  HardCase start{"", any_bounded(random), any_bounded(random), {}, {}};
  start.pose_a.orientation = random.rotation();
  start.pose_b.orientation = random.rotation();
  start.pose_b.position = random.direction() * 2.0 * (extent(start.a) + extent(start.b));
  const Vec3 apart = start.pose_b.position;
  set_gap(start, 0.0);
  const Vec3 direction = (apart - start.pose_b.position).normalized();
  HardMotion m{"graze", start.a, start.b, {}};
  for (int k = 0; k < steps; ++k) {
    const double t = 2.0 * k / steps - 1.0;
    const double gap = std::pow(10.0, -16.0 + 15.0 * std::abs(t));
    Pose b = start.pose_b;
    b.position += direction * gap;
    m.poses.emplace_back(start.pose_a, b);
  }
  return m;
}

// Tips roll over each other, so that many facets become active one after another.
HardMotion roll(Random& random, int steps) {
  const int sides = random.integer(6, 40);
  HardMotion m{"roll", cone(sides, random.log_uniform(0.1, 1.5), 1.0), Body{}, {}};
  m.b = random.chance(0.5) ? box(Vec3(2, 2, 0.5)) : rounded(random);
  for (int k = 0; k < steps; ++k) {
    const double angle = 2 * std::numbers::pi * k / steps;
    const Quat lean = test::turned(Vec3(std::cos(angle), std::sin(angle), 0), 0.8);
    m.poses.emplace_back(pose_at(Vec3::Zero(), lean), pose_at(Vec3(0, 0, 2.5)));
  }
  return m;
}

constexpr MotionFamily kMotionFamilies[] = {{"flyby", flyby},
                                            {"spin", spin},
                                            {"teleport", teleport},
                                            {"slide", slide},
                                            {"stationary", stationary},
                                            {"through", through},
                                            {"graze", graze},
                                            {"roll", roll},
                                            {"past_corners", past_corners}};

std::string number(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}

template <class List, class Print>
std::string json_list(const List& list, Print print) {
  std::string out = "[";
  for (const auto& item : list) {
    if (out.size() > 1) out += ',';
    out += print(item);
  }
  out += ']';
  return out;
}

std::string json(const Vec3& v) { return json_list(v, number); }

std::string json(const Pose& pose) {
  const Vec3& p = pose.position;
  const Quat& q = pose.orientation;
  const double turn[] = {q.x(), q.y(), q.z(), q.w()};
  return R"({"xyz":)" + json(p) + R"(,"quaternion":)" + json_list(turn, number) + '}';
}

std::string json(const Body& body) {
  const auto row = [](const HalfSpace& r) {
    const double all[] = {r.normal.x(), r.normal.y(), r.normal.z(), r.offset};
    return json_list(all, number);
  };
  std::ostringstream out;
  out << R"({"halfspaces":)" << (body.rows.empty() ? "null" : json_list(body.rows, row))
      << R"(,"vertices":)"
      << (body.points.empty() ? "null"
                              : json_list(body.points, [](const Vec3& p) { return json(p); }))
      << R"(,"radius":)" << number(body.radius) << '}';
  return out.str();
}

std::string json_head(const std::string& id, const std::string& family, const std::string& note,
                      const Body& a, const Body& b) {
  std::ostringstream out;
  out << R"({"id":")" << id << R"(","family":")" << family << R"(","note":")" << note << R"(","a":)"
      << json(a) << R"(,"b":)" << json(b);
  return out.str();
}

}  // namespace

std::span<const MotionFamily> motion_families() { return kMotionFamilies; }

std::string json_line(const std::string& id, const std::string& family, const HardCase& c) {
  std::ostringstream out;
  out << json_head(id, family, c.note, c.a, c.b) << R"(,"pose_a":)" << json(c.pose_a)
      << R"(,"pose_b":)" << json(c.pose_b) << '}';
  return out.str();
}

std::string json_line(const std::string& id, const std::string& family, const HardMotion& m) {
  const auto step = [](const std::pair<Pose, Pose>& poses) {
    const Pose both[] = {poses.first, poses.second};
    return json_list(both, [](const Pose& pose) { return json(pose); });
  };
  std::ostringstream out;
  out << json_head(id, family, m.note, m.a, m.b) << R"(,"poses":)" << json_list(m.poses, step)
      << '}';
  return out.str();
}

}  // namespace clearance::hard
