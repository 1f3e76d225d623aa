#include "tools/bench/suite/cases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <variant>

#include "core/shapes.hpp"
#include "tools/bench/bodies.hpp"

namespace clearance::bench {
namespace {

using Real = long double;
using RealVec = Eigen::Matrix<Real, 3, 1>;

constexpr double kOutside[] = {0.0, 1e-6, 1e-3, 0.1, 1.0, 10.0};
constexpr double kInside[] = {-1e-6, -1e-3, -0.03, -0.3};

Body made(ShapeResult shape) {
  return std::make_shared<const ConvexBody>(std::get<ConvexBody>(std::move(shape)));
}

double size_of(const ConvexBody& body) { return body.bounding_radius + body.radius; }

SuiteCase empty_case(const std::string& kind, double separation, Body a, Body b) {
  const double size = std::max(size_of(*a), size_of(*b));
  return {kind, separation, {std::move(a), std::move(b), {}}, {}, size};
}

// Makes a pose from the rounded rows of a rotation matrix.
Pose reported_pose(const Vec3& position, const Vec3& x, const Vec3& y, const Vec3& z) {
  Mat3 rows;
  rows << x.transpose(), y.transpose(), z.transpose();
  return {position, Eigen::Quaterniond(rows).normalized()};
}

// Pairs from reports of wrong answers in the tracker of a library: sizes in m, poses in the world.
// A pair that touches begins 0.1 m apart, since it has no certain normal.
Trajectory fcl_493() {
  const Vec3 x{0.94096063217417758, 0.29296840037289501, 0.16959541586174812},
      y{-0.23569836841299879, 0.92661523595848427, -0.29296840037289507},
      z{-0.2429801799032639, 0.23569836841299885, 0.94096063217417758};
  const Body cube = made(box({0.125, 0.125, 0.125}));
  const Vec3 b{0.0, 0.0, 1.25}, a{0.073242100093223821, 0.23165380898962123, 1.3089245921032497};
  return {cube, cube, {{reported_pose(a + 0.4 * (a - b), x, y, z), reported_pose(b, x, y, z)}}};
}
Trajectory coal_604() {
  return {made(box({0.1815, 0.1385, 0.1815})),
          made(box({0.1815, 0.1815, 0.1385})),
          {{reported_pose({1.503354966, -0.8531707835, 0.7700092418},
                          {0.9999195703, 0.01021849413, 0.007512347878},
                          {-0.01021878248, 0.9999477869, -3.329855922e-17},
                          {-0.007511955635, -7.676704888e-05, 0.9999717819}),
            reported_pose({1.48838308, -1.102020834, 0.4497073799},
                          {0.9998670967, -0.01297708324, 0.009868343982},
                          {0.01297771517, 0.9999157859, 5.255670031e-17},
                          {-0.009867512928, 0.0001280685574, 0.9999513067})}}};
}
Trajectory mujoco_1857() {
  return {made(segment({0.0, 0.0, -0.05}, {0.0, 0.0, 0.05}, 0.01)),
          made(cylinder(0.2, 0.005)),
          {{Pose{{-0.1, 0.0, 0.0}, Eigen::Quaterniond::Identity()},
            Pose{{0.0, 0.0, 0.1}, Eigen::Quaterniond::Identity()}}}};
}

struct Ride {
  const char *kind, *load;
  bool rounded;                        // both bodies are points or segments with a radius
  Trajectory (*reported)() = nullptr;  // its first pose, in place of a load
};
constexpr Ride kRides[] = {
    {"boxes", "boxes", false},
    {"links, 24 vertices", "links24", false},
    {"links, 48 vertices", "links", false},
    {"links, 400 vertices", "links400", false},
    {"spheres", "sphere-sphere", true},
    {"capsules", "capsule-capsule", true},
    {"ellipsoids", "ellipsoid-ellipsoid", false},
    {"cylinders", "cylinder-cylinder", false},
    {"cones", "cone-cone", false},
    {"cylinder and box", "cylinder-box", false},
    {"ellipsoid and link", "ellipsoid-link", false},
    {"link and capsule", "link-capsule", false},
    {"FCL 493, boxes", "", false, fcl_493},
    {"Coal 604, boxes", "", false, coal_604},
    {"MuJoCo 1857, capsule and disc", "", false, mujoco_1857},
};

// A reported pair slides on by 1e-5 m a step.
std::vector<Trajectory> motions_of(const Ride& ride) {
  if (ride.reported == nullptr) return trajectories(ride.load);
  Trajectory motion = ride.reported();
  const auto [a, b] = motion.poses.front();
  for (int k = 1; k < kTrajectorySteps; ++k)
    motion.poses.push_back({a, {b.position + 1e-5 * k * Vec3(0.6, 0.8, 0.0), b.orientation}});
  return {motion};
}

void ride(const Ride& ride, int motions, int steps, std::vector<SuiteCase>& into) {
  const std::vector<Trajectory> all = motions_of(ride);
  for (int i = 0; i < std::min(motions, static_cast<int>(all.size())); ++i) {
    const Trajectory& t = all[static_cast<std::size_t>(i)];
    TrueDistance pair(*t.a, *t.b);
    std::vector<Truth> truth;
    for (int k = 0; k < steps; ++k) {
      const auto& [a, b] = t.poses[static_cast<std::size_t>(k)];
      truth.push_back(pair.at(a, b));
    }
    const auto add = [&](double separation) {
      SuiteCase c = empty_case(ride.kind, separation, t.a, t.b);
      for (std::size_t k = 0; k < truth.size(); ++k) {
        auto [a, b] = t.poses[k];
        b.position += (separation - truth[k].distance) * truth[k].normal;
        c.motion.poses.emplace_back(a, b);
        c.exact.push_back(separation);
      }
      into.push_back(std::move(c));
    };
    for (const double separation : kOutside) add(separation);
    for (const double separation : kInside) {
      if (ride.rounded && -separation < 0.5 * (t.a->radius + t.b->radius)) add(separation);
    }
  }
}

// A and B in a frame that stands in the world. Every second motion has the world's frame.
struct Frame {
  Pose world;
  Frame(int motion, Random& random) {
    const Eigen::Quaterniond turned = random.turn().normalized();
    if (motion % 2 == 1) world = {random.direction(), turned};
  }
  void add(SuiteCase& c, const Vec3& b, const Eigen::Quaterniond& b_turn, double exact) const {
    const Pose placed{world.position + world.orientation * b,
                      (world.orientation * b_turn).normalized()};
    c.motion.poses.emplace_back(world, placed);
    c.exact.push_back(exact);
  }
};

// The signed distance of two boxes of one orientation, the centre of B at `c`.
double level_distance(const Vec3& half_a, const Vec3& half_b, const Vec3& c) {
  Real most = -std::numeric_limits<Real>::infinity(), squared = 0.0L;
  for (int i = 0; i < 3; ++i) {
    const Real apart = std::abs(static_cast<Real>(c[i])) - half_a[i] - half_b[i];
    most = std::max(most, apart);
    squared += apart > 0.0L ? apart * apart : 0.0L;
  }
  return static_cast<double>(most > 0.0L ? std::sqrt(squared) : most);
}

Vec3 random_half(Random& random) {
  const double x = random.uniform(0.05, 0.5), y = random.uniform(0.05, 0.5);
  return {x, y, random.uniform(0.05, 0.5)};
}

// -1 to 1 over the motion.
double along(int k, int steps) { return 2.0 * (k + 0.5) / steps - 1.0; }

Eigen::Quaterniond about(const Vec3& axis, double angle) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis));
}

