#include "tools/python/module/cell.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <chrono>
#include <map>
#include <optional>

#include "config/write/single_robot_cell.hpp"
#include "monitor/report.hpp"
#include "tools/python/module/arrays.hpp"
#include "tools/python/module/module.hpp"
#include "tools/python/module/waiting.hpp"

namespace clearance::python {
namespace {

PyObject* cell_error = nullptr;  // kept by the module

// Throws CellError with all mistakes, in `errors`, too.
[[noreturn]] void refuse(const std::vector<CellError>& mistakes) {
  std::string text;
  py::list errors;
  for (const CellError& mistake : mistakes) {
    text += (text.empty() ? "" : "\n") + mistake.text;
    errors.append(mistake.text);
  }
  py::object error = py::reinterpret_borrow<py::object>(cell_error)(text);
  error.attr("errors") = errors;
  PyErr_SetObject(cell_error, error.ptr());
  throw py::error_already_set();
}

// `read` gets the options and returns a CellResult. Meshes may take half a minute to split.
template <class Read>
std::shared_ptr<CellObject> cell_by(const Read& read) {
  std::vector<std::string> notes;
  CellResult result;
  {
    const Unlocked unlock;
    result =
        read(CellOptions{.tell = [&notes](const std::string& line) { notes.push_back(line); }});
  }
  if (const auto* errors = std::get_if<std::vector<CellError>>(&result)) refuse(*errors);
  return std::make_shared<CellObject>(std::get<Cell>(std::move(result)), std::move(notes));
}

using Packages = std::map<std::string, std::filesystem::path>;

std::shared_ptr<CellObject> cell_of_urdf(const std::filesystem::path& urdf,
                                         const std::optional<std::filesystem::path>& srdf,
                                         const Packages& packages, double age_limit_ms) {
  if (!(age_limit_ms > 0.0 && age_limit_ms <= 86'400'000.0))
    throw py::value_error("age_limit_ms: expected 0.001 to 86400000");
  const SingleRobotOptions options{.urdf = urdf,
                                   .srdf = srdf.value_or(""),
                                   .packages = {packages.begin(), packages.end()},
                                   .age_limit_ms = age_limit_ms};
  return cell_by([&](const CellOptions& reading) { return read_single_robot(options, reading); });
}

// ---- Distances

// The arrays of one call.
struct Distances {
  py::array_t<double> distance, lower, upper;
  py::array_t<std::uint8_t> status;
  py::array_t<std::uint32_t> part_a, part_b;
  py::object point_a = py::none(), point_b = py::none(), normal = py::none();
  py::object gradient = py::none();
};

// The addresses of the results of all configurations; those of configuration i follow.
struct Rows {
  ConfigurationResults first;
  std::size_t pairs, variables;

