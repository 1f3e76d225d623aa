#include "config/write/starter_cell.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "config/yaml/yaml_emitter.hpp"

namespace clearance {
namespace {

// All in m. The middle of the bodies at y = 0, robots along y, machine in front, people behind.
constexpr double kBetweenRobots = 0.6;
constexpr double kTableTop = 0.75, kTableThickness = 0.05;
constexpr double kTableBack = -0.4, kTableFront = 0.8, kTableBeside = 0.5;
constexpr double kAboveGround = 0.05;  // the lowest moving link, where the zone `stop` is clear
constexpr double kMachineAway = 0.2, kPersonAway = 2.0;  // beyond reach; behind the back
constexpr double kCameraBeside = 2.0, kCameraHigh = 2.2;

std::string quoted(const std::string& text) {
  YAML::Emitter out;
  out << YAML::DoubleQuoted << text;
  return out.c_str();
}

// Rounded to mm, so that a person can read it.
std::string mm(double length) { return shortest(std::round(1e3 * length) / 1e3); }

class StarterWriter {
 public:
  explicit StarterWriter(const StarterOptions& options) : options_(options) { place(); }
  std::string write();

 private:
  void place();
  void write_head();
  void write_table();
  void write_machine();
  void write_person();
  void write_floor();
  void write_camera();
  void write_robot(std::size_t robot);
  void write_joints(const StarterRobot& robot);
  void write_pairs();
  void write_exceptions();
  void write_zones();
  void write_distance_zones(const std::string& a, const std::string& b, double stop, double slow);
  void write_people(const std::string& robot);
  template <class... Values>
  void line(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Values>(values)...);
    text_ += '\n';
  }
  // A camera needs a floor.
  [[nodiscard]] bool has_surroundings() const {
    return options_.table || options_.machine || options_.camera;
  }
  // The body on which robots stand; empty: none is written.
  [[nodiscard]] std::string ground() const {
    return options_.table ? "table" : options_.camera ? "floor" : "";
  }
  // By how much the robot stands above it.
  [[nodiscard]] double raised(const StarterRobot& robot) const {
    return ground().empty() ? 0.0
                            : std::ceil(1e3 * std::max(0.0, kAboveGround - robot.lowest)) / 1e3;
  }

