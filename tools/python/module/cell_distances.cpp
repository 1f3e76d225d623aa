// Cell.distances(): the configurations of an array, and the arrays that come back.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <vector>

#include "tools/python/module/arrays.hpp"
#include "tools/python/module/cell.hpp"
#include "tools/python/module/waiting.hpp"

namespace clearance::python {
namespace {

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

// A position that is not plausible.
struct BadPosition {
  std::size_t row;
  std::uint32_t variable;
  double position;
};

[[noreturn]] void refuse(const BadPosition& bad, const Scene& scene) {
  const JointVariable& joint = scene.variables[bad.variable];
  throw py::value_error(
      fmt::format("joints[{}, {}]: found {} for '{}'; expected a position within its limits, {} to "
                  "{}, and within 1e6 rad or 1e4 m",
                  bad.row, bad.variable, bad.position, joint.name, joint.lower, joint.upper));
}

// Evaluates all rows up to the first one with a position that is not plausible. Called without the
// interpreter's lock: another thread may write to the array meanwhile, so each row is copied first.
std::optional<BadPosition> evaluate_all(Configurations& configurations, const double* joints,
                                        std::size_t count, const Rows& rows) {
  using Clock = std::chrono::steady_clock;
  constexpr std::size_t kBetweenLooks = 32;
  auto look = Clock::now() + kSlice;
  std::vector<double> row(rows.variables);
  for (std::size_t i = 0; i < count; ++i) {
    if (i % kBetweenLooks == 0 && Clock::now() >= look) {
      check_signals();
      look = Clock::now() + kSlice;
    }
    std::copy_n(joints + i * row.size(), row.size(), row.begin());
    if (const auto bad = configurations.implausible(row)) return BadPosition{i, *bad, row[*bad]};
    configurations.evaluate(row, rows.at(i));
  }
  return std::nullopt;
}

void place_objects(const Scene& scene, const py::dict& poses, Configurations& configurations) {
  // A copy, since the conversion of a value may run code that changes the dictionary.
  const py::list items(poses.attr("items")());
  for (const py::handle item : items) {
    const auto [key, value] = item.cast<std::pair<py::object, py::object>>();
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
  std::optional<BadPosition> bad;
  {
    const double* const data = array.data();
    const auto count = static_cast<std::size_t>(array.shape(0));
    const Unlocked unlock;
    bad = evaluate_all(*configurations, data, count, rows);
  }
  if (bad) refuse(*bad, scene);
  self.give_back(std::move(configurations));
  return result;
}

// An array that the call may have left out.
template <py::object Distances::*kArray>
py::object given(const Distances& self) {
  if ((self.*kArray).is_none())
    throw py::attribute_error(
        "the call left this out; expected points=True or gradients=True there");
  return self.*kArray;
}

void add_result(py::module_& module) {
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
      .def_property_readonly("point_a", given<&Distances::point_a>,
                             "Witness points, (n, pairs, 3). AttributeError with points=False.")
      .def_property_readonly("point_b", given<&Distances::point_b>,
                             "The same on the second object.")
      .def_property_readonly("normal", given<&Distances::normal>,
                             "Unit vectors from the first object to the second, (n, pairs, 3).")
      .def_property_readonly("gradient", given<&Distances::gradient>,
                             R"((n, pairs, joints), m/rad or m/m.

The derivatives of the distances with respect to the joint positions, that of the points found where
several are closest. AttributeError unless gradients=True.)")
      .def("__len__", [](const Distances& d) { return d.distance.shape(0); })
      .def("__repr__", [](const Distances& d) {
        return fmt::format("<clearance.Distances: {} configurations, {} pairs>",
                           d.distance.shape(0), d.distance.shape(1));
      });
}

}  // namespace

void add_distances(py::module_& module, CellClass& cells) {
  add_result(module);
  cells.def("distances", &distances, py::arg("joints"), py::arg("poses") = py::dict(),
            py::kw_only(), py::arg("points") = true, py::arg("gradients") = false,
            R"(The distances of all pairs in n configurations.

joints: (n, joints), rad or m, in the order of Cell.joints. poses: of moving objects that are no
links, by name; pairs of objects without a pose are unknown. points: False leaves points and normals
out. gradients: True adds the derivatives with respect to the joints.

Raises ValueError for another shape, or for a position that is not finite or outside the joint's
limits and their tolerance; KeyError for an unknown object. Releases the interpreter's lock; Ctrl-C
ends it. The same call gives the same bits.)");
}

}  // namespace clearance::python
