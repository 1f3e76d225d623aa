#include "tools/python/module/cell.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <map>
#include <optional>

#include "config/write/single_robot_cell.hpp"
#include "monitor/interface/report.hpp"
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

// Ends a reading. No handler of the reader catches it.
struct Stopped {};

// `read` gets the options and returns a CellResult. Meshes may take half a minute to split: the
// reader tells of each, and signals are looked for then.
template <class Read>
std::shared_ptr<CellObject> cell_by(const Read& read) {
  std::vector<std::string> notes;
  CellResult result;
  bool stopped = false;
  {
    const Unlocked unlock;
    try {
      result = read(CellOptions{.tell = [&notes](const std::string& line) {
        notes.push_back(line);
        if (interrupted()) throw Stopped{};
      }});
    } catch (const Stopped&) {
      stopped = true;
    }
  }
  if (stopped || PyErr_CheckSignals() != 0) throw py::error_already_set();
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

std::optional<std::string> stated_interface(const CellObject& cell) {
  const std::string& stated = cell.cell().interface;
  return stated.empty() ? std::nullopt : std::optional(stated);
}

}  // namespace

py::tuple CellObject::pair_names(const ObjectPair& pair) const {
  return py::make_tuple(scene().objects[pair.first].name, scene().objects[pair.second].name);
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

  CellClass cells(module, "Cell", R"(A checked cell.

It does not change, and threads may share it.)");
  cells
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
          "domain", [](const CellObject& c) { return c.cell().domain; },
          "Of DDS; None: that of ROS_DOMAIN_ID, or 0.")
      .def_property_readonly(
          "partition", [](const CellObject& c) { return c.cell().partition; }, "Of DDS.")
      .def_property_readonly("interface", &stated_interface,
                             "The network of DDS; None: ros where ROS 2 is set up, else lo.")
      .def_property_readonly(
          "yaml", [](const CellObject& c) { return c.cell().yaml; }, "The text.")
      .def_property_readonly("notes", &CellObject::notes, "What the reader told, a line each.")
      .def("__repr__",
           [](const CellObject& c) { return "<clearance.Cell: " + summary(c.scene()) + ">"; });
  add_distances(module, cells);
  add_questions(module, cells);
}

}  // namespace clearance::python
