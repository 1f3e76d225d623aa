#include "monitor/sensors/sensors.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "monitor/inputs/elapsed.hpp"
#include "monitor/intake/tf_tree.hpp"
#include "monitor/motion/directed_rounding.hpp"
#include "monitor/sensors/measured_points.hpp"
#include "monitor/wire/camera_types.hpp"
#include "monitor/wire/ros_types.hpp"

namespace clearance {
namespace {

using Type = RawSensorMessage::Type;

SeenCloud cloud_of(const Sensor& sensor) {
  return sensor.kind == SensorKind::kDepthImage ? SeenCloud::of_images(sensor.columns, sensor.rows)
                                                : SeenCloud::of_points(sensor.most_points);
}

}  // namespace

// A frame that was judged and is not built yet. The views are of the sample's memory.
struct Sensors::Waiting {
  Sample<sensor_msgs_msg_dds__Image_> image_sample;
  Sample<sensor_msgs_msg_dds__PointCloud2_> points_sample;
  DepthImage image;
  PointsView points;
  PinholeCamera camera;
  std::string frame;  // of tf
  std::int64_t stamp_ns = 0, came_ns = 0;

  [[nodiscard]] auto& sample(const sensor_msgs_msg_dds__Image_*) noexcept { return image_sample; }
  [[nodiscard]] auto& sample(const sensor_msgs_msg_dds__PointCloud2_*) noexcept {
    return points_sample;
  }
  [[nodiscard]] DepthImage& view(const sensor_msgs_msg_dds__Image_*) noexcept { return image; }
  [[nodiscard]] PointsView& view(const sensor_msgs_msg_dds__PointCloud2_*) noexcept {
    return points;
  }
};

struct Sensors::State {
  State(std::uint32_t the_index, const Sensor& the_sensor)
      : index(the_index), sensor(the_sensor), stream({.most_pixels = the_sensor.most_points}) {
    for (std::size_t i = 0; i < kClouds; ++i)
      clouds.push_back(std::make_unique<SeenCloud>(cloud_of(sensor)));
  }
  std::uint32_t index;
  const Sensor& sensor;
  CameraStream stream;
  std::vector<std::unique_ptr<SeenCloud>> clouds;
  std::deque<std::unique_ptr<Waiting>> waiting;
  // The last image before the first CameraInfo: drivers publish the info of a frame after its
  // image.
  RawSensorMessage without_info;
  std::array<std::uint64_t, kFrameFaults> not_built{};
  SensorStatus status;
};

Sensors::Sensors(const Cell& cell, const SensorsOptions& options)
    : cell_(cell), options_(options), postures_(cell.scene), mounts_(cell, options.is_log) {
  const Scene& scene = cell.scene;
  for (std::uint32_t i = 0; i < scene.sensors.size(); ++i) {
    states_.push_back(std::make_unique<State>(i, scene.sensors[i]));
    for (const Robot& robot : scene.robots) {
      for (const RobotLink& link : robot.links) {
        if (link.object != RobotLink::kNoObject)
          states_.back()->status.own.push_back({.object = link.object});
      }
    }
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
  frame->stamp_ns = stamp_ns(sample->header);
  frame->came_ns = now_ns;
  frame->frame = frame_name(sample->header.frame_id);
  const FrameOrigin origin{frame->stamp_ns, message.sent_ns, message.writer};
  const FrameFault fault =
      state.stream.take(*sample, origin, frame->view(static_cast<const Message*>(nullptr)));
  if (fault == FrameFault::kNoCameraInfo) state.without_info = message;
  if (fault != FrameFault::kNoFault) return;
  if (state.stream.camera()) frame->camera = *state.stream.camera();
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
    } else if (sensor.topic != message.topic || is_image != (message.type == Type::kImage)) {
      continue;
    } else if (is_image) {
      add_frame<sensor_msgs_msg_dds__Image_>(message, *state, now_ns);
    } else {
      add_frame<sensor_msgs_msg_dds__PointCloud2_>(message, *state, now_ns);
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
  const auto began = std::chrono::steady_clock::now();
  SensorFrame out{.cloud = &cloud, .stamp_ns = frame.stamp_ns, .world_from_sensor = {}};
  postures_.place(frame.stamp_ns);
  const PastPose place =
      mounts_.find(state.sensor, frame.frame, frame.stamp_ns, frames_, postures_);
  FrameFault fault = place.known ? fill(state, frame, cloud) : FrameFault::kNoPlace;
  if (fault == FrameFault::kNoFault) {
    leave_out_own(state, place, cloud);
    if (cloud.size() == 0) fault = FrameFault::kNothingSeen;
  }
  if (fault != FrameFault::kNoFault) {
    ++state.not_built[static_cast<std::size_t>(fault)];
    return;
  }
  out.world_from_sensor = place.world_from_body;
  out.pose_error = place.error(state.sensor.extent());
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
}

FrameFault Sensors::fill(State& state, const Waiting& frame, SeenCloud& cloud) {
  const Sensor& sensor = state.sensor;
  if (DepthCloud* const depth = cloud.depth()) {
    const DepthBuild built =
        depth->build(frame.camera, frame.image,
                     {.constant = sensor.error_constant, .quadratic = sensor.error_quadratic},
                     {.least = sensor.least_depth, .greatest = sensor.greatest_depth});
    return built == DepthBuild::kBuilt ? FrameFault::kNoFault : FrameFault::kCannotBuild;
  }
  measured_points(frame.points, sensor, points_);
  const CloudBuild built =
      cloud.points()->build(points_, {.centre = Vec3::Zero(), .radius = sensor.extent()});
  return built == CloudBuild::kBuilt ? FrameFault::kNoFault : FrameFault::kCannotBuild;
}

// A link whose pose at the stamp is not known is not left out: its image counts as an obstacle.
void Sensors::leave_out_own(State& state, const PastPose& place, SeenCloud& cloud) {
  const Scene& scene = cell_.scene;
  auto own = state.status.own.begin();
  const double place_error = place.error(state.sensor.extent());
  for (std::uint32_t robot = 0; robot < scene.robots.size(); ++robot) {
    const std::vector<RobotLink>& links = scene.robots[robot].links;
    for (std::uint32_t link = 0; link < links.size(); ++link) {
      if (links[link].object == RobotLink::kNoObject) continue;
      OwnImage& image = *own++;
      image.elements = 0;
      image.thickness = 0.0;
      const PastPose past = postures_.link(robot, link);
      if (!past.known) continue;
      for (const Part& part : scene.objects[links[link].object].parts) {
        const double radius = part.object_from_part.position.norm() + part.shape.bounding_radius +
                              part.shape.radius + part.shape.position_error;
        const double shell = rounded_up(state.sensor.own_shell + place_error + past.error(radius));
        const Pose world_from_part = compose(past.world_from_body, part.object_from_part);
        const BlindShell blind = cloud.shelve(
            part.shape, relative_pose(world_from_part, place.world_from_body), shell, body_);
        image.elements += blind.elements;
        image.thickness = std::max(image.thickness, blind.thickness);
      }
      image.thickest = std::max(image.thickest, image.thickness);
    }
  }
  cloud.refit();
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