  [[nodiscard]] ConfigurationResults at(std::size_t i) const noexcept {
    const auto from = [i](auto* start, std::size_t each) {
      return start == nullptr ? nullptr : start + i * each;
    };
    return {.distance = from(first.distance, pairs),
            .lower = from(first.lower, pairs),
            .upper = from(first.upper, pairs),
            .status = from(first.status, pairs),
            .part_a = from(first.part_a, pairs),
            .part_b = from(first.part_b, pairs),
            .witness_a = from(first.witness_a, 3 * pairs),
            .witness_b = from(first.witness_b, 3 * pairs),
            .normal = from(first.normal, 3 * pairs),
            .gradient = from(first.gradient, pairs * variables)};
  }
};

Rows make_arrays(py::ssize_t n, const Scene& scene, bool points, bool gradients, Distances& to) {
  const auto pairs = static_cast<py::ssize_t>(scene.pairs.size());
  const auto variables = static_cast<py::ssize_t>(scene.variables.size());
  const std::vector<py::ssize_t> shape = {n, pairs};
  to.distance = py::array_t<double>(shape);
  to.lower = py::array_t<double>(shape);
  to.upper = py::array_t<double>(shape);
  to.status = py::array_t<std::uint8_t>(shape);
  to.part_a = py::array_t<std::uint32_t>(shape);
  to.part_b = py::array_t<std::uint32_t>(shape);
  Rows rows{{.distance = to.distance.mutable_data(),
             .lower = to.lower.mutable_data(),
             .upper = to.upper.mutable_data(),
             .status = to.status.mutable_data(),
             .part_a = to.part_a.mutable_data(),
             .part_b = to.part_b.mutable_data()},
            scene.pairs.size(),
            scene.variables.size()};
  const auto add = [n, pairs](py::object& array, double*& data, py::ssize_t each) {
    py::array_t<double> made(std::vector<py::ssize_t>{n, pairs, each});
    data = made.mutable_data();
    array = std::move(made);
  };
  if (points) {
    add(to.point_a, rows.first.witness_a, 3);
    add(to.point_b, rows.first.witness_b, 3);
    add(to.normal, rows.first.normal, 3);
  }
  if (gradients) add(to.gradient, rows.first.gradient, variables);
  return rows;
}

[[noreturn]] void refuse_position(const Scene& scene, std::size_t row, std::uint32_t variable,
                                  double position) {
  const JointVariable& joint = scene.variables[variable];
  throw py::value_error(
      fmt::format("joints[{}, {}]: found {} for '{}'; expected a position within its limits, {} to "
                  "{}, and within 1e6 rad or 1e4 m",
                  row, variable, position, joint.name, joint.lower, joint.upper));
}

// Evaluates all rows. Returns the first row that is not plausible. Called without the interpreter's
// lock.
std::optional<std::size_t> evaluate_all(Configurations& configurations, const double* joints,
                                        std::size_t count, const Rows& rows) {
  using Clock = std::chrono::steady_clock;
  constexpr std::size_t kBetweenLooks = 32;
  auto look = Clock::now() + kSlice;
  for (std::size_t i = 0; i < count; ++i) {
    if (i % kBetweenLooks == 0 && Clock::now() >= look) {
      check_signals();
      look = Clock::now() + kSlice;
    }
    const std::span<const double> row(joints + i * rows.variables, rows.variables);
    if (configurations.implausible(row)) return i;
    configurations.evaluate(row, rows.at(i));
  }
  return std::nullopt;
}

void place_objects(const Scene& scene, const py::dict& poses, Configurations& configurations) {
  for (const auto& [key, value] : poses) {
    if (!py::isinstance<py::str>(key)) {
      throw py::type_error(fmt::format("poses: found a key of type {}; expected names of objects",
                                       Py_TYPE(key.ptr())->tp_name));
    }
    const auto name = key.cast<std::string>();
    std::uint32_t i = 0;
    while (i < scene.objects.size() && scene.objects[i].name != name) ++i;
    if (i == scene.objects.size())
      throw py::key_error(fmt::format("poses: the cell has no object '{}'", name));
    if (scene.objects[i].fixed)
      throw py::value_error(fmt::format("poses: '{}' is fixed; expected a moving object", name));
    for (const Robot& robot : scene.robots) {
      for (const RobotLink& link : robot.links) {
        if (link.object == i)
          throw py::value_error(
              fmt::format("poses: '{}' follows the joints of '{}'; expected an object with a pose",
                          name, robot.name));
      }
    }
    configurations.place(i, pose_of(value, ("poses['" + name + "']").c_str()));
  }
}

Distances distances(const CellObject& self, const py::object& joints, const py::dict& poses,
                    bool points, bool gradients) {
  const Scene& scene = self.scene();
  const auto variables = static_cast<py::ssize_t>(scene.variables.size());
  const Doubles array = doubles_of(joints, "joints", {kAny, variables});
  Distances result;
  const Rows rows = make_arrays(array.shape(0), scene, points, gradients, result);
  std::unique_ptr<Configurations> configurations = self.borrow();
  configurations->begin();
  place_objects(scene, poses, *configurations);
  std::optional<std::size_t> bad;
  {
    const double* const data = array.data();
    const auto count = static_cast<std::size_t>(array.shape(0));
    const Unlocked unlock;
    bad = evaluate_all(*configurations, data, count, rows);
  }
  if (bad) {
    const double* row = array.data() + *bad * rows.variables;
    const auto variable = *configurations->implausible({row, rows.variables});
    refuse_position(scene, *bad, variable, row[variable]);
  }
  self.give_back(std::move(configurations));
  return result;
}

// ---- Members

template <class Items>
py::list names_of(const Items& items) {
  py::list names;
  for (const auto& item : items) names.append(item.name);
  return names;
}

Doubles limits_of(const CellObject& self) {
  Doubles limits({static_cast<py::ssize_t>(self.scene().variables.size()), py::ssize_t{2}});
  double* out = limits.mutable_data();
  for (const JointVariable& variable : self.scene().variables) {
    *out++ = variable.lower;
    *out++ = variable.upper;
  }
  return limits;
}

py::list pairs_of(const CellObject& self, bool published_only) {
  py::list pairs;
  for (const ObjectPair& pair : self.scene().pairs) {
    if (pair.publish || !published_only) pairs.append(self.pair_names(pair));
  }
  return pairs;
}

void add_distances(py::module_& module) {
  py::class_<Distances>(module, "Distances", R"(The distances of n configurations, by pair.

Arrays have the shape (n, pairs), with the pairs in the order of Cell.pairs. An unknown bound is
infinite, any other unknown figure is NaN. Lengths are in m, points in the world.)")
      .def_readonly("distance", &Distances::distance,
                    "Signed distances: minus the penetration depth where objects overlap.")
      .def_readonly("lower", &Distances::lower, "Certified: no true distance is smaller.")
      .def_readonly("upper", &Distances::upper, "Certified: no true distance is larger.")
      .def_readonly("status", &Distances::status, "PairStatus, uint8.")
      .def_readonly("part_a", &Distances::part_a, "The closest part of the first object, uint32.")
      .def_readonly("part_b", &Distances::part_b, "The closest part of the second object.")
      .def_readonly("point_a", &Distances::point_a,
                    "Witness points, (n, pairs, 3); None with points=False.")
      .def_readonly("point_b", &Distances::point_b, "The same on the second object.")
      .def_readonly("normal", &Distances::normal,
                    "Unit vectors from the first object to the second, (n, pairs, 3).")
      .def_readonly("gradient", &Distances::gradient, R"((n, pairs, joints), m/rad or m/m.

The derivatives of the distances with respect to the joint positions, that of the points found where
several are closest. None unless gradients=True.)")
      .def("__len__", [](const Distances& d) { return d.distance.shape(0); })
      .def("__repr__", [](const Distances& d) {
        return fmt::format("<clearance.Distances: {} configurations, {} pairs>",
                           d.distance.shape(0), d.distance.shape(1));
      });
}

}  // namespace

py::tuple CellObject::pair_names(const ObjectPair& pair) const {
  return py::make_tuple(scene().objects[pair.first].name, scene().objects[pair.second].name);
}

std::unique_ptr<Configurations> CellObject::borrow() const {
  {
    const std::lock_guard lock(mutex_);
    if (!idle_.empty()) {
      auto configurations = std::move(idle_.back());
      idle_.pop_back();
      return configurations;
    }
  }
  return std::make_unique<Configurations>(scene());
}

void CellObject::give_back(std::unique_ptr<Configurations> configurations) const {
  const std::lock_guard lock(mutex_);
  idle_.push_back(std::move(configurations));
}

void add_cell(py::module_& module) {
  const py::object error = py::reinterpret_steal<py::object>(PyErr_NewExceptionWithDoc(
      "clearance._clearance.CellError",
      "A cell, or changes of one, have mistakes: `errors` lists each as FILE:LINE:COLUMN: ...",
      PyExc_ValueError, nullptr));
  module.attr("CellError") = error;
  cell_error = error.ptr();
  Py_INCREF(cell_error);
  std::vector<Enumerator> statuses;
  for (int i = 0; i <= static_cast<int>(PairStatus::kAbsent); ++i)
    statuses.push_back({constant_name(name(static_cast<PairStatus>(i))), i});
  add_enum(module, "PairStatus", statuses, "What a pair's figures rest on.");

  add_distances(module);
  py::class_<CellObject, std::shared_ptr<CellObject>>(module, "Cell", R"(A checked cell.

It does not change, and threads may share it.)")
      .def(py::init([](const std::filesystem::path& file) {
             return cell_by([&](const CellOptions& options) { return read_cell(file, options); });
           }),
           py::arg("file"), R"(Reads a cell file (YAML).

Raises CellError with every mistake. The first reading of a robot with meshes takes half a minute;
the parts are then kept beside the cell. Releases the interpreter's lock.)")
      .def_static("from_urdf", &cell_of_urdf, py::arg("urdf"), py::arg("srdf") = py::none(),
                  py::arg("packages") = Packages(), py::arg("age_limit_ms") = 20.0,
                  R"(The cell of one robot alone: every pair of its links is watched.

urdf: xacro expanded. srdf: None: a link and the next above it that has shapes may touch.
packages: folders by name, for package:// paths. age_limit_ms: of live joint states.
Raises CellError.)")
      .def_static(
          "from_yaml",
          [](const std::string& yaml, const std::filesystem::path& file) {
            return cell_by(
                [&](const CellOptions& options) { return parse_cell(yaml, file, options); });
          },
          py::arg("yaml"), py::arg("file") = std::filesystem::path("cell.yaml"),
          R"(A cell from its text.

file: the name in messages; paths in the cell are relative to its folder. Raises CellError.)")
      .def("distances", &distances, py::arg("joints"), py::arg("poses") = py::dict(), py::kw_only(),
           py::arg("points") = true, py::arg("gradients") = false,
           R"(The distances of all pairs in n configurations.

joints: (n, joints), rad or m, in the order of Cell.joints. poses: of moving objects that are no
links, by name; pairs of objects without a pose are unknown. points: False leaves points and normals
out. gradients: True adds the derivatives with respect to the joints.

Raises ValueError for another shape, or for a position that is not finite or outside the joint's
limits and their tolerance; KeyError for an unknown object. Releases the interpreter's lock; Ctrl-C
ends it. The same call gives the same bits.)")
      .def_property_readonly(
          "name", [](const CellObject& c) { return c.scene().name; }, "The name in the file.")
      .def_property_readonly(
          "joints", [](const CellObject& c) { return names_of(c.scene().variables); },
          "Names of the joint positions of all robots.")
      .def_property_readonly("joint_limits", &limits_of,
                             "(joints, 2): lower and upper, rad or m; infinite: not stated.")
      .def_property_readonly(
          "objects", [](const CellObject& c) { return names_of(c.scene().objects); },
          "Names of objects, links included.")
      .def_property_readonly(
          "zones", [](const CellObject& c) { return names_of(c.scene().zones); }, "Names of zones.")
      .def_property_readonly(
          "pairs", [](const CellObject& c) { return pairs_of(c, false); },
          "The watched pairs, two names each.")
      .def_property_readonly(
          "published_pairs", [](const CellObject& c) { return pairs_of(c, true); },
          "Those that are in every report.")
      .def_property_readonly(
          "revision", [](const CellObject& c) { return c.scene().revision; }, "As in live reports.")
      .def_property_readonly(
          "rate_hz", [](const CellObject& c) { return c.scene().rate_hz; }, "Ticks a second.")
      .def_property_readonly(
          "domain", [](const CellObject& c) { return c.cell().domain; }, "Of DDS.")
      .def_property_readonly(
          "partition", [](const CellObject& c) { return c.cell().partition; }, "Of DDS.")
      .def_property_readonly(
          "interface", [](const CellObject& c) { return c.cell().interface; },
          "The network of DDS.")
      .def_property_readonly(
          "yaml", [](const CellObject& c) { return c.cell().yaml; }, "The text.")
      .def_property_readonly("notes", &CellObject::notes, "What the reader told, a line each.")
      .def("__repr__",
           [](const CellObject& c) { return "<clearance.Cell: " + summary(c.scene()) + ">"; });
}

}  // namespace clearance::python
