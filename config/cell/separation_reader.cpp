// A term with a value in a standard has it as default; a term that only the cell's owner can know
// is required.
#include "config/cell/separation_reader.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "config/scene/attached.hpp"
#include "config/scene/people.hpp"
#include "config/text/sentences.hpp"

namespace clearance {
namespace {

// Reads the quantities of one map.
class SeparationReader {
 public:
  SeparationReader(const YamlNode& node, const Quantities& quantities)
      : map_(node, "the separation of a zone", quantities.diagnostics()), quantities_(quantities) {}

  Separation read();
  // Returns the side of `between` that is people, 0 or 1; nothing after a diagnostic.
  std::optional<std::size_t> read_human_side(const Between& between);
  void refuse_unknown_keys() { map_.refuse_unknown_keys(); }

 private:
  void read_human(Separation& separation);
  void read_robot(Separation& separation);
  void read_reaction(Separation& separation);
  double length_or(const YamlNode* node, const std::string& what, double otherwise) const {
    return node == nullptr ? otherwise
                           : quantities_.length(*node, what, kNotNegative).value_or(otherwise);
  }
  std::int64_t required_time(const char* key, const std::string& what) {
    const YamlNode* node = map_.required(key);
    return node == nullptr ? 0 : quantities_.milliseconds(*node, what, kNotNegative).value_or(0);
  }

