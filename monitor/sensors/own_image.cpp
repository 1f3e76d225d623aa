#include "monitor/sensors/own_image.hpp"

#include <algorithm>
#include <cmath>

#include "config/scene/rigid_root.hpp"
#include "monitor/bodies/directed_rounding.hpp"

namespace clearance {
namespace {

// No point of a part is farther from the origin of its object, m.
double radius_of(const Part& part) noexcept {
  return part.object_from_part.position.norm() + part.shape.bounding_radius + part.shape.radius +
         part.shape.position_error;
}

// No point of the part is farther than this from its place, m. A body without bounds has a place
// only if it does not turn.
double error_of(const PastPose& past, const Part& part) noexcept {
  return past.turn_error > 0.0 ? past.error(radius_of(part)) : past.shift_error;
}

}  // namespace

OwnImage::OwnImage(const Scene& scene) : scene_(scene), errors_(scene) {
  for (std::uint32_t robot = 0; robot < scene.robots.size(); ++robot) {
    if (!is_of_a_robot(scene.robots, scene.robots[robot])) continue;
    const auto carrier = static_cast<std::uint32_t>(&carrier_of(scene.robots, scene.robots[robot]) -
                                                    scene.robots.data());
    const auto found = std::ranges::find(groups_, carrier);
    const auto group = static_cast<std::uint32_t>(found - groups_.begin());
    if (found == groups_.end()) groups_.push_back(carrier);
    const std::vector<RobotLink>& links = scene.robots[robot].links;
    for (std::uint32_t link = 0; link < links.size(); ++link) {
      if (links[link].object != RobotLink::kNoObject)
        bodies_.push_back({links[link].object, robot, link, group});
    }
  }
  for (const std::uint32_t object : known_bodies(scene)) bodies_.push_back({.object = object});
  std::ranges::sort(bodies_, {}, &Body::object);
  for (const Sensor& sensor : scene.sensors) {
    unseen_.push_back(sensor.unseen ? std::make_unique<Unseen>(sensor, groups_.size()) : nullptr);
  }
}

PastPose OwnImage::place_of(const Body& body, const PostureHistory& postures) noexcept {
  return body.robot == kNone ? postures.object(body.object) : postures.link(body.robot, body.link);
}

bool OwnImage::hang_together(std::uint32_t group, std::uint32_t other) const noexcept {
  if (other == kNone) return false;
  const auto stands_on = [&](std::uint32_t above, std::uint32_t below) {
    while (above != below && scene_.robots[above].base.kind == RobotBase::Kind::kLink)
      above = scene_.robots[above].base.robot;
    return above == below;
  };
  return stands_on(groups_[group], groups_[other]) || stands_on(groups_[other], groups_[group]);
}

// An element that is near both a link and a known body is the link's: it shows nothing of the body.
std::size_t OwnImage::leave_out(const Sensor& sensor, bool along_ray, const PastPose& place,
                                const PostureHistory& postures, SeenCloud& cloud, SlabBody& body) {
  OfFrame frame{
      .sensor = sensor,
      .place = place,
      .postures = postures,
      .cloud = cloud,
      .body = body,
      .limit = {.error = {.constant = sensor.error_constant, .quadratic = sensor.error_quadratic},
                .along_ray = along_ray,
                .large = sensor.trusted_shell}};
  Unseen* const places = of_sensor(sensor);
  if (places != nullptr) {
    places->is_built = std::ranges::all_of(places->clouds, [&](DepthCloud& each) {
      return each.build_unseen(*cloud.depth(),
                               {.least = sensor.least_depth, .greatest = sensor.greatest_depth});
    });
    std::ranges::fill(places->others, *cloud.depth());
  }
  cloud.hidden().assign(bodies_.size(), {});
  cloud.trust_shells(sensor.trusted_shell);
  std::size_t known = 0;
  bool is_elsewhere = false;
  for (const bool links : {true, false}) {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      if ((bodies_[i].robot != kNone) != links) continue;
      HiddenNear& near = cloud.hidden()[i];
      near.object = bodies_[i].object;
      if (!links && !sensor.knows) continue;
      leave_out(bodies_[i], frame, near);
      if (links) continue;
      known += near.shell.elements;
      is_elsewhere |= near.shell.sampled > 0 && 2 * near.shell.deep >= near.shell.sampled;
    }
  }
  for (std::size_t group = 0; group < unseen(sensor).size(); ++group) {
    places->clouds[group].leave_out_behind(
        *cloud.depth(), places->others.empty() ? nullptr : &places->others[group]);
  }
  return is_elsewhere ? 0 : known;
}