// B slides above A, from beyond one edge of its top to beyond the opposite one. It goes across the
// top, with two side faces in one plane, or beside the top with an edge above an edge.
enum class Lane : std::uint8_t { kAcross, kFlush, kBeside };
template <Lane lane>
SuiteCase slide(double separation, int motion, int steps, Random& random) {
  const char* const kind = lane == Lane::kAcross  ? "level, sliding"
                           : lane == Lane::kFlush ? "level, flush"
                                                  : "level, edge over edge";
  const Vec3 half_a = random_half(random), half_b = random_half(random);
  SuiteCase c = empty_case(kind, separation, made(box(half_a)), made(box(half_b)));
  const Frame frame(motion, random);
  const double both = half_a.x() + half_b.x();
  const double across = lane == Lane::kAcross ? random.uniform(-0.8, 0.8) * both : 0.0;
  for (int k = 0; k < steps; ++k) {
    const double s = 1.1 * along(k, steps);
    const double x = lane == Lane::kAcross  ? s * across
                     : lane == Lane::kFlush ? half_a.x() - half_b.x()
                                            : both;
    const Vec3 centre{x, s * (half_a.y() + half_b.y()), half_a.z() + half_b.z() + separation};
    frame.add(c, centre, Eigen::Quaterniond::Identity(), level_distance(half_a, half_b, centre));
  }
  return c;
}

