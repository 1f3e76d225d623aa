#include "monitor/visual/cell_markers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "monitor/interface/report.hpp"
#include "monitor/visual/body_mesh.hpp"

namespace clearance {
namespace {

constexpr ros::Colour kFixedColour{0.62F, 0.65F, 0.69F, 1.0F},
    kMovingColour{0.32F, 0.55F, 0.80F, 1.0F}, kPlaneColour{0.5F, 0.5F, 0.5F, 0.25F},
    kNearColour{0.92F, 0.34F, 0.05F, 1.0F}, kClosestColour{0.07F, 0.65F, 0.52F, 1.0F};
constexpr double kLineWidth = 0.006, kTextHeight = 0.05;  // m
constexpr std::size_t kMostLines = 64;

ros::Marker part_marker(const Object& object, const Part& part, std::int32_t id) {
  const BodyMesh mesh = body_mesh(part.shape);
  ros::Marker marker{.frame = object.name,
                     .name_space = "bodies",
                     .id = id,
                     .type = ros::MarkerType::kTriangles,
                     .pose = part.object_from_part,
                     .colour = object.fixed ? kFixedColour : kMovingColour};
  if (!part.shape.bounded()) marker.colour = kPlaneColour;
  marker.points.reserve(3 * mesh.triangles.size());
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) marker.points.push_back(mesh.positions[corner]);
  }
  return marker;
}

// The parts of all objects, in the order of the scene. What sensors see has no body.
std::vector<ros::Marker> part_markers(const Scene& scene) {
  std::vector<ros::Marker> markers;
  for (const Object& object : scene.objects) {
    if (object.is_seen()) continue;  // its part is the ball of the sensor's view
    for (const Part& part : object.parts) {
      markers.push_back(part_marker(object, part, static_cast<std::int32_t>(markers.size())));
    }
  }
  return markers;
}

Vec3 vector_of(const clearance_msg_Vector3& v) { return {v.x, v.y, v.z}; }

bool has_points(const clearance_msg_PairDistance& pair) {
  return pair.status < static_cast<std::uint8_t>(PairStatus::kStale) &&
         vector_of(pair.witness_a).allFinite() && vector_of(pair.witness_b).allFinite();
}

// For each pair, the largest enter_below of its zones plus both margins, m; -infinity: no zone.
std::vector<double> near_below(const Scene& scene) {
  std::vector<double> limits(scene.pairs.size(), -kInfinity);
  for (const Zone& zone : scene.zones) {
    for (const std::uint32_t pair : zone.pairs) {
      const ObjectPair& both = scene.pairs[pair];
      const double margins = scene.objects[both.first].margin + scene.objects[both.second].margin;
      limits[pair] = std::max(limits[pair], zone.enter_below + margins);
    }
  }
  return limits;
}

void add_pair(const clearance_msg_PairDistance& pair, const ros::Colour& colour, ros::Marker& lines,
              std::vector<ros::Marker>& markers) {
  const Vec3 a = vector_of(pair.witness_a), b = vector_of(pair.witness_b);
  lines.points.insert(lines.points.end(), {a, b});
  lines.colours.insert(lines.colours.end(), {colour, colour});
  ros::Marker text{.frame = lines.frame,
                   .name_space = "distances",
                   .id = static_cast<std::int32_t>(markers.size()),
                   .type = ros::MarkerType::kText,
                   .pose = {0.5 * (a + b) + Vec3(0.0, 0.0, kTextHeight), {}},
                   .scale = Vec3(0.0, 0.0, kTextHeight),
                   .colour = colour};
  text.pose.orientation = Eigen::Quaterniond::Identity();
  text.text = fmt::format("{:.1f} mm", 1e3 * pair.distance);
  markers.push_back(std::move(text));
}

}  // namespace

Sample<ros::TransformMessage> transforms_message(const Scene& scene, const ObjectPoses& poses,
                                                 std::int64_t stamp_ns) {
  std::vector<ros::Transform> transforms;
  transforms.reserve(scene.objects.size());
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const Pose* const pose = poses.pose(i);
    if (pose != nullptr) transforms.push_back({scene.objects[i].name, *pose});
  }
  for (const PathFrame::Placed& link : poses.at_standstill())
    transforms.push_back(
        {kStandstillFrames + scene.objects[link.object].name, link.world_from_object});
  return ros::transform_message(stamp_ns, transforms);
}

Sample<ros::MarkerArray> bodies_message(const Scene& scene) {
  return ros::marker_array(0, part_markers(scene));
}

Sample<ros::MarkerArray> bodies_message_for_tf(const Scene& scene, const std::string& world) {
  std::vector<ros::Marker> markers = part_markers(scene);
  auto marker = markers.begin();
  for (const Object& object : scene.objects) {
    if (object.is_seen()) continue;
    for (std::size_t part = 0; part < object.parts.size(); ++part, ++marker) {
      if (!object.frame.empty()) marker->frame = object.frame;
      if (!object.fixed) continue;
      marker->frame = world;
      marker->pose = compose(object.world_from_object, marker->pose);
    }
  }
  return ros::marker_array(0, markers);
}

Sample<ros::MarkerArray> closest_message(const Scene& scene, const clearance_msg_Distances& report,
                                         std::int64_t stamp_ns, std::string_view world) {
  std::vector<ros::Marker> markers(1);
  ros::Marker lines{.frame = world,
                    .name_space = "lines",
                    .type = ros::MarkerType::kLineList,
                    .scale = Vec3(kLineWidth, 0.0, 0.0),
                    .colour = kClosestColour};
  const std::vector<double> limits = near_below(scene);
  const auto colour_of = [&](const clearance_msg_PairDistance& pair) {
    return pair.pair < limits.size() && pair.lower < limits[pair.pair] ? kNearColour
                                                                       : kClosestColour;
  };
  if (report.minimum_known && has_points(report.minimum)) {
    add_pair(report.minimum, colour_of(report.minimum), lines, markers);
  }
  for (const auto& pair : std::span(report.pairs._buffer, report.pairs._length)) {
    if (markers.size() > kMostLines) break;
    if (pair.pair == report.minimum.pair || pair.pair >= limits.size()) continue;
    if (has_points(pair) && pair.lower < limits[pair.pair]) {
      add_pair(pair, kNearColour, lines, markers);
    }
  }
  // Delete the texts of lines that are gone.
  lines.deleted = lines.points.empty();
  const std::size_t shown = markers.size();
  for (std::size_t id = shown; id <= kMostLines; ++id) {
    markers.push_back({.frame = world,
                       .name_space = "distances",
                       .id = static_cast<std::int32_t>(id),
                       .type = ros::MarkerType::kText,
                       .deleted = true});
  }
  markers.front() = std::move(lines);
  return ros::marker_array(stamp_ns, markers);
}

}  // namespace clearance
