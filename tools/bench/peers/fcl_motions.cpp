// An arm of seven joints makes short straight motions in joint space among sheets, rods and boxes,
// as a planner's edges are. All methods get the same convex bodies and the same watched pairs.
//
//   certified  Asker with the margin 0, verdicts only
//   1 degree   postures at most one degree apart, each pair by fcl::collide
//   FCL, CA    fcl::continuousCollide by conservative advancement along a screw, from one posture
//              to the next one at most five degrees away: between them a link does not move as FCL
//              assumes, because it is moved by several joints
//
// The last two leave out pairs whose bounding spheres are apart for as long as the postures differ.
// The truth is the certified verdict, whose undecided motions are left out and counted.
#include "tools/bench/peers/fcl_motions.hpp"

#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/continuous_collision.h>

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "config/cell/cell_file.hpp"
#include "monitor/app/options.hpp"
#include "monitor/app/print.hpp"
#include "monitor/app/program.hpp"
#include "monitor/ask/asker.hpp"
#include "monitor/bodies/forward_kinematics.hpp"
#include "monitor/bodies/posed_part.hpp"
#include "tools/bench/clocks.hpp"
#include "tools/bench/peers/fcl_bodies.hpp"

namespace clearance::bench {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : engine_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }

 private:
  std::mt19937_64 engine_;
};

// Around an arm that stands at the origin: sheets of 2 mm, rods of 1 cm, boxes.
std::string cell_text(Draw& draw, int obstacles) {
  std::string text =
      "name: asked\nunits: {length: m, angle: rad}\nrobots:\n"
      "  - {name: arm, urdf: seven_joint_arm/arm.urdf, srdf: seven_joint_arm/arm.srdf}\nobjects:\n";
  for (int i = 0; i < obstacles; ++i) {
    const double angle = draw.between(-std::numbers::pi, std::numbers::pi);
    const double away = draw.between(0.35, 0.9);
    const std::string shape =
        i % 3 == 0   ? fmt::format("box: {{size: [{}, 0.002, {}]}}", draw.between(0.1, 0.4),
                                   draw.between(0.1, 0.4))
        : i % 3 == 1 ? fmt::format("cylinder: {{radius: 0.01, length: {}}}", draw.between(0.2, 0.8))
                     : fmt::format("box: {{size: [{}, {}, {}]}}", draw.between(0.03, 0.2),
                                   draw.between(0.03, 0.2), draw.between(0.03, 0.2));
    text += fmt::format(
        "  - {{name: o{}, fixed: true, groups: [around], {}, pose: {{xyz: [{}, {}, {}], rpy: [{}, "
        "{}, {}]}}}}\n",
        i, shape, away * std::cos(angle), away * std::sin(angle), draw.between(0.1, 1.2),
        draw.between(-1, 1), draw.between(-1, 1), draw.between(-3, 3));
  }
  return text + "pairs: [{between: [arm, around]}, {between: [arm, arm]}]\n";
}

