// The part of Sensors that makes a cloud of a frame.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "monitor/bodies/directed_rounding.hpp"
#include "monitor/sensors/sensor_state.hpp"

namespace clearance {
namespace {

// Known bodies that fill less than this share of a picture do not show that a place is clear.
constexpr double kLeastKnown = 0.25;

const CloudCrop kNoCrop{.centre = Vec3::Zero(), .radius = kInfinity};

// The least ball around two.
CloudCrop ball_around(const CloudCrop& a, const CloudCrop& b) noexcept {
  const Vec3 between = b.centre - a.centre;
  const double distance = between.norm();
  if (distance + b.radius <= a.radius) return a;
  if (distance + a.radius <= b.radius) return b;
  const double radius = 0.5 * (distance + a.radius + b.radius);
  return {.centre = a.centre + (radius - a.radius) / distance * between, .radius = radius};
}

// The crop is a ball around those of the cell's robots, in the frame of the sensor. The ball's
// place is off by the errors of both, which costs only some of the elements that it was to keep.
// Without a place of each base, nothing is cropped.
std::optional<CloudCrop> crop_of(const Sensor& sensor, const PastPose& place,
                                 const PostureHistory& postures) noexcept {
  std::optional<CloudCrop> crop;
  for (const ReachBall& ball : sensor.crop) {
    CloudCrop next{.centre = ball.centre, .radius = ball.radius};
    if (ball.is_carried) {
      const PastPose base = postures.link(ball.robot, ball.link);
      if (!base.known) return std::nullopt;
      next.centre = base.world_from_body.position;
    }
    crop = crop ? ball_around(*crop, next) : next;
  }
  if (!crop) return std::nullopt;
  const Pose& world_from_sensor = place.world_from_body;
  crop->centre =
      world_from_sensor.orientation.conjugate() * (crop->centre - world_from_sensor.position);
  return crop;
}

}  // namespace

// A map may be older than the daemon. If nothing is known of the robot at its stamp, what it has of
// the robot is an obstacle.
void Sensors::build(State& state, const Waiting& frame, SeenCloud& cloud, const Use& use) {
  postures_.place(frame.stamp_ns, state.sensor.stamp_error_ns);
  mounts_.judge(state.sensor, frame.cloud->frame, frames_, now_);
  PastPose place =
      mounts_.find(state.sensor, frame.cloud->frame, frame.stamp_ns, frames_, postures_);
  if (state.sensor.kind == SensorKind::kOctomap)
    place = carried(place, frame.cloud->frame_from_sensor, 0.0, 0.0);
  FrameFault fault = FrameFault::kNoFault;
  std::string elsewhere;
  if (!place.known) {
    fault = mounts_.awaits_transforms(state.sensor, frame.cloud->frame, frame.stamp_ns, frames_)
                ? FrameFault::kLateTransforms
                : FrameFault::kNoPlace;
  } else if (elsewhere = mounts_.robot_elsewhere(state.sensor, frame.cloud->frame, frame.stamp_ns,
                                                 frames_, place);
             !elsewhere.empty()) {
    fault = FrameFault::kRobotElsewhere;
  } else if (state.sensor.kind != SensorKind::kOctomap && !postures_.began_by(frame.stamp_ns)) {
    fault = FrameFault::kBeforeJoints;
  } else {
    const Carrier carrier =
        mounts_.carrier(state.sensor, frame.cloud->frame, frame.stamp_ns, frames_);
    fault = build_at(state, frame, place, carrier, cloud, use, false);
  }
  state.status.robot_elsewhere = std::move(elsewhere);
  if (fault != FrameFault::kNoFault) ++state.not_built[static_cast<std::size_t>(fault)];
}

// The postures are placed. What a frame leaves behind for later ones is left by each frame that is
// kept, even if it shows nothing.
FrameFault Sensors::build_at(State& state, const Waiting& frame, const PastPose& place,
                             const Carrier& carrier, SeenCloud& cloud, const Use& use, bool again) {
  const auto began = std::chrono::steady_clock::now();
  SensorFrame out{.cloud = &cloud,
                  .stamp_ns = frame.stamp_ns,
                  .world_from_sensor = place.world_from_body,
                  .pose_error = place.error(state.sensor.extent()),
                  .carrier = carrier};
  if (!(rounded_up(state.sensor.extent() + out.pose_error) <= state.sensor.view_radius()))
    return FrameFault::kNoPlace;
  if (const FrameFault fault = fill(state, frame, place, cloud, again);
      fault != FrameFault::kNoFault)
    return fault;
  if (!again && has_left_its_image(state, frame, cloud)) return FrameFault::kFrozen;
  if (options_.keep) {
    options_.keep({.sensor = state.index,
                   .stamp_ns = frame.stamp_ns,
                   .scene_revision = cell_.scene.revision,
                   .place = place,
                   .carrier = carrier,
                   .postures = postures_.placed(),
                   .camera = frame.camera,
                   .message = frame.message});
  }
  leave_out(state, frame, place, cloud);
  if (!cloud.shows_place()) return FrameFault::kNothingSeen;
  if (state.payloads) {
    state.payloads->look(*cloud.depth(), place, postures_, state.robots, frame.stamp_ns);
    state.status.payloads = state.payloads->all();
  }
  out.robots = state.robots;
  for (std::size_t r = 0; r < state.status.robots.size(); ++r) {
    const bool counts = r < kMostRobotsSeen;
    state.status.robots[r].rays = witness_.rays()[r];
    state.status.robots[r].count.add(counts && (out.robots.there >> r & 1U) != 0,
                                     counts && (out.robots.not_there >> r & 1U) != 0,
                                     state.sensor.witness_frames);
  }
  if (!again) state.seen_share.use();
  SensorStatus& status = state.status;
  ++status.frames;
  status.stamp_ns = frame.stamp_ns;
  status.elements = cloud.size();
  status.pose_error = out.pose_error;
  status.largest_pose_error = std::max(status.largest_pose_error, out.pose_error);
  const auto took = std::chrono::steady_clock::now() - began;
  status.longest_build_ns = std::max<std::int64_t>(
      status.longest_build_ns, std::chrono::duration_cast<std::chrono::nanoseconds>(took).count());
  use(state.index, out);
  return FrameFault::kNoFault;
}

bool Sensors::has_room(std::uint32_t sensor, const IsUsed& is_used) const {
  return !std::ranges::all_of(states_[sensor]->clouds,
                              [&](const auto& cloud) { return is_used(cloud.get()); });
}

bool Sensors::rebuild(const BuiltFrame& built, const IsUsed& is_used, const Use& use) {
  if (built.scene_revision != cell_.scene.revision || built.sensor >= states_.size() ||
      !has(cell_.scene, built.carrier) || !built.place.known || !built.place.is_sound()) {
    return false;
  }
  State& state = *states_[built.sensor];
  const FrameDecoder* const decoder = frame_decoder(built.message.type);
  if (decoder == nullptr || state.sensor.kind != decoder->kind) return false;
  Waiting frame;
  frame.cloud = decoder->decode(built.message, state.sensor, decoder_);
  frame.camera = built.camera;
  frame.stamp_ns = built.stamp_ns;
  if (options_.keep) frame.message = built.message;
  const auto cloud =
      std::ranges::find_if(state.clouds, [&](const auto& each) { return !is_used(each.get()); });
  if (cloud == state.clouds.end() || frame.cloud == nullptr ||
      frame.cloud->fault != FrameFault::kNoFault || !postures_.place(built.postures)) {
    return false;
  }
  const FrameFault fault = build_at(state, frame, built.place, built.carrier, **cloud, use, true);
  return fault == FrameFault::kNoFault || fault == FrameFault::kNothingSeen;
}

// The depth is that of a frame before, as it may be while nothing moves. If most of what was the
// robot's image then is nowhere near it now, the robot has moved, and the picture has not.
bool Sensors::has_left_its_image(State& state, const Waiting& frame, const SeenCloud& cloud) {
  std::size_t own = 0;
  for (const HiddenNear& near : cloud.hidden()) own += near.shell.elements;
  if (frame.repeats) return 2 * own < state.own_elements;
  state.own_elements = own;
  return false;
}

FrameFault Sensors::judge_share(State& state, const Waiting& frame, std::size_t seen, bool again) {
  const double least = state.sensor.least_seen;
  if (again || seen == 0) return FrameFault::kNoFault;
  if (!frame.cloud->is_picture())
    return least > 0.0 ? FrameFault::kNotOrganised : FrameFault::kNoFault;
  const double all = static_cast<double>(frame.cloud->columns) * frame.cloud->rows;
  return state.seen_share.judge(static_cast<double>(seen) / all, least, frame.stamp_ns);
}

// Fills a cloud with what the frame shows, without the robot's own image.
FrameFault Sensors::fill(State& state, const Waiting& frame, const PastPose& place,
                         SeenCloud& cloud, bool again) {
  const Sensor& sensor = state.sensor;
  cloud.note_crop(kNoCrop);
  const auto note_known = [&](std::size_t elements) {
    const double picture = static_cast<double>(frame.cloud->columns) * frame.cloud->rows;
    cloud.note_known(frame.cloud->is_picture() &&
                     static_cast<double>(elements) >= kLeastKnown * picture);
  };
  if (DepthCloud* const depth = cloud.depth()) {
    const DepthBuild built =
        depth->build(frame.camera, *frame.cloud->image(),
                     {.constant = sensor.error_constant, .quadratic = sensor.error_quadratic},
                     {.least = sensor.least_depth, .greatest = sensor.greatest_depth});
    if (built != DepthBuild::kBuilt) return FrameFault::kCannotBuild;
    if (const FrameFault fault = judge_share(state, frame, depth->size(), again);
        fault != FrameFault::kNoFault) {
      return fault;
    }
    if (sensor.is_witness)
      state.robots = witness_.judge(sensor, frame.camera, *frame.cloud->image(), place, postures_);
    if (state.payloads) state.payloads->note(*depth, frame.camera, place);
    note_known(own_image_.leave_out(sensor, frame.cloud->is_along_ray(sensor), place, postures_,
                                    cloud, body_));
    return FrameFault::kNoFault;
  }
  const bool is_map = sensor.kind == SensorKind::kOctomap;
  const MessageCloud& shown = *frame.cloud;
  double excess = 0.0;
  if (const FrameFault fault = shown.elements(sensor, points_, excess);
      fault != FrameFault::kNoFault) {
    return fault;
  }
  cloud.note_excess(excess);
  const auto seen = std::ranges::count_if(points_, [](const MeasuredPoint& point) {
    return !std::isnan(point.x) && !std::isnan(point.radius);
  });
  if (const FrameFault fault = judge_share(state, frame, static_cast<std::size_t>(seen), again);
      fault != FrameFault::kNoFault) {
    return fault;
  }
  if (sensor.by_neighbours) {
    narrow_ = points_;
    const FrameFault fault = organised_.widen(shown.columns, shown.rows, points_);
    if (fault != FrameFault::kNoFault) return fault;
  }
  PointCloud& points = *cloud.points();
  // False: it cannot be built.
  const auto build_within = [&](const CloudCrop& crop) {
    const CloudBuild built =
        is_map ? points.build_cubes(points_, crop) : points.build(points_, crop);
    if (built != CloudBuild::kBuilt || points.extent() > sensor.extent()) return false;
    state.status.cropped = points.cropped();
    cloud.note_crop(points.cropped() > 0 ? crop : kNoCrop);
    note_known(own_image_.leave_out(sensor, frame.cloud->is_along_ray(sensor), place, postures_,
                                    cloud, body_));
    return true;
  };
  // A map is cropped to the range, and nothing of it is dropped.
  const CloudCrop whole{.centre = Vec3::Zero(),
                        .radius = is_map ? sensor.greatest_depth : sensor.extent()};
  // Links that are farther apart than a map reaches need no crop: the range is one already.
  if (!build_within(crop_of(sensor, place, postures_).value_or(whole)) &&
      !(is_map && build_within(whole)))
    return FrameFault::kCannotBuild;
  // If all but the robot is beyond the links' reach, none is cropped: the frame shows something.
  if (points.size() == 0 && points.cropped() > 0 && !build_within(whole))
    return FrameFault::kCannotBuild;
  if (sensor.by_neighbours) narrow(shown, points);
  return FrameFault::kNoFault;
}

// Own points count as rays from now on: no ball reaches towards them, into the robot. A surface
// between an own point and a neighbour is in the blind shell, which was found with balls that reach
// that far, so the whole distance is no longer than the diameter of the own point's ball.
void Sensors::narrow(const MessageCloud& frame, PointCloud& points) {
  for (std::size_t b = 0; b < points.blocks(); ++b) {
    const PointCloud::Block& block = points.block(b);
    for (std::size_t lane = 0; lane < PointCloud::kFanOut; ++lane) {
      if (!block.is_present(lane))
        narrow_[block.source[lane]].radius = std::numeric_limits<float>::quiet_NaN();
    }
  }
  // The rays are those of the frame that was widened before, so there is no fault.
  static_cast<void>(organised_.widen(frame.columns, frame.rows, narrow_));
  points.narrow(narrow_);
}

// Leaves out what else is no obstacle, or none that matters, and notes what may be hidden by that.
void Sensors::leave_out(State& state, const Waiting& frame, const PastPose& place,
                        SeenCloud& cloud) {
  const Sensor& sensor = state.sensor;
  if (state.persistence) {
    const std::span<DepthCloud> unseen = own_image_.unseen(sensor);
    state.status.hidden = state.persistence->hide(
        cloud, place.world_from_body, place.error(sensor.extent()), frame.stamp_ns, unseen);
    for (DepthCloud& each : unseen) each.refit();
    if (state.status.hidden > 0) cloud.note_known(false);  // they may be more than speckle
  }
  own_image_.find_unseen(sensor, place, postures_, cloud, body_);
  if (DepthCloud* const depth = cloud.depth()) {
    if (const auto crop = crop_of(sensor, place, postures_)) {
      state.status.cropped = depth->crop(crop->centre, crop->radius);
      if (state.status.cropped > 0) cloud.note_crop(*crop);
    }
  }
  cloud.refit();
  std::vector<OwnImageStatus>& own = state.status.own;
  for (std::size_t i = 0; i < own.size(); ++i) {
    const HiddenNear& near = cloud.hidden()[i];
    own[i] = {.object = near.object,
              .elements = near.shell.elements,
              .thickness = near.shell.thickness,
              .thickest = std::max(own[i].thickest, near.shell.thickness),
              .shell = near.shell.shell,
              .unseen = near.unseen};
  }
}

}  // namespace clearance
