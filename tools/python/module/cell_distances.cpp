// Cell.distances(): the configurations of an array, and the arrays that come back.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "config/scene/pairs_between.hpp"
#include "monitor/interface/mutex.hpp"
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
  py::object verdict = py::none();
};

// The addresses of the results of all configurations; those of configuration i follow.
struct Rows {
  ConfigurationResults first;
  std::size_t pairs, variables;
  std::optional<double> limit = {};  // m
  std::uint8_t* verdict = nullptr;   // with the limit: one for each configuration

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

Rows make_arrays(py::ssize_t n, std::size_t chosen, const Scene& scene, bool points, bool gradients,
                 const std::optional<double>& below, Distances& to) {
  const auto pairs = static_cast<py::ssize_t>(chosen);
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
            chosen,
            scene.variables.size(),
            below};
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
  if (below) {
    py::array_t<std::uint8_t> made(n);
    rows.verdict = made.mutable_data();
    to.verdict = std::move(made);
  }
  return rows;
}

// A position that is not plausible.
struct BadPosition {
  std::size_t row;
  Configurations::Implausible why;
  double position;
};

[[noreturn]] void refuse(const BadPosition& bad, const Scene& scene) {
  const JointVariable& joint = scene.variables[bad.why.variable];
  if (bad.why.length != 1.0) {
    throw py::value_error(
        fmt::format("joints[{0}, {1}:{2}]: found a quaternion of the length {3} from '{4}' on; "
                    "expected 1",
                    bad.row, bad.why.variable, bad.why.variable + 4, bad.why.length, joint.name));
  }
  throw py::value_error(
      fmt::format("joints[{}, {}]: found {} for '{}'; expected a position within its limits, {} to "
                  "{}, and within 1e6 rad or 1e4 m",
                  bad.row, bad.why.variable, bad.position, joint.name, joint.lower, joint.upper));
}

// The work of one call, which threads share. Every kTogether configurations begin anew, so that the
// results do not depend on the number of threads.
class Work {
 public:
  static constexpr std::size_t kTogether = 32;

  Work(const double* joints, std::size_t count, const Rows& rows)
      : joints_(joints), count_(count), rows_(rows), first_bad_(count) {}

  // Called without the interpreter's lock. Returns the first row with a position that is not
  // plausible. Rows behind it may have been evaluated or not.
  std::optional<BadPosition> run(std::span<const std::unique_ptr<Configurations>> all) {
    {
      std::vector<std::jthread> threads;
      for (const auto& one : all.subspan(1))
        threads.emplace_back([this, &one] { evaluate(*one, [] { return false; }); });
      auto look = Clock::now() + kSlice;
      evaluate(*all.front(), [&] {
        if (Clock::now() < look) return false;
        look = Clock::now() + kSlice;
        return interrupted();
      });
    }
    if (is_interrupted_) throw_pending();
    const Lock lock(mutex_);
    return bad_;
  }

 private:
  using Clock = std::chrono::steady_clock;

  static void throw_pending() {
    const py::gil_scoped_acquire lock;
    throw py::error_already_set();
  }
  void note_bad(const BadPosition& bad) {
    const Lock lock(mutex_);
    if (bad.row >= first_bad_) return;
    first_bad_ = bad.row;
    bad_ = bad;
  }
  // Another thread may write to the array meanwhile, so each row is copied first.
  template <class Stop>
  void evaluate(Configurations& configurations, const Stop& stop) {
    std::vector<double> row(rows_.variables);
    for (;;) {
      const std::size_t begin = next_.fetch_add(kTogether);
      if (begin >= first_bad_ || is_interrupted_) return;
      if (stop()) {
        is_interrupted_ = true;
        return;
      }
      configurations.forget_tracking();
      for (std::size_t i = begin; i < std::min(begin + kTogether, count_); ++i) {
        std::copy_n(joints_ + i * row.size(), row.size(), row.begin());
        if (const auto bad = configurations.implausible(row)) {
          note_bad({i, *bad, row[bad->variable]});
          break;
        }
        if (rows_.limit) {
          rows_.verdict[i] =
              static_cast<std::uint8_t>(configurations.decide(row, *rows_.limit, rows_.at(i)));
        } else {
          configurations.evaluate(row, rows_.at(i));
        }
      }
    }
  }

  const double* joints_;
  std::size_t count_;
  const Rows& rows_;
  std::atomic<std::size_t> next_ = 0, first_bad_;
  std::atomic<bool> is_interrupted_ = false;
  Mutex mutex_;
  GUARDED_BY(mutex_) std::optional<BadPosition> bad_;
};

