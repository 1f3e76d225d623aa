// Assimp parses the bytes in memory (except PLY), and the transforms of the scene graph place each
// mesh. Indices and accessors are checked before they are used: assimp takes them from the file as
// they are.
#include "config/mesh/mesh_import.hpp"

#include <fmt/format.h>

#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <utility>
#include <vector>

#include "config/mesh/collada_check.hpp"
#include "config/mesh/obj_check.hpp"
#include "config/mesh/ply.hpp"

namespace clearance {
namespace {

// Thrown and caught inside this file.
struct BadMesh {
  std::string reason;
};

// Assimp's floats, widened without rounding.
Vec3 to_vec3(const aiVector3D& v) { return {v.x, v.y, v.z}; }

// Returns the position of vertex `k` of a face.
Vec3 corner(const aiMesh& mesh, unsigned f, unsigned k, const aiMatrix4x4& placed) {
  const unsigned index = mesh.mFaces[f].mIndices[k];
  if (index >= mesh.mNumVertices || mesh.mVertices == nullptr) {
    throw BadMesh{fmt::format("face {} names vertex {} of {}", f, index, mesh.mNumVertices)};
  }
  return to_vec3(placed * mesh.mVertices[index]);
}

// The diffuse colour of the material. Assimp invents one where a file has none, and a texture
// replaces it.
std::optional<Vec3> colour_of(const aiScene& scene, const aiMesh& mesh) {
  if (mesh.mMaterialIndex >= scene.mNumMaterials) return std::nullopt;
  const aiMaterial& material = *scene.mMaterials[mesh.mMaterialIndex];
  aiColor4D colour;
  if (material.GetTextureCount(aiTextureType_DIFFUSE) > 0 ||
      material.Get(AI_MATKEY_COLOR_DIFFUSE, colour) != aiReturn_SUCCESS) {
    return std::nullopt;
  }
  const Vec3 found(colour.r, colour.g, colour.b);
  if (!found.allFinite()) return std::nullopt;
  return found.cwiseMax(0.0).cwiseMin(1.0);
}

std::vector<Triangle>& triangles_of(const std::optional<Vec3>& colour,
                                    std::vector<ColouredTriangles>& all) {
  const auto known = std::ranges::find(all, colour, &ColouredTriangles::colour);
  return known != all.end() ? known->triangles : all.emplace_back(colour).triangles;
}

// Depth first through the scene graph; `outer` is the transform from the node's parent to the
// file's root, column vectors on the right.
void collect(const aiScene& scene, const aiNode& node, const aiMatrix4x4& outer, bool has_colours,
             std::vector<ColouredTriangles>& all) {
  const aiMatrix4x4 placed = outer * node.mTransformation;
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    if (node.mMeshes[i] >= scene.mNumMeshes) throw BadMesh{"it places a mesh that it lacks"};
    const aiMesh& mesh = *scene.mMeshes[node.mMeshes[i]];
    std::vector<Triangle>& triangles =
        triangles_of(has_colours ? colour_of(scene, mesh) : std::nullopt, all);
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices < 3) continue;  // stray points and lines are no part of the surface
      for (unsigned k = 1; k + 1 < face.mNumIndices; ++k) {
        triangles.push_back({corner(mesh, f, 0, placed), corner(mesh, f, k, placed),
                             corner(mesh, f, k + 1, placed)});
      }
    }
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i)
    collect(scene, *node.mChildren[i], placed, has_colours, all);
}

// Returns assimp's message without the name that it invents for bytes in memory.
std::string plain(std::string message) {
  const std::size_t start = message.find("$$$___magic___$$$");
  if (start == std::string::npos) return message;
  const bool quoted = start > 0 && message[start - 1] == '"';
  const std::size_t first = start - (quoted ? 1 : 0);
  const std::size_t end =
      quoted ? message.find('"', start) + 1 : message.find_first_of(" :,", start);
  return message.replace(first, end - first, "it");
}