void OwnImage::leave_out(const Body& each, OfFrame& frame, HiddenNear& near) {
  const Sensor& sensor = frame.sensor;
  const PastPose past = place_of(each, frame.postures);
  if (!past.known) return;
  Unseen* const places = of_sensor(sensor);
  CentreLimit limit = frame.limit;
  for (const Part& part : scene_.objects[each.object].parts) {
    const double error = frame.place.error(sensor.extent()) + error_of(past, part) +
                         errors_.largest(each.object, sensor.object);
    const Pose world_from_part = compose(past.world_from_body, part.object_from_part);
    const double shell = std::min(sensor.most_shell, rounded_up(sensor.own_shell + error));
    // The distance of an organised point to its neighbours says nothing about whose image it is.
    limit.most = sensor.by_neighbours ? shell : sensor.most_shell;
    if (each.robot == kNone) limit.depth = scene_.objects[each.object].mesh_error;
    const RelativePose part_from_cloud =
        relative_pose(world_from_part, frame.place.world_from_body);
    const BlindShell blind =
        frame.cloud.shelve(part.shape, part_from_cloud, shell, limit, frame.body);
    for (std::uint32_t group = 0; places != nullptr && group < places->others.size(); ++group) {
      if (!hang_together(group, each.group))
        static_cast<void>(shelve_own_points(part.shape, part_from_cloud, shell,
                                            places->others[group], frame.body));
    }
    near.shell.add(blind);
    if (blind.elements > 0)
      near.shell.thickness = std::max(near.shell.thickness, rounded_up(blind.thickness + error));
  }
}

std::span<DepthCloud> OwnImage::unseen(const Sensor& sensor) noexcept {
  Unseen* const unseen = of_sensor(sensor);
  if (unseen == nullptr || !unseen->is_built) return {};
  return unseen->clouds;
}

void OwnImage::find_unseen(const Sensor& sensor, const PastPose& place,
                           const PostureHistory& postures, SeenCloud& cloud, SlabBody& body) {
  if (unseen(sensor).empty()) return;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (bodies_[i].robot == kNone) continue;
    const double place_error =
        place.error(sensor.extent()) + errors_.largest(bodies_[i].object, sensor.object);
    const PastPose past = place_of(bodies_[i], postures);
    if (past.known) {
      find_unseen(bodies_[i], past, place, place_error, body, *of_sensor(sensor),
                  cloud.hidden()[i]);
    }
  }
}

void OwnImage::find_unseen(const Body& of, const PastPose& past, const PastPose& place,
                           double place_error, SlabBody& body, Unseen& unseen,
                           HiddenNear& near) const {
  near.unseen = kInfinity;
  for (const Part& part : scene_.objects[of.object].parts) {
    const Pose world_from_part = compose(past.world_from_body, part.object_from_part);
    unseen.tracking.forget();
    const NearestElement found =
        nearest_element(part.shape, unseen.clouds[of.group], body,
                        relative_pose(world_from_part, place.world_from_body), unseen.tracking);
    if (found.answer == CloudAnswer::kEmpty) continue;
    const double lower = rounded_down(found.lower - place_error - past.error(radius_of(part)));
    if (lower >= near.unseen) continue;
    near.unseen = std::isnan(lower) ? -kInfinity : lower;
    near.unseen_at =
        world_from_part.orientation * found.point_on_element + world_from_part.position;
  }
}

}  // namespace clearance
