#include "config/mesh/mesh_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <string>

#include "tests/config/cells.hpp"
#include "tests/config/mesh/box_meshes.hpp"
#include "tests/shared/mistake_at.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance {
namespace {

using test::mistake_at;
using testing::HasSubstr;

// A private directory for each test, removed afterwards.
class MeshFile : public testing::Test {
 protected:
  void write(const std::string& name, const std::string& bytes) {
    test::write_text(directory_ / name, bytes);
  }

  std::string cell(const std::string& mesh) const {
    return cell_text("objects:\n  - {name: a, mesh: {" + mesh +
                     "}}\n  - {name: b, sphere: {radius: 1}}\npairs: [{between: [a, b]}]\n");
  }

  Scene scene(const std::string& mesh) const {
    return scene_of(cell(mesh), directory_ / "cell.yaml");
  }
  std::string errors(const std::string& mesh) const {
    return errors_of(cell(mesh), directory_ / "cell.yaml");
  }

  test::ScratchFolder directory_;
};

// The vertices of a unit cube and one interior point, as triangles of a binary STL. The hull has 8
// vertices and 6 facets.
std::string binary_stl() {
  const float corners[9][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0},         {0, 0, 1},
                               {1, 0, 1}, {0, 1, 1}, {1, 1, 1}, {0.5f, 0.5f, 0.5f}};
  const int triangles[5][3] = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}, {0, 3, 5}, {2, 4, 7}};
  std::string bytes(80, ' ');
  const std::uint32_t count = 5;
  bytes.append(reinterpret_cast<const char*>(&count), 4);
  for (const auto& triangle : triangles) {
    bytes.append(12, '\0');
    for (const int corner : triangle)
      bytes.append(reinterpret_cast<const char*>(corners[corner]), 12);
    bytes.append(2, '\0');
  }
  return bytes;
}

const std::string kTetrahedronObj =
    "mtllib nowhere.mtl\nv 0 0 0\nv 2 0 0\nv 0 2 0\nv 0 0 2\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n";

TEST_F(MeshFile, ItsHullIsThePart) {
  write("cube.stl", binary_stl());
  const ConvexBody shape = scene("file: cube.stl, max_parts: 1").objects.at(0).parts.at(0).shape;
  EXPECT_EQ(shape.vertices.size(), 8u);
  EXPECT_EQ(shape.facets.size(), 6u);
  EXPECT_NEAR(shape.bounding_radius, std::sqrt(3.0), 1e-14);
}

TEST_F(MeshFile, UnitAndScaleApply) {
  write("cube.stl", binary_stl());
  const ConvexBody mm =
      scene("file: cube.stl, unit: mm, max_parts: 1").objects.at(0).parts.at(0).shape;
  EXPECT_NEAR(mm.bounding_radius, std::sqrt(3.0) / 1000.0, 1e-15);
  const ConvexBody scaled =
      scene("file: cube.stl, scale: [2, 1, -3], max_parts: 1").objects.at(0).parts.at(0).shape;
  EXPECT_NEAR(scaled.bounding_radius, std::sqrt(4.0 + 1.0 + 9.0), 1e-12);
}

TEST_F(MeshFile, ObjIsReadEvenWithoutItsMaterials) {
  write("tetrahedron.obj", kTetrahedronObj);
  EXPECT_EQ(scene("file: tetrahedron.obj").objects.at(0).parts.at(0).shape.vertices.size(), 4u);
}

TEST_F(MeshFile, ColladaKeepsItsAxesAndItsUnit) {
  write("tetrahedron.dae", R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="0.001" name="millimeter"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="12">0 0 0 1000 0 0 0 2000 0 0 0 4000</float_array>
<technique_common><accessor source="#pa" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2 0 1 3 0 2 3 1 2 3</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)");
  const ConvexBody shape = scene("file: tetrahedron.dae").objects.at(0).parts.at(0).shape;
  double highest = 0.0;
  for (const Vertex& vertex : shape.vertices) highest = std::max(highest, vertex.position.z());
  EXPECT_NEAR(highest, 4.0, 1e-6);
}

