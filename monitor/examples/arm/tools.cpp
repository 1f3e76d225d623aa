#include "monitor/examples/arm/tools.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <deque>
#include <numbers>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>

#include "config/cell/simulation.hpp"
#include "core/distance.hpp"
#include "monitor/bodies/forward_kinematics.hpp"
#include "monitor/examples/arm/world.hpp"

namespace clearance::tools {
namespace {

constexpr const char* kName = "tool changing arm";
constexpr std::chrono::milliseconds kPatience(500);
constexpr std::int64_t kEndNs = 5'000'000'000;  // without an answer
constexpr double kLongestStep = 5e-3;  // s, of the motion, however long the machine stalled
constexpr double kMotion = 0.1;        // s: from dock to dock, or up and down with a tool
constexpr double kLift = 0.12;         // rad, of joint2
// joint2, joint3 and joint4 above a dock: the flange points down.
constexpr double kDown[] = {0.35, 1.2, std::numbers::pi - 1.55};
// The numbers of the docks in the cell are rounded, m.
constexpr double kRounded = 1e-6;
// How far the joint of a tool moves while it is carried, m or rad.
constexpr double kWork[] = {0.02, 0.3};

// A tool: its robot in the cell, its place in its dock, and its joint.
struct Tool {
  std::uint32_t robot;
  Pose dock;
  std::uint32_t variable;
  double at_rest;
  double azimuth;  // of its dock, rad
};

std::vector<Tool> tools_of(const Scene& scene) {
  std::vector<Tool> tools;
  for (std::uint32_t v = 0; v < scene.variables.size(); ++v) {
    const JointVariable& variable = scene.variables[v];
    if (!variable.is_held()) continue;
    const Pose& dock = scene.robots[variable.robot].base.base_from_root;
    tools.push_back(
        {variable.robot, dock, v, variable.held, std::atan2(dock.position.y(), dock.position.x())});
  }
  if (tools.size() != 2 || scene.robots.size() != 3)
    throw std::invalid_argument(
        "the cell has to have an arm and two tools in docks, as tools.yaml");
  return tools;
}

// Where the bodies truly are, without the daemon.
class Truth {
 public:
  explicit Truth(const Cell& cell)
      : scene_(cell.scene),
        simulation_(cell.simulation),
        states_(scene_.variables.size()),
        stands_(scene_.objects.size()),
        kinematics_(scene_.robots) {
    for (std::uint32_t link = 0; link < scene_.robots[0].links.size(); ++link)
      if (scene_.robots[0].links[link].name == "flange") flange_ = link;
  }

  // From the next step on. Null: all tools are in their docks.
  void carry(const Tool* tool, const std::vector<Tool>& tools) {
    for (std::size_t i = 0; i < stands_.size(); ++i) stands_[i] = scene_.objects[i].fixed;
    for (const Tool& each : tools) {
      Robot& robot = scene_.robots[each.robot];
      robot.base = {};
      if (&each != tool) {
        robot.base.base_from_root = each.dock;
      } else {
        robot.base.kind = RobotBase::Kind::kLink;
        robot.base.link = flange_;
      }
      for (const RobotLink& link : robot.links) stands_[link.object] = &each != tool;
    }
  }
  void step(double t_s, const std::vector<double>& positions, std::int64_t stamp_ns) {
    for (std::size_t i = 0; i < states_.size(); ++i) {
      states_[i].input.has_value = true;
      states_[i].position = positions[i];
    }
    kinematics_.place(states_, {});
    std::vector<Pose> places;
    for (const Object& object : scene_.objects) places.push_back(object.world_from_object);
    for (std::uint32_t robot = 0; robot < scene_.robots.size(); ++robot) {
      for (std::size_t link = 0; link < scene_.robots[robot].links.size(); ++link)
        places[scene_.robots[robot].links[link].object] = kinematics_.links(robot)[link].pose;
    }
    poses_at(simulation_, t_s, moved_);
    for (const PoseAt& each : moved_) places[each.object] = each.world_from_object;
    steps_.emplace_back(stamp_ns, std::move(places));
    if (steps_.size() > kSteps) steps_.pop_front();
  }

