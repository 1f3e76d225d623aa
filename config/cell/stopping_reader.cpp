#include "config/cell/stopping_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "config/cell/joint_stop_reader.hpp"
#include "config/cell/measured_steps.hpp"
#include "config/cell/ros_reader.hpp"
#include "config/cell/stop_steps.hpp"
#include "config/cell/stop_table.hpp"
#include "config/cell/stopped_joints.hpp"
#include "config/text/printable.hpp"
#include "config/text/sentences.hpp"
#include "config/yaml/map_reader.hpp"
#include "config/yaml/scalar.hpp"

namespace clearance {
namespace {

// A percentage up to 1 is probably a share.
constexpr Range kPercents{.least = 1.0, .most = 1000.0, .above_least = true};
constexpr Range kFullLoads{.least = 0.01, .most = 1e6}, kMasses{.least = 0.0, .most = 1e6};  // kg
constexpr Range kReactions{.least = 0.0, .most = 60e3};                                      // ms

class StoppingReader {
 public:
  StoppingReader(const std::filesystem::path& cell, const Quantities& quantities,
                 Revision& revision, std::span<const JointVariable> variables, Robot& robot)
      : cell_(cell),
        quantities_(quantities),
        diagnostics_(quantities.diagnostics()),
        revision_(revision),
        variables_(variables),
        robot_(robot),
        joints_(stopped_joints(robot, variables)) {}

  void read(const YamlNode& node);

 private:
  void read_conditions(MapReader& map);
  std::optional<double> read_share(const YamlNode* node, const char* key);
  void read_load(const YamlNode& node);
  void read_extension(const YamlNode& node);
  void read_table(const YamlNode& node);
  void read_csv(const YamlNode& node);
  void read_inline(const YamlNode& node);
  // Returns the first mistake.
  std::optional<StopMistake> use_rows(std::vector<StopRow> rows);
  std::optional<StopMistake> use_steps(int place,
                                       const std::vector<std::vector<StopRow>>& of_joint);
  void keep(const YamlNode& node);

