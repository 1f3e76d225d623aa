#include "config/mesh/mesh_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "config/mesh/file_lock.hpp"

namespace clearance {
namespace {

// To be raised when the same mesh would be split otherwise: what is kept from before is then made
// anew.
constexpr int kMethod = 2;

// A hull that is found sooner is found anew at every start, s.
constexpr double kWorthKeeping = 0.1;

// Of all that decides on the parts.
std::string key_of(const MeshUse& use, const std::string& bytes) {
  Revision hash;
  hash.add(bytes);
  hash.add(fmt::format("{} {:a} {:a} {:a} {} {:a} {:a} {}", kMethod, use.scale.x(), use.scale.y(),
                       use.scale.z(), static_cast<int>(use.unit), use.reach, use.limits.tolerance,
                       use.limits.max_parts));
  return fmt::format("{:016x}", hash.value());
}

void to_metres(const MeshUse& use, TriangleMesh& mesh) {
  for (Vec3& v : mesh.vertices) {
    v = {metres(v.x() * use.scale.x(), use.unit), metres(v.y() * use.scale.y(), use.unit),
         metres(v.z() * use.scale.z(), use.unit)};
  }
}

std::string_view bytes_of(const std::vector<Vec3>& vertices) {
  return {reinterpret_cast<const char*>(vertices.data()), vertices.size() * sizeof(Vec3)};
}

// Nothing where a part is no body: what was kept is not what was made.
std::optional<MeshParts> bodies_of(const ConvexParts& parts) {
  MeshParts bodies{{}, parts.error};
  for (const auto& vertices : parts.parts) {
    ShapeResult made = polyhedron_from_vertices(vertices);
    auto* body = std::get_if<ConvexBody>(&made);
    if (body == nullptr) return std::nullopt;
    bodies.shapes.push_back(std::move(*body));
  }
  return bodies;
}

}  // namespace

std::filesystem::path MeshLibrary::path_of(const MeshUse& use) const {
  return path_in(revision_.root(), directory_, use.file);
}

// Each file is read once, however many parts use it, and its bytes go into the scene's revision:
// two scenes with different meshes must not pass for one.
MeshLibrary::File& MeshLibrary::load(const std::filesystem::path& path) {
  const auto [entry, is_new] = files_.try_emplace(path.string());
  File& file = entry->second;
  if (!is_new) return file;
  auto bytes = read_bytes(path.string());
  if (auto* fault = std::get_if<MeshFault>(&bytes)) {
    file.refusal = {MeshRefusal::Kind::kFile, std::move(fault->reason)};
    return file;
  }
  file.bytes = std::get<std::string>(std::move(bytes));
  revision_.add_file(path, file.bytes);
  return file;
}

std::variant<ConvexParts, MeshRefusal> MeshLibrary::split(const MeshUse& use,
                                                          const std::string& key, File& file) {
  const std::filesystem::path path = path_of(use);
  if (!file.mesh) {
    auto read = read_mesh(file.bytes, path.extension().string());
    if (auto* fault = std::get_if<MeshFault>(&read)) {
      file.refusal = {MeshRefusal::Kind::kDamaged,
                      fmt::format("'{}': {}", path.string(), fault->reason)};
      return *file.refusal;
    }
    file.mesh = std::get<TriangleMesh>(std::move(read));
  }
  TriangleMesh mesh = *file.mesh;
  to_metres(use, mesh);
  // Checked after scaling: a wrong unit shows as a mesh of a thousand times the size.
  for (const Vec3& vertex : mesh.vertices) {
    const double farthest = vertex.cwiseAbs().maxCoeff();
    if (farthest > use.reach) {
      return MeshRefusal{MeshRefusal::Kind::kTooLarge, fmt::format("{:.4g} m", farthest)};
    }
  }
  const auto start = std::chrono::steady_clock::now();
  auto made = convex_parts(mesh, use.limits, [&] {
    say(fmt::format("{}: not convex; being split into parts within {:g} mm of it ...",
                    path.filename().string(), 1e3 * use.limits.tolerance));
  });
  if (auto* error = std::get_if<ShapeError>(&made)) {
    return MeshRefusal{MeshRefusal::Kind::kNotSolid, std::move(error->reason)};
  }
  auto& parts = std::get<ConvexParts>(made);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  if (parts.is_hull) {
    if (took.count() > kWorthKeeping) cache_.keep(path.filename().string(), key, parts);
    return std::move(parts);
  }
  const std::filesystem::path kept = cache_.keep(path.filename().string(), key, parts);
  say(fmt::format(
      "{}: {} part{}, {:.1f} mm, in {:.1f} s; {}", path.filename().string(), parts.parts.size(),
      parts.parts.size() == 1 ? "" : "s", 1e3 * parts.error, took.count(),
      kept.empty() ? fmt::format("warning: '{}' cannot be written, so they will be made "
                                 "again at the next start",
                                 cache_.folder().string())
                   : fmt::format("kept in '{}'", kept.string())));
  return std::move(parts);
}

std::variant<MeshParts, MeshRefusal> MeshLibrary::parts(const MeshUse& use) {
  const std::filesystem::path path = path_of(use);
  File& file = load(path);
  if (file.refusal) return *file.refusal;
  const std::string key = key_of(use, file.bytes);
  if (const auto made = made_.find(key); made != made_.end()) return made->second;
  const std::string name = path.filename().string();
  const auto kept_bodies = [&]() -> std::optional<MeshParts> {
    const auto kept = cache_.find(name, key);
    return kept ? bodies_of(*kept) : std::nullopt;
  };
  std::optional<MeshParts> bodies = kept_bodies();
  std::optional<FileLock> lock;
  if (!bodies) {
    lock.emplace(path, [&] { say(fmt::format("{}: another program splits it ...", name)); });
    if (lock->waited()) bodies = kept_bodies();
  }
  if (!bodies) {
    auto split_now = split(use, key, file);
    if (auto* refusal = std::get_if<MeshRefusal>(&split_now)) return std::move(*refusal);
    bodies = bodies_of(std::get<ConvexParts>(split_now));
  }
  if (!bodies) return MeshRefusal{MeshRefusal::Kind::kNotSolid, "a part of it is flat"};
  if (bodies->error > use.limits.tolerance) {
    say(fmt::format(
        "warning: {}: its {} part{} reach {:.1f} mm beyond it, more than the tolerance "
        "of {:g} mm: raise {} in the cell (clearance-scene import writes one)",
        path.filename().string(), bodies->shapes.size(), bodies->shapes.size() == 1 ? "" : "s",
        1e3 * bodies->error, 1e3 * use.limits.tolerance,
        bodies->shapes.size() < use.limits.max_parts
            ? std::string("tolerance")
            : fmt::format("max_parts (now {}) or tolerance", use.limits.max_parts)));
  }
  if (bodies->shapes.size() > 1) {
    for (const ConvexBody& shape : bodies->shapes) revision_.add(bytes_of(shape.anchors));
  }
  return made_.emplace(key, *std::move(bodies)).first->second;
}

}  // namespace clearance
