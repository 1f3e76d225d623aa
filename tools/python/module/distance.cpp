// clearance.distance(): core/distance.hpp.
//
// A query takes 0.1 us, so the call is made of CPython's own parts: pybind11 would add 1 us for the
// conversion of arguments and for the object that is returned.
#include "core/distance.hpp"

#include <fmt/format.h>

#include <new>

#include "tools/python/module/arrays.hpp"
#include "tools/python/module/module.hpp"

namespace clearance::python {
namespace {

// The Python object with a result.
struct ResultObject {
  PyObject_HEAD DistanceResult value;
};

// Filled when the module is made. The module keeps them, and is never unloaded.
PyTypeObject* result_type = nullptr;
PyObject* statuses[6] = {};
PyObject* paths[5] = {};

const DistanceResult& value_of(PyObject* self) {
  return reinterpret_cast<const ResultObject*>(self)->value;
}

template <double DistanceResult::*kMember>
PyObject* number(PyObject* self, void*) {
  return PyFloat_FromDouble(value_of(self).*kMember);
}

template <Vec3 DistanceResult::*kMember>
PyObject* vector(PyObject* self, void*) {
  try {
    return array_of(value_of(self).*kMember).release().ptr();
  } catch (py::error_already_set& error) {
    error.restore();
  } catch (const std::exception& error) {
    PyErr_SetString(PyExc_RuntimeError, error.what());
  }
  return nullptr;
}

PyObject* status(PyObject* self, void*) {
  PyObject* const found = statuses[static_cast<int>(value_of(self).status)];
  Py_INCREF(found);
  return found;
}

PyObject* path(PyObject* self, void*) {
  PyObject* const found = paths[static_cast<int>(value_of(self).path)];
  Py_INCREF(found);
  return found;
}

PyObject* iterations(PyObject* self, void*) { return PyLong_FromLong(value_of(self).iterations); }

PyObject* text(PyObject* self) {
  const DistanceResult& r = value_of(self);
  return PyUnicode_FromString(fmt::format("<clearance.Distance: {} m in [{}, {}], {}>", r.distance,
                                          r.lower, r.upper, name(r.status))
                                  .c_str());
}

void free_result(PyObject* self) {
  PyTypeObject* const type = Py_TYPE(self);
  PyObject_Free(self);
  Py_DECREF(type);
}

PyGetSetDef members[] = {
    {"distance", number<&DistanceResult::distance>, nullptr,
     "The signed distance, m, within the bounds; minus the penetration depth if the bodies "
     "overlap.",
     nullptr},
    {"lower", number<&DistanceResult::lower>, nullptr,
     "Certified: the true distance is not smaller, m.", nullptr},
    {"upper", number<&DistanceResult::upper>, nullptr,
     "Certified: the true distance is not larger, m.", nullptr},
    {"normal", vector<&DistanceResult::normal>, nullptr,
     "Unit vector from A towards B, (3,), in frame A.", nullptr},
    {"point_on_a", vector<&DistanceResult::point_on_a>, nullptr,
     "Witness point, (3,), m, in frame A.", nullptr},
    {"point_on_b", vector<&DistanceResult::point_on_b>, nullptr,
     "Witness point, (3,), m, in frame A.", nullptr},
    {"status", status, nullptr, "A DistanceStatus.", nullptr},
    {"path", path, nullptr, "The method that has answered: a DistancePath.", nullptr},
    {"iterations", iterations, nullptr, "The iterations of that method.", nullptr},
    {nullptr, nullptr, nullptr, nullptr, nullptr}};

constexpr const char* kResultDoc =
    "The result of clearance.distance(): lower <= true distance <= upper, rounding included.";
PyType_Slot slots[] = {{Py_tp_getset, members},
                       {Py_tp_repr, reinterpret_cast<void*>(text)},
                       {Py_tp_dealloc, reinterpret_cast<void*>(free_result)},
                       {Py_tp_doc, const_cast<char*>(kResultDoc)},
                       {0, nullptr}};
PyType_Spec spec = {"clearance._clearance.Distance", sizeof(ResultObject), 0,
                    Py_TPFLAGS_DEFAULT | Py_TPFLAGS_DISALLOW_INSTANTIATION, slots};

// The C++ object of an argument whose class is exactly T. Null for any other object, and for one
// whose __init__ was not called.
template <class T>
T* exactly(PyObject* object) {
  static PyTypeObject* const type =
      reinterpret_cast<PyTypeObject*>(py::type::of<T>().ptr());  // kept by the module
  if (Py_TYPE(object) != type) return nullptr;
  auto* const instance = reinterpret_cast<py::detail::instance*>(object);
  return instance->get_value_and_holder().value_ptr<T>();
}

PyObject* wrong_type(const char* argument, const char* expected, PyObject* found) {
  return PyErr_Format(PyExc_TypeError, "distance(): %s: found %s; expected %s", argument,
                      Py_TYPE(found)->tp_name, expected);
}

struct Arguments {
  PyObject *a = nullptr, *b = nullptr, *pose = nullptr, *state = Py_None, *depth = Py_True;
};

// False after an exception was set.
bool read(PyObject* const* given, Py_ssize_t count, PyObject* keywords, Arguments& to) {
  static constexpr const char* kNames[] = {"a", "b", "pose", "state", "depth"};
  PyObject** const places[] = {&to.a, &to.b, &to.pose, &to.state, &to.depth};
  if (count > 4) {
    PyErr_Format(PyExc_TypeError,
                 "distance(): found %zd arguments by position; expected a, b, pose and state",
                 count);
    return false;
  }
  for (Py_ssize_t i = 0; i < count; ++i) *places[i] = given[i];
  const Py_ssize_t named = keywords == nullptr ? 0 : PyTuple_GET_SIZE(keywords);
  for (Py_ssize_t k = 0; k < named; ++k) {
    PyObject* const key = PyTuple_GET_ITEM(keywords, k);
    Py_ssize_t i = 0;
    while (i < 5 && PyUnicode_CompareWithASCIIString(key, kNames[i]) != 0) ++i;
    if (i == 5 || i < count) {
      PyErr_Format(PyExc_TypeError, "distance(): the argument '%U' is %s", key,
                   i == 5 ? "unknown" : "given twice");
      return false;
    }
    *places[i] = given[count + k];
  }
  if (to.a != nullptr && to.b != nullptr && to.pose != nullptr) return true;
  PyErr_SetString(PyExc_TypeError, "distance(): expected a, b and pose");
  return false;
}

// The relative pose of an argument that is none. Throws Python's exceptions.
RelativePose relative_of(PyObject* pose) {
  const RelativePose found = relative_pose(Pose(), pose_of(pose, "pose"));
  if (!found.translation.allFinite()) throw py::value_error("pose: farther than 1e12 m");
  return found;
}

PyObject* result_of(const DistanceResult& value) {
  auto* const object = PyObject_New(ResultObject, result_type);
  if (object == nullptr) return nullptr;
  new (&object->value) DistanceResult(value);
  return reinterpret_cast<PyObject*>(object);
}

PyObject* distance_of(PyObject*, PyObject* const* given, Py_ssize_t count, PyObject* keywords) {
  Arguments arguments;
  if (!read(given, count, keywords, arguments)) return nullptr;
  const auto* a = exactly<ConvexBody>(arguments.a);
  if (a == nullptr) return wrong_type("a", "a Body", arguments.a);
  const auto* b = exactly<ConvexBody>(arguments.b);
  if (b == nullptr) return wrong_type("b", "a Body", arguments.b);
  TrackingState cold;
  TrackingState* state = &cold;
  if (arguments.state != Py_None) {
    state = exactly<TrackingState>(arguments.state);
    if (state == nullptr) return wrong_type("state", "a TrackingState or None", arguments.state);
  }
  const int depth = PyObject_IsTrue(arguments.depth);
  if (depth < 0) return nullptr;
  const DistanceOptions options{.depth = depth != 0};
  if (const auto* relative = exactly<RelativePose>(arguments.pose))
    return result_of(distance(*a, *b, *relative, *state, options));
  try {
    return result_of(distance(*a, *b, relative_of(arguments.pose), *state, options));
  } catch (py::error_already_set& error) {
    error.restore();
  } catch (const py::type_error& error) {
    PyErr_SetString(PyExc_TypeError, error.what());
  } catch (const std::exception& error) {
    PyErr_SetString(PyExc_ValueError, error.what());
  }
  return nullptr;
}

PyMethodDef distance_method = {"distance",
                               reinterpret_cast<PyCFunction>(reinterpret_cast<void*>(distance_of)),
                               METH_FASTCALL | METH_KEYWORDS,
                               R"(distance($module, a, b, pose, state=None, *, depth=True)
--

The signed distance of two convex bodies with certified bounds: a Distance.

a, b: a Body each. pose: of B in A's frame, a RelativePose (fastest), a Pose, seven numbers or a
4 x 4 matrix. state: a TrackingState, one a pair, which makes the next call for a nearby pose faster.
depth: False leaves the penetration depth out.

Points and normal are in frame A, lengths in m. Raises TypeError and ValueError for arguments that
are none of these. Releases no lock: a call takes a tenth of a microsecond.)"};

}  // namespace

void add_distance(py::module_& module) {
  std::vector<Enumerator> values;
  for (int i = 0; i < 6; ++i)
    values.push_back({constant_name(name(static_cast<DistanceStatus>(i))), i});
  const py::object status_enum = add_enum(module, "DistanceStatus", values, "Why a query ended.");
  for (int i = 0; i < 6; ++i) statuses[i] = status_enum(i).release().ptr();
  const py::object path_enum = add_enum(module, "DistancePath",
                                        {{"FEATURE_TRACKING", 0},
                                         {"ACTIVE_SET", 1},
                                         {"GJK", 2},
                                         {"PENETRATION", 3},
                                         {"DIRECTION", 4}},
                                        "The method that has answered a query.");
  for (int i = 0; i < 5; ++i) paths[i] = path_enum(i).release().ptr();

  py::class_<TrackingState>(module, "TrackingState", R"(What a pair keeps between two queries.

A hint and never a fact: any state leaves the bounds true. One thread uses it at a time.)")
      .def(py::init<>())
      .def(
          "forget", [](TrackingState& state) { state = {}; },
          "The next query starts from nothing.");

  result_type = reinterpret_cast<PyTypeObject*>(PyType_FromSpec(&spec));
  if (result_type == nullptr) throw py::error_already_set();
  module.attr("Distance") =
      py::reinterpret_borrow<py::object>(reinterpret_cast<PyObject*>(result_type));
  PyObject* const function =
      PyCFunction_NewEx(&distance_method, nullptr, py::str(module.attr("__name__")).ptr());
  module.attr("distance") = py::reinterpret_steal<py::object>(function);
}

}  // namespace clearance::python