  // m, with the first body where it was at one stamp, and the second at another. Nothing: no step
  // has these stamps.
  [[nodiscard]] std::optional<double> distance_of(std::uint32_t a, std::int64_t stamp_a_ns,
                                                  std::uint32_t b, std::int64_t stamp_b_ns) const {
    const Pose *at_a = place_of(a, stamp_a_ns), *at_b = place_of(b, stamp_b_ns);
    if (at_a == nullptr || at_b == nullptr) return std::nullopt;
    double least = kInfinity;
    for (const Part& part_a : scene_.objects[a].parts) {
      for (const Part& part_b : scene_.objects[b].parts) {
        TrackingState cold;
        const DistanceResult found =
            distance(part_a.shape, part_b.shape, compose(*at_a, part_a.object_from_part),
                     compose(*at_b, part_b.object_from_part), cold);
        least = std::min(least, found.distance);
      }
    }
    return least;
  }
  [[nodiscard]] std::uint32_t object(const std::string& name) const {
    const auto found = std::ranges::find(scene_.objects, name, &Object::name);
    if (found == scene_.objects.end()) throw std::invalid_argument("the daemon has another cell");
    return static_cast<std::uint32_t>(found - scene_.objects.begin());
  }

 private:
  [[nodiscard]] const Pose* place_of(std::uint32_t object, std::int64_t stamp_ns) const {
    if (stands_[object]) return &steps_.back().second[object];
    for (auto step = steps_.rbegin(); step != steps_.rend(); ++step)
      if (std::abs(step->first - stamp_ns) < kSameNs) return &step->second[object];
    return nullptr;
  }

  static constexpr std::size_t kSteps = 256;
  static constexpr std::int64_t kSameNs = 20'000;  // steps are farther apart
  Scene scene_;
  Simulation simulation_;
  std::vector<TrackedVariable> states_;
  std::vector<bool> stands_;  // by object
  ForwardKinematics kinematics_;
  std::uint32_t flange_ = 0;
  std::vector<PoseAt> moved_;
  std::deque<std::pair<std::int64_t, std::vector<Pose>>> steps_;  // with their stamps
};

// Takes all reports, and compares their bounds with the truth.
class Watcher {
 public:
  Watcher(client::Connection& connection, const Truth& truth, RunResult& result)
      : reports_(connection, {.old_after = kPatience, .depth = 256}),
        catalogue_(connection),
        truth_(truth),
        result_(result) {}

  // Waits for a report of a tick that began after the stamp.
  bool wait_for(std::int64_t stamp_ns) {
    while (reports_.next(std::chrono::milliseconds(20))) {
      if (is_counting_) take();
      if (reports_->now_ns >= stamp_ns) return true;
    }
    return false;
  }
  void count() { is_counting_ = true; }
  [[nodiscard]] std::uint64_t cycle() const { return reports_->cycle; }
  [[nodiscard]] bool all_known() const { return reports_->unknown == 0; }

 private:
  void take() {
    ++result_.reports;
    if (cycle_ != 0) result_.missed += reports_->cycle - cycle_ - 1;
    cycle_ = reports_->cycle;
    result_.unknown += all_known() ? 0 : 1;
    if (!knows_names()) return;  // a catalogue comes a moment later than the first report
    for (const auto& pair : std::span(reports_->pairs._buffer, reports_->pairs._length)) {
      const auto& [a, b] = pairs_[pair.pair];
      const auto found = truth_.distance_of(a, reports_->now_ns - pair.age_a_ns, b,
                                            reports_->now_ns - pair.age_b_ns);
      if (!found) continue;
      ++result_.compared;
      if (pair.lower > *found + kRounded || pair.upper < *found - kRounded) ++result_.wrong;
      if ((a != person_ && b != person_) || *found >= result_.least_distance_m) continue;
      result_.least_distance_m = *found;
      const auto& objects = catalogue_.message()->pairs._buffer[pair.pair];
      result_.nearest = catalogue_.object_name(objects.object_a) + " - " +
                        catalogue_.object_name(objects.object_b);
    }
  }
  bool knows_names() {
    if (revision_ == reports_->scene_revision) return true;
    if (catalogue_.revision() != reports_->scene_revision) catalogue_.update();
    if (catalogue_.revision() != reports_->scene_revision) return false;
    revision_ = reports_->scene_revision;
    person_ = truth_.object("person");
    pairs_.clear();
    const auto& pairs = catalogue_.message()->pairs;
    for (const auto& pair : std::span(pairs._buffer, pairs._length)) {
      pairs_.emplace_back(truth_.object(catalogue_.object_name(pair.object_a)),
                          truth_.object(catalogue_.object_name(pair.object_b)));
    }
    return true;
  }

  client::Reports reports_;
  client::Catalogue catalogue_;
  const Truth& truth_;
  RunResult& result_;
  bool is_counting_ = false;
  std::uint64_t cycle_ = 0, revision_ = 0;
  std::uint32_t person_ = 0;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs_;  // objects, by pair
};

class Arm {
 public:
  Arm(const Cell& cell, client::Connection& connection, RunResult& result,
      const std::function<bool()>& go_on)
      : scene_(cell.scene),
        tools_(tools_of(scene_)),
        world_(cell, connection, kName, "tracked person"),
        commands_(connection, kName),
        truth_(cell),
        watcher_(connection, truth_, result),
        result_(result),
        go_on_(go_on),
        positions_(scene_.variables.size(), 0.0) {
    truth_.carry(nullptr, tools_);
    positions_[0] = tools_[0].azimuth;
    std::ranges::copy(kDown, positions_.begin() + 1);
    for (const Tool& tool : tools_) positions_[tool.variable] = tool.at_rest;
  }

