// clearance.Question, and its answer by a cell: monitor/ask.

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "monitor/ask/asker.hpp"
#include "monitor/ask/named_answer.hpp"
#include "monitor/interface/question.hpp"
#include "tools/python/module/arrays.hpp"
#include "tools/python/module/cell.hpp"
#include "tools/python/module/module.hpp"
#include "tools/python/module/waiting.hpp"

namespace clearance::python {
namespace {

using Body = std::shared_ptr<ConvexBody>;

std::vector<double> numbers_of(const Doubles& array) {
  return {array.data(), array.data() + array.size()};
}

JointTrajectory trajectory_of(const std::vector<std::string>& joints, const py::object& times,
                              const py::object& positions, const py::object& velocities) {
  JointTrajectory motion;
  motion.joints = joints;
  motion.times = numbers_of(doubles_of(times, "times", {kAny}));
  const auto rows = static_cast<py::ssize_t>(motion.times.size());
  const auto columns = static_cast<py::ssize_t>(joints.size());
  motion.positions = numbers_of(doubles_of(positions, "positions", {rows, columns}));
  if (!velocities.is_none())
    motion.velocities = numbers_of(doubles_of(velocities, "velocities", {rows, columns}));
  return motion;
}

ObjectMotion object_motion(const std::string& object, const py::tuple& value) {
  const std::string name = "moving['" + object + "']";
  if (value.size() != 2)
    throw py::value_error(name + ": expected times and poses: (times (n,), poses (n, 7))");
  ObjectMotion motion{.object = object, .times = {}, .world_from_object = {}};
  motion.times = numbers_of(doubles_of(value[0], name.c_str(), {kAny}));
  const auto rows = static_cast<py::ssize_t>(motion.times.size());
  const Doubles poses = doubles_of(value[1], name.c_str(), {rows, 7});
  for (py::ssize_t i = 0; i < rows; ++i)
    motion.world_from_object.push_back(pose_in(poses.data(i, 0), name.c_str(), i));
  return motion;
}

Payload payload_of(const std::string& object, const py::tuple& value) {
  const std::string name = "payloads['" + object + "']";
  if (value.size() < 2 || value.size() > 4) {
    throw py::value_error(name +
                          ": expected (link, pose in the link's frame[, names that it may touch[, "
                          "Body of a new object]])");
  }
  Payload payload{.name = object,
                  .shape = {},
                  .link = value[0].cast<std::string>(),
                  .link_from_object = pose_of(value[1], name.c_str()),
                  .touch = {}};
  if (value.size() > 2) payload.touch = value[2].cast<std::vector<std::string>>();
  if (value.size() > 3) {
    const Body body = value[3].cast<Body>();
    if (body == nullptr) throw py::value_error(name + ": found None; expected a Body");
    payload.shape = *body;
  }
  return payload;
}

void set_age(const std::string& name, double age, Question& question) {
  const auto pose = std::ranges::find(question.poses, name, &StatedPose::object);
  if (pose != question.poses.end()) {
    pose->age = age;
    return;
  }
  const auto joint = std::ranges::find(question.joints, name, &StatedJoint::name);
  if (joint == question.joints.end())
    throw py::value_error("ages: '" + name + "' is neither in `poses` nor in `joints_of_others`");
  joint->age = age;
}

MeantContact contact_of(const py::tuple& value) {
  if (value.size() < 3 || value.size() > 5)
    throw py::value_error("contacts: expected (first, second, depth[, until[, distance]]) each");
  const auto number = [&](std::size_t at) {
    return value.size() > at && !value[at].is_none() ? value[at].cast<double>() : kInfinity;
  };
  return {.first = value[0].cast<std::string>(),
          .second = value[1].cast<std::string>(),
          .depth = value[2].cast<double>(),
          .until = number(3),
          .distance = number(4)};
}

// A number is of all pairs. The last entry of a tuple is the margin.
void read_margins(const std::vector<py::object>& margins, Question& question) {
  question.margins.clear();
  for (const py::object& each : margins) {
    if (!py::isinstance<py::tuple>(each)) {
      question.margins.push_back(each.cast<double>());
      continue;
    }
    const auto entry = py::reinterpret_borrow<py::tuple>(each);
    if (entry.size() != 2 && entry.size() != 3)
      throw py::value_error("margins: expected m, (zone, m) or (first, second, m) each");
    MarginBetween& of = question.margins_between.emplace_back();
    of.a = entry[0].cast<std::string>();
    if (entry.size() == 3) of.b = entry[1].cast<std::string>();
    of.margin = entry[entry.size() - 1].cast<double>();
  }
}

Question question_of(
    const std::vector<std::string>& joints, const py::object& times, const py::object& positions,
    const py::object& velocities, const std::map<std::string, double>& held,
    const std::map<std::string, double>& joints_of_others,
    const std::map<std::string, py::object>& poses, const std::vector<py::tuple>& beside,
    const std::map<std::string, py::tuple>& moving,
    const std::map<std::string, py::tuple>& payloads, const std::map<std::string, double>& ages,
    const std::map<std::string, double>& turn_speeds,
    const std::optional<std::vector<py::tuple>>& contacts, const std::string& others,
    const std::vector<py::object>& margins, double tolerance, bool only_margins,
    std::uint32_t profile, double profile_tolerance,
    const std::optional<std::pair<std::string, std::string>>& profile_pair, bool time_scaling,
    bool stoppable, std::uint64_t work_limit, const std::vector<std::string>& without) {
  Question question;
  question.motion = trajectory_of(joints, times, positions, velocities);
  for (const py::tuple& each : beside) {
    if (each.size() != 3 && each.size() != 4)
      throw py::value_error("beside: expected (joints, times, positions[, velocities]) each");
    question.beside.push_back(trajectory_of(each[0].cast<std::vector<std::string>>(), each[1],
                                            each[2],
                                            each.size() == 4 ? py::object(each[3]) : py::none()));
  }
  for (const auto& [name, position] : held) question.held.push_back({name, position});
  for (const auto& [name, position] : joints_of_others)
    question.joints.push_back({.name = name, .position = position});
  for (const auto& [name, pose] : poses) {
    question.poses.push_back(
        {.object = name, .world_from_object = pose_of(pose, ("poses['" + name + "']").c_str())});
  }
  for (const auto& [name, value] : moving) question.moving.push_back(object_motion(name, value));
  for (const auto& [name, value] : payloads) question.payloads.push_back(payload_of(name, value));
  for (const auto& [name, age] : ages) set_age(name, age, question);
  for (const auto& [name, speed] : turn_speeds) {
    const auto at = std::ranges::find(question.poses, name, &StatedPose::object);
    if (at == question.poses.end())
      throw py::value_error("turn_speeds: '" + name + "' has no pose in `poses`");
    at->turn_speed = speed;
  }
  if (contacts) {
    question.contacts.emplace();
    for (const py::tuple& each : *contacts) question.contacts->push_back(contact_of(each));
  }
  if (others != "max_speed" && others != "still") {
    throw py::value_error(
        fmt::format("others: found '{}'; expected 'max_speed' or 'still'", others));
  }
  question.others = others == "still" ? OthersMove::kNot : OthersMove::kWithinMaxSpeed;
  read_margins(margins, question);
  question.tolerance = tolerance;
  question.only_margins = only_margins;
  if (profile > 0) {
    const auto [first, second] = profile_pair.value_or(std::pair<std::string, std::string>());
    question.profile = ProfileRequest{
        .first = first, .second = second, .tolerance = profile_tolerance, .most_points = profile};
  }
  question.time_scaling = time_scaling;
  question.stoppable = stoppable;
  question.work_limit = work_limit;
  for (const std::string& sensor : without)
    question.seen.push_back({.sensor = sensor, .is_known = false});
  return question;
}

constexpr std::uint64_t kWorkLimit = 1'000'000;

QuestionResult ask_cell(const CellObject& cell, const Question& asked) {
  Question question = asked;
  if (question.work_limit == 0) question.work_limit = kWorkLimit;
  std::optional<std::string> refused;
  Answer answer;
  QuestionResult result;
  {
    const Unlocked unlock;
    std::unique_ptr<Asker> asker = cell.borrow_asker();
    refused = asker->ask(question, answer);
    cell.give_back(std::move(asker));
    if (!refused) name_answer(answer, question, cell.scene(), result);
  }
  if (refused) throw py::value_error(*refused);
  result.scene_revision = cell.scene().revision;
  return result;
}

void add_question(py::module_& module) {
  using Empty = std::map<std::string, py::object>;
  py::class_<Question>(module, "Question",
                       "A motion that was not made yet, and what is asked of it.")
      .def(
          py::init(&question_of), py::arg("joints"), py::arg("times"), py::arg("positions"),
          py::arg("velocities") = py::none(), py::kw_only(),
          py::arg("held") = std::map<std::string, double>(),
          py::arg("joints_of_others") = std::map<std::string, double>(), py::arg("poses") = Empty(),
          py::arg("beside") = std::vector<py::tuple>(),
          py::arg("moving") = std::map<std::string, py::tuple>(),
          py::arg("payloads") = std::map<std::string, py::tuple>(),
          py::arg("ages") = std::map<std::string, double>(),
          py::arg("turn_speeds") = std::map<std::string, double>(),
          py::arg("contacts") = py::none(), py::arg("others") = "max_speed",
          py::arg("margins") = std::vector<py::object>{py::float_(0.0)},
          py::arg("tolerance") = 1e-3, py::arg("only_margins") = false, py::arg("profile") = 0,
          py::arg("profile_tolerance") = 5e-3, py::arg("profile_pair") = py::none(),
          py::arg("time_scaling") = false, py::arg("stoppable") = false, py::arg("work_limit") = 0,
          py::arg("without") = std::vector<std::string>(),
          R"(joints: names of k joints. times: (n,), s, increasing. positions: (n, k), rad or m; joints move
linearly between waypoints. velocities: (n, k), per second; then along cubic polynomials.

held: positions of joints that stay, by name. joints_of_others: of robots that do nothing here, which
`others` is about. poses: of objects that are neither fixed nor part of a robot. A daemon knows all
three; what is left out is where it is now. ages: how long before the first waypoint a pose or one of
`joints_of_others` was so, s. turn_speeds: the fastest rotation of objects on which robots stand,
rad/s. beside: motions of other robots, each
(joints, times, positions[, velocities]). moving: {object: (times (n,), poses (n, 7))}. payloads:
{object: (link, pose in the link[, names that it may touch[, Body of a new object]])}.
contacts: those that are meant, each (first, second, depth[, until[, distance]]): down to this depth, m,
up to this instant, s, and until the objects may have been this far apart, m. None: those of the cell,
or with a daemon those in force now.
others: "max_speed": such objects and joints stay within their largest speed x time of where they are;
"still": they do not move.

margins: m, of all pairs; or (zone, m), or (first, second, m) of objects or groups; 0 asks for
contact. tolerance: m, upper - lower. only_margins: bounds need not be better
than the verdicts need. profile: most parts of a distance profile; 0: none. profile_tolerance: m.
profile_pair: names of two objects; None: the least distance. time_scaling: asks by how much the motion
may be timed faster for zones with `separation`. stoppable: bounds and margins count stops that begin at
any instant of the motion, too, as the cell states `stopping` for its robot; time_scaling then keeps the
margins as well, and tries no factor above 1. work_limit: most distance queries; 0: 1,000,000, or that of
the daemon. without: names of sensors of the cell, what they see is left out; a cell that is not run
has no frames. A daemon has them, and refuses it.

Raises TypeError and ValueError for wrong shapes; names and values are checked when it is asked.)")
      .def("__repr__", [](const Question& q) {
        return fmt::format("<clearance.Question: {} joints, {} waypoints>", q.motion.joints.size(),
                           q.motion.times.size());
      });
}

}  // namespace

void add_questions(py::module_& module, CellClass& cells) {
  add_question(module);
  add_answers(module);
  constexpr const char* kAsk =
      R"(Certified bounds of the distance over the whole motion: all instants, not samples.

The question states all joints and all objects that move. Returns a MotionAnswer. Raises ValueError
with the reason if the question does not fit the cell. Releases the interpreter's lock.)";
  cells.def("ask", &ask_cell, py::arg("question"), kAsk);
  module.def("ask", &ask_cell, py::arg("cell"), py::arg("question"), kAsk);
}

}  // namespace clearance::python
