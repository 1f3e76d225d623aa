// clearance.DistanceBatch: core/batch.hpp.
#include "core/batch.hpp"

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <vector>

#include "tools/python/module/arrays.hpp"
#include "tools/python/module/module.hpp"
#include "tools/python/module/waiting.hpp"

namespace clearance::python {
namespace {

const py::dtype& result_dtype() {
  // Never destroyed: the interpreter may be gone by then.
  static const auto* const dtype =
      new py::dtype(record_dtype({{"distance", "f8", offsetof(DistanceResult, distance)},
                                  {"lower", "f8", offsetof(DistanceResult, lower)},
                                  {"upper", "f8", offsetof(DistanceResult, upper)},
                                  {"normal", "3f8", offsetof(DistanceResult, normal)},
                                  {"point_on_a", "3f8", offsetof(DistanceResult, point_on_a)},
                                  {"point_on_b", "3f8", offsetof(DistanceResult, point_on_b)},
                                  {"status", "u1", offsetof(DistanceResult, status)},
                                  {"path", "u1", offsetof(DistanceResult, path)},
                                  {"iterations", "u2", offsetof(DistanceResult, iterations)}},
                                 sizeof(DistanceResult)));
  return *dtype;
}

class Batch {
 public:
  Batch(const py::sequence& bodies, const py::object& pairs) {
    std::vector<const ConvexBody*> pointers;
    for (const py::object body : bodies) {  // an owner: some sequences make their items on demand
      if (!py::isinstance<ConvexBody>(body)) {
        throw py::type_error(fmt::format("bodies[{}]: found {}; expected a Body", bodies_.size(),
                                         Py_TYPE(body.ptr())->tp_name));
      }
      bodies_.push_back(body.cast<std::shared_ptr<ConvexBody>>());
      pointers.push_back(bodies_.back().get());
    }
    const Doubles array = doubles_of(pairs, "pairs", {kAny, 2});
    std::vector<BodyPair> list;
    for (py::ssize_t i = 0; i < array.shape(0); ++i)
      list.push_back({index(array.at(i, 0), i), index(array.at(i, 1), i)});
    poses_.resize(bodies_.size());
    pairs_ = list.size();
    batch_.emplace(pointers, list);
  }

  py::array evaluate(const py::object& poses) {
    const Exclusive exclusive(in_use_, "the DistanceBatch");
    const auto count = static_cast<py::ssize_t>(bodies_.size());
    const Doubles array = doubles_of(poses, "poses", {count, 7});
    for (py::ssize_t i = 0; i < count; ++i)
      poses_[static_cast<std::size_t>(i)] = pose_in(array.data(i, 0), "poses", i);
    std::span<const DistanceResult> found;
    {
      const Unlocked unlock;
      found = batch_->evaluate(poses_);
    }
    return records_of(result_dtype(), found.data(), found.size());
  }

  void forget() {
    const Exclusive exclusive(in_use_, "the DistanceBatch");
    batch_->forget();
  }

  [[nodiscard]] std::size_t size() const { return pairs_; }

 private:
  [[nodiscard]] std::uint32_t index(double value, py::ssize_t pair) const {
    if (!(value >= 0.0 && value < static_cast<double>(bodies_.size()) &&
          value == std::floor(value))) {
      throw py::value_error(fmt::format("pairs[{}]: found the index {}; expected 0 to {}", pair,
                                        value, static_cast<py::ssize_t>(bodies_.size()) - 1));
    }
    return static_cast<std::uint32_t>(value);
  }

  std::vector<std::shared_ptr<ConvexBody>> bodies_;
  std::vector<Pose> poses_;
  std::size_t pairs_ = 0;
  std::optional<DistanceBatch> batch_;
  std::atomic<bool> in_use_ = false;
};

}  // namespace

void add_batch(py::module_& module) {
  py::class_<Batch>(module, "DistanceBatch", R"(The distances of many tracked pairs at once.

The answers are those of distance() with one state a pair, bit for bit. Vector instructions make it
faster for bodies that move a little between two calls.)")
      .def(py::init<const py::sequence&, const py::object&>(), py::arg("bodies"), py::arg("pairs"),
           R"(bodies: a sequence of Body. pairs: (m, 2), indices of bodies.

Raises TypeError and ValueError.)")
      .def("evaluate", &Batch::evaluate, py::arg("poses"),
           R"(poses: (bodies, 7), each x, y, z, and the quaternion x, y, z, w; m.

Returns records, (m,), with the fields of a Distance. Points and normals are in frame A of each pair.
Raises ValueError for a pose that is not finite or not of unit length. Releases the interpreter's
lock; RuntimeError if another thread uses the batch.)")
      .def("forget", &Batch::forget, "The next call starts from nothing.")
      .def("__len__", &Batch::size);
}

}  // namespace clearance::python
