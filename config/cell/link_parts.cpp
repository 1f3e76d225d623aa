#include "config/cell/link_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <variant>

namespace clearance {
namespace {

constexpr std::array<const char*, 5> kKinds = {"mesh", "box", "cylinder", "sphere",
                                               "capsule"};  // in the order of the variant

}  // namespace

void refuse_robot(const YamlNode& at, const UrdfFaults& faults, Diagnostics& diagnostics) {
  for (const UrdfFault& fault : faults) {
    diagnostics.add(at, "found a robot that cannot be used", {fault.place.line, fault.text});
  }
}

PackagesFrom packages_from(const Diagnostics& diagnostics) {
  return diagnostics.is_of_urdf() ? PackagesFrom::kCommandLine : PackagesFrom::kCell;
}

void LinkParts::refuse(UrdfPlace place, const std::string& text) {
  refuse_robot(at_, {fault_at(urdf_, place, text)}, diagnostics_);
}

// A missing mesh is reported by its name in the URDF.
std::optional<std::variant<MeshParts, ShapeError>> LinkParts::parts_of(const UrdfMesh& mesh) {
  UrdfFaults faults;
  const auto path = meshes_.find(mesh, faults);
  refuse_robot(at_, faults, diagnostics_);
  if (!path) return std::nullopt;
  auto parts = shapes_.mesh_parts({.file = path->string(), .scale = mesh.scale, .limits = limits_});
  if (const auto* mistake = std::get_if<MeshMistake>(&parts)) {
    refuse(mesh.place, mistake->text);
    return std::nullopt;
  }
  if (auto* error = std::get_if<ShapeError>(&parts)) return std::move(*error);
  return std::get<MeshParts>(std::move(parts));
}

std::optional<std::variant<MeshParts, ShapeError>> LinkParts::shapes_of(
    const UrdfCollision& collision) {
  const auto one = [](ShapeResult made) -> std::variant<MeshParts, ShapeError> {
    if (auto* error = std::get_if<ShapeError>(&made)) return std::move(*error);
    MeshParts parts;
    parts.shapes.push_back(std::get<ConvexBody>(std::move(made)));
    return parts;
  };
  if (const auto* shape = std::get_if<UrdfBox>(&collision.shape)) {
    return one(box(0.5 * shape->size));
  }
  if (const auto* shape = std::get_if<UrdfSphere>(&collision.shape)) {
    return one(point(Vec3::Zero(), shape->radius));
  }
  if (const auto* shape = std::get_if<UrdfCapsule>(&collision.shape)) {
    const Vec3 end(0.0, 0.0, 0.5 * shape->length);
    return one(segment(-end, end, shape->radius));
  }
  if (const auto* shape = std::get_if<UrdfCylinder>(&collision.shape)) {
    return one(cylinder(shape->radius, 0.5 * shape->length));
  }
  return parts_of(std::get<UrdfMesh>(collision.shape));
}

double LinkParts::add(const UrdfLink& link, Object& object) {
  double mesh_error = 0.0;
  for (std::size_t place = 0; place < link.collisions.size(); ++place) {
    const UrdfCollision& collision = link.collisions[place];
    auto result = shapes_of(collision);
    if (!result) continue;
    const char* kind = kKinds[collision.shape.index()];
    if (const auto* error = std::get_if<ShapeError>(&*result)) {
      refuse(collision.place,
             fmt::format("found a {} of the link '{}' that is not a solid convex body: {}", kind,
                         link.name, error->reason));
      continue;
    }
    auto& parts = std::get<MeshParts>(*result);
    mesh_error = std::max(mesh_error, parts.error);
    for (std::size_t i = 0; i < parts.shapes.size(); ++i) {
      object.parts.push_back({name_of_part(kind + std::to_string(place), i, parts.shapes.size()),
                              std::move(parts.shapes[i]), pose_of(collision.link_from_shape)});
    }
  }
  return mesh_error;
}

}  // namespace clearance