// Two triangles in red and one in a blue that is out of range; both readers find all three.
TEST_F(MeshFile, ColladaHasItsColoursAndOtherFormatsHaveNone) {
  const std::string dae = R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="1" name="meter"/><up_axis>Z_UP</up_axis></asset>
<library_effects>
<effect id="re"><profile_COMMON><technique sid="t"><lambert><diffuse><color>1 0.25 0 1</color></diffuse></lambert></technique></profile_COMMON></effect>
<effect id="be"><profile_COMMON><technique sid="t"><lambert><diffuse><color>0 0 7 1</color></diffuse></lambert></technique></profile_COMMON></effect>
</library_effects>
<library_materials><material id="r"><instance_effect url="#re"/></material><material id="b"><instance_effect url="#be"/></material></library_materials>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="12">0 0 0 1 0 0 0 2 0 0 0 4</float_array>
<technique_common><accessor source="#pa" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="2" material="red"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2 0 1 3</p></triangles>
<triangles count="1" material="blue"><input semantic="VERTEX" source="#v" offset="0"/><p>0 2 3</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"><bind_material><technique_common>
<instance_material symbol="red" target="#r"/><instance_material symbol="blue" target="#b"/>
</technique_common></bind_material></instance_geometry></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
  const auto read = read_coloured_mesh(dae, ".dae");
  const auto& found = std::get<std::vector<ColouredMesh>>(read);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].colour, Vec3(1.0, 0.25, 0.0));
  EXPECT_EQ(found[0].mesh.triangles.size(), 2u);
  EXPECT_EQ(found[1].colour, Vec3(0.0, 0.0, 1.0));
  EXPECT_EQ(found[1].mesh.triangles.size(), 1u);
  const auto joined = read_mesh(dae, "dae");
  EXPECT_EQ(std::get<TriangleMesh>(joined).triangles.size(), 3u);

  const auto plain = read_coloured_mesh(kTetrahedronObj, "obj");
  ASSERT_EQ(std::get<std::vector<ColouredMesh>>(plain).size(), 1u);
  EXPECT_EQ(std::get<std::vector<ColouredMesh>>(plain)[0].colour, std::nullopt);
}

// Assimp skips each of these, or takes a default instead.
TEST_F(MeshFile, WhatTheReadersWouldLeaveOutIsRefused) {
  const auto fault = [](const std::string& bytes, const char* format) {
    const auto read = read_mesh(bytes, format);
    const auto* const found = std::get_if<MeshFault>(&read);
    return found == nullptr ? std::string() : found->reason;
  };
  EXPECT_EQ(fault(kTetrahedronObj + "g x\n# y\nl 1 \\\n 2\n", "obj"), "");
  for (const char* line : {"ff 1 2 3", "curv 0 1 1 2", "call other.obj", "fo 1 2 3"})
    EXPECT_THAT(fault(kTetrahedronObj + line, "obj"), HasSubstr("line 10 begins with")) << line;

  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
      "z\nelement face 1\nproperty list uchar int vertex_indices\n";
  const std::string numbers = "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  EXPECT_EQ(fault(ply + numbers, "ply"), "");
  EXPECT_THAT(fault(ply + numbers + "3 2 1 0\n", "ply"), HasSubstr("goes on"));
  EXPECT_THAT(fault(ply + "element tristrips 1\nproperty list int int vertex_indices\n" + numbers +
                        "3 0 1 2\n",
                    "ply"),
              HasSubstr("'tristrips'"));

  const auto dae = [](const std::string& unit, const std::string& node, const std::string& url) {
    return R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit )" +
           unit + R"(/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="12">0 0 0 1 0 0 0 2 0 0 0 4</float_array>
<technique_common><accessor source="#pa" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n">)" +
           node + R"(<instance_geometry url="#g"/>)" + url +
           R"(</node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
  };
  EXPECT_EQ(fault(dae("meter=\"1\"", "<translate>1 0 0</translate>", ""), "dae"), "");
  EXPECT_THAT(fault(dae("metre=\"0.001\"", "", ""), "dae"),
              HasSubstr("line 3 has the attribute 'metre'"));
  EXPECT_THAT(fault(dae("meter=\"1\"", "<skew>45 0 1 0 1 0 0</skew>", ""), "dae"),
              HasSubstr("line 10 has <skew>"));
  EXPECT_THAT(fault(dae("meter=\"1\"", "", "<instance_geometry url=\"#gone\"/>"), "dae"),
              HasSubstr("'#gone'"));
}

TEST_F(MeshFile, RevisionFollowsItsBytes) {
  write("mesh.obj", kTetrahedronObj);
  const std::uint64_t before = scene("file: mesh.obj").revision;
  EXPECT_EQ(scene("file: mesh.obj").revision, before);
  write("mesh.obj", kTetrahedronObj + "# changed\n");
  EXPECT_NE(scene("file: mesh.obj").revision, before);
}