// The pairs that the argument names, by their objects in any order; all: it is None.
std::vector<std::uint32_t> pairs_of(const py::object& pairs, const Scene& scene) {
  std::vector<std::uint32_t> chosen;
  if (pairs.is_none()) {
    chosen.resize(scene.pairs.size());
    std::iota(chosen.begin(), chosen.end(), 0U);
    return chosen;
  }
  for (const auto& [first, second] :
       pairs.cast<std::vector<std::pair<std::string, std::string>>>()) {
    const auto found = std::ranges::find_if(scene.pairs, [&](const ObjectPair& pair) {
      const std::string &a = scene.objects[pair.first].name, &b = scene.objects[pair.second].name;
      return (a == first && b == second) || (a == second && b == first);
    });
    if (found == scene.pairs.end())
      throw py::key_error("pairs: " + why_no_pairs_between(scene, first, second));
    chosen.push_back(static_cast<std::uint32_t>(found - scene.pairs.begin()));
  }
  return chosen;
}

std::size_t threads_of(int threads, py::ssize_t configurations) {
  if (threads < 0)
    throw py::value_error(
        fmt::format("threads: found {}; expected 0, all cores, or more", threads));
  const std::size_t wanted =
      threads == 0 ? std::max(1U, std::thread::hardware_concurrency()) : threads;
  return std::clamp<std::size_t>(wanted, 1,
                                 static_cast<std::size_t>(configurations) / Work::kTogether + 1);
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
    if (scene.objects[i].is_seen())
      throw py::value_error(fmt::format(
          "poses: '{}' is a sensor; expected an object whose shape the cell states", name));
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
                    bool points, bool gradients, const py::object& pairs,
                    const std::optional<double>& below, int threads) {
  const Scene& scene = self.scene();
  const auto variables = static_cast<py::ssize_t>(scene.variables.size());
  const Doubles array = doubles_of(joints, "joints", {kAny, variables});
  const std::vector<std::uint32_t> chosen = pairs_of(pairs, scene);
  if (below && !std::isfinite(*below))
    throw py::value_error(fmt::format("below: found {}; expected a distance, m", *below));
  Distances result;
  const Rows rows =
      make_arrays(array.shape(0), chosen.size(), scene, points, gradients, below, result);
  std::vector<std::unique_ptr<Configurations>> configurations;
  for (std::size_t i = threads_of(threads, array.shape(0)); i > 0; --i) {
    configurations.push_back(self.borrow());
    configurations.back()->begin();
    configurations.back()->choose(chosen);
    place_objects(scene, poses, *configurations.back());
  }
  std::optional<BadPosition> bad;
  {
    Work work(array.data(), static_cast<std::size_t>(array.shape(0)), rows);
    const Unlocked unlock;
    bad = work.run(configurations);
  }
  if (bad) refuse(*bad, scene);
  for (auto& one : configurations) self.give_back(std::move(one));
  return result;
}

// An array that the call may have left out.
template <py::object Distances::*kArray>
py::object given(const Distances& self) {
  if ((self.*kArray).is_none())
    throw py::attribute_error(
        "the call left this out; expected points=True, gradients=True or below= there");
  return self.*kArray;
}

void add_result(py::module_& module) {
  py::class_<Distances>(module, "Distances", R"(The distances of n configurations, by pair.

Arrays have the shape (n, pairs), with the pairs in the order of the call, else of Cell.pairs. An unknown bound is
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
      .def_property_readonly("verdict", given<&Distances::verdict>,
                             R"((n,), a Verdict, uint8: BELOW if a pair is nearer than `below`.

FREE if none is. UNDECIDED if that is not known of a pair. AttributeError without below=.)")
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
            py::arg("pairs") = py::none(), py::arg("below") = py::none(), py::arg("threads") = 1,
            R"(The distances of all pairs in n configurations.

joints: (n, joints), rad or m, in the order of Cell.joints. poses: of moving objects that are no
links, by name; pairs of objects without a pose are unknown. The joints of an absent robot may all be
NaN: its pairs are then absent. points: False leaves points and normals
out. gradients: True adds the derivatives with respect to the joints. pairs: only these, by the
names of their objects. below: whether a pair is nearer than this, m; a configuration ends at the
first pair that is, and pairs that are proven to be farther are not queried: their lower bounds are
known, other figures are those of an unknown pair. threads: 0 takes all cores.

Raises ValueError for another shape, or for a position that is not finite or outside the joint's
limits and their tolerance, or for a quaternion whose length is not 1; KeyError for an unknown object or pair. Releases the interpreter's lock; Ctrl-C
ends it. The same call gives the same bits, for any number of threads.)");
}

}  // namespace clearance::python
