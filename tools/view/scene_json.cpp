#include "tools/view/scene_json.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "monitor/interface/contact_text.hpp"
#include "monitor/interface/zone_cause.hpp"
#include "monitor/visual/body_mesh.hpp"

namespace clearance::view {
namespace {

using nlohmann::json;

// With more parts than these, a group makes no clear picture of a zone.
constexpr std::size_t kMostShells = 120;

// Number of round parts that are drawn as finely as one alone. More are drawn more coarsely, down
// to steps of kCoarsest (rad), so that the number of triangles stays about the same.
constexpr double kMostFine = 30.0, kCoarsest = 0.6;
// Steps of the arcs of zones' shells (rad). A shell is faint, and its facets are not seen; a
// plate's shell has arcs at all edges and corners, so that fine ones cost ten times the cell's
// bodies.
constexpr double kShellStep = 0.8;
constexpr double kBlindShell = 0.01;  // m

// Six digits: micrometres in a cell of a metre. The text is a third as long.
double rounded(double value) { return std::round(value * 1e6) * 1e-6; }

void add(const Vec3& v, json& numbers) {
  for (int i = 0; i < 3; ++i) numbers.push_back(rounded(v[i]));
}

json pose_json(const Pose& pose) {
  const Eigen::Quaterniond q = pose.orientation.normalized();
  const Vec3& p = pose.position;
  return {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()};
}

json mesh_json(const BodyMesh& mesh) {
  json all = {{"positions", json::array()},
              {"normals", json::array()},
              {"triangles", json::array()},
              {"edges", json::array()}};
  for (const Vec3& p : mesh.positions) add(p, all["positions"]);
  for (const Vec3& n : mesh.normals) add(n, all["normals"]);
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) all["triangles"].push_back(corner);
  }
  for (const auto& edge : mesh.edges) {
    add(edge[0], all["edges"]);
    add(edge[1], all["edges"]);
  }
  return all;
}

double arc_step_of(const Scene& scene) {
  double round = 0.0;
  for (const Object& object : scene.objects) {
    round += static_cast<double>(std::ranges::count_if(object.parts, [](const Part& part) {
      return part.shape.is_curved() || part.shape.radius > 0.0;
    }));
  }
  // The triangles of a part grow with the square of its steps.
  return std::clamp(kArcStep * std::sqrt(round / kMostFine), kArcStep, kCoarsest);
}

// Numbers meshes in their order; equal ones share a number.
class Meshes {
 public:
  explicit Meshes(const Scene& scene) : arc_step_(arc_step_of(scene)) {}

  std::size_t number_of(const ConvexBody& shape) {
    return number_of(body_mesh(shape, 0.0, kReach, arc_step_));
  }
  // The body with its radius enlarged by `offset`, m.
  std::size_t number_of_shell(const ConvexBody& shape, double offset) {
    return number_of(body_mesh(shape, offset, kReach, kShellStep));
  }
  [[nodiscard]] json take() { return std::move(list_); }

 private:
  static constexpr double kReach = 20.0;  // half width of the drawn part of an unbounded body, m

  std::size_t number_of(const BodyMesh& mesh) {
    json found = mesh_json(mesh);
    const auto [entry, is_new] = numbers_.try_emplace(found.dump(), list_.size());
    if (is_new) list_.push_back(std::move(found));
    return entry->second;
  }

  double arc_step_;
  std::map<std::string, std::size_t> numbers_;
  json list_ = json::array();
};

// The keys of the lists of causes.
const char* key(PlacedBy placed_by) {
  return placed_by == PlacedBy::kFrames        ? "frames"
         : placed_by == PlacedBy::kJointStates ? "joint_states"
                                               : "poses";
}

json objects_json(const Scene& scene, const std::map<std::size_t, Vec3>& colours) {
  json list = json::array();
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    json entry = {{"name", object.name},     {"groups", object.groups},
                  {"fixed", object.fixed},   {"placed_by", key(placed_by(scene, i))},
                  {"margin", object.margin}, {"parts", json::array()}};
    for (const Part& part : object.parts) entry["parts"].push_back(part.name);
    if (object.fixed) entry["pose"] = pose_json(object.world_from_object);
    if (const auto colour = colours.find(i); colour != colours.end())
      entry["colour"] = {colour->second.x(), colour->second.y(), colour->second.z()};
    list.push_back(std::move(entry));
  }
  return list;
}

json parts_json(const Scene& scene, Meshes& meshes) {
  json list = json::array();
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    if (scene.objects[i].is_seen()) continue;  // its part is the ball of the sensor's view
    for (const Part& part : scene.objects[i].parts) {
      json entry = {{"object", i}, {"pose", pose_json(part.object_from_part)}};
      if (part.shape.is_half_space()) {
        const Facet& plane = part.shape.facets.front();
        entry["plane"] = {plane.normal.x(), plane.normal.y(), plane.normal.z(), plane.offset};
      } else {
        entry["mesh"] = meshes.number_of(part.shape);
        entry["unbounded"] = !part.shape.bounded();
      }
      list.push_back(std::move(entry));
    }
  }
  return list;
}

json pairs_json(const Scene& scene) {
  json list = json::array();
  for (const ObjectPair& pair : scene.pairs) {
    list.push_back({pair.first, pair.second, pair.publish ? 1 : 0});
  }
  return list;
}

