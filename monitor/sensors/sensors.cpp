#include "monitor/sensors/sensors.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <type_traits>
#include <utility>

#include "monitor/inputs/elapsed.hpp"
#include "monitor/intake/tf_tree.hpp"
#include "monitor/motion/directed_rounding.hpp"
#include "monitor/sensors/measured_points.hpp"
#include "monitor/sensors/persistence.hpp"
#include "monitor/wire/camera_types.hpp"
#include "monitor/wire/moveit_types.hpp"
#include "monitor/wire/ros_types.hpp"

namespace clearance {
namespace {

using Type = RawSensorMessage::Type;

SeenCloud cloud_of(const Sensor& sensor) {
  return sensor.kind == SensorKind::kDepthImage ? SeenCloud::of_images(sensor.columns, sensor.rows)
                                                : SeenCloud::of_points(sensor.most_points);
}

SensorKind kind_of(Type type) noexcept {
  switch (type) {
    case Type::kPoints:
      return SensorKind::kPoints;
    case Type::kOctomap:
    case Type::kPlanningScene:
      return SensorKind::kOctomap;
    case Type::kImage:
    case Type::kCameraInfo:
    case Type::kTransforms:
    case Type::kStaticTransforms:
      return SensorKind::kDepthImage;
  }
  return SensorKind::kDepthImage;
}

// The ball of the cell's robots in the frame of the sensor. Its place is off by the error of the
// sensor's, which counts as the error of every element.
CloudCrop crop_of(const Sensor& sensor, const PastPose& place) noexcept {
  const Pose& world_from_sensor = place.world_from_body;
  return {.centre = world_from_sensor.orientation.conjugate() *
                    (sensor.crop_centre - world_from_sensor.position),
          .radius = sensor.crop_radius};
}

}  // namespace

// A frame that was judged and is not built yet. The views are of the sample's memory.
struct Sensors::Waiting {
  Sample<sensor_msgs_msg_dds__Image_> image_sample;
  Sample<sensor_msgs_msg_dds__PointCloud2_> points_sample;
  Sample<octomap_msgs_msg_dds__Octomap_> map_sample;
  Sample<moveit_msgs_msg_dds__PlanningScene_> scene_sample;
  DepthImage image;
  PointsView points;
  OctomapView map;
  Pose frame_from_sensor;  // of a map of MoveIt
  PinholeCamera camera;
  std::string frame;         // of tf
  RawSensorMessage message;  // if it is kept
  std::int64_t stamp_ns = 0, came_ns = 0;

