#include "config/cell/stopping_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "config/cell/stop_table.hpp"
#include "config/text/sentences.hpp"
#include "config/text/spelling.hpp"
#include "config/yaml/map_reader.hpp"
#include "config/yaml/scalar.hpp"

namespace clearance {
namespace {

constexpr Range kPercents{.least = 0.0, .most = 1000.0};
constexpr Range kSpeedPercents{.least = 0.0, .most = 1000.0, .above_least = true};
// From its speed, a joint that brakes goes at most as far as without brakes, and hardly less than
// this share of it. Noise and rounding are in the greater one.
constexpr double kLeastShare = 0.05, kMostShare = 1.05;

// A joint whose position is one number of its own.
struct StoppedJoint {
  std::string name;  // without the prefix
  std::size_t joint = 0;
  double full_speed = 0.0;  // per second
  bool turns = true;
  std::optional<JointStop> stop = {};
};

class StoppingReader {
 public:
  StoppingReader(const std::filesystem::path& cell, const Quantities& quantities,
                 Revision& revision, std::span<const JointVariable> variables, Robot& robot)
      : cell_(cell),
        quantities_(quantities),
        diagnostics_(quantities.diagnostics()),
        revision_(revision),
        variables_(variables),
        robot_(robot) {}

  void read(const YamlNode& node);

 private:
  bool find_joints(const YamlNode& node);
  void read_table(const YamlNode& node);
  void read_exceptions(const YamlNode& node);
  void read_exception(const YamlNode& node, StoppedJoint& joint);
  std::optional<StopPoint> read_point(const YamlNode& node, const StoppedJoint& joint);
  std::optional<double> read_share(MapReader& map, const char* key);
  std::optional<double> read_deceleration(const YamlNode& node, bool turns);
  [[nodiscard]] StoppedJoint* named(const std::string& name);
  [[nodiscard]] std::vector<std::string> names() const;
  // An empty text: the numbers fit one another.
  [[nodiscard]] static std::string doubt(const StoppedJoint& joint, const StopPoint& point);
  void keep(const YamlNode& node);