TEST_F(MeshFile, WhatIsNoMeshIsRefusedByName) {
  write("text.stl", "this is no mesh");
  write("line.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
  write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n");
  write("short.stl", binary_stl().substr(0, 200));
  write("mesh.xyz", "1 2 3");
  EXPECT_THAT(errors("file: text.stl"), mistake_at("cell.yaml:5:28", "text.stl"));
  EXPECT_THAT(errors("file: line.obj"), HasSubstr("found a mesh that is not a solid convex body"));
  EXPECT_THAT(errors("file: points.obj"), mistake_at("cell.yaml:5:28", "points.obj"));
  EXPECT_THAT(errors("file: short.stl"), mistake_at("cell.yaml:5:28", "short.stl"));
  EXPECT_THAT(errors("file: mesh.xyz"), mistake_at("cell.yaml:5:28", "mesh.xyz"));
  EXPECT_THAT(errors("file: ."), HasSubstr("is a directory"));
}

TEST_F(MeshFile, VerticesThatAreNotFiniteAreRefused) {
  std::string bytes = binary_stl();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(bytes.data() + 84 + 12, &nan, 4);
  write("nan.stl", bytes);
  EXPECT_THAT(errors("file: nan.stl"), HasSubstr("a vertex is not finite"));
}

TEST_F(MeshFile, AFaceThatNamesAVertexThatIsNotThereIsRefused) {
  write("index.ply",
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty "
        "float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 "
        "0\n0 1 0\n0 0 1\n3 0 1 2\n3 0 1 3\n3 0 2 3\n3 1 2 70000\n");
  EXPECT_THAT(errors("file: index.ply"), mistake_at("cell.yaml:5:28", "index.ply", "70000", "4"));
}

// The accessor announces 200 numbers for an array of 24.
TEST_F(MeshFile, AColladaAccessorThatLeavesItsArrayIsRefused) {
  std::string dae = box_mesh("Collada").bytes;
  dae.replace(dae.find("count=\"8\" stride"), 9, "count=\"67\"");
  dae.replace(dae.find("<p> 0 0"), 5, "<p> 66");
  write("mesh.dae", dae);
  EXPECT_THAT(errors("file: mesh.dae"), mistake_at("cell.yaml:5:28", "line 6", "24", "'pa'"));
}

TEST_F(MeshFile, BytesOfTheFileDoNotReachTheTerminal) {
  std::string ply = box_mesh("AsciiPly").bytes;
  ply.replace(ply.find("1.0 1.0 1.0"), 3, "\x1b[2J\xff");
  write("mesh.ply", ply);
  EXPECT_THAT(errors("file: mesh.ply"),
              mistake_at("cell.yaml:5:28", "mesh.ply", "'\\x1B[2J\\xFF'"));
}

TEST_F(MeshFile, AnAsciiStlThatIsCutOffIsRefused) {
  const std::string stl = box_mesh("AsciiStl").bytes;
  write("mesh.stl", stl);
  EXPECT_EQ("", errors("file: mesh.stl"));
  write("mesh.stl", stl.substr(0, stl.rfind(" facet normal")));
  EXPECT_THAT(errors("file: mesh.stl"), mistake_at("cell.yaml:5:28", "mesh.stl", "'endsolid'"));
}

TEST_F(MeshFile, ABodyOfKilometresIsRefusedUnlessTheCellSaysSo) {
  write("far.obj", "v 0 0 0\nv 3600 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n");
  EXPECT_THAT(errors("file: far.obj"), mistake_at("cell.yaml:5:21", "3600 m", "100 m", "'reach'"));
  EXPECT_EQ("", errors("file: far.obj, unit: mm"));
  EXPECT_EQ("", errors("file: far.obj, reach: 4000"));
  EXPECT_THAT(errors("file: far.obj, unit: mm, reach: 3"),
              mistake_at("cell.yaml:5:21", "3.6 m", "3 m", "'reach'"));
}

TEST_F(MeshFile, OtherFormatsAreRefusedWithTheListOfThese) {
  write("mesh.gltf", "{}");
  EXPECT_THAT(errors("file: mesh.gltf"),
              mistake_at("cell.yaml:5:28", "mesh.gltf", "stl, obj, ply, dae"));
  write("MESH.OBJ", kTetrahedronObj);
  EXPECT_EQ("", errors("file: MESH.OBJ"));
}

TEST_F(MeshFile, AnUnknownUnitOrAScaleOfZeroIsRefused) {
  write("mesh.obj", kTetrahedronObj);
  EXPECT_THAT(errors("file: mesh.obj, unit: cm"), mistake_at("cell.yaml:5:44", "'cm'"));
  EXPECT_THAT(errors("file: mesh.obj, scale: 0"), mistake_at("cell.yaml:5:45", "0"));
  EXPECT_THAT(errors("file: mesh.obj, scale: [1, 0, 1]"), mistake_at("cell.yaml:5:45", "0"));
  EXPECT_THAT(errors("file: mesh.obj, scale: 1e9"), mistake_at("cell.yaml:5:21", "2e+09 m"));
}

}  // namespace
}  // namespace clearance