// The bounded objects on the side of the zone that has fewer objects, and never on that of a
// sensor, whose body is all that it may see. A margin is part of the clearance to be kept.
json shells_json(const Scene& scene, const Zone& zone, Meshes& meshes) {
  std::set<std::uint32_t> first, second;
  for (const std::uint32_t pair : zone.pairs) {
    first.insert(scene.pairs[pair].first);
    second.insert(scene.pairs[pair].second);
  }
  const auto has_sensor = [&](const std::set<std::uint32_t>& side) {
    return std::ranges::any_of(side, [&](auto i) { return scene.objects[i].is_seen(); });
  };
  const bool is_first =
      has_sensor(first) != has_sensor(second) ? has_sensor(second) : first.size() <= second.size();
  json list = json::array();
  for (const std::uint32_t i : is_first ? first : second) {
    const Object& object = scene.objects[i];
    for (const Part& part : object.parts) {
      if (!part.shape.bounded()) continue;
      if (list.size() == kMostShells) return json::array();
      list.push_back(
          {{"object", i},
           {"pose", pose_json(part.object_from_part)},
           {"mesh", meshes.number_of_shell(part.shape, zone.enter_below + object.margin)}});
    }
  }
  return list;
}

// The sensors, and the bodies of robots enlarged by kBlindShell, which the page moves to the shell
// of a frame along their normals.
json sensors_json(const Scene& scene) {
  json list = json::array();
  for (const Sensor& sensor : scene.sensors) {
    list.push_back({{"object", sensor.object},
                    {"name", sensor.name},
                    {"age_limit_ns", scene.objects[sensor.object].age_limit_ns}});
  }
  return list;
}
json blind_shells_json(const Scene& scene, Meshes& meshes) {
  json list = json::array();
  if (scene.sensors.empty()) return {{"offset", kBlindShell}, {"parts", list}};
  for (const Robot& robot : scene.robots) {
    for (const RobotLink& link : robot.links) {
      if (link.object == RobotLink::kNoObject) continue;
      for (const Part& part : scene.objects[link.object].parts) {
        list.push_back({{"object", link.object},
                        {"pose", pose_json(part.object_from_part)},
                        {"mesh", meshes.number_of_shell(part.shape, kBlindShell)}});
      }
    }
  }
  return {{"offset", kBlindShell}, {"parts", list}};
}

json zones_json(const Scene& scene, Meshes& meshes) {
  json list = json::array();
  for (const Zone& zone : scene.zones) {
    list.push_back({{"name", zone.name},
                    {"between", {zone.group_a, zone.group_b}},
                    {"enter_below", zone.enter_below},
                    {"leave_above", zone.leave_above},
                    {"pairs", zone.pairs},
                    {"shells", shells_json(scene, zone, meshes)}});
  }
  return list;
}

// What stops with a robot that states how it stops: its links, and those of robots that stand on it
// and state nothing.
json robots_json(const Scene& scene) {
  json list = json::array();
  for (const Robot& robot : scene.robots)
    list.push_back({{"name", robot.name}, {"stopping", json::array()}});
  for (std::uint32_t r = 0; r < scene.robots.size(); ++r) {
    std::uint32_t by = r;
    const auto is_stated = [&] { return scene.robots[by].stopping.is_stated(); };
    while (!is_stated() && scene.robots[by].base.kind == RobotBase::Kind::kLink)
      by = scene.robots[by].base.robot;
    if (!is_stated()) continue;
    for (const RobotLink& link : scene.robots[r].links)
      if (link.object != RobotLink::kNoObject) list[by]["stopping"].push_back(link.object);
  }
  return list;
}

json contacts_json(const Scene& scene) {
  json list = json::array();
  for (const AllowedContact& contact : scene.contacts) {
    list.push_back({{"name", contact.name},
                    {"depth", contact.depth},
                    {"end", end_text(contact.end)},
                    {"by", contact.by},
                    {"reason", contact.reason}});
  }
  return list;
}

// The text of every ZoneCause, in the order of their numbers, with {} for the object's name.
json causes_json(PlacedBy placed_by) {
  json list = json::array();
  for (std::uint8_t i = 0; *name(static_cast<ZoneCause>(i)) != '\0'; ++i) {
    list.push_back(cause_text(static_cast<ZoneCause>(i), "{}", placed_by));
  }
  return list;
}

}  // namespace

std::string scene_json(const Cell& cell, const std::map<std::size_t, Vec3>& colours) {
  const Scene& scene = cell.scene;
  Meshes meshes(scene);
  json all = {{"name", scene.name},
              {"revision", std::to_string(scene.revision)},
              {"rate_hz", scene.rate_hz},
              {"has_robots", !scene.robots.empty()},
              {"topics",
               {{"distances", cell.topics.distances},
                {"zones", cell.topics.zones},
                {"health", cell.topics.health},
                {"separation", cell.topics.separation}}},
              {"objects", objects_json(scene, colours)},
              {"parts", parts_json(scene, meshes)},
              {"pairs", pairs_json(scene)},
              {"sensors", sensors_json(scene)},
              {"blind_shells", blind_shells_json(scene, meshes)},
              {"zones", zones_json(scene, meshes)},
              {"contacts", contacts_json(scene)},
              {"robots", robots_json(scene)},
              {"zone_causes", json::object()}};
  for (const PlacedBy by : {PlacedBy::kPoses, PlacedBy::kJointStates, PlacedBy::kFrames})
    all["zone_causes"][key(by)] = causes_json(by);
  all["meshes"] = meshes.take();
  return all.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace clearance::view
