#include "monitor/dds/sensor_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <utility>

#include "config/scene/scene_map.hpp"
#include "monitor/app/log_line.hpp"
#include "monitor/inputs/elapsed.hpp"
#include "monitor/loop/realtime.hpp"
#include "monitor/sensors/attach_command.hpp"

namespace clearance {
namespace {

// Batches that wait while a frame is built: 30 ms of several sources at 1 kHz.
constexpr std::size_t kBatches = 256;
// The longest wait, ns, so that batches do not fill their ring; and while a frame waits for joints.
constexpr std::int64_t kIdleNs = 5'000'000, kFrameWaitsNs = 500'000;
// A sensor without a frame for this long after the start is reported once.
constexpr std::int64_t kSensorSilentNs = 5'000'000'000;

}  // namespace

SensorReader::SensorReader(const Cell& cell, Participant& participant, SimulatedTime* time)
    : cell_(&cell),
      participant_(participant),
      time_(time),
      frames_(cell.scene.sensors.size()),
      batches_(kBatches),
      ids_(cell.scene),
      sensors_(std::make_unique<Sensors>(cell, SensorsOptions{})),
      intake_(cell,
              {.use_sensor =
                   [this](const RawSensorMessage& message) REQUIRES(mutex_) {
                     sensors_->add(message, {time_ns(), now_ns_});
                   },
               .only_sensors = true,
               .time = time},
              [](PoseBatch&) { return true; }),
      ros_(participant, intake_),
      wait_(participant, {}),
      where_(participant.where()),
      silence_said_(cell.scene.sensors.size()),
      is_shell_thick_(cell.scene.sensors.size()),
      is_denied_(cell.scene.sensors.size(), std::vector<bool>(cell.scene.robots.size())),
      carries_(cell.scene.sensors.size()),
      last_(cell.scene.sensors.size()),
      names_(cell.scene),
      sent_(cell.scene.sensors.size()) {
  wait_.add(ros_.present().reader());
  ros_.stand();
  build();
}

SensorReader::~SensorReader() {
  stop_ = true;
  wait_.wake();
  if (thread_.joinable()) thread_.join();
}

void SensorReader::share_frames(const Topics& topics, const DaemonIdentity& identity,
                                const TickPartner& ticks) {
  const Lock lock(mutex_);
  partner_ = std::make_unique<PartnerFrames>(participant_, topics, identity, ticks);
  wait_.add(partner_->reader());
}

void SensorReader::end_sharing() {
  const Lock lock(mutex_);
  partner_ = nullptr;
}

void SensorReader::start() {
  const Lock lock(mutex_);
  if (records_ || partner_)
    sensors_->keep([this](BuiltFrame frame) REQUIRES(mutex_) { keep(std::move(frame)); });
  thread_ = std::thread([this] { run(); });
}

// Frames of the cell before are not shown any more (FrameExchange). A monitor that takes over for
// the same cell goes on with the frames in use.
void SensorReader::change(const Cell& cell) {
  const Lock lock(mutex_);
  if (&cell == cell_) return;
  SceneMap map = scene_map(cell_->scene, cell.scene);
  ids_.change(cell.scene.revision, map);
  static_cast<void>(ids_.sources().add_named(named_sources(cell.scene)));
  last_.assign(cell.scene.sensors.size(), {});
  names_ = FrameNames(cell.scene);
  carries_.assign(cell.scene.sensors.size(), {});  // what is attached now is no news
  sent_.assign(cell.scene.sensors.size(), {});
  sensors_ = std::make_unique<Sensors>(cell, *sensors_, ids_.sources());
  intake_.change(cell);
  ros_.stand();
  cell_ = &cell;
}

void SensorReader::note(const PoseBatch& batch) {
  NotedBatch* const slot = batches_.back();
  if (slot == nullptr) return;
  slot->batch = batch;
  slot->came_ns = time_ns();
  batches_.push();
}

// The cloud of the last frame is not built anew, even if the tick has refused it.
std::vector<SeenFrame> SensorReader::copies(std::uint64_t scene_revision) {
  const Lock lock(mutex_);
  std::vector<SeenFrame> seen;
  for (std::uint32_t i = 0; i < last_.size(); ++i) {
    Last& last = last_[i];
    if (last.frame.cloud == nullptr || last.scene_revision != scene_revision) continue;
    if (last.copy == nullptr) last.copy = std::make_shared<const SeenCloud>(*last.frame.cloud);
    seen.push_back({.sensor = cell_->scene.sensors[i].name,
                    .cloud = last.copy,
                    .world_from_sensor = last.frame.world_from_sensor,
                    .pose_error = last.frame.pose_error});
  }
  return seen;
}

std::vector<SensorStatus> SensorReader::statuses() const {
  const Lock lock(status_mutex_);
  return statuses_;
}

void SensorReader::run() {
  name_thread("sensors");
  SystemClock clock;
  started_ns_ = clock.monotonic_ns();
  for (std::int64_t patience = kIdleNs; !stop_;) {
    wait_.wait(patience);
    if (stop_) return;
    const Lock lock(mutex_);
    now_ns_ = clock.monotonic_ns();
    try {
      poll();
      forget_other_run();
      take_all();
      build();
      log_news();
    } catch (const DdsError& error) {
      log_line(lines::kInputsFailed, error.what());
    } catch (const std::bad_alloc&) {
      tell_of_no_memory();
    }
    const bool builds_own = !partner_ || partner_->builds_its_own(now_ns_);
    patience = builds_own && sensors_->any_waiting() ? kFrameWaitsNs : kIdleNs;
  }
}

// Makes readers for topics that have appeared.
void SensorReader::poll() {
  if (ros_.poll()) {
    std::vector<std::uint64_t> writers = ros_.writers();
    std::ranges::sort(writers);
    sensors_->keep(writers);
  }
  const std::vector<RosReaders::Reader>& readers = ros_.readers();
  for (; waited_for_ < readers.size(); ++waited_for_) wait_.add(readers[waited_for_].handle);
}

std::int64_t SensorReader::time_ns() const noexcept {
  return time_ == nullptr ? SystemClock().realtime_ns() : time_->latest_ns();
}

// Stamps of a simulation that began anew are those of another motion.
void SensorReader::forget_other_run() {
  if (time_ == nullptr || std::exchange(resets_, time_->resets()) == time_->resets()) return;
  sensors_->begin_anew();
  last_.assign(last_.size(), {});
}

// Joints and poses come first: they may be those at the stamp of a frame.
void SensorReader::take_all() {
  for (; const NotedBatch* const noted = batches_.front(); batches_.pop()) {
    poses_.clear();
    joints_.clear();
    static_cast<void>(ids_.append(noted->batch, poses_, joints_));
    sensors_->add(poses_, joints_, noted->came_ns);
  }
  const Now now{.realtime_ns = SystemClock().realtime_ns(), .monotonic_ns = now_ns_};
  for (const RosReaders::Reader& reader : ros_.readers()) ros_.take(reader, now, taken_);
  if (!partner_) return;
  const std::size_t sensors = sent_.size();
  partner_->take(
      now_ns_,
      [&](std::uint32_t sensor, std::uint64_t content) {
        if (sensor < sensors) frames_.note_built(sensor, content);
      },
      [&](BuiltFrame frame, std::uint64_t content) REQUIRES(mutex_) {
        const std::uint32_t sensor = frame.sensor;
        if (sensor < sensors) sent_[sensor] = {content, std::move(frame)};
      });
}

void SensorReader::keep(BuiltFrame frame) {
  content_ = names_.name(frame);
  if (partner_ && !is_shared_) partner_->send(frame, content_);
  if (records_) built_.put(std::move(frame));
}

bool SensorReader::is_used(const SeenCloud* cloud) const noexcept {
  return frames_.is_used(cloud) || std::ranges::any_of(last_, [cloud](const Last& last) {
           return last.frame.cloud == cloud;
         });
}

void SensorReader::use(std::uint32_t sensor, SensorFrame frame) {
  frame.content = std::exchange(content_, 0);
  if (time_ != nullptr) time_->lead(frame.stamp_ns);
  frames_.put(sensor, frame, cell_->scene.revision);
  // A follower and its leader may build the same frames in another order.
  Last& last = last_[sensor];
  const std::int64_t older_ns = elapsed(frame.stamp_ns, last.frame.stamp_ns);
  if (last.frame.cloud != nullptr && older_ns > 0 && older_ns <= kSetBackNs) return;
  last = {frame, cell_->scene.revision, nullptr};
}

void SensorReader::build_own() {
  is_shared_ = false;  // also if the last shared frame found no memory
  sensors_->settle(
      now_ns_, [this](const SeenCloud* cloud) REQUIRES(mutex_) { return is_used(cloud); },
      [this](auto sensor, const SensorFrame& frame) REQUIRES(mutex_) { use(sensor, frame); });
}

// The partner shows a frame only when the answer has come. One of another content, since earlier
// frames were missed that still count (persist), is of no use to it.
void SensorReader::build_shared() {
  is_shared_ = true;
  sensors_->drop_waiting();
  for (std::uint32_t sensor = 0; sensor < sent_.size(); ++sensor) {
    const auto in_use = [this](const SeenCloud* cloud) REQUIRES(mutex_) { return is_used(cloud); };
    if (sent_[sensor].content == 0 || !sensors_->has_room(sensor, in_use)) continue;
    const Sent sent = std::exchange(sent_[sensor], {});
    std::uint64_t built = 0;
    const bool is_built = sensors_->rebuild(
        sent.frame, in_use, [&](std::uint32_t of, const SensorFrame& frame) REQUIRES(mutex_) {
          built = content_;
          use(of, frame);
        });
    if (is_built && built == sent.content) partner_->answer(sensor, built);
  }
  is_shared_ = false;
}

void SensorReader::build() {
  if (!partner_ || partner_->builds_its_own(now_ns_)) {
    for (Sent& sent : sent_) sent.content = 0;
    build_own();
  } else {
    build_shared();
  }
  const Lock lock(status_mutex_);
  statuses_.resize(cell_->scene.sensors.size());
  for (std::uint32_t i = 0; i < statuses_.size(); ++i) statuses_[i] = sensors_->status(i);
}

// The frame that was being taken or built is gone.
void SensorReader::tell_of_no_memory() {
  constexpr std::int64_t kToldAfterNs = 1'000'000'000;
  if (no_memory_ns_ != 0 && now_ns_ - no_memory_ns_ < kToldAfterNs) return;
  no_memory_ns_ = now_ns_;
  log_line(lines::kInputsFailed, "no memory is left for a frame of a sensor, which is refused");
}

void SensorReader::log_news() {
  for (const News& news : intake_.take_news()) log_text(news.level, news.text, news.code);
  tell_of_silence();
  tell_of_shells();
  tell_of_robots();
  tell_of_payloads();
}

void SensorReader::tell_of_silence() {
  if (now_ns_ - started_ns_ < kSensorSilentNs) return;
  for (std::uint32_t i = 0; i < silence_said_.size(); ++i) {
    const SensorStatus status = sensors_->status(i);
    if (silence_said_[i] || status.frames > 0) continue;
    silence_said_[i] = true;
    const Sensor& sensor = cell_->scene.sensors[i];
    log_line(lines::kFramesSilent, sensor.name, why_silent(sensor, status));
  }
}

// Each time that a shell becomes thicker than trusted.
void SensorReader::tell_of_shells() {
  for (std::uint32_t i = 0; i < is_shell_thick_.size(); ++i) {
    const Sensor& sensor = cell_->scene.sensors[i];
    const SensorStatus status = sensors_->status(i);
    const auto thickest = std::ranges::max_element(status.own, {}, &OwnImageStatus::shell);
    const bool is_thick = thickest != status.own.end() && thickest->shell > sensor.trusted_shell;
    if (is_thick && !is_shell_thick_[i]) {
      log_line(lines::kShellThick, sensor.name, thickest->thickness,
               cell_->scene.objects[thickest->object].name);
    }
    is_shell_thick_[i] = is_thick;
  }
}

// Each time that a witness denies a robot, and when it does so no more.
void SensorReader::tell_of_robots() {
  for (std::uint32_t i = 0; i < is_denied_.size(); ++i) {
    const Sensor& sensor = cell_->scene.sensors[i];
    if (!sensor.is_witness) continue;
    const SensorStatus status = sensors_->status(i);
    for (std::size_t r = 0; r < status.robots.size(); ++r) {
      const auto& [rays, count] = status.robots[r];
      if (count.denied == is_denied_[i][r]) continue;
      is_denied_[i][r] = count.denied;
      const std::string& robot = cell_->scene.robots[r].name;
      if (count.denied) {
        log_line(lines::kRobotNotThere, sensor.name, robot, rays.through,
                 rays.through + rays.agreeing);
      } else {
        log_line(lines::kRobotThere, sensor.name, robot);
      }
    }
  }
}

// Each time that a hand carries something which is no body of the cell, and when it is gone.
void SensorReader::tell_of_payloads() {
  for (std::uint32_t i = 0; i < carries_.size(); ++i) {
    const Sensor& sensor = cell_->scene.sensors[i];
    if (!sensor.is_witness) continue;
    const SensorStatus status = sensors_->status(i);
    carries_[i].resize(status.payloads.size());
    for (std::size_t k = 0; k < status.payloads.size(); ++k) {
      const UnknownPayload& payload = status.payloads[k];
      if (payload.is_held == carries_[i][k]) continue;
      carries_[i][k] = payload.is_held;
      const std::string& link = cell_->scene.robots[payload.robot].links[payload.link].name;
      const auto& [at, size] = payload.box;
      if (payload.is_held) {
        log_line(lines::kCarriesSomething, sensor.name, link,
                 1e-9 * static_cast<double>(status.stamp_ns - payload.since_ns), size.x(), size.y(),
                 size.z(), at.x(), at.y(), at.z(), attach_command(*cell_, payload));
      } else {
        log_line(lines::kCarriesNothing, sensor.name, link);
      }
    }
  }
}

std::string SensorReader::why_silent(const Sensor& sensor, const SensorStatus& status) const {
  std::uint64_t refused = 0;
  for (std::size_t fault = 1; fault < kFrameFaults; ++fault) refused += status.counts[fault];
  if (refused > 0) {
    return fmt::format("{} of its messages were refused, as health lists{}{}", refused,
                       status.robot_elsewhere.empty() ? "" : "; ", status.robot_elsewhere);
  }
  for (const std::string& topic : {sensor.topic, sensor.camera_info}) {
    if (topic.empty()) continue;
    const std::string name = ros_dds_name(topic);
    const auto& writers = ros_.present().writers();
    const auto writer = std::ranges::find_if(
        writers, [&](const auto& entry) { return entry.second.topic == name; });
    if (writer == writers.end())
      return fmt::format("there is no publisher of {} {}", name, ros_.present().instead_on(where_));
    const std::string& partition = writer->second.partition;
    if (topic == sensor.topic && status.counts[0] == 0) {
      return fmt::format("{} is published in {} as {}, and no message has come", name,
                         partition.empty() ? "the default partition" : "partition " + partition,
                         writer->second.type);
    }
  }
  return "no image has come since its CameraInfo";
}

}  // namespace clearance
