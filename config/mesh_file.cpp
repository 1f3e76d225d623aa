// Assimp parses the bytes in memory, and the scene graph's transforms place each mesh. The vertices
// are sorted and made unique, so that the result does not depend on the order of faces in the file.
#include "config/mesh_file.hpp"

#include <fmt/format.h>

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cerrno>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

namespace clearance {
namespace {

// Assimp's floats, widened without rounding.
Vec3 to_vec3(const aiVector3D& v) { return {v.x, v.y, v.z}; }

// Depth first through the scene graph; `outer` is the transform from the node's parent to the
// file's root, column vectors on the right.
void collect(const aiScene& scene, const aiNode& node, const aiMatrix4x4& outer,
             std::vector<Vec3>& vertices) {
  const aiMatrix4x4 placed = outer * node.mTransformation;
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const aiMesh& mesh = *scene.mMeshes[node.mMeshes[i]];
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices < 3) continue;  // stray points and lines are no part of the surface
      for (unsigned k = 0; k < face.mNumIndices; ++k) {
        vertices.push_back(to_vec3(placed * mesh.mVertices[face.mIndices[k]]));
      }
    }
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i)
    collect(scene, *node.mChildren[i], placed, vertices);
}

// Assimp's message, without the name that it invents for what it reads from memory.
std::string plain(std::string message) {
  const std::size_t start = message.find("$$$___magic___$$$");
  if (start == std::string::npos) return message;
  const bool quoted = start > 0 && message[start - 1] == '"';
  const std::size_t first = start - (quoted ? 1 : 0);
  const std::size_t end =
      quoted ? message.find('"', start) + 1 : message.find_first_of(" :,", start);
  return message.replace(first, end - first, "it");
}

// Any order serves that depends on the coordinates only.
bool lexicographic(const Vec3& a, const Vec3& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

}  // namespace

// The whole file, so that its bytes can go into the revision and be parsed without reading it
// again.
std::variant<std::string, MeshFault> read_bytes(const std::string& path) {
  std::error_code fault;
  if (std::filesystem::is_directory(path, fault))
    return MeshFault{fmt::format("'{}' is a directory", path)};
  std::ifstream stream(path, std::ios::binary);
  if (!stream)
    return MeshFault{fmt::format("'{}' cannot be opened: {}", path, std::strerror(errno))};
  std::string bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (stream.bad())
    return MeshFault{fmt::format("'{}' cannot be read: {}", path, std::strerror(errno))};
  return bytes;
}

// No post-processing step of assimp is used: joining vertices or triangulating does not change
// their convex hull. Assimp throws for some malformed files, so everything is caught here.
std::variant<std::vector<Vec3>, MeshFault> mesh_vertices(const std::string& bytes,
                                                         const std::string& extension) {
  try {
    Assimp::Importer importer;
    importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
    const std::string hint = extension.substr(extension.empty() || extension[0] != '.' ? 0 : 1);
    const aiScene* scene = importer.ReadFileFromMemory(bytes.data(), bytes.size(), 0, hint.c_str());
    if (scene == nullptr) return MeshFault{plain(importer.GetErrorString())};
    std::vector<Vec3> vertices;
    if (scene->mRootNode != nullptr) collect(*scene, *scene->mRootNode, aiMatrix4x4(), vertices);
    if (vertices.empty()) return MeshFault{"it has no faces"};
    const bool finite =
        std::all_of(vertices.begin(), vertices.end(), [](const Vec3& v) { return v.allFinite(); });
    if (!finite) return MeshFault{"a vertex is not finite"};
    std::sort(vertices.begin(), vertices.end(), lexicographic);
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
  } catch (const std::exception& fault) {
    return MeshFault{fault.what()};
  }
}

}  // namespace clearance
