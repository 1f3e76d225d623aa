#include "config/link_parts.hpp"

#include <fmt/format.h>

#include <array>
#include <string>
#include <system_error>
#include <utility>
#include <variant>

namespace clearance {
namespace {

constexpr std::array<const char*, 4> kKinds = {"mesh", "box", "cylinder",
                                               "sphere"};  // as the variant

}  // namespace

void refuse_robot(const YamlNode& at, const UrdfFaults& faults, Diagnostics& diagnostics) {
  for (const UrdfFault& fault : faults) {
    diagnostics.add(at, fmt::format("found a robot that cannot be used: {}", fault.text));
  }
}

// A mesh that is not there is reported as the URDF names it.
std::optional<ShapeResult> LinkParts::hull_of(const UrdfMesh& mesh) {
  const auto path = files_.find(mesh.file);
  if (std::error_code fault; path && std::filesystem::is_regular_file(*path, fault)) {
    return shapes_.mesh_hull({.file = path->string(), .scale = mesh.scale}, at_, at_);
  }
  const std::string package = package_of(mesh.file);
  const std::string missing =
      path ? fmt::format("no file '{}'", path->string())
           : fmt::format("no directory for the package '{}'; expected packages: {{{}: DIRECTORY}}",
                         package, package);
  refuse_robot(at_,
               {{mesh.line, fmt::format("{}:{}: found the mesh '{}', and {}",
                                        files_.named_in.string(), mesh.line, mesh.file, missing)}},
               diagnostics_);
  return std::nullopt;
}

std::optional<ShapeResult> LinkParts::shape_of(const UrdfCollision& collision) {
  if (const auto* shape = std::get_if<UrdfBox>(&collision.shape)) return box(0.5 * shape->size);
  if (const auto* shape = std::get_if<UrdfSphere>(&collision.shape)) {
    return point(Vec3::Zero(), shape->radius);
  }
  if (const auto* shape = std::get_if<UrdfCylinder>(&collision.shape)) {
    return prism(prism_around(*shape), -0.5 * shape->length, 0.5 * shape->length);
  }
  return hull_of(std::get<UrdfMesh>(collision.shape));
}

std::vector<Part> LinkParts::of(const UrdfLink& link) {
  std::vector<Part> parts;
  for (const UrdfCollision& collision : link.collisions) {
    auto result = shape_of(collision);
    if (!result) continue;
    const char* kind = kKinds[collision.shape.index()];
    if (const auto* error = std::get_if<ShapeError>(&*result)) {
      diagnostics_.add(
          at_, fmt::format("found a {} of the link '{}' that is not a solid convex body: {}", kind,
                           link.name, error->reason));
      continue;
    }
    parts.push_back({kind + std::to_string(parts.size()),
                     std::get<ConvexPolyhedron>(std::move(*result)),
                     pose_of(collision.link_from_shape)});
  }
  return parts;
}

}  // namespace clearance
