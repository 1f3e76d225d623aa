// clearance.MotionAnswer: what is certain about a motion, from a cell or from a daemon.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "monitor/ask/named_answer.hpp"
#include "monitor/interface/question.hpp"
#include "tools/python/module/arrays.hpp"
#include "tools/python/module/cell.hpp"
#include "tools/python/module/module.hpp"

namespace clearance::python {
namespace {

// Two names, or None.
py::object pair_of(const std::string& first, const std::string& second) {
  if (first.empty() && second.empty()) return py::none();
  return py::make_tuple(first, second);
}

// The name of a zone, or two names.
MarginBetween pairs_of(const py::object& between) {
  if (py::isinstance<py::str>(between)) return {.a = between.cast<std::string>(), .b = {}};
  const auto [a, b] = between.cast<std::pair<std::string, std::string>>();
  return {.a = a, .b = b};
}

py::object points_of(const QuestionResult& result) {
  if (!result.point_on_first.allFinite()) return py::none();
  Doubles points({py::ssize_t{2}, py::ssize_t{3}});
  for (py::ssize_t i = 0; i < 3; ++i) {
    points.mutable_at(0, i) = result.point_on_first[i];
    points.mutable_at(1, i) = result.point_on_second[i];
  }
  return points;
}

Doubles profile_of(const QuestionResult& result) {
  Doubles profile({static_cast<py::ssize_t>(result.profile.size()), py::ssize_t{4}});
  double* out = profile.mutable_data();
  for (const ProfilePart& part : result.profile) {
    for (const double number : {part.from, part.to, part.lower, part.upper}) *out++ = number;
  }
  return profile;
}

py::list profile_pairs(const QuestionResult& result) {
  py::list pairs;
  for (const ProfilePart& part : result.profile) pairs.append(pair_of(part.first, part.second));
  return pairs;
}

// The type is an attribute of the module, which outlives its functions.
void add_margin_answer(py::module_& module, py::handle verdict_type) {
  py::class_<MarginResult>(module, "MarginAnswer", "Whether a motion keeps one margin.")
      .def_readonly("margin", &MarginResult::margin, "m.")
      .def_property_readonly(
          "verdict",
          [verdict_type](const MarginResult& m) {
            return verdict_type(static_cast<int>(m.verdict));
          },
          "A Verdict: FREE, BELOW or UNDECIDED.")
      .def_readonly("above_until", &MarginResult::above_until,
                    "s: the distance is at least the margin at all instants before this.")
      .def_readonly("below_at", &MarginResult::below_at,
                    "s: an instant below the margin; NaN unless BELOW.")
      .def_property_readonly(
          "pair", [](const MarginResult& m) { return pair_of(m.first, m.second); },
          "Names of the pair that is below it, or may be; None if FREE.")
      .def_property_readonly(
          "between",
          [](const MarginResult& m) -> py::object {
            if (m.a.empty()) return py::none();
            return m.b.empty() ? py::object(py::str(m.a)) : pair_of(m.a, m.b);
          },
          "Of which pairs it is: the name of a zone, two names, or None for all pairs.")
      .def("__repr__", [](const MarginResult& m) {
        return fmt::format("<clearance.MarginAnswer: {} m {}>", m.margin, name(m.verdict));
      });
}

void add_time_limit(py::module_& module) {
  py::class_<TimeLimit>(module, "TimeLimit", "The speed that zones with `separation` admit.")
      .def_readonly("is_limited", &TimeLimit::is_limited,
                    "Such a zone has a pair with a robot of the motion.")
      .def_readonly("factor", &TimeLimit::factor,
                    "At this factor of the speed and at all lower ones, S_p holds at all instants.")
      .def_readonly("factor_above", &TimeLimit::factor_above,
                    "At a larger one S_p does not hold at `time`.")
      .def_readonly("time", &TimeLimit::time, "s.")
      .def_property_readonly(
          "pair", [](const TimeLimit& t) { return pair_of(t.first, t.second); },
          "Names of the pair that limits it, or None.")
      .def_readonly("zone", &TimeLimit::zone, "The name of the zone that limits it, or ''.");
}

void add_motion_answer(py::module_& module, py::handle status_type) {
  py::class_<QuestionResult>(module, "MotionAnswer", "What is certain about a motion.")
      .def_property_readonly(
          "status",
          [status_type](const QuestionResult& r) -> py::object {
            const int value = static_cast<int>(r.status);
            if (value >= static_cast<int>(kQuestionStatuses)) return py::int_(value);
            return status_type(value);
          },
          "A QuestionStatus, or the number of one that this client does not know.")
      .def_property_readonly("answered", &QuestionResult::done,
                             "False: nothing is known of the motion, and `reason` says why.")
      .def(
          "is_free",
          [](const QuestionResult& r, double margin, const py::object& between) {
            const MarginBetween of = between.is_none() ? MarginBetween() : pairs_of(between);
            return r.is_free(margin, of.a, of.b);
          },
          py::arg("margin") = 0.0, py::arg("between") = py::none(),
          "True if the motion certainly keeps this margin, which the question had, m: of all "
          "pairs, "
          "or of a zone or two names that it had it for.")
      .def_readonly("path", &QuestionResult::path, "Of a refusal: the field at fault.")
      .def_readonly("reason", &QuestionResult::reason, "Of a refusal: a sentence.")
      .def_readonly("revision", &QuestionResult::scene_revision, "Of the scene of the answer.")
      .def_readonly("cycle", &QuestionResult::cycle,
                    "Of a daemon: joints and objects are where this tick had them.")
      .def_readonly("now_ns", &QuestionResult::now_ns, "Of a daemon: the time of that tick.")
      .def_readonly("without", &QuestionResult::without,
                    "Names of the sensors that the question leaves out.")
      .def_readonly("lower", &QuestionResult::lower,
                    "m: no distance of a watched pair is smaller at any instant.")
      .def_readonly("upper", &QuestionResult::upper,
                    "m: the least distance is not larger; 0 if bodies overlap.")
      .def_readonly("time", &QuestionResult::time, "s: where `upper` is attained.")
      .def_property_readonly(
          "pair", [](const QuestionResult& r) { return pair_of(r.first, r.second); },
          "Names of the pair that attains `upper`, or None.")
      .def_property_readonly("points", &points_of,
                             "(2, 3), m, in the world: its closest points then, or None.")
      .def_readonly("margins", &QuestionResult::margins,
                    "A MarginAnswer for each margin of the question.")
      .def_property_readonly("profile", &profile_of,
                             "(parts, 4): from, to, s; lower and upper at all instants between, m.")
      .def_property_readonly("profile_pairs", &profile_pairs,
                             "Names of the closest pair in the middle of each part.")
      .def_readonly("time_limit", &QuestionResult::time_limit,
                    "A TimeLimit if it was asked for, or None.")
      .def_readonly("within_work_limit", &QuestionResult::within_work_limit,
                    "False: the bounds hold, but may be wider than asked for.")
      .def_readonly("queries", &QuestionResult::queries, "Distance queries.")
      .def_readonly(
          "start_deviation", &QuestionResult::start_deviation,
          "Of a daemon: largest difference of a first waypoint from the present position.")
      .def_readonly("start_joint", &QuestionResult::start_joint, "That joint.")
      .def("__repr__", [](const QuestionResult& r) {
        if (!r.done())
          return fmt::format("<clearance.MotionAnswer: {}: {}>", name_of(r.status), r.reason);
        return fmt::format("<clearance.MotionAnswer: {} - {} m>", r.lower, r.upper);
      });
}

}  // namespace

void add_answers(py::module_& module) {
  std::vector<Enumerator> statuses;
  for (std::size_t i = 0; i < kQuestionStatuses; ++i) {
    statuses.push_back(
        {constant_name(name_of(static_cast<QuestionStatus>(i))), static_cast<int>(i)});
  }
  const py::handle status_type =
      add_enum(module, "QuestionStatus", statuses, "Whether a question was answered.").release();
  std::vector<Enumerator> words;
  for (const Verdict verdict : {Verdict::kFree, Verdict::kBelow, Verdict::kUndecided})
    words.push_back({constant_name(name(verdict)), static_cast<int>(verdict)});
  const py::handle verdict_type =
      add_enum(module, "Verdict", words, "Whether a motion keeps a margin.").release();
  add_margin_answer(module, verdict_type);
  add_time_limit(module);
  add_motion_answer(module, status_type);
}

}  // namespace clearance::python
