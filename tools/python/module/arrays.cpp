#include "tools/python/module/arrays.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>

namespace clearance::python {
namespace {

std::string shape_text(const py::ssize_t* shape, std::size_t count) {
  std::string text = "(";
  for (std::size_t i = 0; i < count; ++i) {
    text += shape[i] == kAny ? "n" : std::to_string(shape[i]);
    if (i + 1 < count || count == 1) text += i + 1 < count ? ", " : ",";
  }
  return text + ")";
}

void check(const Pose& pose, const std::string& name) {
  if (!pose.position.allFinite() || pose.position.cwiseAbs().maxCoeff() > kLargestCoordinate) {
    throw py::value_error(
        fmt::format("{}: the position is ({}, {}, {}); expected finite numbers up to 1e12 m", name,
                    pose.position.x(), pose.position.y(), pose.position.z()));
  }
  if (!is_unit(pose.orientation)) {
    throw py::value_error(
        fmt::format("{}: the quaternion (x, y, z, w) = ({}, {}, {}, {}) has length {}; expected 1 "
                    "to within 1e-6",
                    name, pose.orientation.x(), pose.orientation.y(), pose.orientation.z(),
                    pose.orientation.w(), pose.orientation.norm()));
  }
}

Pose pose_of_row(const double* p) {
  return {{p[0], p[1], p[2]}, Eigen::Quaterniond(p[6], p[3], p[4], p[5])};
}

Pose pose_of_matrix(const Doubles& array, const char* name) {
  Eigen::Matrix4d m;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) m(i, j) = array.at(i, j);
  }
  const Mat3 turn = m.topLeftCorner<3, 3>();
  constexpr double kTolerance = 1e-6;
  const bool rigid = m.allFinite() && m.row(3) == Eigen::RowVector4d(0, 0, 0, 1) &&
                     (turn.transpose() * turn - Mat3::Identity()).norm() <= kTolerance &&
                     turn.determinant() > 0.0;
  if (!rigid) {
    throw py::value_error(fmt::format(
        "{}: the 4 x 4 matrix is no rigid motion; expected a rotation to within 1e-6 and the last "
        "row 0, 0, 0, 1",
        name));
  }
  return {m.topRightCorner<3, 1>(), Eigen::Quaterniond(turn).normalized()};
}

}  // namespace

Doubles doubles_of(py::handle argument, const char* name,
                   std::initializer_list<py::ssize_t> shape) {
  Doubles array = Doubles::ensure(argument);
  if (!array || argument.is_none() || py::isinstance<py::str>(argument)) {
    PyErr_Clear();
    throw py::type_error(fmt::format("{}: found {}; expected numbers of shape {}", name,
                                     Py_TYPE(argument.ptr())->tp_name,
                                     shape_text(shape.begin(), shape.size())));
  }
  bool fits = array.ndim() == static_cast<py::ssize_t>(shape.size());
  for (std::size_t i = 0; fits && i < shape.size(); ++i) {
    const py::ssize_t expected = shape.begin()[i];
    fits = expected == kAny || array.shape(static_cast<py::ssize_t>(i)) == expected;
  }
  if (!fits) {
    throw py::value_error(
        fmt::format("{}: found the shape {}; expected {}", name,
                    shape_text(array.shape(), static_cast<std::size_t>(array.ndim())),
                    shape_text(shape.begin(), shape.size())));
  }
  return array;
}

Vec3 vec3_of(py::handle argument, const char* name) {
  const Doubles array = doubles_of(argument, name, {3});
  return {array.at(0), array.at(1), array.at(2)};
}

Pose pose_in(const double* row, const char* name, py::ssize_t number) {
  const Pose pose = pose_of_row(row);
  check(pose, fmt::format("{}[{}]", name, number));
  return pose;
}

Pose pose_of(py::handle argument, const char* name) {
  if (py::isinstance<Pose>(argument)) return argument.cast<Pose>();
  const Doubles array = Doubles::ensure(argument);
  if (!array || argument.is_none()) {
    PyErr_Clear();
    throw py::type_error(
        fmt::format("{}: found {}; expected a Pose, seven numbers (x, y, z, and the quaternion x, "
                    "y, z, w), or a 4 x 4 matrix",
                    name, Py_TYPE(argument.ptr())->tp_name));
  }
  Pose pose;
  if (array.ndim() == 2 && array.shape(0) == 4 && array.shape(1) == 4) {
    pose = pose_of_matrix(array, name);
  } else if (array.ndim() == 1 && array.shape(0) == 7) {
    pose = pose_of_row(array.data());
  } else {
    throw py::value_error(
        fmt::format("{}: found the shape {}; expected (7,) or (4, 4)", name,
                    shape_text(array.shape(), static_cast<std::size_t>(array.ndim()))));
  }
  check(pose, name);
  return pose;
}

Doubles array_of(const Vec3& v) {
  Doubles array(3);
  std::copy_n(v.data(), 3, array.mutable_data());
  return array;
}

py::dtype record_dtype(const std::vector<Field>& fields, std::size_t size) {
  py::list names, formats, offsets;
  for (const Field& field : fields) {
    names.append(py::str(field.name.data(), field.name.size()));
    formats.append(field.type);
    offsets.append(field.offset);
  }
  py::dict layout;
  layout["names"] = names;
  layout["formats"] = formats;
  layout["offsets"] = offsets;
  layout["itemsize"] = size;
  return py::dtype::from_args(layout);
}

py::array records_of(const py::dtype& dtype, const void* first, std::size_t count) {
  py::array array(dtype, static_cast<py::ssize_t>(count));
  if (count != 0)
    std::memcpy(array.mutable_data(), first, count * static_cast<std::size_t>(dtype.itemsize()));
  return array;
}

py::array records_from(const py::dtype& dtype, std::vector<std::byte>&& bytes, std::size_t count) {
  auto* const kept = new std::vector<std::byte>(std::move(bytes));
  const py::capsule owner(kept, [](void* p) { delete static_cast<std::vector<std::byte>*>(p); });
  return py::array(dtype, {static_cast<py::ssize_t>(count)}, {dtype.itemsize()}, kept->data(),
                   owner);
}

py::object add_enum(py::module_& module, const char* name, const std::vector<Enumerator>& values,
                    const char* doc) {
  py::list members;
  for (const Enumerator& value : values) members.append(py::make_tuple(value.name, value.value));
  py::object type = py::module_::import("enum").attr("IntEnum")(
      name, members, py::arg("module") = module.attr("__name__"));
  type.attr("__doc__") = doc;
  module.attr(name) = type;
  return type;
}

std::string constant_name(std::string_view word) {
  std::string constant(word);
  for (char& c : constant) {
    c = c == '-' || c == ' ' ? '_' : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  }
  return constant;
}

}  // namespace clearance::python
