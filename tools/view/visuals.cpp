#include "tools/view/visuals.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "config/mesh/mesh_file.hpp"
#include "config/text/file_bytes.hpp"
#include "config/urdf/robot_files.hpp"
#include "config/urdf/visuals.hpp"
#include "config/yaml/yaml_node.hpp"
#include "core/shapes.hpp"
#include "monitor/visual/body_mesh.hpp"

namespace clearance::view {
namespace {

using nlohmann::json;

constexpr std::size_t kMostTriangles = 2'000'000;

// A robot of the cell file, which has been read without a mistake before.
struct NamedRobot {
  std::string prefix, urdf;
  RobotFiles files;
};

const YamlNode* value_of(const YamlNode& map, std::string_view key) {
  const auto found = std::ranges::find_if(
      map.entries, [=](const YamlEntry& each) { return each.key.text == key; });
  return found == map.entries.end() ? nullptr : &found->value;
}

std::string text_of(const YamlNode& map, std::string_view key) {
  const YamlNode* const value = value_of(map, key);
  return value == nullptr ? "" : value->text;
}

std::vector<NamedRobot> robots_of(const Cell& cell) {
  std::vector<NamedRobot> robots;
  const auto document = parse_yaml(cell.yaml);
  const auto* const root = std::get_if<YamlNode>(&document);
  const YamlNode* const list = root == nullptr ? nullptr : value_of(*root, "robots");
  if (list == nullptr) return robots;
  for (const YamlNode& each : list->items) {
    NamedRobot robot{.prefix = text_of(each, "prefix"),
                     .urdf = text_of(each, "urdf"),
                     .files = {.named_in = cell.file, .packages = {}}};
    if (const YamlNode* const packages = value_of(each, "packages")) {
      for (const YamlEntry& entry : packages->entries) {
        robot.files.packages.emplace_back(entry.key.text,
                                          cell.file.parent_path() / entry.value.text);
      }
    }
    robots.push_back(std::move(robot));
  }
  return robots;
}

std::optional<TriangleMesh> mesh_of(const ShapeResult& made) {
  const auto* const body = std::get_if<ConvexBody>(&made);
  if (body == nullptr) return std::nullopt;
  BodyMesh mesh = body_mesh(*body);
  return TriangleMesh{std::move(mesh.positions), std::move(mesh.triangles)};
}

// Finds and reads meshes, each file once.
class MeshFiles {
 public:
  explicit MeshFiles(RobotFiles files) : files_(std::move(files)) {}

  std::optional<TriangleMesh> operator()(const UrdfMesh& named) {
    const auto path = files_.find(named.file);
    if (!path) return std::nullopt;
    const auto [entry, is_new] = read_.try_emplace(path->string());
    if (is_new) {
      const auto bytes = read_bytes(path->string());
      if (const auto* const text = std::get_if<std::string>(&bytes)) {
        auto mesh = read_mesh(*text, path->extension().string());
        if (auto* const good = std::get_if<TriangleMesh>(&mesh)) entry->second = std::move(*good);
      }
    }
    if (!entry->second) return std::nullopt;
    TriangleMesh scaled = *entry->second;
    for (Vec3& vertex : scaled.vertices) vertex = vertex.cwiseProduct(named.scale);
    return scaled;
  }
  std::optional<TriangleMesh> operator()(const UrdfBox& shape) {
    return mesh_of(box(0.5 * shape.size));
  }
  std::optional<TriangleMesh> operator()(const UrdfSphere& shape) {
    return mesh_of(point(Vec3::Zero(), shape.radius));
  }
  std::optional<TriangleMesh> operator()(const UrdfCylinder& shape) {
    return mesh_of(cylinder(shape.radius, 0.5 * shape.length));
  }
  std::optional<TriangleMesh> operator()(const UrdfCapsule& shape) {
    const Vec3 end(0.0, 0.0, 0.5 * shape.length);
    return mesh_of(segment(-end, end, shape.radius));
  }

 private:
  RobotFiles files_;
  std::map<std::string, std::optional<TriangleMesh>> read_;
};

// Micrometres, as in the scene: the text is a third as long.
json mesh_json(const TriangleMesh& mesh) {
  json positions = json::array(), triangles = json::array();
  for (const Vec3& vertex : mesh.vertices) {
    for (int i = 0; i < 3; ++i) positions.push_back(std::round(vertex[i] * 1e6) * 1e-6);
  }
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) triangles.push_back(corner);
  }
  return {{"positions", std::move(positions)}, {"triangles", std::move(triangles)}};
}

}  // namespace

std::string visuals_json(const Cell& cell) {
  std::map<std::string, std::size_t> objects;
  for (std::size_t i = 0; i < cell.scene.objects.size(); ++i) {
    objects[cell.scene.objects[i].name] = i;
  }
  json visuals = json::array(), meshes = json::array();
  std::size_t triangles = 0;
  for (const NamedRobot& robot : robots_of(cell)) {
    const auto urdf = robot.files.find(robot.urdf);
    if (!urdf) continue;
    MeshFiles read({.named_in = *urdf, .packages = robot.files.packages});
    for (const UrdfVisual& visual : read_visuals(*urdf)) {
      const auto object = objects.find(robot.prefix + visual.link);
      if (object == objects.end()) continue;
      const auto mesh = std::visit(read, visual.shape.shape);
      if (!mesh || triangles + mesh->triangles.size() > kMostTriangles) continue;
      triangles += mesh->triangles.size();
      const Pose pose = pose_of(visual.shape.link_from_shape);
      const Eigen::Quaterniond& q = pose.orientation;
      const Vec3& p = pose.position;
      json entry = {{"object", object->second},
                    {"pose", {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()}},
                    {"mesh", meshes.size()}};
      if (const auto& c = visual.colour) entry["colour"] = {c->x(), c->y(), c->z()};
      visuals.push_back(std::move(entry));
      meshes.push_back(mesh_json(*mesh));
    }
  }
  return json{{"visuals", std::move(visuals)}, {"meshes", std::move(meshes)}}.dump();
}

Resource Visuals::get() {
  if (resource_.body) return resource_;
  if (!made_.valid()) {
    made_ = std::async(std::launch::async, [this] { return visuals_json(cell_); });
  }
  const bool is_made = made_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  if (!is_made) return {"application/json", std::make_shared<const std::string>("null")};
  return resource_ = {"application/json", std::make_shared<const std::string>(made_.get())};
}

}  // namespace clearance::view
