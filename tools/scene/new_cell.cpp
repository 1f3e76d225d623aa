// Writes a commented cell of some robots to start from, and beside it what the robots lack: a URDF
// expanded from xacro, or a proposed SRDF.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <variant>

#include "config/urdf/robot_files.hpp"
#include "config/write/single_robot_cell.hpp"
#include "config/write/starter_cell.hpp"
#include "monitor/app/output_file.hpp"
#include "monitor/app/print.hpp"
#include "monitor/app/program.hpp"
#include "tools/scene/allowed_collisions.hpp"
#include "tools/scene/arguments.hpp"
#include "tools/scene/written_cell.hpp"
#include "tools/scene/xacro.hpp"

namespace clearance {
namespace {

namespace fs = std::filesystem;

// Fewer than `allow` tries by default: a cell to start from should be there soon.
constexpr std::uint64_t kSamples = 20'000;

std::vector<std::string> words_of(const std::string& list) {
  std::vector<std::string> words;
  for (std::size_t at = 0; at <= list.size();) {
    const std::size_t comma = std::min(list.find(',', at), list.size());
    if (comma > at) words.push_back(list.substr(at, comma - at));
    at = comma + 1;
  }
  return words;
}

// A robot as the command line names it.
struct NamedRobot {
  fs::path description, srdf;
  bool operator<(const NamedRobot& other) const {
    return std::tie(description, srdf) < std::tie(other.description, other.srdf);
  }
};

std::vector<NamedRobot> robots_of(const std::string& list) {
  std::vector<NamedRobot> robots;
  for (const fs::path file : words_of(list)) {
    if (file.extension() != ".srdf") robots.push_back({.description = file, .srdf = {}});
    if (file.extension() == ".srdf" && !robots.empty()) robots.back().srdf = file;
  }
  return robots;
}

// Reads robots one after another, each description once.
class RobotsOfFiles {
 public:
  RobotsOfFiles(const NewArguments& arguments, fs::path directory)
      : arguments_(arguments), directory_(std::move(directory)) {}

  // Returns kOk, or the exit code after the reason has gone to stderr.
  int add(const NamedRobot& named);
  [[nodiscard]] std::vector<StarterRobot> finish();

 private:
  int read(const NamedRobot& named, StarterRobot& robot);
  int expand(const fs::path& xacro, StarterRobot& robot);
  void find_packages(const fs::path& xacro, StarterRobot& robot);
  [[nodiscard]] fs::path srdf_of(const NamedRobot& named, const StarterRobot& robot) const;
  int propose_srdf(const Scene& scene, StarterRobot& robot);

