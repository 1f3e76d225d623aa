#include "tests/config/mesh/box_meshes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>

namespace clearance {
namespace {

// The bits of i are the coordinates x, y, z of vertex i.
constexpr int kBoxCorners = 8;
constexpr std::array<std::array<int, 3>, 12> kBoxTriangles = {{{0, 2, 1},
                                                               {1, 2, 3},
                                                               {4, 5, 6},
                                                               {5, 7, 6},
                                                               {0, 1, 4},
                                                               {1, 5, 4},
                                                               {2, 6, 3},
                                                               {3, 6, 7},
                                                               {0, 4, 2},
                                                               {2, 4, 6},
                                                               {1, 3, 5},
                                                               {3, 7, 5}}};

float corner_coordinate(int corner, int axis) { return static_cast<float>(corner >> axis & 1); }

std::string corner_text(int corner) {
  return fmt::format("{:.1f} {:.1f} {:.1f}", corner_coordinate(corner, 0),
                     corner_coordinate(corner, 1), corner_coordinate(corner, 2));
}

// The bytes of a number, in little-endian order unless `big_endian`.
template <class Number>
std::string number_bytes(Number number, bool big_endian = false) {
  std::string bytes(reinterpret_cast<const char*>(&number), sizeof number);
  if (big_endian) std::ranges::reverse(bytes);
  return bytes;
}

std::string as_binary_stl() {
  std::string out(80, ' ');
  out += number_bytes(static_cast<std::uint32_t>(kBoxTriangles.size()));
  for (const auto& triangle : kBoxTriangles) {
    out.append(12, '\0');
    for (const int corner : triangle)
      for (int axis = 0; axis < 3; ++axis) out += number_bytes(corner_coordinate(corner, axis));
    out.append(2, '\0');
  }
  return out;
}

std::string as_ascii_stl() {
  std::string out = "solid box\n";
  for (const auto& triangle : kBoxTriangles) {
    out += " facet normal 0 0 0\n  outer loop\n";
    for (const int corner : triangle) out += "   vertex " + corner_text(corner) + "\n";
    out += "  endloop\n endfacet\n";
  }
  return out + "endsolid box\n";
}

std::string as_obj() {
  std::string out = "# a box\no box\n";
  for (int corner = 0; corner < kBoxCorners; ++corner) out += "v " + corner_text(corner) + "\n";
  out += "vn 0 0 1\n";
  for (const auto& [a, b, c] : kBoxTriangles)
    out += fmt::format("f {}//1 {}//1 {}//1\n", a + 1, b + 1, c + 1);
  return out;
}

std::string ply_header(const std::string& format) {
  return fmt::format(
      "ply\nformat {} 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float "
      "z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
      format, kBoxCorners, kBoxTriangles.size());
}

std::string as_ascii_ply() {
  std::string out = ply_header("ascii");
  for (int corner = 0; corner < kBoxCorners; ++corner) out += corner_text(corner) + "\n";
  for (const auto& [a, b, c] : kBoxTriangles) out += fmt::format("3 {} {} {}\n", a, b, c);
  return out;
}

std::string as_binary_ply(bool big_endian) {
  std::string out = ply_header(big_endian ? "binary_big_endian" : "binary_little_endian");
  for (int corner = 0; corner < kBoxCorners; ++corner)
    for (int axis = 0; axis < 3; ++axis)
      out += number_bytes(corner_coordinate(corner, axis), big_endian);
  for (const auto& triangle : kBoxTriangles) {
    out += '\3';
    for (const std::int32_t corner : triangle) out += number_bytes(corner, big_endian);
  }
  return out;
}

std::string as_collada() {
  std::string positions, corners;
  for (int corner = 0; corner < kBoxCorners; ++corner) positions += " " + corner_text(corner);
  for (const auto& [a, b, c] : kBoxTriangles) corners += fmt::format(" {} 0 {} 0 {} 0", a, b, c);
  return fmt::format(R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="1" name="meter"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="24">{}</float_array>
<technique_common><accessor source="#pa" count="8" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<source id="n"><float_array id="na" count="3">0 0 1</float_array>
<technique_common><accessor source="#na" count="1" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="12"><input semantic="VERTEX" source="#v" offset="0"/><input semantic="NORMAL" source="#n" offset="1"/><p>{}</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="outer"><translate>0 0 0.5</translate><node id="n0"><matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</matrix><instance_geometry url="#g"/></node></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>
)",
                     positions, corners);
}

}  // namespace

std::vector<BoxMesh> box_meshes() {
  return {{"BinaryStl", "stl", as_binary_stl()},
          {"AsciiStl", "stl", as_ascii_stl()},
          {"Obj", "obj", as_obj()},
          {"AsciiPly", "ply", as_ascii_ply()},
          {"BinaryPly", "ply", as_binary_ply(false)},
          {"BigEndianPly", "ply", as_binary_ply(true)},
          {"Collada", "dae", as_collada()}};
}

BoxMesh box_mesh(const std::string& name) {
  const std::vector<BoxMesh> all = box_meshes();
  return *std::ranges::find(all, name, &BoxMesh::name);
}

}  // namespace clearance
