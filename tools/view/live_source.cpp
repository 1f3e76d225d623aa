#include "tools/view/live_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <string>
#include <thread>
#include <utility>
#include <variant>

#include "monitor/loop/ports.hpp"
#include "monitor/participant/question_message.hpp"
#include "monitor/wire/report_checksum.hpp"
#include "tools/view/sensors_json.hpp"

namespace clearance::view {
namespace {

// Without a report for this long, the daemon or the machine hangs. clearance-watch uses the same
// time.
constexpr std::int64_t kSilentNs = 1'000'000'000;

// Two faulty reports within this time are not forgotten while a page is open.
constexpr std::int64_t kErrorsNs = 3'600'000'000'000;

// Readers stay for this time after the last viewer has gone, because a page may be loaded again.
constexpr std::int64_t kLingerNs = 2'000'000'000;

// The first report comes within this time after its reader was made, if there is a daemon.
constexpr std::int64_t kFirstReportNs = 500'000'000;

// Topics whose every message is complete are read only while there is a viewer. The last pose must
// not be missed, because an object that seldom moves sends it once.
constexpr std::array kOnDemand = {TopicKind::kDistances, TopicKind::kSeparation,
                                  TopicKind::kGradients};

// Messages of a client; only the last one is shown.
constexpr std::int32_t kQuestionsKept = 8;

// Reports of two partners that are compared: those of 30 ms at 1 kHz.
constexpr std::int32_t kReportsCompared = 64;

// A reader of reports needs no more than the newest of each 1/60 s. A reader of poses needs as many
// as a source sends meanwhile, since the report names the batch that it used.
std::int32_t depth_of(TopicKind kind) {
  return kind == TopicKind::kPoses || kind == TopicKind::kJointStates ? 32 : 1;
}

}  // namespace

LiveSource::LiveSource(std::shared_ptr<const Cell> cell, const DdsOptions& dds)
    : cell_(std::move(cell)),
      topics_(cell_->topics),
      participant_(dds),
      seen_(cell_->scene.sensors.empty() ? nullptr : std::make_unique<SeenFrames>(*cell_, false)),
      frame_(make_frame()),
      questions_(participant_.reader(TopicKind::kQuestions, topics_.questions, kQuestionsKept)),
      answers_(participant_.reader(TopicKind::kAnswers, topics_.answers, kQuestionsKept)),
      intake_(*cell_, {.use_sensor = [this](const RawSensorMessage& message) { hear(message); }},
              [this](PoseBatch& batch) {
                frame_->take_from_ros(std::move(batch));
                return true;
              }),
      ros_(participant_, intake_),
      judge_({.old_after_ns = kSilentNs, .period_ns = kSilentNs, .error_interval_ns = kErrorsNs},
             participant_.address(topics_.distances)) {
  for (const Topic& topic : kRecordedTopics) {
    if (std::ranges::find(kOnDemand, topic.kind) == kOnDemand.end()) join(topic.kind);
  }
}

std::unique_ptr<Frame> LiveSource::make_frame() {
  return std::make_unique<Frame>(cell_->scene, [this](const PoseBatch& batch) {
    if (seen_) seen_->hear(batch);
  });
}

// Images are large: they are decoded only while a viewer shows them.
void LiveSource::hear(const RawSensorMessage& message) {
  const bool is_transform = message.type == RawSensorMessage::Type::kTransforms ||
                            message.type == RawSensorMessage::Type::kStaticTransforms;
  if (seen_ && (is_transform || is_seen_wanted_))
    seen_->hear(message, SystemClock().monotonic_ns());
}

void LiveSource::show_what_is_seen(Server& server, std::int64_t steady_ns) {
  seen_->settle(steady_ns, [&server](std::uint32_t sensor, std::int64_t stamp_ns,
                                     std::span<const std::byte> cdr) {
    server.publish({kSeen, sensor, stamp_ns,
                    std::make_shared<const std::vector<std::byte>>(cdr.begin(), cdr.end())});
  });
}

std::string LiveSource::sensors() const {
  return sensors_json(seen_ ? seen_->states() : std::vector<SeenState>());
}

void LiveSource::advance(Server& server) {
  const std::int64_t steady_ns = SystemClock().monotonic_ns();
  if (server.viewers() > 0) watched_ns_ = steady_ns;
  if (steady_ns - watched_ns_ > kLingerNs) return leave(server);
  for (const TopicKind kind : kOnDemand) {
    if (kind == TopicKind::kDistances || server.is_wanted(channel(kind))) join(kind);
  }
  take_all(steady_ns);
  const std::int64_t now_ns = SystemClock().realtime_ns();
  take_questions(server);
  note_the_catalogue();
  follow_the_catalogue(server);
  note_what_is_attached(server);
  server.set_time(now_ns);
  frame_->publish(server);
  tell_of_the_daemon(server, now_ns, steady_ns);
  is_seen_wanted_ = server.is_wanted(kSeen);
  if (seen_) show_what_is_seen(server, steady_ns);
}

void LiveSource::take_all(std::int64_t steady_ns) {
  for (const Topic& topic : kRecordedTopics) take(topic.kind, steady_ns);
  take_from_ros({.realtime_ns = SystemClock().realtime_ns(), .monotonic_ns = steady_ns});
}

// Waits, in its first call, for a report and its poses. If the daemon is silent, the answer is that
// nothing is known.
std::string LiveSource::distance(std::uint32_t a, std::uint32_t b) {
  SystemClock clock;
  watched_ns_ = clock.monotonic_ns();
  join(TopicKind::kDistances);
  const bool is_first = !heard_;
  const auto is_placed = [this](std::uint32_t object) {
    return object >= cell_->scene.objects.size() || frame_->poses().age_ns(object) >= 0;
  };
  for (std::int64_t now_ns = watched_ns_;; now_ns = clock.monotonic_ns()) {
    take_all(now_ns);
    frame_->use_report();
    const bool waits = is_first && !(heard_ && is_placed(a) && is_placed(b));
    if (!waits || now_ns - watched_ns_ > kFirstReportNs) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  const bool is_known = heard_ && judge_.error(clock.monotonic_ns()) == ReportError::kGood &&
                        clock.realtime_ns() - frame_->report_time_ns() <= kSilentNs;
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  return frame_->distance_json(is_known ? a : kNone, is_known ? b : kNone);
}

void LiveSource::join(TopicKind kind) {
  dds_entity_t& reader = readers_[index(kind)];
  if (reader != 0) return;
  reader = participant_.reader(kind, topics_.*topic(kind).name, depth_of(kind));
}

// The next viewer must not be shown an old report. The last one to close the page acknowledges.
void LiveSource::leave(Server& server) {
  for (const TopicKind kind : kOnDemand) {
    dds_entity_t& reader = readers_[index(kind)];
    if (reader == 0) continue;
    check_dds(dds_delete(std::exchange(reader, 0)), "deleting a reader");
    server.forget(channel(kind));
  }
  server.forget(kTransforms);
  server.forget(kClosest);
  server.forget(kSeen);
  heard_ = false;
  is_merging_ = has_looked_ = false;
  merged_ = {};
  judge_.acknowledge();
  refused_.clear();
  for (const char* status : {"daemon", "partners", "refused"}) server.set_status(status, 0, "");
}

// The bytes as they came, if they are as the daemon wrote them.
void LiveSource::take(TopicKind kind, std::int64_t steady_ns) {
  const dds_entity_t reader = readers_[index(kind)];
  if (reader == 0) return;
  while (take_cdr(reader, taken_) == kMostAtOnce) {
  }
  const bool are_reports = kind == TopicKind::kDistances;
  const bool begins_merging = are_reports && !is_merging_ && are_all_needed(reader);
  is_merging_ = is_merging_ || begins_merging;
  if (are_reports && taken_.size() >= kReportsCompared) merged_.note_loss(steady_ns);
  for (const CdrSample& sample : taken_) {
    if (is_shown(kind, sample, steady_ns)) frame_->take(kind, sample.source_ns(), sample.bytes());
  }
  heard_ = heard_ || (are_reports && !taken_.empty());
  taken_.clear();
  if (begins_merging) merge(steady_ns);
}

// Only the first report of a daemon that is alone is decoded for this, and one after reports that
// lacked pairs were shown: it may have been started again with other options.
bool LiveSource::are_all_needed(dds_entity_t reader) {
  if (taken_.empty()) return false;
  const bool is_known = std::exchange(has_looked_, true) && !frame_->lacks_pairs();
  if (is_known && writers_alive(reader) < 2) return false;
  return decoder_.decode(taken_.back().bytes(), report_, CdrBytes::kOfReader) &&
         (*report_->partner != '\0' || report_->changes_since != 0);
}

// Both reports of a cycle, and all of what changed, are needed from now on: not only the newest.
void LiveSource::merge(std::int64_t steady_ns) {
  dds_entity_t& reader = readers_[index(TopicKind::kDistances)];
  check_dds(dds_delete(reader), "deleting a reader");
  reader = participant_.reader(TopicKind::kDistances, topics_.distances, kReportsCompared);
  merged_.note_loss(steady_ns);
}

bool LiveSource::is_shown(TopicKind kind, const CdrSample& sample, std::int64_t steady_ns) {
  switch (kind) {
    case TopicKind::kDistances:
      return is_good(sample, steady_ns);
    case TopicKind::kHealth:
      return is_sound(kind, sample, health_) && (!is_merging_ || merged_.take(*health_, steady_ns));
    case TopicKind::kZones:
      return is_sound(kind, sample, zone_);
    case TopicKind::kCatalogue:
      return is_sound(kind, sample, catalogue_);
    case TopicKind::kSeparation:
      return is_sound(kind, sample, separation_);
    case TopicKind::kGradients:
      return is_sound(kind, sample, gradients_);
    default:
      return true;  // written by others than the daemon
  }
}

bool LiveSource::is_good(const CdrSample& sample, std::int64_t steady_ns) {
  if (!decoder_.decode(sample.bytes(), report_, CdrBytes::kOfReader)) return false;
  const ReportError error = judge_.refuse(*report_, steady_ns);
  bool is_next = error == ReportError::kGood;
  if (is_merging_ && (is_next || error == ReportError::kCorrupt))
    is_next = merged_.take(*report_, steady_ns, is_next);
  if (is_next) static_cast<void>(judge_.check(*report_, SystemClock().realtime_ns(), steady_ns));
  return is_next;
}

template <class Message>
bool LiveSource::is_sound(TopicKind kind, const CdrSample& sample, Sample<Message>& message) {
  const std::string& name = topics_.*topic(kind).name;
  if (!decoder_.decode(sample.bytes(), message, CdrBytes::kOfReader)) return false;
  const ReportError error = delivery_error(*message, participant_.address(name));
  if (error == ReportError::kGood) return true;
  client::RefusedMessages& refused = refused_[kind];
  refused = {.count = refused.count + 1, .last = error, .topic = name};
  return false;
}

// Takes messages of ROS 2 as the daemon does (dds/pose_reader.cpp). News is dropped here, because
// the daemon's log has it.
void LiveSource::take_from_ros(const Now& now) {
  if (!intake_.hears_ros()) return;
  if (ros_.poll()) {
    std::vector<std::uint64_t> writers = ros_.writers();
    intake_.keep(writers);
    std::ranges::sort(writers);
    if (seen_) seen_->keep(writers);
  }
  for (const RosReaders::Reader& reader : ros_.readers()) {
    ros_.take(reader, now, taken_);
  }
  intake_.settle(now);
  static_cast<void>(intake_.take_news());
}

void LiveSource::take_questions(Server& server) {
  take_cdr(questions_, taken_);
  for (const CdrSample& sample : std::exchange(taken_, {})) {
    Sample<clearance_msg_Question> message;
    if (!decoder_.decode(sample.bytes(), message, CdrBytes::kOfReader)) continue;
    const auto read = from_wire(*message);
    const auto* question = std::get_if<MotionQuestion>(&read);
    if (question != nullptr && asked_.take(*question, frame_->poses())) server.parameters_changed();
  }
  take_cdr(answers_, taken_);
  for (const CdrSample& sample : std::exchange(taken_, {})) {
    Sample<clearance_msg_Answer> message;
    if (!decoder_.decode(sample.bytes(), message, CdrBytes::kOfReader)) continue;
    if (asked_.take(from_wire(*message), frame_->poses())) server.parameters_changed();
  }
}

// Reading may take long where meshes are new, so that a thread does it.
void LiveSource::follow_the_catalogue(Server& server) {
  const clearance_msg_Catalogue& catalogue = frame_->catalogue();
  const std::uint64_t now = catalogue.scene_revision;
  if (now != 0 && now != cell_->scene.revision && now != read_ && !reading_.valid()) {
    read_ = now;
    reading_ =
        std::async(std::launch::async, [yaml = std::string(catalogue.cell_yaml),
                                        file = cell_->file] { return parse_cell(yaml, file); });
  }
  using namespace std::chrono_literals;
  if (!reading_.valid() || reading_.wait_for(0s) != std::future_status::ready) return;
  CellResult read = reading_.get();
  Cell* const cell = std::get_if<Cell>(&read);
  if (cell == nullptr || cell->scene.revision != now) return;
  // The cell before must outlive the frame and the intake that refer to it.
  const std::shared_ptr<const Cell> before = cell_;
  cell_ = std::make_shared<const Cell>(std::move(*cell));
  if (cell_->scene.sensors.empty()) {
    seen_ = nullptr;
  } else if (seen_) {
    seen_->change(*cell_);
  } else {
    seen_ = std::make_unique<SeenFrames>(*cell_, false);
  }
  server.forget(kSeen);
  frame_ = make_frame();
  asked_ = {};
  intake_.change(*cell_);
  server.parameters_changed();
}

nlohmann::json LiveSource::parameters() const {
  return {{{"name", "scene.attached"}, {"value", attached_json(attached_)}},
          {{"name", "asked.motion"}, {"value", asked_.json()}}};
}

// The frame of a changed cell does not get the catalogue again.
void LiveSource::note_the_catalogue() {
  const clearance_msg_Catalogue& catalogue = frame_->catalogue();
  if (catalogue.scene_revision == 0) return;
  told_ = {catalogue.scene_revision, catalogue.in_force_from, catalogue.daemon};
}

// A scene that has been in force since the daemon's start has followed no other one.
void LiveSource::note_what_is_attached(Server& server) {
  if (told_.revision == 0 || told_.revision != cell_->scene.revision) return;
  if (told_.revision == attached_of_ && told_.daemon == daemon_) return;
  if (told_.daemon != daemon_) attached_.clear();
  const bool is_first = told_.in_force_from != 0 && told_.daemon != daemon_;
  attached_ =
      attached_in(cell_->scene, attached_, {.cycle = told_.in_force_from, .is_first = is_first});
  attached_of_ = told_.revision;
  daemon_ = told_.daemon;
  server.parameters_changed();
}

// The same states as those of clearance-watch.
void LiveSource::tell_of_the_daemon(Server& server, std::int64_t now_ns, std::int64_t steady_ns) {
  const dds_entity_t reader = readers_[index(TopicKind::kDistances)];
  const double silent_s = 1e-9 * static_cast<double>(now_ns - frame_->report_time_ns());
  const ReportError error = judge_.error(steady_ns);
  const bool is_fault = judge_.is_held() || error == ReportError::kCorrupt ||
                        error == ReportError::kOtherAddress || error == ReportError::kRepeated;
  std::string text;
  if (!heard_) {
    text = fmt::format("waiting for clearanced on {}", participant_.where());
  } else if (writers_there(reader) == 0) {
    text = "clearanced has ended";
  } else if (!is_fault &&
             (silent_s * 1e9 > kSilentNs || (writers_alive(reader) == 0 && silent_s > 0.2))) {
    text = "clearanced is silent: it died or stands still";
  } else if (writers_alive(reader) > (merged_.are_partners(steady_ns) ? 2u : 1u)) {
    text = fmt::format("{} daemons publish here: figures are mixed", writers_alive(reader));
  } else if (error != ReportError::kGood) {
    text = fmt::format("no report may be relied on: {}{}", client::name(error),
                       judge_.is_held() ? ", twice within an hour; when the cause is found, "
                                          "close this page in all browsers for 3 s"
                                        : "");
  } else if (frame_->revision() != 0 && frame_->revision() != cell_->scene.revision) {
    text = reading_.valid() ? "the daemon has changed its cell, which is being read"
                            : "clearanced runs another cell than the one shown here";
  }
  server.set_status("daemon", heard_ ? 2 : 1, text);
  const MergedReports::Trouble trouble =
      text.empty() ? merged_.trouble(steady_ns) : MergedReports::Trouble();
  server.set_status("partners", trouble.level, trouble.text);
  std::vector<client::RefusedMessages> refused;
  for (const auto& [kind, messages] : refused_) refused.push_back(messages);
  server.set_status("refused", 1, client::text_of(refused));
}

}  // namespace clearance::view
