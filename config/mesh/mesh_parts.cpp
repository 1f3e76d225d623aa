#include "config/mesh/mesh_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "config/mesh/file_lock.hpp"
#include "config/mesh/mesh_codes.hpp"
#include "config/mesh/parts_cover.hpp"
#include "config/text/sentences.hpp"

namespace clearance {
namespace {

// A version number. It is raised when the same mesh would be split differently, so that kept parts
// are made anew.
constexpr int kMethod = 6;

// s. A hull that took less time is not kept, but computed anew at every start.
constexpr double kWorthKeeping = 0.1;

// Hashes everything on which the parts depend. The names of the mesh file and of the cell are not
// among it.
std::string key_of(const MeshUse& use, const std::string& bytes) {
  Revision hash;
  hash.add(bytes);
  hash.add(fmt::format("{} {} {:a} {:a} {:a} {} {:a} {:a} {} {:a}", kMethod,
                       std::filesystem::path(use.file).extension().string(), use.scale.x(),
                       use.scale.y(), use.scale.z(), static_cast<int>(use.unit), use.reach,
                       use.limits.tolerance, use.limits.max_parts, use.limits.plate));
  return fmt::format("{:016x}", hash.value());
}

void scale(const MeshUse& use, TriangleMesh& mesh) {
  for (Vec3& v : mesh.vertices) {
    v = {to_metres(v.x() * use.scale.x(), use.unit), to_metres(v.y() * use.scale.y(), use.unit),
         to_metres(v.z() * use.scale.z(), use.unit)};
  }
}

// Returns a body of 1 cm, which takes the place of a mesh that is not split yet.
MeshParts stand_in() {
  MeshParts parts;
  parts.shapes.push_back(std::get<ConvexBody>(point(Vec3::Zero(), 0.01)));
  return parts;
}

std::string_view bytes_of(const std::vector<Vec3>& vertices) {
  return {reinterpret_cast<const char*>(vertices.data()), vertices.size() * sizeof(Vec3)};
}

// Returns nothing if a part makes no valid body: the kept file is then damaged.
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

// A library with a revision of its own.
struct ReadMeshes {
  ReadMeshes(const std::filesystem::path& cell, const std::filesystem::path& root,
             const std::function<void(const std::string&)>& tell, Advice advice)
      : revision(root), library(cell, revision, tell, advice) {}
  Revision revision;
  MeshLibrary library;
};

// The cell of a recording has no folder of its own: its parts are in the user's cache.
MeshLibrary::MeshLibrary(const std::filesystem::path& cell, Revision& revision,
                         std::function<void(const std::string&)> tell, Advice advice,
                         MeshesAhead* ahead)
    : directory_(cell.parent_path()),
      revision_(revision),
      cache_(revision.root().empty() ? std::optional(directory_) : std::nullopt),
      tell_(std::move(tell)),
      advice_(advice),
      ahead_(ahead) {}

// A file that could not be used may have been replaced since.
void MeshLibrary::begin(bool splits) {
  splits_ = splits;
  has_put_off_ = false;
  not_made_.clear();
  std::erase_if(files_, [](const auto& entry) { return entry.second.refusal.has_value(); });
  for (auto& [path, file] : files_) file.counted = false;
  for (auto& [key, made] : made_) made.counted = false;
}

std::filesystem::path MeshLibrary::path_of(const MeshUse& use) const {
  return path_in(revision_.root(), directory_, use.file);
}

// Each file is read once, however many parts use it. Its bytes go into the scene's revision, so
// that two scenes with different meshes have different revisions.
MeshLibrary::File& MeshLibrary::load(const MeshUse& use) {
  const std::filesystem::path path = path_of(use);
  const auto [entry, is_new] = files_.try_emplace(path.string());
  File& file = entry->second;
  if (is_new) {
    auto bytes = revision_.read(path, use.file);
    if (auto* fault = std::get_if<FileFault>(&bytes)) {
      file.refusal = {MeshRefusal::Kind::kFile, std::move(fault->reason)};
    } else {
      file.bytes = std::get<std::string>(std::move(bytes));
      file.digest = sha256(file.bytes);
    }
  }
  if (!file.refusal && !std::exchange(file.counted, true))
    revision_.add_file(path, file.bytes, file.digest);
  return file;
}

// The size is checked after scaling: a wrong unit shows as a mesh of a thousand times the size.
std::variant<TriangleMesh, MeshRefusal> MeshLibrary::mesh_of(const MeshUse& use, File& file) {
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
  scale(use, mesh);
  for (const Vec3& vertex : mesh.vertices) {
    const double farthest = vertex.cwiseAbs().maxCoeff();
    if (farthest > use.reach) {
      return MeshRefusal{MeshRefusal::Kind::kTooLarge, fmt::format("{:.4g} m", farthest)};
    }
  }
  return mesh;
}

std::variant<ConvexParts, MeshRefusal> MeshLibrary::split(const MeshUse& use,
                                                          const std::string& key, File& file) {
  const std::string name = path_of(use).filename().string();
  auto mesh = mesh_of(use, file);
  if (auto* refusal = std::get_if<MeshRefusal>(&mesh)) return std::move(*refusal);
  const auto start = std::chrono::steady_clock::now();
  auto made = convex_parts(std::get<TriangleMesh>(mesh), use.limits, [&] {
    say(fmt::format("{}: not convex; being split into parts within {:g} mm of it ...", name,
                    1e3 * use.limits.tolerance));
  });
  if (auto* error = std::get_if<ShapeError>(&made)) {
    return MeshRefusal{MeshRefusal::Kind::kNotSolid, std::move(error->reason)};
  }
  auto& parts = std::get<ConvexParts>(made);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  if (parts.is_hull) {
    if (took.count() > kWorthKeeping) cache_.keep(key, parts);
    return std::move(parts);
  }
  const std::filesystem::path kept = cache_.keep(key, parts);
  say(fmt::format("{}: {}, {:.1f} mm, in {:.1f} s; {}", name, counted(parts.parts.size(), "part"),
                  1e3 * parts.error, took.count(),
                  kept.empty() ? fmt::format("warning: '{}' cannot be written, so they will be "
                                             "made again at the next start [{}]",
                                             cache_.folder().string(), kPartsNotKept)
                               : fmt::format("kept in '{}'", kept.string())));
  return std::move(parts);
}

std::optional<MeshParts> MeshLibrary::kept(const MeshUse& use, const std::string& key, File& file) {
  const auto parts = cache_.find(key);
  if (!parts) return std::nullopt;
  const auto mesh = mesh_of(use, file);
  if (std::holds_alternative<MeshRefusal>(mesh)) return std::nullopt;
  auto bodies = bodies_of(*parts);
  if (bodies && cover(bodies->shapes, std::get<TriangleMesh>(mesh))) return bodies;
  if (splits_) {
    say(
        fmt::format("warning: {}: the parts that are kept of it in '{}' do not contain it; they "
                    "are made again [{}]",
                    path_of(use).filename().string(), cache_.folder().string(), kPartsAgain));
  }
  return std::nullopt;
}

// Postpones the split and returns a stand-in. A mesh that cannot be read, or is too large, is
// refused now.
std::variant<MeshParts, MeshRefusal> MeshLibrary::put_off(const MeshUse& use, File& file) {
  auto mesh = mesh_of(use, file);
  if (auto* refusal = std::get_if<MeshRefusal>(&mesh)) return std::move(*refusal);
  has_put_off_ = true;
  return stand_in();
}

// When programs start together on a new mesh, one splits it, and the others wait for its parts.
std::variant<MeshParts, MeshRefusal> MeshLibrary::make(const MeshUse& use, const std::string& key,
                                                       File& file) {
  const std::filesystem::path path = path_of(use);
  const FileLock lock(path, [&] {
    say(fmt::format("{}: another program splits it ...", path.filename().string()));
  });
  if (lock.waited()) {
    if (auto bodies = kept(use, key, file)) return *std::move(bodies);
  }
  auto made = split(use, key, file);
  if (auto* refusal = std::get_if<MeshRefusal>(&made)) return std::move(*refusal);
  if (auto bodies = bodies_of(std::get<ConvexParts>(made))) return *std::move(bodies);
  return MeshRefusal{MeshRefusal::Kind::kNotSolid, "a part of it is flat"};
}

void MeshLibrary::warn_of_error(const MeshUse& use, const MeshParts& parts) const {
  if (parts.error <= use.limits.tolerance) return;
  const std::string limits =
      parts.shapes.size() < use.limits.max_parts
          ? std::string("tolerance")
          : fmt::format("max_parts (now {}) or tolerance", use.limits.max_parts);
  say(fmt::format(
      "warning: {}: its {} reach{} {:.1f} mm beyond it, more than the tolerance of {:g} "
      "mm: raise {} in {} [{}]",
      path_of(use).filename().string(), counted(parts.shapes.size(), "part"),
      parts.shapes.size() == 1 ? "es" : "", 1e3 * parts.error, 1e3 * use.limits.tolerance, limits,
      advice_ == Advice::kCell ? "the cell"
                               : "a cell: 'clearance-scene new --robots URDF -o CELL.yaml' writes "
                                 "one of this robot, with "
                                 "max_parts and tolerance, and 'clearanced CELL.yaml' runs it",
      kMeshFarFromParts));
}

// Keeps the refusal of a mesh that was read ahead until the command that wants it is done.
std::optional<std::variant<MeshParts, MeshRefusal>> MeshLibrary::from_ahead(const MeshUse& use) {
  const std::filesystem::path path = path_of(use);
  const auto here = files_.find(path.string());
  const bool is_here = here != files_.end() && !here->second.refusal;
  if (is_here && made_.contains(key_of(use, here->second.bytes))) return std::nullopt;
  if (const MeshLibrary* const read = ahead_->read ? &ahead_->read->library : nullptr;
      read != nullptr && read->files_.contains(path.string())) {
    const File& found = read->files_.at(path.string());
    if (found.refusal) return *found.refusal;
    File& file = files_[path.string()];
    const bool was_counted = is_here && file.counted;
    file = found;
    file.counted = was_counted;
    const std::string key = key_of(use, file.bytes);
    if (const auto refused = read->not_made_.find(key); refused != read->not_made_.end())
      return refused->second;
    if (const auto made = read->made_.find(key); made != read->made_.end()) {
      made_.emplace(key, Made{.parts = made->second.parts});
      return std::nullopt;
    }
  }
  if (!ahead_->asks || revision_.refusal(path, use.file)) return std::nullopt;
  ahead_->wanted.push_back(use);
  has_put_off_ = true;
  return stand_in();
}

std::variant<MeshParts, MeshRefusal> MeshLibrary::parts(const MeshUse& use) {
  if (ahead_ != nullptr) {
    if (auto found = from_ahead(use)) return *std::move(found);
  }
  File& file = load(use);
  if (file.refusal) return *file.refusal;
  const std::string key = key_of(use, file.bytes);
  auto made = made_.find(key);
  if (made == made_.end()) {
    std::optional<MeshParts> bodies = kept(use, key, file);
    if (!bodies && !splits_) return put_off(use, file);
    if (!bodies) {
      auto result = make(use, key, file);
      if (const auto* refusal = std::get_if<MeshRefusal>(&result)) {
        not_made_.insert_or_assign(key, *refusal);
        return result;
      }
      bodies = std::get<MeshParts>(std::move(result));
    }
    warn_of_error(use, *bodies);
    made = made_.emplace(key, Made{.parts = *std::move(bodies)}).first;
  }
  const MeshParts& parts = made->second.parts;
  if (!std::exchange(made->second.counted, true) && parts.shapes.size() > 1) {
    for (const ConvexBody& shape : parts.shapes) revision_.add(bytes_of(shape.anchors));
  }
  return parts;
}

std::shared_ptr<const ReadMeshes> read_meshes(const std::filesystem::path& cell,
                                              const std::filesystem::path& root,
                                              const std::function<void(const std::string&)>& tell,
                                              Advice advice, const std::vector<MeshUse>& meshes) {
  const auto read = std::make_shared<ReadMeshes>(cell, root, tell, advice);
  read->library.split_from_here();
  for (const MeshUse& use : meshes) (void)read->library.parts(use);
  return read;
}

}  // namespace clearance
