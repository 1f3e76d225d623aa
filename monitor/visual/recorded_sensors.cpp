#include "monitor/visual/recorded_sensors.hpp"

#include <algorithm>

#include "monitor/replay/side_feed.hpp"
#include "monitor/sensors/sensors.hpp"

namespace clearance {
RecordedSensors::RecordedSensors(std::filesystem::path file) : file_(std::move(file)) {}
RecordedSensors::~RecordedSensors() = default;

void RecordedSensors::change(const Cell& cell) {
  cell_ = &cell;
  seen_ = cell.scene.sensors.empty() ? nullptr : std::make_unique<SeenFrames>(cell, true);
  place_.forget();
}

void RecordedSensors::show(std::int64_t time_ns, const SeenFrames::Use& use) {
  if (seen_ == nullptr) return;
  for (const BuiltFrame& frame : frames_until(time_ns)) seen_->show(frame, use);
}

// Speckle that a frame hides depends on the frames before it, so some of each sensor are built.
std::vector<BuiltFrame> RecordedSensors::frames_until(std::int64_t time_ns) {
  if (const auto window = place_.go_to(time_ns)) {
    feed_ = std::make_unique<FrameFeed>(std::vector{file_}, *window);
    anew_ = true;
  }
  const std::vector<Sensor>& sensors = cell_->scene.sensors;
  std::vector<BuiltFrame> found;
  for (; feed_->front() != nullptr && feed_->front_ns() <= time_ns; feed_->pop()) {
    if (feed_->front()->sensor < sensors.size()) found.push_back(from_wire(*feed_->front()));
  }
  std::vector<std::uint32_t> newer(sensors.size());
  for (auto frame = found.rbegin(); frame != found.rend(); ++frame) {
    if (newer[frame->sensor]++ >= sensors[frame->sensor].persist_of) frame->scene_revision = 0;
  }
  std::erase_if(found, [](const BuiltFrame& frame) { return frame.scene_revision == 0; });
  return found;
}

std::vector<SeenState> RecordedSensors::states() const {
  return seen_ ? seen_->states() : std::vector<SeenState>();
}

}  // namespace clearance
