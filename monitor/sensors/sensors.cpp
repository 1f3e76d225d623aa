#include "monitor/sensors/sensors.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "monitor/inputs/elapsed.hpp"
#include "monitor/intake/stamp_check.hpp"
#include "monitor/intake/tf_tree.hpp"
#include "monitor/sensors/sensor_state.hpp"
#include "monitor/wire/camera_types.hpp"
#include "monitor/wire/ros_types.hpp"

namespace clearance {

namespace {

using Type = RawSensorMessage::Type;

// This machine's clock was set back if messages come this much before the last one, ns. Batches
// wait in a queue, so smaller steps are usual.
constexpr std::int64_t kClockSetBackNs = 100'000'000;

}  // namespace

Sensors::Sensors(const Cell& cell, const SensorsOptions& options)
    : Sensors(cell, options, SourceNumbers(cell.scene)) {}
Sensors::Sensors(const Cell& cell, const SensorsOptions& options, const SourceNumbers& numbers)
    : cell_(cell),
      options_(options),
      postures_(cell.scene, numbers),
      mounts_(cell),
      own_image_(cell.scene),
      witness_(cell.scene) {
  const Scene& scene = cell.scene;
  for (std::uint32_t i = 0; i < scene.sensors.size(); ++i) {
    states_.push_back(
        std::make_unique<State>(i, scene.sensors[i], scene.objects[scene.sensors[i].object]));
    states_.back()->status.own.resize(own_image_.bodies());
    if (!scene.sensors[i].is_witness) continue;
    states_.back()->status.robots.resize(scene.robots.size());
    states_.back()->payloads.emplace(scene, scene.sensors[i]);
  }
}
Sensors::Sensors(const Cell& cell, Sensors& before, const SourceNumbers& numbers)
    : Sensors(cell, before.options_, numbers) {
  frames_ = std::move(before.frames_);
  mounts_.take_over(before.mounts_);
  now_ = before.now_;
  for (const std::unique_ptr<State>& state : states_) {
    for (const std::unique_ptr<State>& old : before.states_) {
      const Sensor &a = old->sensor, &b = state->sensor;
      if (a.name == b.name && a.topic == b.topic && a.camera_info == b.camera_info &&
          a.most_points == b.most_points && a.least_interval_ns == b.least_interval_ns) {
        state->stream = old->stream;
        state->pairing = old->pairing;
        state->own_elements = old->own_elements;
        // Without it, the first picture of a changed scene might be a torn one.
        if (a.least_depth == b.least_depth && a.greatest_depth == b.greatest_depth)
          state->seen_share = old->seen_share;
        keep_map(*old, *state);
      }
    }
  }
}
Sensors::~Sensors() = default;

// Another cell may have another place, range or mount for it.
void Sensors::keep_map(State& before, State& state) {
  if (before.map.cdr.empty() || state.sensor.kind != SensorKind::kOctomap) return;
  auto frame = std::make_unique<Waiting>();
  frame->cloud = frame_decoder(before.map.type)->decode(before.map, state.sensor, decoder_);
  if (frame->cloud == nullptr || frame->cloud->fault != FrameFault::kNoFault) return;
  frame->came_ns = now_.monotonic_ns;
  frame->stamp_ns = state.map_ns = before.map_ns;
  state.map = std::move(before.map);
  if (options_.keep) frame->message = state.map;
  state.waiting.push_back(std::move(frame));
}

// Stamps come again after this machine's clock was set back. Samples from before say nothing about
// frames from after it, and vice versa.
void Sensors::note_time(std::int64_t came_ns) {
  if (elapsed(came_ns, std::exchange(now_.realtime_ns, came_ns)) > kClockSetBackNs) forget_past();
}

void Sensors::forget_past() {
  postures_.forget();
  frames_.forget();
  mounts_.forget();
  drop_waiting();
}

void Sensors::begin_anew() {
  forget_past();
  for (const std::unique_ptr<State>& state : states_) state->stream.begin_anew();
}

bool Sensors::is_ahead(std::int64_t stamp_ns, std::int64_t came_ns) const noexcept {
  return elapsed(came_ns, stamp_ns) > cell_.scene.future_limit_ns;
}

void Sensors::add(std::span<const PoseSample> poses, std::span<const JointSample> joints,
                  std::int64_t came_ns) {
  note_time(came_ns);
  for (const JointSample& sample : joints) postures_.add(sample, came_ns);
  for (const PoseSample& sample : poses) postures_.add(sample, came_ns);
}

void Sensors::add_transforms(const RawSensorMessage& message) {
  Sample<tf2_msgs_msg_dds__TFMessage_> transforms;
  if (!decoder_.decode(message.cdr, transforms, message.bytes)) return;
  const bool is_static = message.type == Type::kStaticTransforms;
  const std::set<std::string> twice = TfFrames::placed_twice(*transforms, is_static);
  for (std::uint32_t i = 0; i < transforms->transforms._length; ++i) {
    const auto& each = transforms->transforms._buffer[i];
    const std::int64_t stamp =
        StampCheck::time_of(stamp_ns(each.header), message.sent_ns, cell_.ros.stamps,
                            options_.is_log ? OtherClock::kReplaced : OtherClock::kTold);
    if (!is_static && is_ahead(stamp, now_.realtime_ns)) continue;
    const std::string child = frame_name(each.child_frame_id);
    TfTree::Link link{.parent = frame_name(each.header.frame_id),
                      .parent_from_child = pose_of(each.transform),
                      .stamp_ns = is_static ? std::nullopt : std::optional(stamp)};
    const bool is_usable = TfFrames::is_transform(child, link) && !twice.contains(child);
    if (!is_usable || frames_.is_one_too_many(child)) continue;
    frames_.set(child, {.writer = message.writer, .is_static = is_static}, std::move(link),
                now_.monotonic_ns);
  }
  frames_.settle(now_.monotonic_ns);
  mounts_.judge(frames_, now_);
}

void Sensors::add_frame(const RawSensorMessage& message, const FrameDecoder& decoder, State& state,
                        std::int64_t now_ns) {
  ++state.status.heard;
  auto frame = std::make_unique<Waiting>();
  frame->cloud = decoder.decode(message, state.sensor, decoder_);
  if (frame->cloud == nullptr) return;
  const MessageCloud& cloud = *frame->cloud;
  frame->came_ns = now_ns;
  frame->stamp_ns = state.sensor.stamps == RosStamps::kSent ? message.sent_ns : cloud.stamp_ns;
  const FrameFault fault = state.stream.take(
      cloud, {.stamp_ns = frame->stamp_ns, .sent_ns = message.sent_ns, .writer = message.writer});
  if (cloud.image() != nullptr && fault != FrameFault::kUndecodable)
    state.pairing.take_image(cloud.stamp_ns);
  if (fault == FrameFault::kNoCameraInfo) {
    state.stream.take_back(fault);
    if (!state.without_info.cdr.empty()) ++state.not_built[static_cast<std::size_t>(fault)];
    state.without_info = message;
  }
  if (fault != FrameFault::kNoFault) return;
  frame->repeats = state.stream.has_repeated();
  if (state.stream.camera()) frame->camera = *state.stream.camera();
  if (options_.keep) frame->message = message;
  if (state.sensor.kind == SensorKind::kOctomap) {
    state.map = message;
    state.map_ns = frame->stamp_ns;
  }
  // The frames that have waited for longest stay: what they wait for comes first.
  if (state.waiting.size() == kMostWaiting) {
    state.waiting.pop_back();
    ++state.status.skipped;
  }
  state.waiting.push_back(std::move(frame));
}

// Images that wait may have been made by the camera of an info that is refused.
void Sensors::take_info(const sensor_msgs_msg_dds__CameraInfo_& info, State& state,
                        std::int64_t now_ns) {
  state.pairing.take_info(stamp_ns(info.header));
  const FrameFault fault = state.stream.take(info);
  if (fault != FrameFault::kNoFault) {
    state.not_built[static_cast<std::size_t>(fault)] += state.waiting.size();
    state.waiting.clear();
    return;
  }
  if (state.without_info.cdr.empty()) return;
  const RawSensorMessage first = std::exchange(state.without_info, {});
  add_frame(first, *frame_decoder(first.type), state, now_ns);
}

void Sensors::add(const RawSensorMessage& message, const Now& now) {
  note_time(now.realtime_ns);
  now_.monotonic_ns = now.monotonic_ns;
  if (message.type == Type::kTransforms || message.type == Type::kStaticTransforms)
    return add_transforms(message);
  const FrameDecoder* const decoder = frame_decoder(message.type);
  const std::int64_t now_ns = now.monotonic_ns;
  for (const std::unique_ptr<State>& state : states_) {
    const Sensor& sensor = state->sensor;
    const bool is_image = sensor.kind == SensorKind::kDepthImage;
    if (message.type == Type::kCameraInfo) {
      if (!is_image || sensor.camera_info != message.topic) continue;
      Sample<sensor_msgs_msg_dds__CameraInfo_> info;
      if (decoder_.decode(message.cdr, info, message.bytes)) {
        take_info(*info, *state, now_ns);
      } else {
        state->stream.refuse();
      }
    } else if (decoder != nullptr && sensor.topic == message.topic &&
               sensor.kind == decoder->kind) {
      add_frame(message, *decoder, *state, now_ns);
    }
  }
}

// All that the frame needs is there, or it has waited for long enough. Without a transform it can
// only be refused, if the mount has no stated speed: so it waits for as long as it is of use.
bool Sensors::is_ready(const State& state, const Waiting& frame, std::int64_t now_ns) const {
  const std::int64_t waited_ns = elapsed(frame.came_ns, now_ns);
  const bool has_no_transform =
      mounts_.awaits_transforms(state.sensor, frame.cloud->frame, frame.stamp_ns, frames_);
  if (has_no_transform && !state.sensor.mount_speed.is_stated())
    return waited_ns >= std::max(options_.patience_ns, state.age_limit_ns / 2);
  return waited_ns >= options_.patience_ns ||
         (!has_no_transform && postures_.covers(frame.stamp_ns) &&
          !state.pairing.is_awaited(frame.cloud->stamp_ns));
}

void Sensors::settle(std::int64_t now_ns, const IsUsed& is_used, const Use& use) {
  for (const std::unique_ptr<State>& state : states_) {
    // The newest one counts.
    std::size_t ready = 0;
    for (std::size_t i = 0; i < state->waiting.size(); ++i) {
      if (is_ready(*state, *state->waiting[i], now_ns)) ready = i + 1;
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

void Sensors::drop_waiting() noexcept {
  for (const std::unique_ptr<State>& state : states_) {
    state->status.skipped += state->waiting.size();
    state->waiting.clear();
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
