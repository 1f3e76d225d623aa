#include "tools/bench/workload.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>

#include "core/shapes.hpp"
#include "tools/bench/bodies.hpp"
#include "tools/bench/crossed_ellipsoids.hpp"
#include "tools/bench/overlaps.hpp"

namespace clearance::bench {
namespace {

constexpr int kTrajectories = 40;

struct Drift {
  double step, turn;  // m, rad, of each body at each step
};
constexpr Drift kBallDrift{0.02, 0.01};
constexpr Drift kLinkDrift{0.002, 0.005};

Eigen::Quaterniond turn(const Vec3& axis, double angle) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis));
}

// Uniform steps along a line and about an axis.
std::vector<Pose> drift(Random& random, const Vec3& middle, const Drift& by) {
  const Vec3 along = random.direction(), axis = random.direction();
  const Eigen::Quaterniond start = random.turn();
  std::vector<Pose> poses;
  for (int k = 0; k < kTrajectorySteps; ++k) {
    const Vec3 position = middle + by.step * (k - kTrajectorySteps / 2) * along;
    poses.push_back({position, (turn(axis, by.turn * k) * start).normalized()});
  }
  return poses;
}

double closest_centres(const std::vector<Pose>& a, const std::vector<Pose>& b) {
  double least = kInfinity;
  for (std::size_t k = 0; k < a.size(); ++k) {
    least = std::min(least, (a[k].position - b[k].position).norm());
  }
  return least;
}

// Trajectories of two bodies. The least distance of their centres is from `nearest` to `farthest`.
std::vector<std::pair<Pose, Pose>> pass(Random& random, const Drift& by, double nearest,
                                        double farthest) {
  for (;;) {
    const std::vector<Pose> a = drift(random, Vec3::Zero(), by);
    const Vec3 direction = random.direction();
    const std::vector<Pose> b = drift(random, random.uniform(nearest, farthest) * direction, by);
    if (closest_centres(a, b) < nearest) continue;
    std::vector<std::pair<Pose, Pose>> poses;
    for (int k = 0; k < kTrajectorySteps; ++k) poses.emplace_back(a[k], b[k]);
    return poses;
  }
}

std::vector<Trajectory> balls(char kind, int order) {
  const auto body = std::make_shared<const ConvexBody>(ball(kind, order));
  Random random(1);
  std::vector<Trajectory> all;
  for (int i = 0; i < kTrajectories; ++i) {
    all.push_back({body, body, pass(random, kBallDrift, 2.6, 7.0)});
  }
  return all;
}

template <int kAround>
ConvexBody link_of(Random& random) {
  return random_link(random, kAround);
}

std::vector<Trajectory> passing(ConvexBody (*make)(Random&), const Drift& by, double nearest,
                                double farthest) {
  Random random(2);
  std::vector<Trajectory> all;
  for (int i = 0; i < kTrajectories; ++i) {
    const auto a = std::make_shared<const ConvexBody>(make(random));
    const auto b = std::make_shared<const ConvexBody>(make(random));
    all.push_back({a, b, pass(random, by, nearest, farthest)});
  }
  return all;
}

// B slides across the face of A at a constant distance, from outside one edge to outside the
// opposite edge.
std::vector<Trajectory> sliding_boxes() {
  Random random(3);
  std::vector<Trajectory> all;
  for (int i = 0; i < kTrajectories; ++i) {
    const auto a = std::make_shared<const ConvexBody>(random_box(random));
    const auto b = std::make_shared<const ConvexBody>(random_box(random));
    const Eigen::Quaterniond both =
        i % 2 == 0 ? Eigen::Quaterniond::Identity() : random.turn().normalized();
    const int across = i % 3;
    Vec3 direction = random.direction();
    direction[across] = 0.0;
    const double apart = a->bounding_radius + b->bounding_radius + random.uniform(0.0, 0.5);
    Trajectory t{a, b, {}};
    for (int k = 0; k < kTrajectorySteps; ++k) {
      Vec3 centre = 0.02 * (k - kTrajectorySteps / 2) * direction;
      centre[across] = apart;
      t.poses.push_back({{Vec3::Zero(), both}, {both * centre, both}});
    }
    all.push_back(std::move(t));
  }
  return all;
}

constexpr int kCurvedKinds = 4;  // of kKinds, the first ones

