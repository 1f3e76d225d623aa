// Convex bodies and poses: core/shapes.hpp and core/pose.hpp.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <memory>
#include <utility>
#include <variant>
#include <vector>

#include "core/shapes.hpp"
#include "tools/python/module/arrays.hpp"
#include "tools/python/module/module.hpp"
#include "tools/python/module/waiting.hpp"

namespace clearance::python {
namespace {

class RefusedShape : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

using Body = std::shared_ptr<ConvexBody>;

// A body with this radius around it, or the factory's reason as an exception.
Body made(ShapeResult result, double radius = 0.0) {
  if (radius != 0.0 && std::holds_alternative<ConvexBody>(result))
    result = rounded_by(radius, std::get<ConvexBody>(std::move(result)));
  if (const auto* error = std::get_if<ShapeError>(&result)) throw RefusedShape(error->reason);
  return std::make_shared<ConvexBody>(std::get<ConvexBody>(std::move(result)));
}

// Exact arithmetic may take milliseconds.
template <class Make>
Body made_unlocked(const Make& make, double radius) {
  const Unlocked unlock;
  return made(make(), radius);
}

Body from_halfspaces(const py::object& rows, double radius) {
  const Doubles array = doubles_of(rows, "rows", {kAny, 4});
  std::vector<HalfSpace> list;
  for (py::ssize_t i = 0; i < array.shape(0); ++i) {
    const double* row = array.data(i, 0);
    list.push_back({{row[0], row[1], row[2]}, row[3]});
  }
  return made_unlocked([&] { return polyhedron_from_halfspaces(list); }, radius);
}

Body from_vertices(const py::object& points, double radius) {
  const Doubles array = doubles_of(points, "points", {kAny, 3});
  std::vector<Vec3> list;
  for (py::ssize_t i = 0; i < array.shape(0); ++i) {
    const double* row = array.data(i, 0);
    list.emplace_back(row[0], row[1], row[2]);
  }
  return made_unlocked([&] { return polyhedron_from_vertices(list); }, radius);
}

Body prism_of(const py::object& base, double z_low, double z_high, double radius) {
  const Doubles array = doubles_of(base, "base", {kAny, 2});
  std::vector<Vec2> list;
  for (py::ssize_t i = 0; i < array.shape(0); ++i)
    list.emplace_back(array.at(i, 0), array.at(i, 1));
  return made_unlocked([&] { return prism(list, z_low, z_high); }, radius);
}

Doubles vertices_of(const ConvexBody& body) {
  Doubles array({static_cast<py::ssize_t>(body.vertices.size()), py::ssize_t{3}});
  double* out = array.mutable_data();
  for (const Vertex& vertex : body.vertices) out = std::copy_n(vertex.position.data(), 3, out);
  return array;
}

Doubles facets_of(const ConvexBody& body) {
  Doubles array({static_cast<py::ssize_t>(body.facets.size()), py::ssize_t{4}});
  double* out = array.mutable_data();
  for (const Facet& facet : body.facets) {
    out = std::copy_n(facet.normal.data(), 3, out);
    *out++ = facet.offset;
  }
  return array;
}

std::string text_of(const ConvexBody& body) {
  const std::string radius = body.radius > 0.0 ? fmt::format(", radius {} m", body.radius) : "";
  if (body.is_curved()) return fmt::format("<clearance.Body: curved{}>", radius);
  return fmt::format("<clearance.Body: {} vertices, {} edges, {} facets{}>", body.vertices.size(),
                     body.edges.size(), body.facets.size(), radius);
}

void add_body_class(py::module_& module) {
  py::class_<ConvexBody, Body>(module, "Body", R"(A convex body, made by one of the factories.

Bodies do not change. They may be shared by threads. Lengths are in metres.)")
      .def_property_readonly("vertices", &vertices_of,
                             "Vertices without the radius, (n, 3), m; none of a curved body.")
      .def_property_readonly("facets", &facets_of, R"(Facets without the radius, (n, 4).

Each row is the outward unit normal and the offset d, m, of a half-space n.x <= d.)")
      .def_readonly("radius", &ConvexBody::radius, "The radius around the body, m.")
      .def_property_readonly(
          "bounding_radius",
          [](const ConvexBody& b) { return b.bounded() ? b.bounding_radius : kInfinity; },
          "The largest distance of a point from the origin, without the radius, m.")
      .def_property_readonly("bounded", &ConvexBody::bounded, "False for a floor, say.")
      .def_property_readonly("curved", &ConvexBody::is_curved,
                             "True for ellipsoids, cylinders and cones.")
      .def("__repr__", &text_of);
}

void add_polyhedra(py::module_& module) {
  module.def("polyhedron_from_halfspaces", &from_halfspaces, py::arg("rows"),
             py::arg("radius") = 0.0,
             R"(The intersection of half-spaces, which may be unbounded.

rows: (n, 4), each an outward normal and an offset d in m: the half-space normal.x <= d.
radius: of a sphere around every point of the body, m.
Raises ShapeError if the intersection is empty, flat, or no row bounds it.)");
  module.def("polyhedron_from_vertices", &from_vertices, py::arg("points"), py::arg("radius") = 0.0,
             R"(The convex hull of points.

points: (n, 3), m; at least four, not all in one plane.
radius: m. Raises ShapeError.)");
  module.def(
      "box",
      [](const py::object& half_extents, double radius) {
        return made(box(vec3_of(half_extents, "half_extents")), radius);
      },
      py::arg("half_extents"), py::arg("radius") = 0.0,
      R"(A box around the origin, along the axes.

half_extents: (3,), m, all positive. radius: m. Raises ShapeError.)");
  module.def("prism", &prism_of, py::arg("base"), py::arg("z_low"), py::arg("z_high"),
             py::arg("radius") = 0.0,
             R"(The hull of the base polygon, extruded along z from z_low to z_high.

base: (n, 2), m, in any order. radius: m. Raises ShapeError.)");
}

void add_round_bodies(py::module_& module) {
  module.def(
      "point",
      [](const py::object& position, double radius) {
        return made(point(vec3_of(position, "position"), radius));
      },
      py::arg("position") = py::make_tuple(0.0, 0.0, 0.0), py::arg("radius") = 0.0,
      R"(A point; with a radius, a sphere.

position: (3,), m. radius: m. Raises ShapeError.)");
  module.def(
      "segment",
      [](const py::object& start, const py::object& end, double radius) {
        return made(segment(vec3_of(start, "start"), vec3_of(end, "end"), radius));
      },
      py::arg("start"), py::arg("end"), py::arg("radius") = 0.0,
      R"(A segment; with a radius, a capsule.

start, end: (3,), m, different. radius: m. Raises ShapeError.)");
  module.def(
      "ellipsoid",
      [](const py::object& semi_axes, double radius) {
        return made(ellipsoid(vec3_of(semi_axes, "semi_axes"), radius));
      },
      py::arg("semi_axes"), py::arg("radius") = 0.0,
      R"(An ellipsoid around the origin, along the axes.

semi_axes: (3,), m. radius: m. Raises ShapeError.)");
  module.def(
      "cylinder",
      [](double radius_of_base, double half_length, double radius) {
        return made(cylinder(radius_of_base, half_length, radius));
      },
      py::arg("base_radius"), py::arg("half_length"), py::arg("radius") = 0.0,
      R"(A cylinder around the z-axis, from z = -half_length to half_length.

All in m; `radius` is that of a sphere around every point. Raises ShapeError.)");
  module.def(
      "cone",
      [](double base_radius, double half_length, double radius) {
        return made(cone(base_radius, half_length, radius));
      },
      py::arg("base_radius"), py::arg("half_length"), py::arg("radius") = 0.0,
      R"(A cone: the base at z = -half_length, the apex at z = half_length.

All in m; `radius` is that of a sphere around every point. Raises ShapeError.)");
  module.def(
      "truncated_cone",
      [](double lower, double upper, double half_length, double radius) {
        return made(truncated_cone(lower, upper, half_length, radius));
      },
      py::arg("lower_radius"), py::arg("upper_radius"), py::arg("half_length"),
      py::arg("radius") = 0.0,
      R"(The hull of a disc at z = -half_length and one at z = half_length.

All in m; one of the discs may have the radius 0. Raises ShapeError.)");
  module.def(
      "rounded_by",
      [](double radius, const ConvexBody& body) { return made(rounded_by(radius, body)); },
      py::arg("radius"), py::arg("body"),
      R"(The same body with this radius in place of its former one, m. Raises ShapeError.)");
}

void add_poses(py::module_& module) {
  py::class_<Pose>(module, "Pose", R"(A rigid motion: x -> position + R(orientation) x.

Functions take a Pose, seven numbers (x, y, z, and the quaternion x, y, z, w) or a 4 x 4 matrix.)")
      .def(py::init([](const py::object& position, const py::object& orientation) {
             const Vec3 p = vec3_of(position, "position");
             const Doubles q = doubles_of(orientation, "orientation", {4});
             const double row[7] = {p.x(), p.y(), p.z(), q.at(0), q.at(1), q.at(2), q.at(3)};
             return pose_in(row, "pose", 0);
           }),
           py::arg("position") = py::make_tuple(0.0, 0.0, 0.0),
           py::arg("orientation") = py::make_tuple(0.0, 0.0, 0.0, 1.0),
           R"(position: (3,), m. orientation: a unit quaternion x, y, z, w.

Raises ValueError if a number is not finite, or if the quaternion is off unit length by more than
1e-6.)")
      .def_static(
          "of", [](const py::object& pose) { return pose_of(pose, "pose"); }, py::arg("pose"),
          "A pose from seven numbers or a 4 x 4 matrix. Raises ValueError.")
      .def_property_readonly(
          "position", [](const Pose& p) { return array_of(p.position); }, "(3,), m.")
      .def_property_readonly(
          "orientation",
          [](const Pose& p) {
            Doubles q(4);
            std::copy_n(p.orientation.coeffs().data(), 4, q.mutable_data());
            return q;
          },
          "The quaternion x, y, z, w.")
      .def(
          "__matmul__", [](const Pose& outer, const Pose& inner) { return compose(outer, inner); },
          py::arg("inner"), "outer_from_middle @ middle_from_inner.")
      .def(
          "apply",
          [](const Pose& pose, const py::object& at) {
            return array_of(transform(pose, vec3_of(at, "point")));
          },
          py::arg("point"), "The place of a point, (3,), m.")
      .def(
          "__eq__", [](const Pose& a, const Pose& b) { return same_pose(a, b); }, py::is_operator())
      .def("__repr__", [](const Pose& p) {
        return fmt::format("clearance.Pose(({}, {}, {}), ({}, {}, {}, {}))", p.position.x(),
                           p.position.y(), p.position.z(), p.orientation.x(), p.orientation.y(),
                           p.orientation.z(), p.orientation.w());
      });
  py::class_<RelativePose>(module, "RelativePose", R"(The pose of B in A's frame, as queries use it.

A query with it costs less than one with a Pose.)")
      .def(py::init([](const py::object& world_from_a, const py::object& world_from_b) {
             const RelativePose relative = relative_pose(pose_of(world_from_a, "world_from_a"),
                                                         pose_of(world_from_b, "world_from_b"));
             if (!relative.translation.allFinite())
               throw py::value_error("the frames are farther than 1e12 m from each other");
             return relative;
           }),
           py::arg("world_from_a"), py::arg("world_from_b"),
           "From the poses of both bodies in one frame. Raises ValueError.")
      .def_property_readonly(
          "translation", [](const RelativePose& r) { return array_of(r.translation); },
          "(3,), m, in frame A.")
      .def_property_readonly(
          "rotation",
          [](const RelativePose& r) {
            Doubles m({3, 3});
            for (int i = 0; i < 3; ++i) {
              for (int j = 0; j < 3; ++j) m.mutable_at(i, j) = r.rotation(i, j);
            }
            return m;
          },
          "(3, 3): x_a = rotation @ x_b + translation.");
}

}  // namespace

void add_bodies(py::module_& module) {
  py::register_exception<RefusedShape>(module, "ShapeError", PyExc_ValueError).doc() =
      "A shape was refused: the text says why.";
  add_body_class(module);
  add_polyhedra(module);
  add_round_bodies(module);
  add_poses(module);
}

}  // namespace clearance::python
