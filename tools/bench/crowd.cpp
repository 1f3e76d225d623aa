#include "tools/bench/crowd.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <utility>
#include <variant>

#include "config/cell/cell_file.hpp"
#include "config/cell/simulation.hpp"
#include "config/write/warehouse_cell.hpp"
#include "core/shapes.hpp"
#include "monitor/app/program.hpp"
#include "tools/bench/bodies.hpp"
#include "tools/bench/random.hpp"

namespace clearance::bench {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kOrbit = 0.18;  // m
constexpr double kSpin = 2.0;    // rad/s for each m/s

ConvexBody made(ShapeResult result) { return std::get<ConvexBody>(std::move(result)); }

ConvexBody facet_ball(double radius, int order = 6) {
  std::vector<HalfSpace> rows;
  // A facet-ball of order 6 or more has its vertices within 1.2 of its inradius.
  for (const Vec3& d : even_directions(order)) rows.push_back({d, radius / 1.2});
  return made(polyhedron_from_halfspaces(rows));
}

// One of four kinds of bodies, inside a sphere of `radius`.
ConvexBody body(std::uint32_t kind, double radius, Random& draw) {
  switch (kind % 4) {
    case 0: {
      const Vec3 d(draw.uniform(0.3, 1.0), draw.uniform(0.3, 1.0), draw.uniform(0.3, 1.0));
      return made(box(radius * d.normalized()));
    }
    case 1:
      return facet_ball(radius);
    case 2: {
      const double half = 0.7 * radius;
      return made(segment(Vec3(-half, 0, 0), Vec3(half, 0, 0), radius - half));
    }
    default: {
      std::array<Vec3, 4> corners;
      for (Vec3& c : corners) c = radius * draw.direction();
      const ShapeResult hull = polyhedron_from_vertices(corners);
      return std::holds_alternative<ConvexBody>(hull) ? made(hull) : facet_ball(radius);
    }
  }
}

Object object_of(const std::string& name, ConvexBody shape) {
  Object object;
  object.name = name;
  object.parts.push_back({name, std::move(shape), {}});
  object.age_limit_ns = 20'000'000;
  object.max_speed = 2.0;
  return object;
}

std::uint32_t grid_side(std::uint32_t count) {
  auto side = static_cast<std::uint32_t>(std::cbrt(count));
  while (side * side * side < count) ++side;
  return side;
}

Crowd crowd_of(std::string name, Cell cell) {
  Crowd crowd;
  crowd.name = std::move(name);
  crowd.scene = std::move(cell.scene);
  crowd.simulation = std::move(cell.simulation);
  return crowd;
}

}  // namespace

void Crowd::samples_at(double t_s, std::int64_t stamp_ns, std::vector<PoseSample>& samples) const {
  samples.clear();
  for (const Orbit& orbit : orbits) {
    const double angle = orbit.turn_rate * t_s;
    PoseSample s;
    s.object = orbit.object;
    s.stamp_ns = stamp_ns;
    s.world_from_object.position =
        orbit.centre + std::cos(angle) * orbit.across + std::sin(angle) * orbit.along;
    s.world_from_object.orientation =
        Eigen::Quaterniond(Eigen::AngleAxisd(orbit.spin_rate * t_s, orbit.spin_axis));
    s.twist.linear =
        orbit.turn_rate * (std::cos(angle) * orbit.along - std::sin(angle) * orbit.across);
    s.twist.angular = orbit.spin_rate * orbit.spin_axis;
    s.has_twist = true;
    samples.push_back(s);
  }
  if (simulation.empty()) return;
  std::vector<PoseAt> poses;
  poses_at(simulation, t_s, poses);
  for (const PoseAt& p : poses) {
    samples.push_back({.object = p.object,
                       .stamp_ns = stamp_ns,
                       .world_from_object = p.world_from_object,
                       .twist = p.twist,
                       .has_twist = true});
  }
}

