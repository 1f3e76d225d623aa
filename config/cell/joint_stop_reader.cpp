#include "config/cell/joint_stop_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "config/text/sentences.hpp"
#include "config/text/spelling.hpp"
#include "config/yaml/map_reader.hpp"
#include "config/yaml/scalar.hpp"

namespace clearance {
namespace {

constexpr Range kStopTimes{.least = 10.0, .most = 60e3};  // ms: no joint stands earlier or later
constexpr Range kPointTimes{.least = 1.0, .most = 60e3};  // ms: of slow joints, too
constexpr Range kPercents{.least = 1.0, .most = 1000.0};

// A change of speed per second, which a joint has or all have.
struct Rate {
  const char* what;
  double StoppedJoint::*urdf;
  std::string (*doubt)(const StoppedJoint&, double);
};
constexpr Rate kDeceleration{"deceleration", &StoppedJoint::urdf_deceleration,
                             doubt_of_deceleration};
constexpr Rate kAcceleration{"acceleration", &StoppedJoint::urdf_acceleration,
                             doubt_of_acceleration};

double seconds(std::int64_t ns) { return 1e-9 * static_cast<double>(ns); }

class JointStopReader {
 public:
  JointStopReader(const Quantities& quantities, StoppedJoints& joints)
      : quantities_(quantities), diagnostics_(quantities.diagnostics()), joints_(joints) {}

  void read_joints(const YamlNode& node);
  void read_time(const YamlNode& node);
  void read_deceleration(const YamlNode& node);
  void read_acceleration(const YamlNode& node);

 private:
  void read_joint(const YamlNode& node, StoppedJoint& joint);
  void read_points(const YamlNode& node, StoppedJoint& joint);
  std::optional<StopPoint> read_point(const YamlNode& node, const StoppedJoint& joint);
  std::optional<double> read_rate(const YamlNode& node, const StoppedJoint& joint,
                                  const Rate& rate);
  using Rates = std::vector<std::optional<double>>;
  Rates read_rates(const YamlNode& node, const Rate& rate,
                   const std::vector<StoppedJoint*>& joints);
  Rates urdf_rates(const YamlNode& node, const Rate& rate,
                   const std::vector<StoppedJoint*>& joints);
  // Returns the joints that have no statement of this kind, by an entry of `joints` or by a row.
  template <class Has>
  std::vector<StoppedJoint*> others(Has has) {
    std::vector<StoppedJoint*> found;
    for (StoppedJoint& joint : joints_.all)
      if (!has(joint)) found.push_back(&joint);
    return found;
  }

