#include "monitor/sensors/own_image.hpp"

#include <algorithm>

#include "config/scene/rigid_root.hpp"
#include "monitor/motion/directed_rounding.hpp"

namespace clearance {
namespace {

// No point of a part is farther from the origin of its object, m.
double radius_of(const Part& part) noexcept {
  return part.object_from_part.position.norm() + part.shape.bounding_radius + part.shape.radius +
         part.shape.position_error;
}

}  // namespace

OwnImage::OwnImage(const Scene& scene) : scene_(scene) {
  for (std::uint32_t robot = 0; robot < scene.robots.size(); ++robot) {
    if (!is_of_a_robot(scene.robots, scene.robots[robot])) continue;
    const std::vector<RobotLink>& links = scene.robots[robot].links;
    for (std::uint32_t link = 0; link < links.size(); ++link) {
      if (links[link].object != RobotLink::kNoObject)
        links_.push_back({links[link].object, robot, link});
    }
  }
  std::ranges::sort(links_, {}, &Link::object);
  for (const Sensor& sensor : scene.sensors) {
    unseen_.push_back(sensor.unseen ? std::make_unique<Unseen>(sensor.columns, sensor.rows)
                                    : nullptr);
  }
}

void OwnImage::leave_out(const Sensor& sensor, const PastPose& place,
                         const PostureHistory& postures, SeenCloud& cloud, SlabBody& body) {
  const double place_error = place.error(sensor.extent());
  CentreLimit limit{
      .error = {.constant = sensor.error_constant, .quadratic = sensor.error_quadratic},
      .along_ray = sensor.along_ray};
  Unseen* const unseen = of_sensor(sensor);
  if (unseen != nullptr) {
    unseen->is_built = unseen->cloud.build_unseen(
        *cloud.depth(), {.least = sensor.least_depth, .greatest = sensor.greatest_depth});
  }
  cloud.hidden().clear();
  for (const Link& link : links_) {
    HiddenNear& near = cloud.hidden().emplace_back();
    near.object = link.object;
    const PastPose past = postures.link(link.robot, link.link);
    if (!past.known) continue;
    for (const Part& part : scene_.objects[link.object].parts) {
      const double error = place_error + past.error(radius_of(part));
      const Pose world_from_part = compose(past.world_from_body, part.object_from_part);
      const double shell = std::min(sensor.most_shell, rounded_up(sensor.own_shell + error));
      // The way of an organised point to its neighbours says nothing about whose image it is.
      limit.most = sensor.by_neighbours ? shell : sensor.most_shell;
      const BlindShell blind = cloud.shelve(
          part.shape, relative_pose(world_from_part, place.world_from_body), shell, limit, body);
      near.shell.elements += blind.elements;
      if (blind.elements > 0)
        near.shell.thickness = std::max(near.shell.thickness, rounded_up(blind.thickness + error));
    }
  }
  if (unseen != nullptr && unseen->is_built) unseen->cloud.leave_out_behind(*cloud.depth());
}

DepthCloud* OwnImage::unseen(const Sensor& sensor) noexcept {
  Unseen* const unseen = of_sensor(sensor);
  return unseen != nullptr && unseen->is_built ? &unseen->cloud : nullptr;
}

void OwnImage::find_unseen(const Sensor& sensor, const PastPose& place,
                           const PostureHistory& postures, SeenCloud& cloud, SlabBody& body) {
  if (unseen(sensor) == nullptr) return;
  const double place_error = place.error(sensor.extent());
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const PastPose past = postures.link(links_[i].robot, links_[i].link);
    if (past.known)
      find_unseen(links_[i], past, place, place_error, body, *of_sensor(sensor), cloud.hidden()[i]);
  }
}

void OwnImage::find_unseen(const Link& of, const PastPose& past, const PastPose& place,
                           double place_error, SlabBody& body, Unseen& unseen,
                           HiddenNear& near) const {
  near.unseen = kInfinity;
  for (const Part& part : scene_.objects[of.object].parts) {
    const Pose world_from_part = compose(past.world_from_body, part.object_from_part);
    unseen.tracking.forget();
    const NearestElement found =
        nearest_element(part.shape, unseen.cloud, body,
                        relative_pose(world_from_part, place.world_from_body), unseen.tracking);
    if (found.answer == CloudAnswer::kEmpty) continue;
    const double lower = rounded_down(found.lower - place_error - past.error(radius_of(part)));
    if (!(lower < near.unseen)) continue;
    near.unseen = lower;
    near.unseen_at =
        world_from_part.orientation * found.point_on_element + world_from_part.position;
  }
}

}  // namespace clearance