// B turns about the vertical through its centre, which is above A.
SuiteCase spin(double separation, int motion, int steps, Random& random) {
  const Vec3 half_a = random_half(random), half_b = random_half(random);
  SuiteCase c = empty_case("level, spinning", separation, made(box(half_a)), made(box(half_b)));
  const Frame frame(motion, random);
  const Vec3 centre{random.uniform(-0.9, 0.9) * half_a.x(), random.uniform(-0.9, 0.9) * half_a.y(),
                    half_a.z() + half_b.z() + separation};
  for (int k = 0; k < steps; ++k) {
    frame.add(c, centre, about(Vec3::UnitZ(), 0.01 * k), separation);
  }
  return c;
}

// B turns about the vertical through a corner of its own, which is above a corner of A.
SuiteCase spin_at_corner(double separation, int motion, int steps, Random& random) {
  const Vec3 half_a = random_half(random), half_b = random_half(random);
  SuiteCase c =
      empty_case("level, corner over corner", separation, made(box(half_a)), made(box(half_b)));
  const Frame frame(motion, random);
  for (int k = 0; k < steps; ++k) {
    const Eigen::Quaterniond turn = about(Vec3::UnitZ(), 0.02 * k);
    const Vec3 corner{half_a.x(), half_a.y(), half_a.z() + separation};
    frame.add(c, corner + turn * half_b, turn, separation);
  }
  return c;
}

// A cylinder above a box: upright and sliding, or lying and rolling.
SuiteCase can(double separation, int motion, int steps, Random& random) {
  const Vec3 half = random_half(random);
  const double radius = random.uniform(0.02, 0.2), length = random.uniform(0.05, 0.2);
  SuiteCase c =
      empty_case("level, cans", separation, made(box(half)), made(cylinder(radius, length)));
  const Frame frame(motion, random);
  const bool lying = motion % 4 >= 2;
  for (int k = 0; k < steps; ++k) {
    const double s = 0.9 * along(k, steps);
    const Vec3 centre{0.3 * s * half.x(), s * half.y(),
                      half.z() + separation + (lying ? radius : length)};
    frame.add(c, centre, about(Vec3::UnitY(), lying ? 0.5 * std::numbers::pi : 0.0), separation);
  }
  return c;
}

// The largest height of a body above its own origin along `up`, which is in its frame.
Real highest(const ConvexBody& body, const RealVec& up) {
  const CurvedShape& shape = body.curved;
  if (shape.kind == CurvedShape::Kind::kEllipsoid) {
    return shape.semi_axes.cast<Real>().cwiseProduct(up).norm();
  }
  Real most = -std::numeric_limits<Real>::infinity();
  if (shape.kind == CurvedShape::Kind::kTruncatedCone) {
    for (const Disc& disc : shape.discs) {
      most = std::max(most, disc.height * up.z() + disc.radius * std::hypot(up.x(), up.y()));
    }
  }
  for (const Vertex& v : body.vertices) most = std::max(most, up.dot(v.position.cast<Real>()));
  return most + body.radius;
}

// The depth of the lowest point of a turned body below its origin, m.
double lowest(const ConvexBody& body, const Eigen::Quaterniond& turn) {
  const Eigen::Quaternion<Real> exact = turn.cast<Real>().normalized();
  return static_cast<double>(highest(body, exact.conjugate() * RealVec(0.0L, 0.0L, -1.0L)));
}

