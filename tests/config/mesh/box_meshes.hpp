// A unit box as mesh files of every format that cells accept.
#pragma once

#include <ostream>
#include <string>
#include <vector>

namespace clearance {

struct BoxMesh {
  std::string name;       // name of the variant, as gtest accepts it
  std::string extension;  // without the dot
  std::string bytes;
};

inline std::ostream& operator<<(std::ostream& out, const BoxMesh& mesh) { return out << mesh.name; }

// Binary and ASCII STL, OBJ, ASCII and binary PLY in both byte orders, and COLLADA with a node that
// places the mesh.
[[nodiscard]] std::vector<BoxMesh> box_meshes();
[[nodiscard]] BoxMesh box_mesh(const std::string& name);

}  // namespace clearance