Crowd orbiting_crowd(const OrbitingOptions& options) {
  const std::uint32_t count = options.count, moving = options.moving;
  Random draw(count);
  Crowd crowd;
  crowd.scene.name = crowd.name = fmt::format("{}_of_which_{}", count, moving);
  crowd.scene.revision = count;
  const std::uint32_t side = grid_side(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const double radius = draw.uniform(0.15, 0.28);
    crowd.scene.objects.push_back(
        object_of(fmt::format("body_{}", i),
                  options.order > 0 ? facet_ball(radius, options.order) : body(i, radius, draw)));
    crowd.scene.objects.back().max_speed *= std::max(1.0, options.speed);
    Crowd::Orbit orbit;
    orbit.object = i;
    orbit.centre = options.spacing * Vec3(i % side, i / side % side, i / side / side);
    const Eigen::Quaterniond plane = draw.turn();
    // Movers are spread evenly over the others.
    const bool moves = static_cast<std::uint64_t>(i) * moving / count !=
                       (static_cast<std::uint64_t>(i) + 1) * moving / count;
    orbit.across = kOrbit * (plane * Vec3::UnitX());
    orbit.along = kOrbit * (plane * Vec3::UnitY());
    orbit.turn_rate = moves ? options.speed / kOrbit : 0.0;
    orbit.spin_axis = draw.direction();
    orbit.spin_rate = moves ? kSpin * options.speed : 0.0;
    crowd.orbits.push_back(orbit);
  }
  for (std::uint32_t a = 0; a < count; ++a) {
    for (std::uint32_t b = a + 1; b < count; ++b) crowd.scene.pairs.push_back({a, b, false});
  }
  return crowd;
}

Crowd robot_in_crowd(std::uint32_t obstacles) {
  constexpr std::uint32_t kLinks = 20;
  constexpr double kLength = 0.14;  // m, of a link
  Random draw(obstacles);
  Crowd crowd;
  crowd.scene.name = crowd.name = fmt::format("robot_among_{}", obstacles);
  crowd.scene.revision = obstacles;
  SimulatedChain chain;
  chain.name = "arm";
  for (std::uint32_t i = 0; i < kLinks; ++i) {
    crowd.scene.objects.push_back(
        object_of(fmt::format("link_{}", i),
                  made(segment(Vec3(0, 0, 0.02), Vec3(0, 0, kLength - 0.02), 0.05))));
    SimulatedJoint joint;
    joint.objects = {i};
    if (i > 0) joint.parent_from_joint.position = Vec3(0, 0, kLength);
    joint.axis = i % 2 == 0 ? Vec3::UnitX() : Vec3::UnitY();
    joint.motion = {.centre = 0.05, .amplitude = 0.15, .frequency_hz = 0.4, .phase = 0.7 * i};
    chain.joints.push_back(joint);
  }
  crowd.simulation.chains.push_back(chain);
  for (std::uint32_t i = 0; i < obstacles; ++i) {
    Object object =
        object_of(fmt::format("obstacle_{}", i), body(i, draw.uniform(0.15, 0.28), draw));
    object.fixed = true;
    const double angle = draw.uniform(0.0, 2.0 * kPi), from_axis = draw.uniform(1.6, 4.0);
    object.world_from_object.position =
        Vec3(from_axis * std::cos(angle), from_axis * std::sin(angle), draw.uniform(-0.5, 3.5));
    object.world_from_object.orientation = draw.turn();
    crowd.scene.objects.push_back(std::move(object));
  }
  const auto count = static_cast<std::uint32_t>(crowd.scene.objects.size());
  for (std::uint32_t a = 0; a < kLinks; ++a) {
    for (std::uint32_t b = a + 1; b < count; ++b) {
      if (b >= kLinks || b > a + 2) crowd.scene.pairs.push_back({a, b, false});
    }
  }
  return crowd;
}

Crowd warehouse_crowd(std::uint32_t objects) {
  Cell cell = std::get<Cell>(parse_cell(warehouse_cell({.objects = objects}), "warehouse.yaml"));
  return crowd_of(cell.scene.name, std::move(cell));
}

Crowd shipped_crowd(const std::string& name) {
  const auto file = fmt::format("{}{}.yaml", CLEARANCE_CELLS "/", name);
  std::optional<Cell> cell = cell_or_errors(read_cell(file));
  if (!cell) {
    throw std::runtime_error(fmt::format(
        "rows of shipped cells read {}, the path at compile time; it is missing or wrong", file));
  }
  return crowd_of(name, *std::move(cell));
}

}  // namespace clearance::bench
