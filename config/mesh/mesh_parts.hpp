// The convex parts of the mesh files of a cell: read, split, kept.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "config/decomposition/convex_parts.hpp"
#include "config/mesh/mesh_file.hpp"
#include "config/mesh/parts_cache.hpp"
#include "config/scene/revision.hpp"
#include "config/yaml/quantities.hpp"
#include "core/shapes.hpp"

namespace clearance {

// A mesh file and how its coordinates become metres.
struct MeshUse {
  std::string file;  // relative to the reader's directory
  Vec3 scale = Vec3::Ones();
  LengthUnit unit = LengthUnit::kMetre;
  // No vertex may be farther from the mesh's origin along an axis, m: a wrong number in a file,
  // or another unit, would make a body so large that it contains the whole cell.
  double reach = 100.0;
  PartLimits limits = {};
};

// What certainly contains the mesh, and how far beyond it that reaches, m (ConvexParts::error).
struct MeshParts {
  std::vector<ConvexBody> shapes;
  double error = 0.0;
};

// Why there are none; of kTooLarge how far from its origin it reaches.
struct MeshRefusal {
  enum class Kind { kFile, kDamaged, kTooLarge, kNotSolid };  // kFile: there is none
  Kind kind;
  std::string reason;
};

// Files are read once, and parts of the same use are made once, as long as this lives.
class MeshLibrary {
 public:
  // Mesh paths are relative to the folder of `cell`; the bytes of every mesh, and what it was split
  // into, go into `revision` once. `tell` gets a line, without its end, when a mesh is being split,
  // and where its parts are farther from it than the tolerance; may be empty.
  MeshLibrary(const std::filesystem::path& cell, Revision& revision,
              std::function<void(const std::string&)> tell)
      : directory_(cell.parent_path()),
        revision_(revision),
        cache_(revision.root().empty() ? cell : std::filesystem::path()),
        tell_(std::move(tell)) {}

  [[nodiscard]] std::variant<MeshParts, MeshRefusal> parts(const MeshUse& use);

 private:
  struct File {
    std::string bytes;
    std::optional<TriangleMesh> mesh;  // once it was needed
    std::optional<MeshRefusal> refusal;
  };
  [[nodiscard]] std::filesystem::path path_of(const MeshUse& use) const;
  File& load(const std::filesystem::path& path);
  std::variant<ConvexParts, MeshRefusal> split(const MeshUse& use, const std::string& key,
                                               File& file);
  void say(const std::string& line) const {
    if (tell_) tell_(line);
  }

  std::filesystem::path directory_;
  Revision& revision_;
  PartsCache cache_;
  std::function<void(const std::string&)> tell_;
  std::map<std::string, File> files_;
  std::map<std::string, MeshParts> made_;  // by key
};

}  // namespace clearance