// Assimp would try its other readers where a file is not of the format of its name.
void keep_one_format(Assimp::Importer& importer, const std::string& format) {
  Assimp::BaseImporter* const wanted = importer.GetImporter(format.c_str());
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    Assimp::BaseImporter* const reader = importer.GetImporter(i);
    if (reader != wanted) importer.UnregisterLoader(reader);
  }
}

// Assimp reads an ASCII STL that is cut off as if it were a smaller one. The length of a binary STL
// follows from its number of triangles.
void refuse_cut_off_stl(const std::string& bytes) {
  constexpr std::size_t kHeader = 80, kTriangle = 50;
  std::uint32_t triangles = 0;
  if (bytes.size() >= kHeader + sizeof triangles) {
    std::memcpy(&triangles, bytes.data() + kHeader, sizeof triangles);
    if (bytes.size() == kHeader + sizeof triangles + kTriangle * triangles) return;
  }
  const std::size_t end = bytes.find_last_not_of(std::string_view(" \t\r\n\0", 5));
  const std::size_t last = bytes.find_last_of("\r\n", end);
  const std::size_t word = bytes.find_first_not_of(" \t", last + 1);
  if (end == std::string::npos || bytes.compare(word, 8, "endsolid") != 0) {
    throw BadMesh{"its length is not that of its triangles, and its last line not 'endsolid'"};
  }
}

// Reads STL, OBJ and COLLADA.
std::vector<ColouredTriangles> import_with_assimp(const std::string& bytes,
                                                  const std::string& format) {
  if (format == "stl") refuse_cut_off_stl(bytes);
  if (format == "obj") {
    if (const std::string fault = fault_of_obj(bytes); !fault.empty()) throw BadMesh{fault};
  }
  if (format == "dae") {
    if (const std::string fault = fault_of_collada(bytes); !fault.empty()) throw BadMesh{fault};
  }
  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  keep_one_format(importer, format);
  const aiScene* scene = importer.ReadFileFromMemory(bytes.data(), bytes.size(), 0, format.c_str());
  if (scene == nullptr) throw BadMesh{plain(importer.GetErrorString())};
  std::vector<ColouredTriangles> all;
  if (scene->mRootNode != nullptr) {
    collect(*scene, *scene->mRootNode, aiMatrix4x4(), format == "dae", all);
  }
  std::erase_if(all, [](const ColouredTriangles& each) { return each.triangles.empty(); });
  return all;
}

std::variant<std::vector<ColouredTriangles>, MeshFault> import_ply(const std::string& bytes) {
  auto read = ply_triangles(bytes);
  if (auto* const fault = std::get_if<MeshFault>(&read)) return std::move(*fault);
  std::vector<ColouredTriangles> all;
  auto& triangles = std::get<std::vector<Triangle>>(read);
  if (!triangles.empty()) all.push_back({.colour = {}, .triangles = std::move(triangles)});
  return all;
}

}  // namespace

// No post-processing step of assimp is used: joining and triangulating is done here. Assimp throws
// for some malformed files, so everything is caught.
std::variant<std::vector<ColouredTriangles>, MeshFault> import_mesh(const std::string& bytes,
                                                                    const std::string& format) {
  try {
    if (format == "ply") {
      auto read = import_ply(bytes);
      const auto* const all = std::get_if<std::vector<ColouredTriangles>>(&read);
      if (all != nullptr && all->empty()) return MeshFault{"it has no faces"};
      return read;
    }
    auto all = import_with_assimp(bytes, format);
    if (all.empty()) return MeshFault{"it has no faces"};
    return all;
  } catch (const BadMesh& fault) {
    return MeshFault{fault.reason};
  } catch (const std::bad_alloc&) {
    throw;  // the child process tells how much memory it may have
  } catch (const std::exception& fault) {
    return MeshFault{fault.what()};
  }
}

}  // namespace clearance