  const NewArguments& arguments_;
  fs::path directory_;  // of the cell
  std::map<NamedRobot, StarterRobot> read_;
  std::vector<StarterRobot> robots_;
};

// Packages beside the xacro file are not found from the folder of the cell.
void RobotsOfFiles::find_packages(const fs::path& xacro, StarterRobot& robot) {
  const auto urdf = read_urdf(robot.urdf);
  if (!std::holds_alternative<UrdfRobot>(urdf)) return;
  const RobotFiles here{.named_in = robot.urdf, .packages = robot.packages};
  const RobotFiles there{.named_in = xacro, .packages = robot.packages};
  std::map<std::string, fs::path> found;
  for (const UrdfLink& link : std::get<UrdfRobot>(urdf).links) {
    for (const UrdfCollision& collision : link.collisions) {
      const auto* mesh = std::get_if<UrdfMesh>(&collision.shape);
      const std::string package = mesh == nullptr ? "" : package_of(mesh->file);
      if (package.empty() || here.find(mesh->file)) continue;
      if (const auto folder = there.find("package://" + package + "/")) found[package] = *folder;
    }
  }
  robot.packages.insert(robot.packages.end(), found.begin(), found.end());
}

int RobotsOfFiles::expand(const fs::path& xacro, StarterRobot& robot) {
  robot.urdf = directory_ / expanded_name(xacro);
  const auto is_same = [&](const StarterRobot& other) { return other.urdf == robot.urdf; };
  if (std::ranges::any_of(robots_, is_same)) {
    print(stderr, "{}: found a second robot whose xacro becomes {}; expected another file name\n",
          kProgram, robot.urdf.string());
    return kFailed;
  }
  if (!output_is_not_an_input(kProgram, robot.urdf, {xacro}) ||
      !can_create(kProgram, robot.urdf, arguments_.force)) {
    return kFailed;
  }
  if (const std::string fault = expand_xacro(xacro, arguments_.xacro, robot.urdf); !fault.empty()) {
    print(stderr, "{}: {}\n", kProgram, fault);
    return kFailed;
  }
  find_packages(xacro, robot);
  return kOk;
}

// The one that was named, else one beside the description or the cell: of the URDF's name, or for
// the robot of that name.
fs::path RobotsOfFiles::srdf_of(const NamedRobot& named, const StarterRobot& robot) const {
  if (!named.srdf.empty()) return named.srdf;
  const fs::path beside = fs::absolute(named.description).parent_path();
  const fs::path name = robot.urdf.stem().string() + ".srdf";
  for (const fs::path& file : {beside / name, directory_ / name})
    if (std::error_code fault; fs::is_regular_file(file, fault)) return file;
  const auto urdf = read_urdf(robot.urdf);
  if (!std::holds_alternative<UrdfRobot>(urdf)) return {};
  std::set<fs::path> found;
  std::error_code fault;
  for (const auto& entry : fs::directory_iterator(beside, fault)) {
    if (entry.path().extension() != ".srdf") continue;
    const auto srdf = read_srdf(entry.path());
    const auto* read = std::get_if<Srdf>(&srdf);
    if (read != nullptr && read->robot == std::get<UrdfRobot>(urdf).name)
      found.insert(entry.path());
  }
  return found.empty() ? fs::path{} : *found.begin();
}

int RobotsOfFiles::propose_srdf(const Scene& scene, StarterRobot& robot) {
  const auto pairs = sample_with_progress(scene, {.samples = kSamples});
  const AllowRule rule{.samples = kSamples};
  robot.srdf = directory_ / (robot.urdf.stem().string() + ".srdf");
  robot.srdf_comment = fmt::format(
      "proposed by {} samples, which prove nothing: check it; clearance-scene allow "
      "--samples tries more",
      kSamples);
  print(stderr, "note: no SRDF of '{}' was found, and {} is a proposal by samples: check it\n{}",
        robot.urdf.string(), robot.srdf.string(), near_misses(scene, pairs, rule));
  return write_text(as_srdf(scene, pairs, rule), robot.srdf);
}

int RobotsOfFiles::read(const NamedRobot& named, StarterRobot& robot) {
  robot.urdf = named.description;
  robot.packages = arguments_.packages;
  if (is_xacro(named.description))
    if (const int failed = expand(named.description, robot); failed != kOk) return failed;
  robot.srdf = srdf_of(named, robot);
  robot.srdf_comment = "which pairs of its links may touch";
  const auto cell = cell_or_errors(read_single_robot(
      {.urdf = robot.urdf, .srdf = robot.srdf, .packages = robot.packages, .directory = directory_},
      told_on_stderr()));
  if (!cell) return kBadCell;
  const Scene& scene = cell->scene;
  robot.name = scene.robots.front().name;
  for (const JointVariable& variable : scene.variables)
    if (variable.name.find('/') == std::string::npos) robot.variables.push_back(variable);
  robot.reach = reach_to_the_front(scene);
  robot.lowest = kInfinity;
  for (const LinkExtent& extent : extents_at_zero(scene)) {
    const Object& link = scene.objects[extent.object];
    robot.low = robot.low.cwiseMin(extent.low);
    robot.high = robot.high.cwiseMax(extent.high);
    if (extent.turns_level) {
      robot.turning.push_back(link.name);
    } else if (!link.fixed && extent.low.z() < robot.lowest) {
      robot.lowest = extent.low.z();
      robot.lowest_link = link.name;
    }
  }
  if (robot.srdf.empty()) return propose_srdf(scene, robot);
  for (const SampledPair& pair : sample_contacts(scene, {.samples = 0})) {
    const auto is_same = [&pair](const ObjectPair& watched) {
      return std::minmax(watched.first, watched.second) == std::minmax(pair.first, pair.second);
    };
    if (pair.touch_at_zero && std::ranges::any_of(scene.pairs, is_same))
      robot.touching.emplace_back(scene.objects[pair.first].name, scene.objects[pair.second].name);
  }
  return kOk;
}

int RobotsOfFiles::add(const NamedRobot& named) {
  if (!read_.contains(named)) {
    StarterRobot robot;
    if (const int failed = read(named, robot); failed != kOk) return failed;
    read_[named] = std::move(robot);
  }
  robots_.push_back(read_[named]);
  return kOk;
}

// Names that several robots have get numbers. A robot alone keeps the names of its joints.
std::vector<StarterRobot> RobotsOfFiles::finish() {
  std::map<std::string, int> count, next;
  for (const StarterRobot& robot : robots_) ++count[robot.name];
  for (StarterRobot& robot : robots_) {
    const std::string name = robot.name;
    if (count[name] > 1) robot.name += fmt::format("_{}", ++next[name]);
    if (robots_.size() > 1) robot.prefix = robot.name + "_";
  }
  return std::move(robots_);
}

void print_next_commands(const std::string& cell, bool has_person) {
  print(stdout,
        "Read its comments, measure and change what they say. Then:\n"
        "  clearanced --check {0}    # every mistake, with its line\n"
        "  clearanced {0}            # runs it\n"
        "  clearance-robot {0}       # beside it, without a robot: moves its joints{1}\n"
        "  clearance-view {0}        # shows it in a browser\n",
        cell, has_person ? " and the person" : "");
}

int wrong_usage(const std::string& fault) {
  print(stderr, "{}: {}\n", kProgram, fault);
  return kUsage;
}

}  // namespace

int new_cell(const NewArguments& arguments) {
  const std::vector<NamedRobot> named = robots_of(arguments.robots);
  if (named.empty()) {
    return wrong_usage(
        fmt::format("found --robots '{}'; expected URDF or xacro files, such as "
                    "A.urdf,B.urdf",
                    arguments.robots));
  }
  const auto is_expanded = [](const NamedRobot& robot) { return is_xacro(robot.description); };
  if (!arguments.xacro.empty() && std::ranges::none_of(named, is_expanded))
    return wrong_usage("found --xacro, but no file of --robots ends with .xacro; expected one");
  for (const NamedRobot& robot : named) {
    if (!output_is_not_an_input(kProgram, arguments.output, {robot.description, robot.srdf}))
      return kUsage;
  }
  if (!can_create(kProgram, arguments.output, arguments.force)) return kFailed;
  const fs::path output = fs::absolute(arguments.output).lexically_normal();
  RobotsOfFiles robots(arguments, output.parent_path());
  for (const NamedRobot& robot : named)
    if (const int failed = robots.add(robot); failed != kOk) return failed;
  StarterOptions options{
      .name = output.stem().string(), .directory = output.parent_path(), .robots = robots.finish()};
  for (const std::string& body : words_of(arguments.bodies)) {
    options.table = options.table || body == "table";
    options.machine = options.machine || body == "machine";
    options.person = options.person || body == "person";
    options.camera = options.camera || body == "camera";
  }
  const int written = write_cell(starter_cell(options), arguments.output);
  if (written == kOk) print_next_commands(arguments.output, options.person);
  return written;
}

}  // namespace clearance