// The bodies of the scene as FCL has them, and where they are at a posture.
class FclPostures {
 public:
  explicit FclPostures(const Scene& scene)
      : scene_(scene),
        parts_(parts_of(scene)),
        first_(first_parts(scene)),
        variables_(scene.variables.size()),
        bases_(scene.robots.size()),
        kinematics_(scene.robots) {
    for (const PosedPart& part : parts_) {
      std::visit([&](const auto& shape) { shapes_.push_back(shape); }, fcl_shape(*part.shape));
    }
    for (const ObjectPair& pair : scene.pairs) {
      for (std::uint32_t a = first_[pair.first]; a < first_[pair.first + 1]; ++a) {
        for (std::uint32_t b = first_[pair.second]; b < first_[pair.second + 1]; ++b)
          pairs_.push_back({a, b});
      }
    }
    for (TrackedVariable& variable : variables_) variable.input.has_value = true;
    for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
      if (scene.objects[i].fixed) put(i, scene.objects[i].world_from_object);
    }
  }

  void place(std::span<const double> positions) {
    for (std::size_t i = 0; i < positions.size(); ++i) variables_[i].position = positions[i];
    kinematics_.place(variables_, bases_);
    for (std::uint32_t r = 0; r < scene_.robots.size(); ++r) {
      for (std::size_t i = 0; i < scene_.robots[r].links.size(); ++i) {
        const std::uint32_t object = scene_.robots[r].links[i].object;
        if (object != RobotLink::kNoObject) put(object, kinematics_.links(r)[i].pose);
      }
    }
  }
  // The pairs whose bounding spheres may meet on the path here from `before`; empty: here. A screw
  // by less than a right angle takes a centre along an arc, which is at most 1.12 times as long as
  // its chord.
  template <class Use>
  bool any_pair(std::span<const Vec3> before, const Use& use) const {
    for (const auto& [a, b] : pairs_) {
      const Sphere &x = parts_[a].sphere_in_world, &y = parts_[b].sphere_in_world;
      const double moved =
          before.empty() ? 0.0
                         : 1.12 * ((x.centre - before[a]).norm() + (y.centre - before[b]).norm());
      if ((x.centre - y.centre).norm() > x.radius + y.radius + moved) continue;
      if (use(a, b)) return true;
    }
    return false;
  }
  [[nodiscard]] const fcl::CollisionGeometry<double>* shape(std::uint32_t part) const {
    return shapes_[part].get();
  }
  [[nodiscard]] fcl::Transform3d pose(std::uint32_t part) const {
    return fcl_transform(parts_[part].world_from_part);
  }
  [[nodiscard]] std::vector<fcl::Transform3d> poses() const {
    std::vector<fcl::Transform3d> poses;
    for (std::uint32_t i = 0; i < parts_.size(); ++i) poses.push_back(pose(i));
    return poses;
  }
  [[nodiscard]] std::vector<Vec3> centres() const {
    std::vector<Vec3> centres;
    for (const PosedPart& part : parts_) centres.push_back(part.sphere_in_world.centre);
    return centres;
  }

 private:
  void put(std::uint32_t object, const Pose& pose) {
    for (std::uint32_t i = first_[object]; i < first_[object + 1]; ++i) place_at(pose, parts_[i]);
  }

  const Scene& scene_;
  std::vector<PosedPart> parts_;
  std::vector<std::uint32_t> first_;
  std::vector<std::shared_ptr<fcl::CollisionGeometry<double>>> shapes_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs_;
  std::vector<TrackedVariable> variables_;
  std::vector<LinkState> bases_;
  ForwardKinematics kinematics_;
};

struct Edge {
  std::vector<double> from, to;
  [[nodiscard]] std::vector<double> at(double u) const {
    std::vector<double> position(from.size());
    for (std::size_t i = 0; i < from.size(); ++i) position[i] = from[i] + u * (to[i] - from[i]);
    return position;
  }
  [[nodiscard]] int steps(double step) const {
    double most = 0.0;
    for (std::size_t i = 0; i < from.size(); ++i) most = std::max(most, std::abs(to[i] - from[i]));
    return std::max(1, static_cast<int>(std::ceil(most / step)));
  }
};

bool free_at_every_degree(FclPostures& postures, const Edge& edge) {
  const int steps = edge.steps(kDegree);
  const fcl::CollisionRequest<double> request;
  for (int i = 0; i <= steps; ++i) {
    postures.place(edge.at(static_cast<double>(i) / steps));
    const bool touches = postures.any_pair({}, [&](std::uint32_t a, std::uint32_t b) {
      fcl::CollisionResult<double> result;
      return fcl::collide(postures.shape(a), postures.pose(a), postures.shape(b), postures.pose(b),
                          request, result) > 0;
    });
    if (touches) return false;
  }
  return true;
}

bool free_by_continuous_collision(FclPostures& postures, const Edge& edge) {
  constexpr double kPiece = 5.0 * kDegree;
  const int steps = edge.steps(kPiece);
  const fcl::ContinuousCollisionRequest<double> request(100, 1e-4, fcl::CCDM_SCREW, fcl::GST_LIBCCD,
                                                        fcl::CCDC_CONSERVATIVE_ADVANCEMENT);
  postures.place(edge.at(0.0));
  std::vector<fcl::Transform3d> before = postures.poses();
  std::vector<Vec3> centres = postures.centres();
  for (int i = 1; i <= steps; ++i) {
    postures.place(edge.at(static_cast<double>(i) / steps));
    const std::vector<fcl::Transform3d> now = postures.poses();
    const bool touches = postures.any_pair(centres, [&](std::uint32_t a, std::uint32_t b) {
      fcl::ContinuousCollisionResult<double> result;
      fcl::continuousCollide(postures.shape(a), before[a], now[a], postures.shape(b), before[b],
                             now[b], request, result);
      return result.is_collide;
    });
    if (touches) return false;
    before = now;
    centres = postures.centres();
  }
  return true;
}