  const std::filesystem::path& cell_;
  const Quantities& quantities_;
  Diagnostics& diagnostics_;
  Revision& revision_;
  std::span<const JointVariable> variables_;
  Robot& robot_;
  std::vector<StoppedJoint> joints_;
  std::optional<double> load_, extension_;  // shares of the largest; nothing: the worst counts
};

// The joints whose stops have to be known.
bool StoppingReader::find_joints(const YamlNode& node) {
  for (std::size_t i = 0; i < robot_.joints.size(); ++i) {
    const RobotJoint& joint = robot_.joints[i];
    if (joint.type == JointType::kFixed || robot_.is_of_base(joint.variable)) continue;
    const JointVariable& variable = variables_[joint.variable];
    if (variables_of(joint.type) != 1) {
      diagnostics_.add(node, fmt::format("found 'stopping' of a robot with '{}', which has several "
                                         "positions; expected joints with one each",
                                         joint.name));
      return false;
    }
    if (variable.name != joint.name) continue;  // it mimics another
    joints_.push_back({.name = joint.name.substr(robot_.prefix.size()),
                       .joint = i,
                       .full_speed = variable.max_speed,
                       .turns = joint.type != JointType::kPrismatic});
  }
  return true;
}

std::vector<std::string> StoppingReader::names() const {
  std::vector<std::string> all;
  for (const StoppedJoint& joint : joints_) all.push_back(joint.name);
  return all;
}

// Tables have names, or numbers from the base on.
StoppedJoint* StoppingReader::named(const std::string& name) {
  const auto found = std::ranges::find(joints_, name, &StoppedJoint::name);
  if (found != joints_.end()) return &*found;
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  const bool is_number = error == std::errc() && end == name.data() + name.size();
  return is_number && number >= 1 && number <= joints_.size() ? &joints_[number - 1] : nullptr;
}

std::string StoppingReader::doubt(const StoppedJoint& joint, const StopPoint& point) {
  if (!std::isfinite(joint.full_speed))
    return fmt::format(
        "found a stop of '{}' from a share of its speed, which nothing states; "
        "expected a velocity limit in the URDF, or `velocity` under `joints`",
        joint.name);
  const double unbraked = point.speed * point.time;
  if (point.distance >= kLeastShare * unbraked && point.distance <= kMostShare * unbraked)
    return "";
  const char* unit = joint.turns ? "rad" : "m";
  return fmt::format(
      "found {:.4g} {} in {:.4g} s for '{}', which would go {:.4g} {} in this time without brakes, "
      "at {:.4g} {}/s; expected from {} to {} of that: is a unit wrong, or the speed limit?",
      point.distance, unit, point.time, joint.name, unbraked, unit, point.speed, unit, kLeastShare,
      kMostShare);
}

// Nothing: 'worst', or the key is not there.
std::optional<double> StoppingReader::read_share(MapReader& map, const char* key) {
  const YamlNode* node = map.optional(key);
  if (node == nullptr || node->text == "worst") return std::nullopt;
  const auto percent =
      read_number(*node, kPercents, fmt::format("'worst', or a {} in percent", key), diagnostics_);
  return percent ? std::optional(0.01 * *percent) : std::nullopt;
}

// The rows of a joint at the stated load and extension, or at the next printed ones above. Rows at
// lower ones count as well, since tables are not monotone.
void StoppingReader::read_table(const YamlNode& node) {
  const auto name = read_text(node, "a CSV file", diagnostics_);
  if (!name) return;
  const std::filesystem::path path = path_in(revision_.root(), cell_.parent_path(), *name);
  const auto bytes = revision_.read(path, *name);
  if (const auto* fault = std::get_if<FileFault>(&bytes)) {
    diagnostics_.add(node, fmt::format("found a file that cannot be used: {}; expected a path "
                                       "relative to the cell file",
                                       fault->reason));
    return;
  }
  revision_.add_file(path, std::get<std::string>(bytes));
  const auto read = stop_rows(std::get<std::string>(bytes));
  const auto refuse = [&](int line, const std::string& text) {
    diagnostics_.add(node, *name, NamedFileMistake{line, text});
  };
  if (const auto* mistake = std::get_if<NamedFileMistake>(&read))
    return refuse(mistake->line, mistake->text);
  const auto& rows = std::get<std::vector<StopRow>>(read);
  // The printed step that is taken for a stated share; nothing: none is as high.
  const auto step = [&](std::optional<double> stated, double StopRow::*share) {
    std::optional<double> next;
    for (const StopRow& row : rows) {
      if (!stated)
        next = std::max(next.value_or(0.0), row.*share);
      else if (row.*share >= *stated)
        next = std::min(next.value_or(row.*share), row.*share);
    }
    return next;
  };
  const auto load = step(load_, &StopRow::load), extension = step(extension_, &StopRow::extension);
  if (!load || !extension)
    return refuse(1,
                  "found no row for as high a load or extension as the cell states; expected "
                  "one, or a lower load or extension");
  std::vector<std::vector<StopPoint>> points(joints_.size());
  for (const StopRow& row : rows) {
    StoppedJoint* const joint = named(row.joint);
    if (joint == nullptr)
      return refuse(row.line, fmt::format("found the joint '{}'; expected one of {}, or its number",
                                          row.joint, one_of(names())));
    if (joint->turns != row.is_angle)
      return refuse(row.line, fmt::format("found '{}', which {}; expected {}", joint->name,
                                          joint->turns ? "turns" : "slides",
                                          joint->turns ? "angle_deg" : "distance_mm"));
    if (row.category >= 0 && row.category != robot_.stopping.category) continue;
    if (row.load > *load || row.extension > *extension) continue;
    const StopPoint point{row.speed * joint->full_speed, row.distance, row.time};
    if (const std::string text = doubt(*joint, point); !text.empty()) return refuse(row.line, text);
    points[static_cast<std::size_t>(joint - joints_.data())].push_back(point);
  }
  for (std::size_t i = 0; i < joints_.size(); ++i)
    if (!points[i].empty()) joints_[i].stop = JointStop::by_table(std::move(points[i]));
}

std::optional<double> StoppingReader::read_deceleration(const YamlNode& node, bool turns) {
  if (!turns) return quantities_.acceleration(node, "a deceleration");
  const auto angle = quantities_.angle(node, "a deceleration, per s2");
  if (angle && *angle > 0.0) return angle;
  if (angle) diagnostics_.add(node, fmt::format("found {}; expected one above 0", node.text));
  return std::nullopt;
}

// [percent of the full speed, distance, ms]
std::optional<StopPoint> StoppingReader::read_point(const YamlNode& node,
                                                    const StoppedJoint& joint) {
  const char* what = "the percent of its full speed, an angle or a length, and ms";
  const std::vector<YamlNode>& items = read_list(node, what, diagnostics_);
  if (items.size() != 3) {
    diagnostics_.add(node, fmt::format("found {} numbers; expected {}", items.size(), what));
    return std::nullopt;
  }
  const auto percent = read_number(items[0], kSpeedPercents, "percent of a speed", diagnostics_);
  const auto distance = joint.turns
                            ? quantities_.angle(items[1], "an angle until the joint stands")
                            : quantities_.length(items[1], "a distance until the joint stands");
  const auto time = quantities_.milliseconds(items[2], "the time until a joint stands", kPositive);
  if (!percent || !distance || !time) return std::nullopt;
  StopPoint point{0.01 * *percent * joint.full_speed, *distance, 1e-9 * static_cast<double>(*time)};
  const std::string text = doubt(joint, point);
  if (text.empty()) return point;
  diagnostics_.add(node, text);
  return std::nullopt;
}

void StoppingReader::read_exception(const YamlNode& node, StoppedJoint& joint) {
  MapReader map(node, "a joint's stop", diagnostics_);
  const YamlNode* points = map.optional("points");
  const YamlNode* deceleration = map.optional("deceleration");
  const YamlNode* time = map.optional("time_ms");
  map.refuse_unknown_keys();
  if ((points != nullptr) + (deceleration != nullptr) + (time != nullptr) != 1) {
    diagnostics_.add(node, fmt::format("found {} for the stop of '{}'; expected one of points, "
                                       "deceleration and time_ms",
                                       describe(node), joint.name));
    return;
  }
  if (points != nullptr) {
    std::vector<StopPoint> all;
    for (const YamlNode& item : read_list(*points, "[percent, distance, ms]", diagnostics_))
      if (const auto point = read_point(item, joint)) all.push_back(*point);
    if (!all.empty()) joint.stop = JointStop::by_table(std::move(all));
  } else if (deceleration != nullptr) {
    if (const auto value = read_deceleration(*deceleration, joint.turns))
      joint.stop = JointStop::by_deceleration(*value);
  } else if (const auto value =
                 quantities_.milliseconds(*time, "the time until a joint stands", kPositive)) {
    joint.stop = JointStop::by_time(1e-9 * static_cast<double>(*value));
  }
}

void StoppingReader::read_exceptions(const YamlNode& node) {
  if (node.kind != YamlNode::Kind::kMap) {
    diagnostics_.add(node,
                     fmt::format("found {}; expected joints and their stops: {{NAME: {{...}}}}",
                                 describe(node)));
  }
  for (const YamlEntry& entry : node.entries) {
    const auto name = read_name(entry.key, "a joint's name", diagnostics_);
    if (!name) continue;
    const auto joint = std::ranges::find(joints_, *name, &StoppedJoint::name);
    if (joint != joints_.end()) {
      read_exception(entry.value, *joint);
    } else {
      diagnostics_.add(entry.key, fmt::format("found the joint '{}'; expected one of {}{}", *name,
                                              one_of(names()), did_you_mean(*name, names())));
    }
  }
}

// Every joint that moves needs a stop. One that mimics another has that one's.
void StoppingReader::keep(const YamlNode& node) {
  std::vector<std::string> missing;
  for (const StoppedJoint& joint : joints_)
    if (!joint.stop) missing.push_back(joint.name);
  if (!missing.empty()) {
    diagnostics_.add(node, fmt::format("found no stop of {}; expected rows in `table`, an entry of "
                                       "`joints`, or `time_ms` for all others",
                                       listed(missing, 8)));
    return;
  }
  robot_.stopping.joints.resize(robot_.joints.size());
  for (std::size_t i = 0; i < robot_.joints.size(); ++i) {
    for (const StoppedJoint& joint : joints_)
      if (robot_.joints[joint.joint].variable == robot_.joints[i].variable &&
          variables_of(robot_.joints[i].type) == 1)
        robot_.stopping.joints[i] = *joint.stop;
  }
}

void StoppingReader::read(const YamlNode& node) {
  MapReader map(node, "the stopping of a robot", diagnostics_);
  RobotStops& stopping = robot_.stopping;
  const std::size_t mistakes = diagnostics_.count();
  if (const YamlNode* category = map.optional("category"))
    stopping.category =
        static_cast<int>(read_integer(*category, 0, kStopCategories - 1,
                                      "a stop category of IEC 60204-1", diagnostics_)
                             .value_or(stopping.category));
  if (const YamlNode* reaction = map.required("reaction_ms")) {
    const auto time =
        quantities_.milliseconds(*reaction, "the time until brakes act", kNotNegative);
    stopping.reaction = 1e-9 * static_cast<double>(time.value_or(0));
  }
  if (const YamlNode* path = map.optional("path")) {
    stopping.keeps_path = path->text == "kept";
    if (!stopping.keeps_path && path->text != "left")
      diagnostics_.add(*path, fmt::format("found {}; expected 'kept' or 'left'", describe(*path)));
  }
  load_ = read_share(map, "load");
  extension_ = read_share(map, "extension");
  const YamlNode* table = map.optional("table");
  const YamlNode* joints = map.optional("joints");
  const YamlNode* time = map.optional("time_ms");
  map.refuse_unknown_keys();
  if (!find_joints(node)) return;
  if (table != nullptr) read_table(*table);
  if (joints != nullptr) read_exceptions(*joints);
  if (time != nullptr) {
    const auto most = quantities_.milliseconds(*time, "the time until a joint stands", kPositive);
    for (StoppedJoint& joint : joints_)
      if (!joint.stop && most) joint.stop = JointStop::by_time(1e-9 * static_cast<double>(*most));
  }
  if (diagnostics_.count() == mistakes) keep(node);
}

}  // namespace

void read_stopping(const YamlNode& node, const std::filesystem::path& cell,
                   const Quantities& quantities, Revision& revision,
                   std::span<const JointVariable> variables, Robot& robot) {
  StoppingReader(cell, quantities, revision, variables, robot).read(node);
}

}  // namespace clearance