SuiteCase graze(double separation, int motion, int steps, Random& random) {
  const Vec3 half_b = random_half(random);
  const Vec3 half_a = half_b + Vec3(1.0, 1.0, 0.0);
  SuiteCase c = empty_case("grazing", separation, made(box(half_a)), made(box(half_b)));
  const Frame frame(motion, random);
  // Tilted about one axis, so that an edge is lowest, or also about the other one.
  const double tilt = std::pow(10.0, random.uniform(-12.0, -1.0));
  const double other = motion % 4 >= 2 ? random.uniform(0.1, 1.0) * tilt : 0.0;
  for (int k = 0; k < steps; ++k) {
    const Eigen::Quaterniond turn =
        (about(Vec3::UnitX(), tilt) * about(Vec3::UnitY(), other)).normalized();
    const double s = 0.3 * along(k, steps);
    frame.add(c, {0.5 * s, s, half_a.z() + separation + lowest(*c.motion.b, turn)}, turn,
              separation);
  }
  return c;
}

SuiteCase sink(double separation, int motion, int steps, Random& random) {
  const double x = random.uniform(0.05, 0.25), y = random.uniform(0.05, 0.25);
  const std::array<Body, 6> bodies{
      made(box(random_half(random))), std::make_shared<const ConvexBody>(random_link(random)),
      made(cylinder(x, y)),           made(cone(x, y)),
      made(ellipsoid({x, y, 0.1})),   made(segment({0.0, 0.0, -0.2}, {0.0, 0.0, 0.2}, x))};
  const Vec3 half{5.0, 5.0, 0.5};
  SuiteCase c = empty_case("deep", separation, made(box(half)),
                           bodies[static_cast<std::size_t>(motion) % bodies.size()]);
  const Frame frame(motion, random);
  const Eigen::Quaterniond start = random.turn();
  const Vec3 axis = random.direction();
  for (int k = 0; k < steps; ++k) {
    const Eigen::Quaterniond turn = (about(axis, 0.005 * k) * start).normalized();
    frame.add(c, {0.2 * along(k, steps), 0.0, half.z() + separation + lowest(*c.motion.b, turn)},
              turn, separation);
  }
  return c;
}

struct Stand {
  const char* kind;
  SuiteCase (*make)(double separation, int motion, int steps, Random& random);
  bool outside, inside;  // the separations
};
constexpr Stand kStands[] = {
    {"level, sliding", slide<Lane::kAcross>, true, true},
    {"level, flush", slide<Lane::kFlush>, true, false},
    {"level, edge over edge", slide<Lane::kBeside>, true, false},
    {"level, spinning", spin, true, false},
    {"level, corner over corner", spin_at_corner, true, false},
    {"level, cans", can, true, false},
    {"grazing", graze, true, false},
    {"deep", sink, false, true},
};

}  // namespace

std::vector<std::string> suite_kinds() {
  std::vector<std::string> kinds;
  for (const Ride& ride : kRides) kinds.emplace_back(ride.kind);
  for (const Stand& stand : kStands) kinds.emplace_back(stand.kind);
  return kinds;
}

std::vector<SuiteCase> suite_cases(const std::string& kind, int motions, int steps) {
  std::vector<SuiteCase> cases;
  for (const Ride& r : kRides) {
    if (kind == r.kind) ride(r, motions, steps, cases);
  }
  for (const Stand& stand : kStands) {
    if (kind != stand.kind) continue;
    Random random(7);
    for (int motion = 0; motion < motions; ++motion) {
      const auto add = [&](double s) { cases.push_back(stand.make(s, motion, steps, random)); };
      if (stand.outside) std::ranges::for_each(kOutside, add);
      if (stand.inside) std::ranges::for_each(kInside, add);
    }
  }
  if (cases.empty()) throw std::invalid_argument(fmt::format("the suite has no class '{}'", kind));
  return cases;
}

}  // namespace clearance::bench