struct Tally {
  std::string name;
  std::vector<double> us = {};
  int free = 0, wrongly_free = 0, wrongly_not = 0;

  void note(double ns, bool is_free, bool truth) {
    us.push_back(1e-3 * ns);
    free += is_free ? 1 : 0;
    wrongly_free += is_free && !truth ? 1 : 0;
    wrongly_not += !is_free && truth ? 1 : 0;
  }
  void tell() {
    std::ranges::sort(us);
    double sum = 0.0;
    for (const double each : us) sum += each;
    const auto at = [&](double share) {
      return us[std::min(us.size() - 1,
                         static_cast<std::size_t>(share * static_cast<double>(us.size())))];
    };
    print(stdout, "| {} | {:.1f} | {:.1f} | {:.1f} | {} | {} | {} |\n", name, at(0.5),
          sum / static_cast<double>(us.size()), at(0.99), free, wrongly_free, wrongly_not);
  }
};

}  // namespace

int run_ask(int argc, char** argv) {
  int motions = 1000, obstacles = 30;
  double longest = 0.5;
  CommandLine line{
      "clearance-bench --ask: short motions of an arm, certified, beside FCL's continuous "
      "collision and beside postures at every degree",
      "Example: clearance-bench --ask --motions 2000"};
  line.add({
      {"--motions", &motions, "How many motions", whole_number_in(1, 1'000'000)},
      {"--obstacles", &obstacles, "Objects around the arm", whole_number_in(1, 1000)},
      {"--longest", &longest, "Largest motion of a joint, rad", number_in(0.01, 3.0)},
  });
  if (const auto done = parse(line, argc, argv)) return *done;
  Draw draw(35);
  const std::filesystem::path beside = std::filesystem::path(CLEARANCE_CELLS) / "asked.yaml";
  const std::optional<Cell> cell = cell_or_errors(parse_cell(cell_text(draw, obstacles), beside));
  if (!cell) return 1;
  const Scene& scene = cell->scene;
  Asker asker(scene);
  FclPostures postures(scene);
  Answer answer;
  Question question;
  question.only_margins = question.only_verdicts = true;
  for (const JointVariable& variable : scene.variables)
    question.motion.joints.push_back(variable.name);
  const auto ask = [&](const std::vector<double>& times, std::vector<double> positions) {
    question.motion.times = times;
    question.motion.positions = std::move(positions);
    if (const auto fault = asker.ask(question, answer)) print(stderr, "{}\n", *fault);
    return answer.margins[0].verdict;
  };
  const auto is_free_there = [&](const std::vector<double>& position) {
    return ask({0.0}, position) == Verdict::kFree;
  };
  Tally certified{"certified"}, degrees{"1 degree, fcl::collide"}, continuous{"FCL, continuous"};
  int undecided = 0, done = 0;
  while (done < motions) {
    Edge edge;
    for (const JointVariable& variable : scene.variables) {
      const double low = std::max(variable.lower, -3.0), high = std::min(variable.upper, 3.0);
      const double from = draw.between(low, high);
      edge.from.push_back(from);
      edge.to.push_back(std::clamp(from + draw.between(-longest, longest), low, high));
    }
    if (!is_free_there(edge.from) || !is_free_there(edge.to)) continue;
    std::vector<double> both = edge.from;
    both.insert(both.end(), edge.to.begin(), edge.to.end());
    double start = cpu_ns();
    const Verdict verdict = ask({0.0, 1.0}, std::move(both));
    const double ours = cpu_ns() - start;
    ++done;
    if (verdict == Verdict::kUndecided) {
      ++undecided;
      continue;
    }
    const bool truth = verdict == Verdict::kFree;
    certified.note(ours, truth, truth);
    start = cpu_ns();
    const bool by_degrees = free_at_every_degree(postures, edge);
    degrees.note(cpu_ns() - start, by_degrees, truth);
    start = cpu_ns();
    const bool by_fcl = free_by_continuous_collision(postures, edge);
    continuous.note(cpu_ns() - start, by_fcl, truth);
  }
  print(stdout,
        "{} motions of up to {} rad, both ends free, {} obstacles, {} part pairs; {} undecided; "
        "time in thread CPU time, us\n\n"
        "| method | p50 | mean | p99 | called free | wrongly free | wrongly not free |\n"
        "|---|---|---|---|---|---|---|\n",
        motions, longest, obstacles, scene.pairs.size(), undecided);
  for (Tally* tally : {&certified, &degrees, &continuous}) tally->tell();
  return 0;
}

}  // namespace clearance::bench
