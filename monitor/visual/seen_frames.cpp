#include "monitor/visual/seen_frames.hpp"

#include <limits>

#include "monitor/intake/frame_decoders.hpp"
#include "monitor/sensors/sensors.hpp"
#include "monitor/visual/seen_points.hpp"

namespace clearance {
namespace {

// The clock of a viewer's machine may be behind the others: no stamp is ahead of this time.
constexpr std::int64_t kAnyTime = std::numeric_limits<std::int64_t>::max();

// Maps come seldom, and may be small parts of messages about something else.
bool is_frequent(const RawSensorMessage& message) {
  const FrameDecoder* const decoder = frame_decoder(message.type);
  return decoder != nullptr && decoder->kind != SensorKind::kOctomap;
}

}  // namespace

SeenFrames::SeenFrames(const Cell& cell, bool is_log)
    : cell_(&cell),
      numbers_(cell.scene),
      sensors_(std::make_unique<Sensors>(cell, SensorsOptions{.is_log = is_log})),
      shown_(cell.scene.sensors.size()) {}
SeenFrames::~SeenFrames() = default;

void SeenFrames::change(const Cell& cell) {
  numbers_ = SourceNumbers(cell.scene);
  sensors_ = std::make_unique<Sensors>(cell, *sensors_, numbers_);
  shown_.assign(cell.scene.sensors.size(), {});
  cell_ = &cell;
}

void SeenFrames::hear(const PoseBatch& batch) {
  poses_.clear();
  joints_.clear();
  numbers_.append(batch, poses_, joints_);
  sensors_->add(poses_, joints_, kAnyTime);
}

void SeenFrames::hear(const RawSensorMessage& message, std::int64_t now_ns) {
  if (is_frequent(message)) {
    const auto [last, is_first] = heard_ns_.try_emplace(message.topic, now_ns);
    const std::int64_t since = now_ns - last->second;
    if (!is_first && since >= 0 && since < kLeastIntervalNs) return;
    last->second = now_ns;
  }
  sensors_->add(message, {.realtime_ns = kAnyTime, .monotonic_ns = now_ns});
}

void SeenFrames::keep(std::span<const std::uint64_t> writers) { sensors_->keep(writers); }

// A cloud is read before the next one is built, so none is in use.
void SeenFrames::settle(std::int64_t now_ns, const Use& use) {
  sensors_->settle(
      now_ns, [](const SeenCloud*) { return false; },
      [&](std::uint32_t sensor, const SensorFrame& frame) { hand_on(sensor, frame, use); });
}

void SeenFrames::show(const BuiltFrame& built, const Use& use) {
  static_cast<void>(sensors_->rebuild(
      built, [](const SeenCloud*) { return false; },
      [&](std::uint32_t sensor, const SensorFrame& frame) { hand_on(sensor, frame, use); }));
}

void SeenFrames::hand_on(std::uint32_t sensor, const SensorFrame& frame, const Use& use) {
  shown_[sensor] = {frame.stamp_ns, frame.world_from_sensor};
  const auto message = seen_points_message(*frame.cloud, frame.world_from_sensor, sensor,
                                           frame.stamp_ns, kMostPoints);
  use(sensor, frame.stamp_ns, encoder_.encode(*message));
}

std::vector<SeenState> SeenFrames::states() const {
  std::vector<SeenState> all;
  for (std::uint32_t i = 0; i < shown_.size(); ++i) {
    const SensorStatus status = sensors_->status(i);
    SeenState& state = all.emplace_back();
    state.object = cell_->scene.sensors[i].object;
    state.stamp_ns = shown_[i].stamp_ns;
    state.world_from_sensor = shown_[i].world_from_sensor;
    state.elements = status.elements;
    state.frames = status.frames;
    for (std::size_t cause = 1; cause < status.counts.size(); ++cause) {
      if (status.counts[cause] > 0)
        state.refused.emplace_back(text(static_cast<FrameFault>(cause)), status.counts[cause]);
    }
    for (const auto& image : status.own) {
      if (image.elements > 0) state.shells.emplace_back(image.object, image.thickness);
    }
  }
  return all;
}

}  // namespace clearance