  const Quantities& quantities_;
  Diagnostics& diagnostics_;
  StoppedJoints& joints_;
};

std::optional<double> JointStopReader::read_rate(const YamlNode& node, const StoppedJoint& joint,
                                                 const Rate& rate) {
  const std::string what = fmt::format("the {} of '{}', {} per s2,", rate.what, joint.name,
                                       joint.turns ? "an angle" : "a length");
  const auto value =
      joint.turns ? quantities_.angle(node, what) : quantities_.length(node, what, kPositive);
  if (!value) return std::nullopt;
  std::string doubt = *value > 0.0 ? rate.doubt(joint, *value)
                                   : fmt::format("found {}; expected {} above 0", node.text, what);
  if (doubt.empty()) return value;
  diagnostics_.add(node, doubt);
  return std::nullopt;
}

// Reads the rates of URDF 1.2. A joint without one gets none.
JointStopReader::Rates JointStopReader::urdf_rates(const YamlNode& node, const Rate& rate,
                                                   const std::vector<StoppedJoint*>& joints) {
  Rates rates;
  for (const StoppedJoint* joint : joints) {
    const double value = joint->*rate.urdf;
    rates.push_back(std::isfinite(value) ? std::optional(value) : std::nullopt);
    if (!rates.back()) continue;
    if (const std::string doubt = rate.doubt(*joint, value); !doubt.empty())
      diagnostics_.add(node, doubt);
  }
  return rates;
}

// One number for all of these joints, or what the URDF states.
JointStopReader::Rates JointStopReader::read_rates(const YamlNode& node, const Rate& rate,
                                                   const std::vector<StoppedJoint*>& joints) {
  if (node.kind == YamlNode::Kind::kScalar && node.text == "urdf")
    return urdf_rates(node, rate, joints);
  Rates rates(joints.size());
  const auto slides = std::ranges::find(joints, false, &StoppedJoint::turns);
  const auto turns = std::ranges::find(joints, true, &StoppedJoint::turns);
  if (slides != joints.end() && turns != joints.end()) {
    diagnostics_.add(node, fmt::format("found one {} for '{}', which turns, and '{}', which "
                                       "slides; expected it under `joints`, or 'urdf'",
                                       rate.what, (*turns)->name, (*slides)->name));
    return rates;
  }
  const std::size_t mistakes = diagnostics_.count();
  for (std::size_t i = 0; i < rates.size() && diagnostics_.count() == mistakes; ++i)
    rates[i] = read_rate(node, *joints[i], rate);
  return rates;
}

// [percent of the full speed, distance, ms]
std::optional<StopPoint> JointStopReader::read_point(const YamlNode& node,
                                                     const StoppedJoint& joint) {
  const std::string what = fmt::format("[percent of the full speed of '{}', {}, ms]", joint.name,
                                       joint.turns ? "angle" : "length");
  if (node.kind != YamlNode::Kind::kSequence || node.items.size() != 3) {
    diagnostics_.add(node, fmt::format("found {}; expected {}", describe(node), what));
    return std::nullopt;
  }
  const auto percent =
      read_number(node.items[0], kPercents, "percent of the full speed", diagnostics_);
  const auto distance =
      joint.turns ? quantities_.angle(node.items[1], "the angle until the joint stands,")
                  : quantities_.length(node.items[1], "the distance until the joint stands,");
  const auto time =
      quantities_.milliseconds(node.items[2], "the time until the joint stands", kPointTimes);
  if (!percent || !distance || !time) return std::nullopt;
  const StopPoint point{0.01 * *percent * joint.full_speed, *distance, seconds(*time)};
  const std::string doubt = doubt_of_point(joint, point);
  if (doubt.empty()) return point;
  diagnostics_.add(node, doubt);
  return std::nullopt;
}

void JointStopReader::read_points(const YamlNode& node, StoppedJoint& joint) {
  const std::size_t mistakes = diagnostics_.count();
  std::vector<StopPoint> points;
  for (const YamlNode& item : read_list(node, "[percent, distance, ms]", diagnostics_))
    if (const auto point = read_point(item, joint)) points.push_back(*point);
  if (!points.empty())
    joint.stop = JointStop::by_table(std::move(points));
  else if (diagnostics_.count() == mistakes)
    diagnostics_.add(node, "found an empty list; expected at least one point");
}

void JointStopReader::read_joint(const YamlNode& node, StoppedJoint& joint) {
  MapReader map(node, "the stop of a joint", diagnostics_);
  const YamlNode* points = map.optional("points");
  const YamlNode* deceleration = map.optional("deceleration");
  const YamlNode* time = map.optional("time_ms");
  const YamlNode* acceleration = map.optional("acceleration");
  map.refuse_unknown_keys();
  if (acceleration != nullptr) joint.acceleration = read_rate(*acceleration, joint, kAcceleration);
  const int stops = (points != nullptr) + (deceleration != nullptr) + (time != nullptr);
  if (stops > 0) joint.by_step.clear();
  if (stops > 1 || (stops == 0 && acceleration == nullptr)) {
    diagnostics_.add(node, fmt::format("found {} stops of '{}'; expected one of points, "
                                       "deceleration and time_ms",
                                       stops, joint.name));
  } else if (points != nullptr) {
    read_points(*points, joint);
  } else if (deceleration != nullptr) {
    if (const auto value = read_rate(*deceleration, joint, kDeceleration))
      joint.stop = JointStop::by_deceleration(*value);
  } else if (time != nullptr) {
    const auto until = quantities_.milliseconds(
        *time, fmt::format("the time until '{}' stands", joint.name), kStopTimes);
    if (until) joint.stop = JointStop::by_time(seconds(*until));
  }
}

void JointStopReader::read_joints(const YamlNode& node) {
  if (node.kind != YamlNode::Kind::kMap) {
    diagnostics_.add(node,
                     fmt::format("found {}; expected joints and their stops: {{NAME: {{...}}}}",
                                 describe(node)));
  }
  std::set<std::string> known;
  for (const YamlEntry& entry : node.entries) {
    const auto name = read_name(entry.key, "a joint's name", diagnostics_);
    if (!name) continue;
    if (!known.insert(*name).second) {
      diagnostics_.add(entry.key,
                       fmt::format("found the joint '{}' again; expected it once", *name));
      continue;
    }
    const auto joint = std::ranges::find(joints_.all, *name, &StoppedJoint::name);
    if (joint != joints_.all.end()) {
      read_joint(entry.value, *joint);
    } else {
      diagnostics_.add(
          entry.key,
          fmt::format("found the joint '{}'; expected one that moves and does not "
                      "mimic another: {}{}",
                      *name, one_of(joints_.names()), did_you_mean(*name, joints_.names())));
    }
  }
}

void JointStopReader::read_time(const YamlNode& node) {
  const auto until = quantities_.milliseconds(node, "the time until each joint stands", kStopTimes);
  for (StoppedJoint& joint : joints_.all)
    if (!joint.stop && until) joint.stop = JointStop::by_time(seconds(*until));
}

void JointStopReader::read_deceleration(const YamlNode& node) {
  const auto joints = others([](const StoppedJoint& joint) { return joint.stop.has_value(); });
  const Rates rates = read_rates(node, kDeceleration, joints);
  for (std::size_t i = 0; i < rates.size(); ++i)
    if (rates[i]) joints[i]->stop = JointStop::by_deceleration(*rates[i]);
}

void JointStopReader::read_acceleration(const YamlNode& node) {
  const std::size_t mistakes = diagnostics_.count();
  const auto joints =
      others([](const StoppedJoint& joint) { return joint.acceleration.has_value(); });
  const Rates rates = read_rates(node, kAcceleration, joints);
  for (std::size_t i = 0; i < rates.size(); ++i) {
    joints[i]->acceleration = rates[i];
    if (rates[i] || diagnostics_.count() != mistakes) continue;
    diagnostics_.add(node, fmt::format("found no acceleration of '{}' in the URDF; expected one "
                                       "there or under `joints`",
                                       joints[i]->name));
    return;
  }
}

}  // namespace

void read_joint_stops(const StopsOfJoints& stated, const Quantities& quantities,
                      StoppedJoints& joints) {
  JointStopReader reader(quantities, joints);
  if (stated.joints != nullptr) reader.read_joints(*stated.joints);
  if (stated.time != nullptr && stated.deceleration != nullptr) {
    quantities.diagnostics().add(*stated.deceleration,
                                 "found deceleration beside time_ms; expected one of the two");
  } else if (stated.time != nullptr) {
    reader.read_time(*stated.time);
  } else if (stated.deceleration != nullptr) {
    reader.read_deceleration(*stated.deceleration);
  }
  if (stated.acceleration != nullptr) reader.read_acceleration(*stated.acceleration);
}

}  // namespace clearance