  // Each returns false when the run has to end.
  bool begin() {
    do {
      if (!send()) return false;
    } while (!commands_.is_heard() || !watcher_.all_known());
    watcher_.count();
    return true;
  }
  bool go_to(std::size_t tool) {
    const double from = positions_[0], to = tools_[tool].azimuth;
    return move([&](double part) {
      positions_[0] = from + 0.5 * (1.0 - std::cos(std::numbers::pi * part)) * (to - from);
    });
  }
  // Lifts the tool, moves its joint, and puts it back where it was.
  bool work_with(std::size_t tool) {
    const Tool& of = tools_[tool];
    return move([&](double part) {
      positions_[of.variable] = of.at_rest + kWork[tool] * std::sin(std::numbers::pi * part);
    });
  }
  bool attach(std::size_t tool) {
    const Tool& of = tools_[tool];
    return change(
        AttachRobot{
            .robot = scene_.robots[of.robot].name, .to = "flange", .carrier_from_root = Pose{}},
        &of);
  }
  // The position is stated, since the last one that was sent may not be in use yet.
  bool detach(std::size_t tool) {
    const Tool& of = tools_[tool];
    return change(DetachRobot{.robot = scene_.robots[of.robot].name,
                              .world_from_root = of.dock,
                              .joints = {{scene_.variables[of.variable].name, of.at_rest}}},
                  nullptr);
  }

 private:
  static double seconds_of(std::int64_t ns) { return 1e-9 * static_cast<double>(ns); }

  // Up and down, while `set` moves something by the part of the time that has passed.
  bool move(const std::function<void(double part)>& set) {
    for (double time = 0.0; time < kMotion;) {
      const std::int64_t before_ns = client::now_ns();
      if (!send()) return false;
      const double step = std::min(seconds_of(client::now_ns() - before_ns), kLongestStep);
      time += step;
      t_s_ += step;
      const double part = std::min(time / kMotion, 1.0);
      set(part);
      positions_[1] = kDown[0] - (part < 1.0 ? kLift * std::sin(std::numbers::pi * part) : 0.0);
    }
    return send();
  }

  // The arm rests until the change is in force.
  bool change(const CellChange& change, const Tool* carried) {
    const std::int64_t began_ns = client::now_ns();
    const std::uint64_t request = commands_.post({change});
    std::optional<CommandResult> answer;
    while (!(answer = commands_.result(request))) {
      if (client::now_ns() - began_ns > kEndNs || !send()) return false;
    }
    if (!answer->done()) {
      result_.refusal = answer->path + ": " + answer->reason;
      return false;
    }
    truth_.carry(carried, tools_);
    while (watcher_.cycle() < answer->in_force_from) {
      if (!send()) return false;
    }
    ++result_.changes;
    result_.commands_ms.push_back(1e3 * seconds_of(client::now_ns() - began_ns));
    return true;
  }

  // Sends arm and person until a report has used them.
  bool send() {
    const std::int64_t began_ns = client::now_ns();
    do {
      if (!go_on_() || client::now_ns() - began_ns > kEndNs) return false;
      const std::int64_t stamp_ns = world_.send(t_s_, positions_, {});
      truth_.step(t_s_, positions_, stamp_ns);
      if (watcher_.wait_for(stamp_ns)) return true;
    } while (true);
  }

  const Scene& scene_;
  std::vector<Tool> tools_;
  World world_;
  client::Commands commands_;
  Truth truth_;
  Watcher watcher_;
  RunResult& result_;
  const std::function<bool()>& go_on_;
  std::vector<double> positions_;
  double t_s_ = 0.0;
};

}  // namespace

RunResult run(const Cell& cell, client::Connection& connection, const RunOptions& options,
              const std::function<bool()>& go_on) {
  RunResult result;
  Arm arm(cell, connection, result, go_on);
  if (!arm.begin()) return result;
  for (std::size_t tool = 0;; tool = 1 - tool) {
    if (!arm.attach(tool)) return result;
    if (result.changes == options.changes) break;
    if (!arm.work_with(tool) || !arm.detach(tool)) return result;
    if (result.changes == options.changes) break;
    if (!arm.go_to(1 - tool)) return result;
  }
  std::ranges::sort(result.commands_ms);
  result.heard = true;
  return result;
}

}  // namespace clearance::tools