  const StarterOptions& options_;
  std::vector<double> y_;  // of the bases
  double back_ = 0.0, reach_ = 0.0;
  std::string text_;
};

// Boxes around the robots keep the distance, so nothing of one robot touches another.
void StarterWriter::place() {
  double next = 0.0;
  for (const StarterRobot& robot : options_.robots) {
    y_.push_back(y_.empty() ? 0.0 : std::ceil(1e2 * (next - robot.low.y())) / 1e2);
    next = y_.back() + robot.high.y() + kBetweenRobots;
    back_ = std::min(back_, robot.low.x());
    reach_ = std::max(reach_, robot.reach);
  }
  const double middle = 0.5 * (y_.front() + y_.back());
  for (double& y : y_) y -= middle;
}

void StarterWriter::write_head() {
  const std::string file = options_.name + ".yaml";
  line(
      "# Written by clearance-scene new, to start from: all that is no part of a URDF is assumed.");
  line("# A comment says the unit of a value, and what to measure. config/KEYS.md has all keys.");
  line("#");
  line("#   clearanced --check {}   # after each change: every mistake, with its line", file);
  line("#   clearanced {}           # runs it", file);
  line("#   clearance-robot {}      # without a robot: moves its joints{}", file,
       options_.person ? ", and the person" : "");
  line("#   clearance-view {}       # shows it in a browser", file);
  line("name: {}", quoted(options_.name));
  line("units: {{length: m, angle: rad}}        # of all values below; speeds per second");
  line("rate_hz: 1000                         # Hz: ticks; not far above the rate of joint states");
  line("defaults:");
  line("  age_limit_ms: 20                    # ms: twice the period of the joint states");
  line("  tolerance: 0.005                    # m: error of the convex parts of meshes");
  line("  max_parts: 24                       # of one mesh; more have smaller errors");
}

void StarterWriter::write_table() {
  const double width = y_.back() - y_.front() + 2.0 * kTableBeside;
  line(
      "  # Robots stand on its top. Measure its length (x), width (y) and height, and where they "
      "stand.");
  line("  - name: table");
  line("    groups: [surroundings]");
  line("    fixed: true");
  line("    box: {{size: [{}, {}, {}]}}         # m: x, y, z", mm(kTableFront - kTableBack),
       mm(width), mm(kTableThickness));
  line("    pose: {{xyz: [{}, 0, {}]}}       # m: its middle; the top is {} m high",
       mm(0.5 * (kTableFront + kTableBack)), mm(kTableTop - 0.5 * kTableThickness), mm(kTableTop));
}

void StarterWriter::write_machine() {
  const double x = std::ceil(1e2 * (reach_ + kMachineAway)) / 1e2;
  line("  # The housing of a machine, here out of reach. Measure it, and where it stands.");
  line("  - name: machine");
  line("    groups: [surroundings]");
  line("    fixed: true");
  line("    box: {{size: [0.8, 1, 1.9]}}         # m: x, y, z");
  line("    pose: {{xyz: [{}, 0, 0.95]}}       # m: its middle", mm(x + 0.4));
  line(
      "  # Its closed door. One that slides: in place of `fixed`, `max_speed` (m/s), and its "
      "poses");
  line(
      "  # arrive on the topic clearance/poses. If it is out of reach while open: `absent: true`.");
  line("  # One with hinges: in place of it, a robot of one joint under `robots`, its `base` with");
  line("  # `on: machine`, and its `groups: [surroundings]`.");
  line("  - name: door");
  line("    groups: [surroundings]");
  line("    fixed: true");
  line("    box: {{size: [0.03, 0.6, 0.8]}}      # m: x, y, z");
  line("    pose: {{xyz: [{}, 0, 1.2]}}       # m: its middle", mm(x - 0.015));
}

void StarterWriter::write_person() {
  line(
      "  # A person, whom a tracker sends on the topic clearance/poses (idl/README.md): the place "
      "of");
  line("  # the feet, z up. Or `frame: NAME` follows a frame of tf (ros2: {{world_frame: NAME}}).");
  line("  # Without poses, all that depends on the person is unknown.");
  line("  - name: person");
  line(
      "    capsule: {{from: [0, 0, 0.3], to: [0, 0, 1.5], radius: 0.3}}  # m: 1.8 m high; arms at "
      "the body");
  line(
      "    max_speed: 1.6                    # m/s: walking, by ISO 13855; no point may be faster");
  line("    age_limit_ms: 100                 # ms: twice the period of the tracker");
  line("    margin: 0.05                      # m: error of the tracker");
}

// A picture in which too little is known shows no clear place.
void StarterWriter::write_floor() {
  line("  # The camera sees it where nothing else stands. Measure its height.");
  line("  - name: floor");
  line("    groups: [surroundings]");
  line("    fixed: true");
  line("    half_space: {{normal: [0, 0, 1], offset: 0}}  # m: its height");
}

// Stands beside the robots, and looks at the middle between them, above the table.
void StarterWriter::write_camera() {
  const Vec3 at(0.0, y_.back() + kCameraBeside, kCameraHigh);
  const Vec3 forward = Vec3(0.2, -at.y(), (options_.table ? kTableTop : 0.0) + 0.4 - at.z());
  const double roll = -std::acos(forward.z() / forward.norm());
  const double yaw = std::atan2(-forward.x(), forward.y());
  line("# What the camera sees is an obstacle, if it is neither a robot nor a body of the cell.");
  line("# Its depth images and CameraInfo come on topics of ROS 2 (config/KEYS.md#sensors).");
  line("sensors:");
  line("  - name: camera");
  line("    depth_image: /camera/depth/image_rect_raw");
  line(
      "    depth_error: {{constant: 0.001, quadratic: 0.0025}}  # m, 1/m: by the maker, or "
      "measured");
  line("    range: [0.3, 5]                   # m: depths that count");
  line("    max_speed: 1.6                    # m/s: of anything that it may see");
  line("    age_limit_ms: 200                 # ms: twice the period of the images and their way");
  line(
      "    knows: true                       # a body of the cell is no obstacle for a second "
      "time");
  line("    # m, rad: of its optical frame, z forward, x right, y down; measure it");
  line("    mount: {{pose: {{xyz: [{}, {}, {}], rpy: [{}, 0, {}]}}}}", mm(at.x()), mm(at.y()),
       mm(at.z()), mm(roll), mm(yaw));
}

void StarterWriter::write_joints(const StarterRobot& robot) {
  line("    # Limits as the URDF has them. Where the controller's differ, uncomment and change:");
  line("    # joints:                         # rad and rad/s, or m and m/s where they slide");
  for (const JointVariable& joint : robot.variables) {
    std::string values;
    if (std::isfinite(joint.max_speed))
      values = fmt::format("velocity: {}", shortest(joint.max_speed));
    if (std::isfinite(joint.lower) && std::isfinite(joint.upper)) {
      values += fmt::format("{}limits: [{}, {}]", values.empty() ? "" : ", ", shortest(joint.lower),
                            shortest(joint.upper));
    }
    line("    #   {}: {{{}}}{}", quoted(joint.name), values,
         std::isfinite(joint.max_speed) ? "" : "  # no velocity: state it");
  }
}

void StarterWriter::write_robot(std::size_t number) {
  const StarterRobot& robot = options_.robots[number];
  const auto path = [&](const std::filesystem::path& file) {
    const auto absolute = std::filesystem::absolute(file).lexically_normal();
    return quoted(absolute.lexically_relative(options_.directory).string());
  };
  line("  - name: {}", quoted(robot.name));
  line("    urdf: {}", path(robot.urdf));
  line("    srdf: {}  # {}", path(robot.srdf), robot.srdf_comment);
  if (!robot.packages.empty()) {
    line("    packages:");
    for (const auto& [package, folder] : robot.packages)
      line("      {}: {}", quoted(package), path(folder));
  }
  if (!robot.prefix.empty()) {
    line("    prefix: {}   # of its links and joints, here and in joint states",
         quoted(robot.prefix));
    line("    # joint_states: /{}/joint_states  # if its joints have a topic of ROS 2 of their own",
         robot.name);
  }
  const double up = raised(robot);
  line("    base: {{{}pose: {{xyz: [0, {}, {}], rpy: [0, 0, 0]}}}}  # m, rad: measure it",
       options_.table ? "on: table, " : "", mm(y_[number]),
       mm(up + (options_.table ? 0.5 * kTableThickness : 0.0)));
  if (up > 0.0) {
    line("    # It stands {} m above the {}: at zero, '{}' reaches {} m {} the base.", mm(up),
         ground(), robot.lowest_link, mm(std::abs(robot.lowest)),
         robot.lowest < 0.0 ? "below" : "above");
  }
  line("    margin: 0.005                     # m: calibration, sag, cables; zones subtract it");
  if (!robot.variables.empty()) write_joints(robot);
}

void StarterWriter::write_pairs() {
  line("pairs:");
  for (const StarterRobot& robot : options_.robots) {
    const std::string name = quoted(robot.name);
    line("  - {{between: [{0}, {0}], publish: false}}", name);
    if (has_surroundings()) line("  - {{between: [{}, surroundings]}}", name);
    if (options_.person) line("  - {{between: [{}, person]}}", name);
    if (options_.camera) line("  - {{between: [{}, camera]}}", name);
  }
  for (std::size_t a = 0; a < options_.robots.size(); ++a) {
    for (std::size_t b = a + 1; b < options_.robots.size(); ++b) {
      line("  - {{between: [{}, {}]}}", quoted(options_.robots[a].name),
           quoted(options_.robots[b].name));
    }
  }
}

void StarterWriter::write_exceptions() {
  std::string entries;
  const auto allow = [&entries](const std::string& a, const std::string& b, const char* why) {
    entries += fmt::format("  - {{between: [{}, {}], reason: {}}}\n", quoted(a), quoted(b), why);
  };
  for (const StarterRobot& robot : options_.robots) {
    if (!ground().empty()) {
      for (const std::string& link : robot.turning)
        allow(robot.prefix + link, ground(), "turns above its base");
    }
    for (const auto& [a, b] : robot.touching) {
      allow(robot.prefix + a, robot.prefix + b,
            "\"touches at zero, and the SRDF does not disable it: check it\"");
    }
  }
  if (!entries.empty()) text_ += "allowed_collisions:\n" + entries;
}

void StarterWriter::write_distance_zones(const std::string& a, const std::string& b, double stop,
                                         double slow) {
  const auto zone = [&](const char* word, double below) {
    line("  - {{name: {}, between: [{}, {}], enter_below: {}, leave_above: {}}}  # m",
         quoted(fmt::format("{}: {} - {}", word, a, b)), quoted(a), quoted(b), mm(below),
         mm(below + 0.01));
  };
  zone("stop", stop);
  zone("slow", slow);
}

void StarterWriter::write_people(const std::string& robot) {
  line("  - name: {}", quoted("people: " + robot));
  line("    between: [{}, person]", quoted(robot));
  line("    enter_below: 0.5                  # m: in any case, whatever the speeds are");
  line("    leave_above: 0.55                 # m");
  line("    separation:                       # the terms of ISO/TS 15066");
  line("      human: person");
  line("      human_speed: 1.6                # m/s: towards the robot, by ISO 13855");
  line("      robot_speed: 2                  # m/s: of its fastest point");
  line("      reaction_time_ms: 100           # ms: network and controller; measure it");
  line("      stopping_time_ms: 500           # ms: from the maker's manual");
  line("      stopping_distance: 0.5          # m: from the maker's manual");
  line(
      "      intrusion_distance: 0.85        # m: C of ISO 13855: an arm's reach beyond the "
      "capsule");
}

void StarterWriter::write_zones() {
  if (options_.robots.size() == 1 && !has_surroundings() && !options_.person) return;
  line(
      "# Distances less margins. tools/TUTORIAL.md has the rules for thresholds by speed and "
      "brake.");
  line("zones:");
  for (std::size_t a = 0; a < options_.robots.size(); ++a) {
    const std::string& name = options_.robots[a].name;
    if (has_surroundings()) write_distance_zones(name, "surroundings", 0.02, 0.1);
    for (std::size_t b = a + 1; b < options_.robots.size(); ++b)
      write_distance_zones(name, options_.robots[b].name, 0.05, 0.2);
    if (options_.camera) write_distance_zones(name, "camera", 0.1, 0.4);
    if (options_.person) write_people(name);
  }
}

std::string StarterWriter::write() {
  write_head();
  if (has_surroundings() || options_.person) line("objects:");
  if (options_.table) write_table();
  if (options_.machine) write_machine();
  if (options_.person) write_person();
  if (options_.camera) write_floor();
  line("robots:");
  for (std::size_t i = 0; i < options_.robots.size(); ++i) write_robot(i);
  if (options_.camera) write_camera();
  write_pairs();
  write_exceptions();
  write_zones();
  if (options_.person) {
    line("# For clearance-robot: the person walks to and fro behind the robots, at up to 1.3 m/s.");
    line("simulation:");
    line(
        "  movers: [{{object: person, centre: {{xyz: [{}, 0, 0]}}, amplitude: [0, 2, 0], "
        "frequency_hz: 0.1}}]",
        mm(back_ - kPersonAway));
  }
  return std::move(text_);
}

}  // namespace

std::string starter_cell(const StarterOptions& options) { return StarterWriter(options).write(); }

}  // namespace clearance