  MapReader map_;
  const Quantities& quantities_;
};

std::optional<std::size_t> SeparationReader::read_human_side(const Between& between) {
  const YamlNode* node = map_.required("human");
  if (node == nullptr) return std::nullopt;
  const auto name =
      read_name(*node, "the side of the zone where people are", quantities_.diagnostics());
  if (!name) return std::nullopt;
  const auto found = std::ranges::find(between.names, *name);
  if (found != between.names.end()) return found - between.names.begin();
  quantities_.diagnostics().add(
      *node, fmt::format("found human: '{}'; expected one of the two sides of the zone, {}", *name,
                         one_of(between.names)));
  return std::nullopt;
}

// A person who stands may walk in the next second, so the measured speed needs an acceleration.
void SeparationReader::read_human(Separation& separation) {
  if (const YamlNode* speed = map_.optional("human_speed")) {
    separation.human_speed = quantities_.speed(*speed, "the speed of people");
  }
  const YamlNode* measured = map_.optional("human_speed_measured");
  const YamlNode* acceleration = map_.optional("human_acceleration");
  Diagnostics& diagnostics = quantities_.diagnostics();
  if (measured != nullptr)
    separation.human_speed_is_measured = read_flag(*measured, diagnostics).value_or(false);
  if (acceleration != nullptr) {
    separation.human_acceleration =
        quantities_.acceleration(*acceleration, "the acceleration of people").value_or(0.0);
  }
  if (separation.human_speed_is_measured == (acceleration != nullptr)) return;
  const YamlNode& at = acceleration != nullptr ? *acceleration : *measured;
  diagnostics.add(at, acceleration != nullptr
                          ? "found human_acceleration without human_speed_measured: true; expected "
                            "both or none"
                          : "found human_speed_measured without human_acceleration; expected what "
                            "a person can accelerate by until the robot stands");
}

void SeparationReader::read_robot(Separation& separation) {
  if (const YamlNode* speed = map_.optional("robot_speed")) {
    separation.robot_speed =
        quantities_.speed(*speed, "the robot's largest speed").value_or(separation.robot_speed);
  }
  if (const YamlNode* acceleration = map_.optional("robot_acceleration")) {
    separation.robot_acceleration =
        quantities_.acceleration(*acceleration, "the robot's acceleration").value_or(0.0);
  }
  read_reaction(separation);
  separation.stopping_time_ns = required_time("stopping_time_ms", "the time of braking");
  separation.stopping_distance = length_or(map_.required("stopping_distance"),
                                           "the way that the robot goes while it brakes", 0.0);
  if (const YamlNode* speed = map_.optional("stopping_speed")) {
    separation.stopping_speed =
        quantities_.speed(*speed, "the speed from which the robot was stopped").value_or(0.0);
  }
}

// All of T_r is stated, or the part that only the cell's owner can measure.
void SeparationReader::read_reaction(Separation& separation) {
  const YamlNode* controller = map_.optional("controller_time_ms");
  if (controller == nullptr) {
    separation.reaction_time_ns =
        required_time("reaction_time_ms", "the time until the robot brakes");
    return;
  }
  separation.reaction_is_measured = true;
  separation.reaction_time_ns =
      quantities_.milliseconds(*controller, "the time of network and controller", kNotNegative)
          .value_or(0);
  if (map_.optional("reaction_time_ms") == nullptr) return;
  quantities_.diagnostics().add(
      *controller,
      "found controller_time_ms beside reaction_time_ms; expected one of them: with "
      "controller_time_ms, the daemon's part is measured");
}

Separation SeparationReader::read() {
  Separation separation;
  read_human(separation);
  read_robot(separation);
  separation.intrusion_distance =
      length_or(map_.required("intrusion_distance"), "how far people can be in unseen", 0.0);
  separation.human_uncertainty =
      length_or(map_.optional("human_uncertainty"), "how far off people's poses are", 0.0);
  separation.robot_uncertainty =
      length_or(map_.optional("robot_uncertainty"), "how far off the robot's pose is", 0.0);
  return separation;
}

}  // namespace

Separation read_separation(const YamlNode& node, const Between& between, const Zone& zone,
                           const PairList& list, const ObjectList& objects,
                           const Quantities& quantities) {
  SeparationReader reader(node, quantities);
  const auto side = reader.read_human_side(between);
  Separation separation = reader.read();
  reader.refuse_unknown_keys();
  if (!side) return separation;
  separation.human_is_a = *side == 0;
  const std::vector<std::uint32_t>&people = *between.objects[*side],
        &robots = *between.objects[1 - *side];
  for (const std::uint32_t person : people) {
    if (!std::ranges::binary_search(robots, person)) continue;
    quantities.diagnostics().add(node, on_both_sides(objects.objects[person]));
    return separation;
  }
  const auto is_of = [](const std::vector<std::uint32_t>& members, std::uint32_t object) {
    return std::ranges::binary_search(members, object);
  };
  const auto is_contact = [&](PairKey key) {
    const auto is_between = [&](std::uint32_t person, std::uint32_t robot) {
      return is_of(people, person) && is_of(robots, robot) && !objects.objects[robot].fixed;
    };
    const std::uint32_t a = first_of(key), b = second_of(key);
    return is_between(a, b) || is_between(b, a);
  };
  for (const std::vector<PairKey>* keys : {&objects.touching, &list.allowed}) {
    const auto found = std::ranges::find_if(*keys, is_contact);
    if (found == keys->end()) continue;
    quantities.diagnostics().add(node,
                                 no_contact_with_people(objects.objects[first_of(*found)],
                                                        objects.objects[second_of(*found)], zone));
    return separation;
  }
  // A sensor measures no speed of what it sees.
  const auto is_seen = [&](std::uint32_t object) { return objects.objects[object].is_seen(); };
  if (const auto robot = std::ranges::find_if(robots, is_seen); robot != robots.end()) {
    quantities.diagnostics().add(
        node,
        fmt::format("found the sensor '{}' on the robot's side of the zone; expected it on that "
                    "of people: 'human' names the other side",
                    objects.objects[*robot].name));
    return separation;
  }
  if (const auto person = std::ranges::find_if(people, is_seen);
      person != people.end() && separation.human_speed_is_measured) {
    quantities.diagnostics().add(
        node,
        fmt::format("found human_speed_measured with the sensor '{}', which measures no speeds; "
                    "expected human_speed alone",
                    objects.objects[*person].name));
    return separation;
  }
  for (const std::uint32_t pair : zone.pairs)
    separation.human_is_first.push_back(std::ranges::binary_search(people, list.pairs[pair].first));
  return separation;
}

}  // namespace clearance