  [[nodiscard]] auto& sample(const sensor_msgs_msg_dds__Image_*) noexcept { return image_sample; }
  [[nodiscard]] auto& sample(const sensor_msgs_msg_dds__PointCloud2_*) noexcept {
    return points_sample;
  }
  [[nodiscard]] auto& sample(const octomap_msgs_msg_dds__Octomap_*) noexcept { return map_sample; }
  [[nodiscard]] auto& sample(const moveit_msgs_msg_dds__PlanningScene_*) noexcept {
    return scene_sample;
  }
  [[nodiscard]] DepthImage& view(const sensor_msgs_msg_dds__Image_*) noexcept { return image; }
  [[nodiscard]] PointsView& view(const sensor_msgs_msg_dds__PointCloud2_*) noexcept {
    return points;
  }
  [[nodiscard]] OctomapView& view(const octomap_msgs_msg_dds__Octomap_*) noexcept { return map; }
};

struct Sensors::State {
  State(std::uint32_t the_index, const Sensor& the_sensor, double max_speed)
      : index(the_index), sensor(the_sensor), stream({.most_pixels = the_sensor.most_points}) {
    for (std::size_t i = 0; i < kClouds; ++i)
      clouds.push_back(std::make_unique<SeenCloud>(cloud_of(sensor)));
    if (sensor.persist_frames > 1) persistence.emplace(sensor, max_speed);
  }
  std::uint32_t index;
  const Sensor& sensor;
  CameraStream stream;
  std::vector<std::unique_ptr<SeenCloud>> clouds;
  std::deque<std::unique_ptr<Waiting>> waiting;
  // The last image before the first CameraInfo: drivers publish the info of a frame after its
  // image.
  RawSensorMessage without_info;
  std::optional<Persistence> persistence;  // none: all elements stay
  std::array<std::uint64_t, kFrameFaults> not_built{};
  SensorStatus status;
};

Sensors::Sensors(const Cell& cell, const SensorsOptions& options)
    : cell_(cell),
      options_(options),
      postures_(cell.scene),
      mounts_(cell, options.is_log),
      own_image_(cell.scene) {
  const Scene& scene = cell.scene;
  for (std::uint32_t i = 0; i < scene.sensors.size(); ++i) {
    states_.push_back(std::make_unique<State>(i, scene.sensors[i],
                                              scene.objects[scene.sensors[i].object].max_speed));
    states_.back()->status.own.resize(own_image_.links());
  }
}
Sensors::Sensors(const Cell& cell, Sensors& before) : Sensors(cell, before.options_) {
  frames_ = std::move(before.frames_);
  for (const std::unique_ptr<State>& state : states_) {
    for (const std::unique_ptr<State>& old : before.states_) {
      const Sensor &a = old->sensor, &b = state->sensor;
      if (a.name == b.name && a.topic == b.topic && a.camera_info == b.camera_info &&
          a.most_points == b.most_points) {
        state->stream = old->stream;
      }
    }
  }
}
Sensors::~Sensors() = default;

void Sensors::add(std::span<const PoseSample> poses, std::span<const JointSample> joints) {
  for (const JointSample& sample : joints) postures_.add(sample);
  for (const PoseSample& sample : poses) postures_.add(sample);
}

void Sensors::add_transforms(const RawSensorMessage& message) {
  Sample<tf2_msgs_msg_dds__TFMessage_> transforms;
  if (!decoder_.decode(message.cdr, transforms, message.bytes)) return;
  for (std::uint32_t i = 0; i < transforms->transforms._length; ++i) {
    const auto& each = transforms->transforms._buffer[i];
    const std::int64_t stamp = stamp_ns(each.header);
    frames_.add(frame_name(each.child_frame_id), frame_name(each.header.frame_id),
                pose_of(each.transform), stamp == 0 ? message.sent_ns : stamp,
                message.type == Type::kStaticTransforms, message.writer);
  }
}

template <class Message>
void Sensors::add_frame(const RawSensorMessage& message, State& state, std::int64_t now_ns) {
  auto frame = std::make_unique<Waiting>();
  Sample<Message>& sample = frame->sample(static_cast<const Message*>(nullptr));
  if (!decoder_.decode(message.cdr, sample, message.bytes)) return state.stream.refuse();
  frame->came_ns = now_ns;
  FrameFault fault = FrameFault::kNoFault;
  if constexpr (std::is_same_v<Message, moveit_msgs_msg_dds__PlanningScene_>) {
    const octomap_msgs_msg_dds__OctomapWithPose_& map = sample->world.octomap;
    if (map.octomap.data._length == 0) return;  // a change of something else
    // MoveIt leaves the stamp at 0.
    const std::int64_t stamp = stamp_ns(map.header);
    frame->stamp_ns = stamp == 0 ? message.sent_ns : stamp;
    frame->frame = frame_name(map.header.frame_id);
    const auto& [position, orientation] = map.origin;
    frame->frame_from_sensor.position = {position.x, position.y, position.z};
    frame->frame_from_sensor.orientation.coeffs() << orientation.x, orientation.y, orientation.z,
        orientation.w;
    // The negated comparison refuses NaN.
    if (!(std::abs(frame->frame_from_sensor.orientation.norm() - 1.0) <= kSampleUnitTolerance &&
          frame->frame_from_sensor.position.allFinite())) {
      ++state.not_built[static_cast<std::size_t>(FrameFault::kNoPlace)];
      return;
    }
    fault = state.stream.take(map.octomap, {frame->stamp_ns, message.sent_ns, message.writer},
                              frame->map);
  } else {
    frame->stamp_ns = stamp_ns(sample->header);
    frame->frame = frame_name(sample->header.frame_id);
    fault = state.stream.take(*sample, {frame->stamp_ns, message.sent_ns, message.writer},
                              frame->view(static_cast<const Message*>(nullptr)));
  }
  if (fault == FrameFault::kNoCameraInfo) state.without_info = message;
  if (fault != FrameFault::kNoFault) return;
  if (state.stream.camera()) frame->camera = *state.stream.camera();
  if (options_.keep) frame->message = message;
  if (state.waiting.size() == kMostWaiting) {
    state.waiting.pop_front();
    ++state.status.skipped;
  }
  state.waiting.push_back(std::move(frame));
}

void Sensors::add(const RawSensorMessage& message, std::int64_t now_ns) {
  if (message.type == Type::kTransforms || message.type == Type::kStaticTransforms)
    return add_transforms(message);
  for (const std::unique_ptr<State>& state : states_) {
    const Sensor& sensor = state->sensor;
    const bool is_image = sensor.kind == SensorKind::kDepthImage;
    if (message.type == Type::kCameraInfo) {
      if (!is_image || sensor.camera_info != message.topic) continue;
      Sample<sensor_msgs_msg_dds__CameraInfo_> info;
      if (!decoder_.decode(message.cdr, info, message.bytes)) {
        state->stream.refuse();
      } else if (state->stream.take(*info) == FrameFault::kNoFault &&
                 !state->without_info.cdr.empty()) {
        const RawSensorMessage first = std::exchange(state->without_info, {});
        add_frame<sensor_msgs_msg_dds__Image_>(first, *state, now_ns);
      }
    } else if (sensor.topic == message.topic && sensor.kind == kind_of(message.type)) {
      if (message.type == Type::kImage)
        add_frame<sensor_msgs_msg_dds__Image_>(message, *state, now_ns);
      if (message.type == Type::kPoints)
        add_frame<sensor_msgs_msg_dds__PointCloud2_>(message, *state, now_ns);
      if (message.type == Type::kOctomap)
        add_frame<octomap_msgs_msg_dds__Octomap_>(message, *state, now_ns);
      if (message.type == Type::kPlanningScene)
        add_frame<moveit_msgs_msg_dds__PlanningScene_>(message, *state, now_ns);
    }
  }
}

void Sensors::settle(std::int64_t now_ns, const IsUsed& is_used, const Use& use) {
  for (const std::unique_ptr<State>& state : states_) {
    // The newest frame for which the joints are there, or that has waited for long enough.
    std::size_t ready = 0;
    for (std::size_t i = 0; i < state->waiting.size(); ++i) {
      const Waiting& frame = *state->waiting[i];
      if (postures_.covers(frame.stamp_ns) ||
          elapsed(frame.came_ns, now_ns) >= options_.patience_ns) {
        ready = i + 1;
      }
    }
    const auto is_free = [&](const auto& cloud) { return !is_used(cloud.get()); };
    const auto cloud = std::ranges::find_if(state->clouds, is_free);
    if (ready == 0 || cloud == state->clouds.end()) continue;
    const std::unique_ptr<Waiting> frame = std::move(state->waiting[ready - 1]);
    state->status.skipped += ready - 1;
    state->waiting.erase(state->waiting.begin(),
                         state->waiting.begin() + static_cast<std::ptrdiff_t>(ready));
    build(*state, *frame, **cloud, use);
  }
}

void Sensors::build(State& state, const Waiting& frame, SeenCloud& cloud, const Use& use) {
  postures_.place(frame.stamp_ns);
  PastPose place = mounts_.find(state.sensor, frame.frame, frame.stamp_ns, frames_, postures_);
  if (state.sensor.kind == SensorKind::kOctomap)
    place = carried(place, frame.frame_from_sensor, 0.0, 0.0);
  FrameFault fault = FrameFault::kNoFault;
  if (!place.known) {
    fault = FrameFault::kNoPlace;
  } else if (!postures_.began_by(frame.stamp_ns)) {
    fault = FrameFault::kBeforeJoints;
  } else {
    fault = build_at(state, frame, place, cloud, use);
  }
  if (fault != FrameFault::kNoFault) ++state.not_built[static_cast<std::size_t>(fault)];
}

// The postures are placed. What a frame leaves behind for later ones is left by each frame that is
// kept, even if it shows nothing.
FrameFault Sensors::build_at(State& state, const Waiting& frame, const PastPose& place,
                             SeenCloud& cloud, const Use& use) {
  const auto began = std::chrono::steady_clock::now();
  if (const FrameFault fault = fill(state, frame, place, cloud); fault != FrameFault::kNoFault)
    return fault;
  if (options_.keep) {
    options_.keep({.sensor = state.index,
                   .stamp_ns = frame.stamp_ns,
                   .scene_revision = cell_.scene.revision,
                   .place = place,
                   .postures = postures_.placed(),
                   .camera = frame.camera,
                   .message = frame.message});
  }
  leave_out(state, place, frame.stamp_ns, cloud);
  if (cloud.size() == 0) return FrameFault::kNothingSeen;
  const SensorFrame out{.cloud = &cloud,
                        .stamp_ns = frame.stamp_ns,
                        .world_from_sensor = place.world_from_body,
                        .pose_error = place.error(state.sensor.extent())};
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

template <class Message, class View>
bool Sensors::decode_again(const BuiltFrame& built, Sample<Message>& sample, View& out) {
  return decoder_.decode(built.message.cdr, sample, built.message.bytes) &&
         view(*sample, cell_.scene.sensors[built.sensor].most_points, out) == FrameFault::kNoFault;
}

bool Sensors::decode_again(const BuiltFrame& built, Waiting& frame) {
  switch (built.message.type) {
    case Type::kImage:
      return decode_again(built, frame.image_sample, frame.image);
    case Type::kPoints:
      return decode_again(built, frame.points_sample, frame.points);
    case Type::kOctomap:
      return decoder_.decode(built.message.cdr, frame.map_sample, built.message.bytes) &&
             view(*frame.map_sample, frame.map) == FrameFault::kNoFault;
    case Type::kPlanningScene:
      return decoder_.decode(built.message.cdr, frame.scene_sample, built.message.bytes) &&
             view(frame.scene_sample->world.octomap.octomap, frame.map) == FrameFault::kNoFault;
    case Type::kCameraInfo:
    case Type::kTransforms:
    case Type::kStaticTransforms:
      return false;
  }
  return false;
}

bool Sensors::rebuild(const BuiltFrame& built, const IsUsed& is_used, const Use& use) {
  if (built.scene_revision != cell_.scene.revision || built.sensor >= states_.size()) return false;
  State& state = *states_[built.sensor];
  if (state.sensor.kind != kind_of(built.message.type)) return false;
  Waiting frame;
  frame.camera = built.camera;
  frame.stamp_ns = built.stamp_ns;
  const auto cloud =
      std::ranges::find_if(state.clouds, [&](const auto& each) { return !is_used(each.get()); });
  if (cloud == state.clouds.end() || !decode_again(built, frame) ||
      !postures_.place(built.postures)) {
    return false;
  }
  const FrameFault fault = build_at(state, frame, built.place, **cloud, use);
  return fault == FrameFault::kNoFault || fault == FrameFault::kNothingSeen;
}

FrameFault Sensors::fill(State& state, const Waiting& frame, const PastPose& place,
                         SeenCloud& cloud) {
  const Sensor& sensor = state.sensor;
  cloud.note_crop({.centre = Vec3::Zero(), .radius = kInfinity});
  if (DepthCloud* const depth = cloud.depth()) {
    const DepthBuild built =
        depth->build(frame.camera, frame.image,
                     {.constant = sensor.error_constant, .quadratic = sensor.error_quadratic},
                     {.least = sensor.least_depth, .greatest = sensor.greatest_depth});
    return built == DepthBuild::kBuilt ? FrameFault::kNoFault : FrameFault::kCannotBuild;
  }
  const bool is_map = sensor.kind == SensorKind::kOctomap;
  if (is_map) {
    const OctomapFault fault = occupied_cubes(frame.map, sensor.most_points, points_);
    if (fault != OctomapFault::kNoFault) {
      return fault == OctomapFault::kTooMany ? FrameFault::kTooManyPixels : FrameFault::kOctree;
    }
  } else {
    measured_points(frame.points, sensor, points_);
  }
  PointCloud& points = *cloud.points();
  const auto built = [&](const CloudCrop& crop) {
    return is_map ? points.build_cubes(points_, crop) : points.build(points_, crop);
  };
  // A map is cropped to the range, and nothing of it is dropped.
  const CloudCrop whole{.centre = Vec3::Zero(),
                        .radius = is_map ? sensor.greatest_depth : sensor.extent()};
  CloudCrop crop = sensor.crop_radius < kInfinity ? crop_of(sensor, place) : whole;
  CloudBuild result = built(crop);
  // If all points are beyond the links' reach, none are cropped: the frame shows something.
  if (result == CloudBuild::kBuilt && points.size() == 0 && points.cropped() > 0) {
    crop = whole;
    result = built(crop);
  }
  if (result != CloudBuild::kBuilt || points.extent() > sensor.extent())
    return FrameFault::kCannotBuild;
  state.status.cropped = points.cropped();
  if (points.cropped() > 0) cloud.note_crop(crop);
  return FrameFault::kNoFault;
}

// Leaves out what is no obstacle, or none that matters, and notes what may be hidden by that.
void Sensors::leave_out(State& state, const PastPose& place, std::int64_t stamp_ns,
                        SeenCloud& cloud) {
  const Sensor& sensor = state.sensor;
  own_image_.leave_out(sensor, place, postures_, cloud, body_);
  if (state.persistence) {
    DepthCloud* const unseen = own_image_.unseen(sensor);
    state.status.hidden = state.persistence->hide(cloud, place.world_from_body,
                                                  place.error(sensor.extent()), stamp_ns, unseen);
    if (unseen != nullptr) unseen->refit();
  }
  own_image_.find_unseen(sensor, place, postures_, cloud, body_);
  if (DepthCloud* const depth = cloud.depth(); depth != nullptr && sensor.crop_radius < kInfinity) {
    const CloudCrop crop = crop_of(sensor, place);
    state.status.cropped = depth->crop(crop.centre, crop.radius);
    if (state.status.cropped > 0) cloud.note_crop(crop);
  }
  cloud.refit();
  std::vector<OwnImageStatus>& own = state.status.own;
  for (std::size_t i = 0; i < own.size(); ++i) {
    const HiddenNear& near = cloud.hidden()[i];
    own[i] = {.object = near.object,
              .elements = near.shell.elements,
              .thickness = near.shell.thickness,
              .thickest = std::max(own[i].thickest, near.shell.thickness),
              .unseen = near.unseen};
  }
}

bool Sensors::any_waiting() const noexcept {
  return std::ranges::any_of(states_, [](const auto& state) { return !state->waiting.empty(); });
}

SensorStatus Sensors::status(std::uint32_t sensor) const {
  const State& state = *states_[sensor];
  SensorStatus status = state.status;
  for (std::size_t i = 0; i < kFrameFaults; ++i)
    status.counts[i] = state.stream.counts()[i] + state.not_built[i];
  return status;
}

}  // namespace clearance
