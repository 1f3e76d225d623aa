#include "tools/view/visuals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
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
#include "monitor/visual/smooth_mesh.hpp"

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
    // The limbs of a person without a URDF have no other looks than their capsules.
    if (!robot.urdf.empty()) robots.push_back(std::move(robot));
  }
  return robots;
}

// The meshes that are sent, numbered in their order.
class SentMeshes {
 public:
  // Nothing: there would be too many triangles.
  std::optional<std::size_t> add(const BodyMesh& mesh) {
    if (triangles_ + mesh.triangles.size() > kMostTriangles) return std::nullopt;
    triangles_ += mesh.triangles.size();
    for (const auto* vectors : {&mesh.positions, &mesh.normals}) {
      for (const Vec3& each : *vectors) {
        const Eigen::Vector3f sent = each.cast<float>();
        append(sent.data(), sizeof(float));
      }
    }
    for (const auto& corners : mesh.triangles) append(corners.data(), sizeof corners[0]);
    list_.push_back({{"vertices", mesh.positions.size()}, {"triangles", mesh.triangles.size()}});
    return list_.size() - 1;
  }
  [[nodiscard]] const json& list() const noexcept { return list_; }
  [[nodiscard]] const std::string& numbers() const noexcept { return numbers_; }

 private:
  void append(const void* three, std::size_t size) {
    numbers_.append(static_cast<const char*>(three), 3 * size);
  }

  std::size_t triangles_ = 0;
  json list_ = json::array();
  std::string numbers_;
};

// A mesh with its own colour, if it has one.
struct Look {
  std::size_t mesh;
  std::optional<Vec3> colour;
};
using Looks = std::variant<std::vector<Look>, std::string>;  // or the reason why there are none

// Finds and reads shapes; each file of one scale becomes one set of meshes.
class Shapes {
 public:
  Shapes(RobotFiles files, SentMeshes& sent) : files_(std::move(files)), sent_(sent) {}

  Looks operator()(const UrdfMesh& named) {
    const auto path = files_.find(named.file);
    if (!path) return files_.why_not_found(named.file, PackagesFrom::kCell);
    const Vec3& s = named.scale;
    const auto [entry, is_new] =
        read_.try_emplace(fmt::format("{} {} {} {}", path->string(), s.x(), s.y(), s.z()));
    if (is_new) entry->second = read(*path, s);
    return entry->second;
  }
  Looks operator()(const UrdfBox& shape) { return look_of(box(0.5 * shape.size)); }
  Looks operator()(const UrdfSphere& shape) { return look_of(point(Vec3::Zero(), shape.radius)); }
  Looks operator()(const UrdfCylinder& shape) {
    return look_of(cylinder(shape.radius, 0.5 * shape.length));
  }
  Looks operator()(const UrdfCapsule& shape) {
    const Vec3 end(0.0, 0.0, 0.5 * shape.length);
    return look_of(segment(-end, end, shape.radius));
  }

 private:
  Looks read(const std::filesystem::path& path, const Vec3& scale) {
    const auto bytes = read_bytes(path.string());
    if (const auto* const fault = std::get_if<FileFault>(&bytes)) return fault->reason;
    auto found = read_coloured_mesh(std::get<std::string>(bytes), path.extension().string());
    if (const auto* const fault = std::get_if<MeshFault>(&found)) {
      return fmt::format("cannot read {}: {}", path.string(), fault->reason);
    }
    std::vector<Look> looks;
    for (auto& [colour, mesh] : std::get<std::vector<ColouredMesh>>(found)) {
      for (Vec3& vertex : mesh.vertices) vertex = vertex.cwiseProduct(scale);
      const auto number = sent_.add(smooth_mesh(mesh));
      if (!number) return fmt::format("{} has too many triangles", path.string());
      looks.push_back({*number, colour});
    }
    return looks;
  }
  Looks look_of(const ShapeResult& made) {
    const auto* const body = std::get_if<ConvexBody>(&made);
    const auto number = body == nullptr ? std::nullopt : sent_.add(body_mesh(*body));
    if (!number) return "its shape cannot be drawn";
    return std::vector<Look>{{*number, std::nullopt}};
  }

  RobotFiles files_;
  SentMeshes& sent_;
  std::map<std::string, Looks> read_;
};

json visual_json(std::size_t object, const Pose& pose, const Look& look,
                 const std::optional<Vec3>& colour) {
  const Eigen::Quaterniond& q = pose.orientation;
  const Vec3& p = pose.position;
  json entry = {{"object", object},
                {"pose", {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()}},
                {"mesh", look.mesh}};
  if (const auto& c = look.colour ? look.colour : colour)
    entry["colour"] = {c->x(), c->y(), c->z()};
  return entry;
}

std::map<std::string, std::size_t> objects_by_name(const Scene& scene) {
  std::map<std::string, std::size_t> objects;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) objects[scene.objects[i].name] = i;
  return objects;
}

}  // namespace

std::map<std::size_t, Vec3> link_colours(const Cell& cell) {
  const std::map<std::string, std::size_t> objects = objects_by_name(cell.scene);
  std::map<std::size_t, Vec3> colours;
  for (const NamedRobot& robot : robots_of(cell)) {
    const auto urdf = robot.files.find(robot.urdf);
    if (!urdf) continue;
    for (const UrdfVisual& visual : read_visuals(*urdf)) {
      const auto object = objects.find(robot.prefix + visual.link);
      if (object != objects.end() && visual.colour) colours.emplace(object->second, *visual.colour);
    }
  }
  return colours;
}

std::string visuals_of(const Cell& cell) {
  const std::map<std::string, std::size_t> objects = objects_by_name(cell.scene);
  json visuals = json::array(), left_out = json::array();
  SentMeshes sent;
  for (const NamedRobot& robot : robots_of(cell)) {
    const auto urdf = robot.files.find(robot.urdf);
    if (!urdf) continue;
    Shapes shapes({.named_in = *urdf, .packages = robot.files.packages}, sent);
    for (const UrdfVisual& visual : read_visuals(*urdf)) {
      const auto object = objects.find(robot.prefix + visual.link);
      if (object == objects.end()) continue;
      const Looks looks = std::visit(shapes, visual.shape.shape);
      if (const auto* const reason = std::get_if<std::string>(&looks)) {
        left_out.push_back(fmt::format("{}: {}", object->first, *reason));
        continue;
      }
      const Pose pose = pose_of(visual.shape.link_from_shape);
      for (const Look& look : std::get<std::vector<Look>>(looks)) {
        visuals.push_back(visual_json(object->second, pose, look, visual.colour));
      }
    }
  }
  std::string text = json{{"visuals", std::move(visuals)},
                          {"meshes", sent.list()},
                          {"left_out", std::move(left_out)}}
                         .dump(-1, ' ', false, json::error_handler_t::replace);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const auto length = static_cast<std::uint32_t>(text.size());
  std::string all(reinterpret_cast<const char*>(&length), sizeof length);
  all += text;
  all += sent.numbers();
  return all;
}

Resource Visuals::get() {
  constexpr const char* kType = "application/octet-stream";
  if (resource_.body) return resource_;
  if (!made_.valid()) {
    made_ = std::async(std::launch::async, [this] { return visuals_of(cell_); });
  }
  const bool is_made = made_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  if (!is_made) return {kType, std::make_shared<const std::string>()};
  return resource_ = {kType, std::make_shared<const std::string>(made_.get())};
}

}  // namespace clearance::view