  const std::filesystem::path& cell_;
  const Quantities& quantities_;
  Diagnostics& diagnostics_;
  Revision& revision_;
  std::span<const JointVariable> variables_;
  Robot& robot_;
  StoppedJoints joints_;
  StopConditions conditions_;
  std::vector<StopStep> steps_;
};

// Nothing: 'worst', or the key is not there.
std::optional<double> StoppingReader::read_share(const YamlNode* node, const char* key) {
  if (node == nullptr || node->text == "worst") return std::nullopt;
  if (node->text == "0") return 0.0;
  const auto percent = read_number(
      *node, kPercents, fmt::format("'worst', the {} in percent of the largest, or a map", key),
      diagnostics_);
  return percent ? std::optional(0.01 * *percent) : std::nullopt;
}

// {full: kg, tool: kg}
void StoppingReader::read_load(const YamlNode& node) {
  MapReader map(node, "a load by masses", diagnostics_);
  CarriedLoad& load = robot_.stopping.load;
  if (const YamlNode* full = map.required("full"))
    load.full =
        read_number(*full, kFullLoads, "the largest load in kg", diagnostics_).value_or(1.0);
  if (const YamlNode* tool = map.required("tool"))
    load.tool =
        read_number(*tool, kMasses, "the mass of the tool in kg", diagnostics_).value_or(0.0);
  map.refuse_unknown_keys();
}

// {link: NAME, reach: length}
void StoppingReader::read_extension(const YamlNode& node) {
  MapReader map(node, "an extension by postures", diagnostics_);
  const YamlNode* link = map.required("link");
  const YamlNode* reach = map.required("reach");
  map.refuse_unknown_keys();
  if (link == nullptr || reach == nullptr) return;
  const auto name = read_name(*link, "a link's name", diagnostics_);
  const auto length = quantities_.length(*reach, "the reach that the maker calls 100 %", kPositive);
  if (!name || !length) return;
  const auto extension = measured_extension(robot_, variables_, *name, *length);
  if (const auto* fault = std::get_if<std::string>(&extension)) {
    diagnostics_.add(*link, *fault);
    return;
  }
  robot_.stopping.extension = std::get<Extension>(extension);
}

// The worst of the table counts, unless the cell states a load and an extension or how they follow.
void StoppingReader::read_conditions(MapReader& map) {
  RobotStops& stops = robot_.stopping;
  if (const YamlNode* category = map.optional("category")) {
    const auto value = read_integer(*category, 0, kStopCategories - 1,
                                    "a stop category of IEC 60204-1", diagnostics_);
    if (value) stops.category = static_cast<int>(*value);
  }
  if (const YamlNode* reaction = map.required("reaction_ms")) {
    const auto time = quantities_.milliseconds(
        *reaction, "the time from a report until the brakes act", kReactions);
    stops.reaction = 1e-9 * static_cast<double>(time.value_or(0));
  }
  if (const YamlNode* path = map.optional("path")) {
    stops.keeps_path = path->text == "kept";
    if (!stops.keeps_path && path->text != "left") {
      diagnostics_.add(*path, fmt::format("found {}; expected 'kept' or 'left'", describe(*path)));
    } else if (stops.keeps_path && stops.category == 0) {
      diagnostics_.add(*path,
                       "found path: kept of category 0, which takes the power away; expected "
                       "'left', or category 1 or 2");
    }
  }
  conditions_.category = stops.category;
  if (const YamlNode* stated = map.optional("stated_on")) {
    stops.stated_on = read_ros_topic(*stated, "/arm/stopping", diagnostics_);
    const std::array known{std::string_view(robot_.joint_states), std::string_view("/joint_states"),
                           std::string_view("/tf"), std::string_view("/tf_static")};
    if (!stops.stated_on.empty() && std::ranges::find(known, stops.stated_on) != known.end()) {
      diagnostics_.add(*stated, fmt::format("found '{}', whose messages are no std_msgs/Bool; "
                                            "expected a topic of its own, as /arm/stopping",
                                            stops.stated_on));
    }
  }
  const auto is_map = [](const YamlNode* node) {
    return node != nullptr && node->kind == YamlNode::Kind::kMap;
  };
  const YamlNode* load = map.optional("load");
  const YamlNode* extension = map.optional("extension");
  if (is_map(load))
    read_load(*load);
  else
    conditions_.load = read_share(load, "load");
  if (is_map(extension))
    read_extension(*extension);
  else
    conditions_.extension = read_share(extension, "extension");
}

std::optional<StopMistake> StoppingReader::use_rows(std::vector<StopRow> rows) {
  std::vector<std::vector<StopRow>> of_joint(joints_.all.size());
  bool is_of_category = false;
  for (StopRow& row : rows) {
    const StoppedJoint* const joint = joints_.named(row.joint);
    if (joint == nullptr)
      return StopMistake{row.place,
                         fmt::format("found the joint '{}'; expected {}, or its number from 1 to "
                                     "{}",
                                     row.joint, one_of(joints_.names()), joints_.all.size())};
    if (joint->turns != row.is_angle)
      return StopMistake{row.place,
                         fmt::format("found {} of the joint '{}'; expected {}, as it {}",
                                     row.is_angle ? "angle_deg" : "distance_mm", row.joint,
                                     joint->turns ? "angle_deg" : "distance_mm",
                                     joint->turns ? "turns" : "slides")};
    const StopPoint point{row.speed * joint->full_speed, row.distance, row.time};
    if (std::string doubt = doubt_of_point(*joint, point); !doubt.empty())
      return StopMistake{row.place, std::move(doubt)};
    is_of_category |= row.category < 0 || row.category == conditions_.category;
    of_joint[static_cast<std::size_t>(joint - joints_.all.data())].push_back(std::move(row));
  }
  if (!is_of_category)
    return StopMistake{rows.front().place,
                       fmt::format("found no row of category {}; expected some, or another "
                                   "`category` of the robot",
                                   conditions_.category)};
  return use_steps(rows.front().place, of_joint);
}

// A joint has a stop for each step of what is measured. The last one is the worst of all.
std::optional<StopMistake> StoppingReader::use_steps(
    int place, const std::vector<std::vector<StopRow>>& of_joint) {
  const RobotStops& stops = robot_.stopping;
  const bool is_extension_measured = stops.extension.reach > 0.0;
  const auto steps =
      measured_steps(of_joint, conditions_, stops.load.full > 0.0, is_extension_measured);
  if (is_extension_measured && *steps.back().extension < 1.0)
    return StopMistake{place, fmt::format("found extensions up to {:g} %; expected 100 % among "
                                          "them, since postures choose from them",
                                          100.0 * *steps.back().extension)};
  for (std::size_t i = 0; i < of_joint.size(); ++i) {
    StoppedJoint& joint = joints_.all[i];
    for (const StopConditions& step : steps) {
      auto counted = counted_rows(of_joint[i], step);
      if (auto* mistake = std::get_if<StopMistake>(&counted)) return std::move(*mistake);
      std::vector<StopPoint> points;
      for (const StopRow& row : std::get<std::vector<StopRow>>(counted))
        points.push_back({row.speed * joint.full_speed, row.distance, row.time});
      if (!points.empty()) joint.by_step.push_back(JointStop::by_table(std::move(points)));
    }
    if (!joint.by_step.empty()) joint.stop = joint.by_step.back();
  }
  for (const StopConditions& step : steps)
    steps_.push_back({step.load.value_or(1.0), step.extension.value_or(1.0), {}});
  return std::nullopt;
}

void StoppingReader::read_csv(const YamlNode& node) {
  const auto name = read_text(node, "a CSV file, or a list of rows", diagnostics_);
  if (!name) return;
  const std::filesystem::path path = path_in(revision_.root(), cell_.parent_path(), *name);
  const auto bytes = revision_.read(path, *name);
  if (const auto* fault = std::get_if<FileFault>(&bytes)) {
    diagnostics_.add(node, fmt::format("found a stopping table that cannot be used: {}; expected "
                                       "a path relative to the cell file",
                                       fault->reason));
    return;
  }
  revision_.add_file(path, std::get<std::string>(bytes));
  auto rows = stop_rows(std::get<std::string>(bytes));
  std::optional<StopMistake> mistake;
  if (auto* found = std::get_if<StopMistake>(&rows))
    mistake = std::move(*found);
  else
    mistake = use_rows(std::get<std::vector<StopRow>>(std::move(rows)));
  if (!mistake) return;
  diagnostics_.add(node, fmt::format("found a stopping table that cannot be used: {}:{}: {}", *name,
                                     mistake->place, excerpt(mistake->text)));
}

// The keys of a row are the columns of the CSV.
void StoppingReader::read_inline(const YamlNode& node) {
  if (node.items.empty())
    diagnostics_.add(node, "found an empty list; expected a row for each stop");
  const std::size_t mistakes = diagnostics_.count();
  std::vector<StopRow> rows;
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    const std::size_t before = diagnostics_.count();
    MapReader map(node.items[i], "a row of a stopping table", diagnostics_);
    StopCells cells;
    for (std::size_t column = 0; column < cells.size(); ++column) {
      const YamlNode* cell = map.optional(kStopColumns[column]);
      if (cell != nullptr && cell->kind == YamlNode::Kind::kScalar) {
        cells[column] = cell->text;
      } else if (cell != nullptr) {
        diagnostics_.add(*cell,
                         fmt::format("found {}; expected a number or a name", describe(*cell)));
      }
    }
    map.refuse_unknown_keys();
    if (diagnostics_.count() != before) continue;
    auto row = stop_row(cells);
    if (const auto* text = std::get_if<std::string>(&row)) {
      diagnostics_.add(node.items[i], *text);
      continue;
    }
    rows.push_back(std::get<StopRow>(std::move(row)));
    rows.back().place = static_cast<int>(i);
  }
  if (rows.empty() || diagnostics_.count() != mistakes) return;
  if (const auto mistake = use_rows(std::move(rows)))
    diagnostics_.add(node.items[static_cast<std::size_t>(mistake->place)], mistake->text);
}

void StoppingReader::read_table(const YamlNode& node) {
  if (node.kind == YamlNode::Kind::kSequence)
    read_inline(node);
  else
    read_csv(node);
}

// Every joint that moves needs a stop. One that mimics another has that one's.
void StoppingReader::keep(const YamlNode& node) {
  std::vector<std::string> missing;
  for (const StoppedJoint& joint : joints_.all)
    if (!joint.stop) missing.push_back("'" + joint.name + "'");
  if (!missing.empty()) {
    diagnostics_.add(node, fmt::format("found no stop of {}; expected rows in `table`, an entry of "
                                       "`joints`, or `time_ms` or `deceleration` for all others",
                                       listed(missing, 8)));
    return;
  }
  RobotStops& stops = robot_.stopping;
  stops.joints.resize(robot_.joints.size());
  stops.max_accelerations.assign(robot_.joints.size(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < robot_.joints.size(); ++i) {
    if (variables_of(robot_.joints[i].type) != 1) continue;
    const auto joint =
        std::ranges::find(joints_.all, robot_.joints[i].variable, &StoppedJoint::variable);
    if (joint == joints_.all.end()) continue;
    stops.joints[i] = *joint->stop;
    for (std::size_t step = 0; step < steps_.size(); ++step) {
      steps_[step].joints.resize(robot_.joints.size());
      steps_[step].joints[i] = joint->by_step.empty() ? *joint->stop : joint->by_step[step];
    }
    if (joint->acceleration) stops.max_accelerations[i] = *joint->acceleration;
  }
  if (stops.load.full > 0.0 || stops.extension.reach > 0.0) stops.steps = std::move(steps_);
}

void StoppingReader::read(const YamlNode& node) {
  const std::size_t mistakes = diagnostics_.count();
  MapReader map(node, "the stopping of a robot", diagnostics_);
  read_conditions(map);
  const YamlNode* table = map.optional("table");
  const StopsOfJoints stated{map.optional("joints"), map.optional("time_ms"),
                             map.optional("deceleration"), map.optional("acceleration")};
  map.refuse_unknown_keys();
  if (!joints_.refused.empty()) {
    diagnostics_.add(node, fmt::format("found 'stopping' of a robot with '{}', which has several "
                                       "positions; expected joints with one each",
                                       joints_.refused));
    return;
  }
  if (joints_.all.empty() && map.is_map())
    diagnostics_.add(node, "found 'stopping' of a robot without joints; expected some that move");
  const RobotStops& stops = robot_.stopping;
  for (const auto& [chooses, key] :
       {std::pair(conditions_.load || stops.load.full > 0.0, "load"),
        {conditions_.extension || stops.extension.reach > 0.0, "extension"}}) {
    if (chooses && table == nullptr)
      diagnostics_.add(node, fmt::format("found '{}' without 'table', whose rows it chooses; "
                                         "expected both",
                                         key));
  }
  if (table != nullptr) read_table(*table);
  read_joint_stops(stated, quantities_, joints_);
  if (diagnostics_.count() == mistakes) keep(node);
}

}  // namespace

void read_stopping(const YamlNode& node, const std::filesystem::path& cell,
                   const Quantities& quantities, Revision& revision,
                   std::span<const JointVariable> variables, Robot& robot) {
  StoppingReader(cell, quantities, revision, variables, robot).read(node);
}

}  // namespace clearance
