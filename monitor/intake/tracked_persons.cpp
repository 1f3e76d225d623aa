#include "monitor/intake/tracked_persons.hpp"

#include <algorithm>

#include "config/scene/absent_robots.hpp"
#include "config/scene/body_id.hpp"
#include "monitor/wire/ros_types.hpp"

namespace clearance {
namespace {

// State of a person by the list. Without a value: absent. The id of a body: there, with this
// body. Empty: there, and nothing says where.
using State = std::optional<std::string>;

State state_of(const Robot& person, const Scene& scene) {
  return is_absent(person, scene.objects) ? State() : State(person.person->id);
}

// True if another robot has a joint of the name that one of the person's would get.
bool has_a_joint_of(const std::string& body, const Robot& person, const Scene& scene) {
  const std::size_t ending = body_name(person.person->id, person.name).size();
  return std::ranges::any_of(person.joints, [&](const RobotJoint& joint) {
    if (joint.name.size() < ending) return false;
    const std::string name = joint.name.substr(0, joint.name.size() - ending) + body;
    return std::ranges::any_of(scene.variables, [&](const JointVariable& variable) {
      return variable.name == name && &scene.robots[variable.robot] != &person;
    });
  });
}

struct Assignment {
  std::vector<State> states;  // by person
  bool is_complete = true;    // each body has a person
};

// A body keeps its person, so that what is known of it stays.
Assignment assign(std::vector<std::string> bodies, std::span<const Robot*> persons,
                  const Scene& scene) {
  Assignment result{.states = std::vector<State>(persons.size())};
  std::vector<State>& states = result.states;
  std::vector<std::size_t> free;
  for (std::size_t i = 0; i < persons.size(); ++i) {
    const State before = state_of(*persons[i], scene);
    const auto found = before ? std::ranges::find(bodies, *before) : bodies.end();
    if (found == bodies.end()) {
      free.push_back(i);
    } else {
      states[i] = *before;
      bodies.erase(found);
    }
  }
  // Neither two persons nor a person and another robot can have one name.
  const auto is_taken = [&](const std::string& body, const Robot& person) {
    return std::ranges::find(states, State(body)) != states.end() ||
           std::ranges::find(scene.robots, body, &Robot::name) != scene.robots.end() ||
           has_a_joint_of(body, person, scene);
  };
  std::size_t given = 0;
  for (const std::string& body : bodies) {
    if (given == free.size() || !is_body_id(body) || is_taken(body, *persons[free[given]])) {
      result.is_complete = false;
    } else {
      states[free[given++]] = body;
    }
  }
  return result;
}

// If a body has no person, the last one is unknown for it, and is no other body's.
std::vector<State> states_by(const std::vector<std::string>& bodies,
                             std::span<const Robot*> persons, const Scene& scene) {
  Assignment of_all = assign(bodies, persons, scene);
  if (of_all.is_complete) return std::move(of_all.states);
  Assignment of_others = assign(bodies, persons.first(persons.size() - 1), scene);
  of_others.states.emplace_back("");
  return std::move(of_others.states);
}

}  // namespace

std::vector<CellChange> changes_by_bodies(const std::optional<std::vector<std::string>>& bodies,
                                          const Scene& scene) {
  std::vector<const Robot*> persons;
  for (const Robot& robot : scene.robots)
    if (robot.person) persons.push_back(&robot);
  if (persons.empty()) return {};
  const std::vector<State> states =
      bodies ? states_by(*bodies, persons, scene) : std::vector<State>(persons.size(), State(""));
  std::vector<CellChange> changes;
  for (std::size_t i = 0; i < persons.size(); ++i) {
    if (states[i] == state_of(*persons[i], scene)) continue;
    changes.emplace_back(SetAbsent{persons[i]->name, !states[i], states[i].value_or("")});
  }
  return changes;
}

std::vector<CellChange> changes_by_bodies(std::span<const std::byte> cdr, CdrBytes bytes,
                                          const Scene& scene) {
  CdrDecoder decoder;
  Sample<hri_msgs_msg_dds__IdsList_> list;
  if (cdr.empty() || !decoder.decode(cdr, list, bytes)) return changes_by_bodies({}, scene);
  return changes_by_bodies(
      std::vector<std::string>(list->ids._buffer, list->ids._buffer + list->ids._length), scene);
}

}  // namespace clearance