ConvexBody body_of_kind(const std::string& kind, Random& random) {
  const auto length = [&] { return random.uniform(0.05, 0.25); };
  const auto made = [](ShapeResult shape) { return std::get<ConvexBody>(std::move(shape)); };
  if (kind == "box") return random_box(random);
  if (kind == "link") return random_link(random);
  const double x = length(), y = length(), z = length();
  if (kind == "ellipsoid") return made(ellipsoid({x, y, z}));
  if (kind == "cylinder") return made(cylinder(x, y));
  if (kind == "cone") return made(cone(x, y));
  if (kind == "truncated_cone") return made(truncated_cone(x, z, y));
  if (kind == "rounded_box")
    return made(rounded_by(0.5 * x, made(box({0.5 * x, 0.5 * y, 0.5 * z}))));
  if (kind == "capsule") return made(segment({0, 0, -y}, {0, 0, y}, x));
  if (kind == "sphere") return made(point(Vec3::Zero(), x));
  throw std::invalid_argument(fmt::format("there is no kind of body named '{}'", kind));
}

std::vector<Trajectory> passing_kinds(const std::string& kind_a, const std::string& kind_b) {
  Random random(5);
  std::vector<Trajectory> all;
  for (int i = 0; i < kTrajectories; ++i) {
    const auto a = std::make_shared<const ConvexBody>(body_of_kind(kind_a, random));
    const auto b = std::make_shared<const ConvexBody>(body_of_kind(kind_b, random));
    const double size = a->bounding_radius + a->radius + b->bounding_radius + b->radius;
    all.push_back({a, b, pass(random, kLinkDrift, size + 0.01, size + 1.0)});
  }
  return all;
}

std::vector<Trajectory> crossed(double separation) {
  const EllipsoidPair pair = crossed_pair(separation);
  const auto made = [](const Vec3& axes) {
    return std::make_shared<const ConvexBody>(std::get<ConvexBody>(ellipsoid(axes)));
  };
  return {{made(pair.axes_a), made(pair.axes_b), {{Pose{}, Pose{pair.apart}}}}};
}

}  // namespace

std::vector<Trajectory> trajectories(const std::string& name) {
  if (name.starts_with("crossed/")) return crossed(std::stod(name.substr(8)));
  if (const std::size_t dash = name.find('-');
      dash != std::string::npos && !name.ends_with("boxes")) {
    return passing_kinds(name.substr(0, dash), name.substr(dash + 1));
  }
  if (name == "boxes") return passing(random_box, kBallDrift, 0.8, 2.0);
  if (name == "parallel-boxes") return sliding_boxes();
  if (name == "links") return passing(link_of<12>, kLinkDrift, 0.5, 1.5);
  if (name == "links24") return passing(link_of<6>, kLinkDrift, 0.5, 1.5);
  if (name == "links400") return passing(link_of<100>, kLinkDrift, 0.5, 1.5);
  for (const int order : kOrders) {
    if (name.substr(1) != std::to_string(order)) continue;
    if (name[0] == 'f' || name[0] == 'v') return balls(name[0], order);
  }
  for (const char* kind : kOverlapKinds) {
    for (const OverlapDepth& depth : kOverlapDepths) {
      if (name == fmt::format("{}/{}", kind, depth.name)) return overlapping(kind, depth);
    }
  }
  throw std::invalid_argument(fmt::format("there is no workload named '{}'", name));
}

std::size_t Workload::queries() const {
  std::size_t sum = 0;
  for (const Trajectory& t : trajectories) sum += t.poses.size();
  return sum;
}

const Workload& workload(const std::string& name) {
  static std::map<std::string, Workload> made;
  if (const auto found = made.find(name); found != made.end()) return found->second;
  Workload w{name, trajectories(name), {}};
  for (const Trajectory& t : w.trajectories) {
    TrueDistance pair(*t.a, *t.b);
    std::vector<Truth>& truth = w.truth.emplace_back();
    for (const auto& [a, b] : t.poses) truth.push_back(pair.at(a, b));
  }
  return made.emplace(name, std::move(w)).first->second;
}

std::vector<std::string> workload_names() {
  std::vector<std::string> names;
  for (const char kind : {'f', 'v'}) {
    for (const int order : kOrders) names.push_back(fmt::format("{}{}", kind, order));
  }
  names.insert(names.end(), {"boxes", "parallel-boxes", "links"});
  return names;
}

std::string KindPair::group() const {
  const auto* const end = std::begin(kKinds) + kCurvedKinds;
  const bool curved = std::find(std::begin(kKinds), end, a) != end;  // B's come no earlier
  return curved ? "curved" : "pair";
}

std::vector<KindPair> kind_pairs() {
  std::vector<KindPair> pairs;
  for (const auto* a = std::begin(kKinds); a != std::end(kKinds); ++a) {
    for (const auto* b = a; b != std::end(kKinds); ++b) pairs.push_back({*a, *b});
  }
  return pairs;
}

}  // namespace clearance::bench
