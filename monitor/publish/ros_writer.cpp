#include "monitor/publish/ros_writer.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "monitor/app/log.hpp"
#include "monitor/app/log_line.hpp"
#include "monitor/loop/realtime.hpp"
#include "monitor/visual/cell_markers.hpp"
#include "monitor/wire/convert.hpp"

namespace clearance {
namespace {

// Slots for reports and numbers: the thread waits for a full send buffer now and then.
constexpr std::size_t kReports = 2, kNumbers = 64;
// Lines of the log that may wait for a second.
constexpr std::size_t kLines = 256;
constexpr std::int64_t kSecondNs = 1'000'000'000;
// A viewer that has dropped its markers gets the bodies again.
constexpr std::int64_t kBodiesAgainNs = 10'000'000'000;
// Diagnostics need the last report before each second's end.
constexpr double kDiagnosticReportsHz = 10.0;

// Returns 0 when the cell does not ask for this topic.
dds_entity_t make_writer(Participant& participant, const RosType& type, const std::string& topic) {
  return topic.empty() ? 0 : participant.ros_writer(type, ros_dds_name(topic));
}

// Zones and stops define the scaling of speeds: without any, 1 would say that everything is clear.
dds_entity_t make_speed_scaling_writer(Participant& participant, const Cell& cell) {
  const std::string& topic = cell.ros.outputs.speed_scaling;
  if (topic.empty() || !cell.scene.zones.empty() || separated_count(cell.scene).any())
    return make_writer(participant, kRosFloat64, topic);
  log_line(lines::kNoSpeedScaling, topic);
  return 0;
}

// Returns the smallest scaling that separation monitoring and stops ask for. Without these, zones
// switch between two speeds: 0 if any zone is active, otherwise 1. It is 0 while a
// pair is unknown or overlaps, because that makes its zone active.
double speed_scaling(const Report& report) noexcept {
  double least = 1.0;
  for (const ZoneSeparation& zone : report.separated_zones) least = std::min(least, zone.scaling);
  for (const RobotStop& stop : report.stops) least = std::min(least, stop.scaling);
  if (!report.separated_zones.empty() || !report.stops.empty()) return least;
  return std::ranges::any_of(report.zones, &ZoneReport::active) ? 0.0 : 1.0;
}

// Levels of rcl_interfaces/msg/Log.
std::uint8_t ros_level(LogLevel level) noexcept {
  constexpr std::uint8_t kInfo = 20, kWarn = 30, kError = 40;
  return level == LogLevel::kInfo ? kInfo : level == LogLevel::kWarn ? kWarn : kError;
}

}  // namespace

bool writes_ros(const Cell& cell) noexcept {
  return std::ranges::any_of(kRosOutputs, [&](const RosOutput& output) {
    return output.topic != &RosOutputs::messages && !(cell.ros.outputs.*output.topic).empty();
  });
}

RosWriter::RosWriter(const Cell& cell, Participant& participant, MakeHealth make_health,
                     RosWrites::Leads leads)
    : scene_(cell.scene),
      settings_(cell.ros),
      make_health_(std::move(make_health)),
      markers_(make_writer(participant, kRosMarkers, cell.ros.outputs.markers)),
      diagnostics_(make_writer(participant, kRosDiagnostics, cell.ros.outputs.diagnostics)),
      minimum_distance_(make_writer(participant, kRosFloat64, cell.ros.outputs.minimum_distance)),
      speed_scaling_(make_speed_scaling_writer(participant, cell)),
      planning_scene_(
          make_writer(participant, kRosMonitoredScene, cell.ros.outputs.monitored_planning_scene)),
      log_(make_writer(participant, kRosLog, cell.ros.outputs.log)),
      queue_(cell.scene, {.reports = kReports}),
      numbers_(kNumbers),
      period_ns_(std::llround(1e9 / (markers_ != 0 ? cell.ros.markers_hz : kDiagnosticReportsHz))),
      cell_diagnostics_(cell.scene),
      distances_(make_distances(cell.scene)),
      writes_(std::move(leads)) {
  if (planning_scene_ != 0) unwritten_scene_ = to_wire(monitored_scene(cell));
  scene_waits_ = planning_scene_ != 0;
  if (log_ != 0) keep_lines(kLines);
  thread_ = std::thread([this] { run(); });
}

// Each cell has writers of its own, and a late reader gets no scene of a cell before.
RosWriter::~RosWriter() {
  finish();
  for (const dds_entity_t writer :
       {markers_, diagnostics_, minimum_distance_, speed_scaling_, planning_scene_, log_}) {
    if (writer != 0) dds_delete(writer);
  }
}

void RosWriter::finish() {
  if (!thread_.joinable()) return;
  stop_ = true;
  queue_.close();
  thread_.join();
}

void RosWriter::report(const Report& report, std::span<const SourceUse> sources) noexcept {
  if (minimum_distance_ != 0 || speed_scaling_ != 0) {
    if (Numbers* const slot = numbers_.back()) {
      *slot = {.minimum_distance = report.lower_all, .speed_scaling = speed_scaling(report)};
      numbers_.push();
      queue_.wake();
    }
  }
  if (markers_ == 0 && diagnostics_ == 0 && !scene_waits_) return;
  if (report.now_ns < next_ns_ && next_ns_ - report.now_ns <= period_ns_) return;
  next_ns_ = report.now_ns + period_ns_;
  queue_.report(report, sources);
}

void RosWriter::statistics(const LoopStatistics& statistics) noexcept {
  if (diagnostics_ != 0 || log_ != 0) queue_.statistics(statistics);
}

void RosWriter::run() {
  name_thread("ros");
  // No safety depends on this thread: it needs no priority.
  if (const Refusal refusal = use_fifo_scheduling(0)) log_line(lines::kSystemRefuses, *refusal);
  for (;;) {
    queue_.wait();
    write_log();
    if (stop_) return;
    write_numbers();
    while (const QueuedReport* queued = queue_.reports().front()) {
      last_ = queued->report;
      const bool leads = writes_.may_write();
      if (unwritten_scene_ && leads) {
        writes_.write(planning_scene_, &**unwritten_scene_);
        unwritten_scene_.reset();
        scene_waits_ = false;
      }
      if (markers_ != 0 && leads) write_markers(*queued);
      queue_.reports().pop();
    }
    while (const LoopStatistics* statistics = queue_.statistics().front()) {
      write_diagnostics(*statistics);
      queue_.statistics().pop();
    }
  }
}

void RosWriter::write_numbers() {
  const bool leads = writes_.may_write();
  while (const Numbers* numbers = numbers_.front()) {
    const std_msgs_msg_dds__Float64_ distance{numbers->minimum_distance};
    const std_msgs_msg_dds__Float64_ scaling{numbers->speed_scaling};
    numbers_.pop();
    if (!leads) continue;
    if (minimum_distance_ != 0) writes_.write(minimum_distance_, &distance);
    if (speed_scaling_ != 0) writes_.write(speed_scaling_, &scaling);
  }
}

// Writes bodies when a reader comes, and now and then: the topic is volatile, as viewers expect.
void RosWriter::write_markers(const QueuedReport& queued) {
  dds_publication_matched_status_t readers{};
  dds_get_publication_matched_status(markers_, &readers);
  bodies_due_ = bodies_due_ || readers.total_count_change > 0;
  if (readers.current_count == 0) return;
  const std::int64_t now_ns = queued.handed_over_ns;
  if (bodies_due_ || std::abs(now_ns - bodies_written_ns_) >= kBodiesAgainNs) {
    if (!bodies_) bodies_ = bodies_message_for_tf(scene_, settings_.world());
    writes_.write(markers_, &**bodies_);
    bodies_written_ns_ = now_ns;
    bodies_due_ = false;
  }
  to_wire(queued.report, queued.sources(), 0, *distances_);
  const std::int64_t stamp_ns = queued.report.now_ns + queued.report.clock_offset_ns;
  writes_.write(markers_, &*closest_message(scene_, *distances_, stamp_ns, settings_.world()));
}

// Each of two partners has a log of its own.
void RosWriter::write_log() {
  if (log_ == 0) return;
  for (const LoggedLine& line : kept_lines()) {
    rcl_interfaces_msg_dds__Log_ message{};
    message.stamp = {.sec = static_cast<std::int32_t>(line.time_ns / kSecondNs),
                     .nanosec = static_cast<std::uint32_t>(line.time_ns % kSecondNs)};
    message.level = ros_level(line.level);
    std::string name = log_name(), none, text = line.text;
    message.name = name.data();
    message.msg = text.data();
    message.file = message.function = none.data();
    writes_.write(log_, &message);
  }
}

void RosWriter::write_diagnostics(const LoopStatistics& statistics) {
  if (diagnostics_ == 0) return;
  const auto health = make_health_(statistics);
  if (!health) return;
  const std::int64_t stamp_ns = (**health).now_ns + (**health).clock_offset_ns;
  const auto sample = cell_diagnostics_.make(**health, last_, stamp_ns);
  if (writes_.may_write()) writes_.write(diagnostics_, &*sample);
}

}  // namespace clearance
