#include "tools/view/recording_source.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <vector>

#include "monitor/loop/ports.hpp"
#include "tools/view/channels.hpp"
#include "tools/view/sensors_json.hpp"

namespace clearance::view {
namespace {

constexpr double kSlowest = 0.01, kFastest = 100.0;

}  // namespace

RecordingSource::RecordingSource(std::shared_ptr<const Cell> cell,
                                 std::unique_ptr<SceneHistory> scenes, std::filesystem::path file,
                                 Timeline timeline)
    : first_(std::move(cell)),
      cell_(first_),
      scenes_(std::move(scenes)),
      file_(std::move(file)),
      timeline_(std::move(timeline)),
      frame_(std::make_unique<Frame>(cell_->scene)),
      sensors_(file_),
      time_ns_(timeline_.begin_ns) {
  sensors_.change(*cell_);
}

std::string RecordingSource::history(double end_s, double width_s,
                                     std::span<const std::uint32_t> pairs) const {
  return timeline_.history.window(at(end_s), std::llround(1e9 * width_s), cell_->scene, pairs);
}

const SceneSince* RecordingSource::scene_now() const {
  const auto after = std::ranges::upper_bound(timeline_.scenes, time_ns_, {}, &SceneSince::log_ns);
  return after == timeline_.scenes.begin() ? nullptr : &*std::prev(after);
}

// The cell that was in force at this time, if the recording has it.
void RecordingSource::follow_the_time() {
  const SceneSince* const now = scene_now();
  const bool is_recorded = timeline_.scenes.front().revision == first_->scene.revision;
  if (now == nullptr || !is_recorded) return;
  const std::uint64_t revision = now->revision;
  if (revision == cell_->scene.revision) return;
  const Cell* const cell = scenes_->cell(revision);
  if (cell == nullptr) return;
  // The history owns it, and the first one is ours.
  cell_ = cell == first_.get() ? first_ : std::shared_ptr<const Cell>(first_, cell);
  frame_ = std::make_unique<Frame>(cell_->scene);
  sensors_.change(*cell_);
  place_.forget();
  changed_ = true;
}

// A rounded time, from a link for instance, still finds its report.
std::int64_t RecordingSource::at(double seconds) const {
  constexpr std::int64_t kRoundedNs = 1'000;
  const double ns =
      std::clamp(1e9 * seconds, 0.0, static_cast<double>(timeline_.end_ns - timeline_.begin_ns));
  const std::int64_t time_ns = timeline_.begin_ns + std::llround(ns);
  const auto next = std::ranges::lower_bound(timeline_.reports, time_ns);
  const bool is_next = next != timeline_.reports.end() && *next - time_ns <= kRoundedNs;
  return is_next ? *next : time_ns;
}

nlohmann::json RecordingSource::parameters() const {
  const double seconds = 1e-9 * static_cast<double>(time_ns_ - timeline_.begin_ns);
  const SceneSince* const now = scene_now();
  return {{{"name", "scene.attached"},
           {"value", now == nullptr ? nlohmann::json::array() : attached_json(now->attached)}},
          {{"name", "playback.playing"}, {"value", playing_}},
          {{"name", "playback.time"}, {"value", seconds}},
          {{"name", "playback.rate"}, {"value", rate_}}};
}

void RecordingSource::set(const std::string& name, const nlohmann::json& value) {
  if (name == "playback.playing" && value.is_boolean()) {
    playing_ = value;
    // Playing from the end begins at the start.
    if (playing_ && time_ns_ >= timeline_.end_ns) time_ns_ = timeline_.begin_ns;
  } else if (name == "playback.time" && value.is_number()) {
    time_ns_ = at(value);
  } else if (name == "playback.rate" && value.is_number()) {
    rate_ = std::clamp(value.get<double>(), kSlowest, kFastest);
  } else if (name == "playback.step" && value.is_number()) {
    playing_ = false;
    step(std::llround(std::clamp(value.get<double>(), -1e6, 1e6)));
  }
  changed_ = true;
}

void RecordingSource::step(std::int64_t reports) {
  const auto& times = timeline_.reports;
  const auto here = std::ranges::upper_bound(times, time_ns_) - times.begin() - 1;
  const auto there =
      std::clamp<std::int64_t>(here + reports, 0, static_cast<std::int64_t>(times.size()) - 1);
  time_ns_ = times[static_cast<std::size_t>(there)];
}

void RecordingSource::advance(Server& server) {
  go_on(SystemClock().monotonic_ns());
  follow_the_time();
  read_up_to(time_ns_);
  server.set_time(time_ns_);
  frame_->publish(server);
  if (server.is_wanted(kSeen)) show_what_is_seen(server);
  if (std::exchange(changed_, false)) server.parameters_changed();
}

void RecordingSource::show_what_is_seen(Server& server) {
  std::vector<Message> shown;
  sensors_.show(
      time_ns_, [&](std::uint32_t sensor, std::int64_t stamp_ns, std::span<const std::byte> cdr) {
        shown.push_back({kSeen, sensor, stamp_ns,
                         std::make_shared<const std::vector<std::byte>>(cdr.begin(), cdr.end())});
      });
  if (sensors_.have_begun_anew()) server.forget(kSeen);
  for (Message& message : shown) server.publish(std::move(message));
}

std::string RecordingSource::sensors() const { return sensors_json(sensors_.states()); }

void RecordingSource::go_on(std::int64_t steady_ns) {
  const std::int64_t passed = steady_ns - std::exchange(steady_ns_, steady_ns);
  if (!playing_) return;
  time_ns_ += std::llround(static_cast<double>(passed) * rate_);
  if (time_ns_ < timeline_.end_ns) return;
  time_ns_ = timeline_.end_ns;
  playing_ = false;
  changed_ = true;
}

void RecordingSource::read_up_to(std::int64_t time_ns) {
  if (const auto window = place_.go_to(time_ns)) begin_reading(*window);
  while (has_next_ && next_.log_ns <= time_ns) {
    frame_->take(next_.kind, next_.log_ns, next_.cdr);
    has_next_ = reader_->next(next_);
  }
}

// A zone's state is recorded only when it changes. So the earlier zone messages are taken first:
// the last state of each zone is the one that holds where the window begins.
void RecordingSource::begin_reading(const McapWindow& window) {
  reader_ = std::make_unique<RecordingReader>(file_, window);
  frame_->jump();
  for (const ZoneMessage& message : timeline_.zone_messages) {
    if (message.log_ns >= static_cast<std::int64_t>(window.start_ns)) break;
    frame_->take(TopicKind::kZones, message.log_ns, message.cdr);
  }
  has_next_ = reader_->next(next_);
}

}  // namespace clearance::view
