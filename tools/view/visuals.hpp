// The looks of robots' links, as their URDFs have them, for the page. Nothing is decided by them.
#pragma once

#include <cstddef>
#include <future>
#include <map>
#include <string>

#include "config/cell/cell.hpp"
#include "core/pose.hpp"
#include "tools/view/server.hpp"

namespace clearance::view {

// A text in JSON, and after it the numbers of the meshes, all in the byte order of this machine:
//   uint32       length of the text in bytes, a multiple of 4
//   text         {"visuals": [{"object", "pose", "mesh", "colour"}],
//                 "meshes": [{"vertices", "triangles"}], "left_out": ["LINK: REASON"]}
//   each mesh    float32 positions and normals of its vertices, uint32 corners of its triangles
// Lengths are in m, each pose is in its object's frame, and colours are sRGB from 0 to 1. A DAE has
// colours of its own, else the URDF's hold. Links that are no objects are left out. So are meshes
// that cannot be read, and triangles beyond two million; `left_out` names these. It takes seconds
// for large meshes.
[[nodiscard]] std::string visuals_of(const Cell& cell);

// By object: the colour that the URDF gives the first look of a link, sRGB from 0 to 1. Reads no
// mesh.
[[nodiscard]] std::map<std::size_t, Vec3> link_colours(const Cell& cell);

// Reads them when a page asks for the first time, beside the thread that serves.
class Visuals {
 public:
  // The cell must outlive this.
  explicit Visuals(const Cell& cell) : cell_(cell) {}
  // The bytes of visuals_of(); empty while they are being made.
  [[nodiscard]] Resource get();

 private:
  const Cell& cell_;
  std::future<std::string> made_;
  Resource resource_;
};

}  // namespace clearance::view
