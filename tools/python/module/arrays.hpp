// Arguments that are NumPy arrays or sequences of numbers, and arrays of records.
//
// Every function names the argument in its exception: TypeError for what is no array of numbers,
// ValueError for a wrong shape or value.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "core/pose.hpp"

namespace clearance::python {

namespace py = pybind11;

// Contiguous doubles. An array of that kind is used as it is; anything else is copied.
using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

// Any number of rows, in a shape.
inline constexpr py::ssize_t kAny = -1;

// The argument as an array of this shape.
[[nodiscard]] Doubles doubles_of(py::handle argument, const char* name,
                                 std::initializer_list<py::ssize_t> shape);

[[nodiscard]] Vec3 vec3_of(py::handle argument, const char* name);

// A Pose, seven numbers (x, y, z, and the quaternion x, y, z, w) or a 4 x 4 matrix.
[[nodiscard]] Pose pose_of(py::handle argument, const char* name);

// Row `row` of an (n, 7) array: a checked pose.
[[nodiscard]] Pose pose_in(const double* row, const char* name, py::ssize_t number);

[[nodiscard]] Doubles array_of(const Vec3& v);

// A field of a record: NumPy's name of the type ("f8", "3f8", "u1"), and the offset in the struct.
struct Field {
  std::string_view name;
  std::string type;
  std::size_t offset;
};

// A dtype with the layout of a C++ struct of `size` bytes; the fields may be any part of it.
[[nodiscard]] py::dtype record_dtype(const std::vector<Field>& fields, std::size_t size);

// A one-dimensional record array: a copy of `count` structs.
[[nodiscard]] py::array records_of(const py::dtype& dtype, const void* first, std::size_t count);

// Takes over the bytes, without a copy, as `count` records.
[[nodiscard]] py::array records_from(const py::dtype& dtype, std::vector<std::byte>&& bytes,
                                     std::size_t count);

// An enum.IntEnum of the module.
struct Enumerator {
  std::string name;
  int value;
};
py::object add_enum(py::module_& module, const char* name, const std::vector<Enumerator>& values,
                    const char* doc);

// "depth-not-asked" or "kept" as a constant's name: "DEPTH_NOT_ASKED".
[[nodiscard]] std::string constant_name(std::string_view word);

}  // namespace clearance::python
