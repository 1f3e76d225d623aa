// Reads, splits and keeps the convex parts of the meshes of a cell.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
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
  std::string file;  // relative to the cell's folder
  Vec3 scale = Vec3::Ones();
  LengthUnit unit = LengthUnit::kMetre;
  // The largest coordinate that a vertex may have along an axis, m. A wrong number in a file, or
  // another unit, would make a body that contains the whole cell.
  double reach = 100.0;
  PartLimits limits = {};
};

// Bodies that certainly contain the mesh, and the largest distance by which they exceed it, m
// (ConvexParts::error).
struct MeshParts {
  std::vector<ConvexBody> shapes;
  double error = 0.0;
};

// Why a mesh has no parts. `reason` of kTooLarge is its largest coordinate.
struct MeshRefusal {
  enum class Kind { kFile, kDamaged, kTooLarge, kNotSolid };  // kFile: it cannot be opened
  Kind kind;
  std::string reason;
};

// The advice in messages for a person who has to raise the limits of a mesh. Limits are in the
// cell. A person who gave a URDF has to write a cell first.
enum class Advice : std::uint8_t { kCell, kUrdf };

struct ReadMeshes;

// Meshes that another thread reads and splits before a cell is read, so that the thread that reads
// the cell never waits for a disk or for a large mesh.
struct MeshesAhead {
  bool asks = false;            // a reading notes meshes that it does not have, in place of them
  std::vector<MeshUse> wanted;  // by the readings since this was cleared
  std::shared_ptr<const ReadMeshes> read;  // what the other thread has made of them; null: nothing
};

// Files are read once, and parts of the same use are made once, as long as this lives.
//
// A cell is read twice where a mesh has to be split. The first reading finds its mistakes, with a
// small body in the place of each mesh whose parts are not kept yet. The second reading has the
// parts.
class MeshLibrary {
 public:
  // Mesh paths are relative to the folder of `cell`. The bytes of every mesh, and what it was split
  // into, go into `revision` once. `tell` gets a line, without its end, when a mesh is being split.
  // It also gets one when the error of the parts exceeds the tolerance. It may be empty.
  MeshLibrary(const std::filesystem::path& cell, Revision& revision,
              std::function<void(const std::string&)> tell, Advice advice = Advice::kCell,
              MeshesAhead* ahead = nullptr);

  [[nodiscard]] std::variant<MeshParts, MeshRefusal> parts(const MeshUse& use);

  // Tells whether parts() has returned a stand-in, because the split of a mesh was postponed.
  [[nodiscard]] bool has_put_off() const noexcept { return has_put_off_; }
  // Call this before the cell is read again, with a fresh revision. The files that were read are
  // not read again. Until split_from_here(), parts() returns stand-ins.
  void begin_reading() { begin(false); }
  // The same, but from then on parts() splits meshes instead of returning stand-ins.
  void split_from_here() { begin(true); }

 private:
  void begin(bool splits);
  struct File {
    std::string bytes, digest;         // and their SHA-256
    std::optional<TriangleMesh> mesh;  // once it was needed; in the file's unit
    std::optional<MeshRefusal> refusal;
    bool counted = false;  // in the revision
  };
  struct Made {
    MeshParts parts;
    bool counted = false;  // in the revision
  };
  // Takes the mesh from what was read ahead, or notes that it is wanted and returns a stand-in.
  // Nothing: it is here, or has to be read here.
  std::optional<std::variant<MeshParts, MeshRefusal>> from_ahead(const MeshUse& use);
  [[nodiscard]] std::filesystem::path path_of(const MeshUse& use) const;
  File& load(const MeshUse& use);
  // Returns the mesh in metres, or refuses one that is too large.
  std::variant<TriangleMesh, MeshRefusal> mesh_of(const MeshUse& use, File& file);
  // Returns the kept parts if they contain the mesh, whoever wrote them.
  [[nodiscard]] std::optional<MeshParts> kept(const MeshUse& use, const std::string& key,
                                              File& file);
  std::variant<MeshParts, MeshRefusal> put_off(const MeshUse& use, File& file);
  std::variant<MeshParts, MeshRefusal> make(const MeshUse& use, const std::string& key, File& file);
  std::variant<ConvexParts, MeshRefusal> split(const MeshUse& use, const std::string& key,
                                               File& file);
  void warn_of_error(const MeshUse& use, const MeshParts& parts) const;
  void say(const std::string& line) const {
    if (tell_) tell_(line);
  }

  std::filesystem::path directory_;
  Revision& revision_;
  PartsCache cache_;
  std::function<void(const std::string&)> tell_;
  Advice advice_;
  bool splits_ = false, has_put_off_ = false;
  std::map<std::string, File> files_;
  std::map<std::string, Made> made_;             // by key
  std::map<std::string, MeshRefusal> not_made_;  // by key, in this reading
  MeshesAhead* ahead_;
};

// Reads these meshes and splits them. To be called in any thread; never asks whether it may.
[[nodiscard]] std::shared_ptr<const ReadMeshes> read_meshes(
    const std::filesystem::path& cell, const std::filesystem::path& root,
    const std::function<void(const std::string&)>& tell, Advice advice,
    const std::vector<MeshUse>& meshes);

}  // namespace clearance
