#include "monitor/requests/overlap.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <variant>

#include "config/scene/rigid_root.hpp"
#include "core/distance.hpp"
#include "core/shapes.hpp"

namespace clearance {
namespace {

// Follows the links that are objects; any other object is its own root.
RigidRoot root_of(const Scene& scene, std::uint32_t object) {
  for (std::uint32_t robot = 0; robot < scene.robots.size(); ++robot) {
    const auto& links = scene.robots[robot].links;
    const auto link = std::ranges::find(links, object, &RobotLink::object);
    if (link == links.end()) continue;
    return root_of_link(scene.robots, robot, static_cast<std::uint32_t>(link - links.begin()));
  }
  return {true, object, 0};
}

// Tells whether a change says anew where this object is. An entry of text does so, too, but its
// name is in the text.
struct PutsElsewhere {
  const std::string& object;
  std::string robot;  // whose root link it is; empty: of none
  bool operator()(const Attach& change) const { return change.object == object; }
  bool operator()(const Detach& change) const { return change.object == object; }
  bool operator()(const Place& change) const { return change.object == object; }
  bool operator()(const RemoveObject& change) const { return change.object == object; }
  bool operator()(const AttachRobot& change) const { return change.robot == robot; }
  bool operator()(const DetachRobot& change) const { return change.robot == robot; }
  template <class Change>
  bool operator()(const Change&) const {
    return false;
  }
};

// m; minus the depth if they certainly overlap, or else an upper bound of the distance.
double distance_of(const Object& a, const Object& b, const Pose& a_from_object_b) {
  double least = kInfinity;
  for (const Part& part_a : a.parts) {
    for (const Part& part_b : b.parts) {
      TrackingState state;
      const DistanceResult result =
          distance(part_a.shape, part_b.shape, part_a.object_from_part,
                   compose(a_from_object_b, part_b.object_from_part), state);
      least = std::min(least, result.upper < 0.0 ? result.distance : result.upper);
    }
  }
  return least;
}

// A frame without a shape.
Object origin_named(const std::string& name) {
  Object origin;
  origin.name = name;
  origin.parts.push_back({name, std::get<ConvexBody>(point(Vec3::Zero(), 0.0)), Pose()});
  return origin;
}

}  // namespace

std::optional<Attach> attachment_in(const CellChange& change, const Scene& scene) {
  if (const auto* attach = std::get_if<Attach>(&change)) return *attach;
  const auto* attach = std::get_if<AttachRobot>(&change);
  const Robot* robot = attach == nullptr ? nullptr : find_robot(scene, attach->robot);
  if (robot == nullptr) return std::nullopt;
  return Attach{.object = robot->links.front().name,
                .to = attach->to,
                .carrier_from_object = attach->carrier_from_root,
                .overlap = attach->overlap,
                .far = attach->far};
}

std::optional<Attach> as_attached(const Attach& change, std::span<const CellChange> later,
                                  const Scene& scene) {
  PutsElsewhere puts{change.object, ""};
  for (const Robot& robot : scene.robots)
    if (robot.links.front().name == change.object) puts.robot = robot.name;
  const auto elsewhere = [&puts](const CellChange& each) { return std::visit(puts, each); };
  const Object* const object = find_object(scene, change.object);
  if (object == nullptr || std::ranges::any_of(later, elsewhere)) return std::nullopt;
  Attach attached = change;
  if (const auto carrier = carrier_of(change.object, scene)) {
    if (carrier->name != change.to) return std::nullopt;
    attached.carrier_from_object = carrier->carrier_from_object;
    return attached;
  }
  if (!object->fixed) return std::nullopt;
  const Object* const to = find_object(scene, change.to);
  if (to == nullptr) return attached;
  if (!to->fixed) return std::nullopt;
  attached.carrier_from_object = a_from_b(to->world_from_object, object->world_from_object);
  return attached;
}

std::vector<std::string> left_out_with(const Attach& change, const Scene& scene) {
  std::vector<std::string> names{change.to};
  const Object* attached = find_object(scene, change.object);
  const auto in_touch = [&](const std::string& name) {
    return std::ranges::find(change.touch, name) != change.touch.end();
  };
  if (attached != nullptr) {
    const RigidRoot root =
        root_of(scene, static_cast<std::uint32_t>(attached - scene.objects.data()));
    for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
      const Object& other = scene.objects[i];
      const bool is_rigid = !attached->fixed && root_of(scene, i) == root;
      const bool may_touch = in_touch(other.name) || std::ranges::any_of(other.groups, in_touch);
      if (is_rigid || may_touch) names.push_back(other.name);
    }
  }
  std::ranges::sort(names);
  const auto same = std::ranges::unique(names);
  names.erase(same.begin(), same.end());
  std::erase(names, change.object);
  return names;
}

Fit fit_of(const Attach& change, const Scene& scene, const std::vector<std::string>& others,
           const PresentPoses& poses, const std::map<std::string, double>& mesh_errors) {
  Fit fit;
  const Object* attached = find_object(scene, change.object);
  if (attached == nullptr || !change.carrier_from_object) return fit;
  const auto usable = [&](const std::string& name) -> const Pose* {
    const auto pose = poses.find(name);
    const bool is = pose != poses.end() && pose->second.state == PresentPose::State::kUsable;
    return is ? &pose->second.world_from_body : nullptr;
  };
  const auto error_of = [&](const std::string& name) {
    const auto error = mesh_errors.find(name);
    return error == mesh_errors.end() ? 0.0 : error->second;
  };
  const Pose* const world_from_carrier = usable(change.to);
  const Object carrier = origin_named(change.to);
  for (const std::string& name : others) {
    const Object* other = find_object(scene, name);
    if (other == nullptr && name == change.to) other = &carrier;
    if (other == nullptr) continue;
    Pose other_from_object = *change.carrier_from_object;
    if (name != change.to) {
      const Pose* const world_from_other = usable(name);
      if (world_from_other == nullptr || world_from_carrier == nullptr) continue;
      other_from_object =
          compose(a_from_b(*world_from_other, *world_from_carrier), *change.carrier_from_object);
    }
    const double apart = distance_of(*other, *attached, other_from_object);
    const double depth = -apart - error_of(name) - error_of(change.object);
    if (depth > fit.depth) {
      fit.deepest = name;
      fit.depth = depth;
    }
    if (std::max(0.0, apart) < fit.distance) {
      fit.nearest = name;
      fit.distance = std::max(0.0, apart);
    }
  }
  return fit;
}

}  // namespace clearance
