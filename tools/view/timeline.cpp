#include "tools/view/timeline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <utility>

#include "monitor/interface/pair_name.hpp"
#include "monitor/interface/report.hpp"
#include "monitor/recording/reader.hpp"
#include "monitor/wire/cdr.hpp"

namespace clearance::view {
namespace {

class Scan {
 public:
  explicit Scan(SceneHistory& scenes) : scenes_(scenes), scene_(&scenes.first().scene) {}

  void take(const RecordedMessage& message) {
    if (message.kind == TopicKind::kDistances && decoder_.decode(message.cdr, report_)) {
      take_report(message.log_ns);
    } else if (message.kind == TopicKind::kZones && decoder_.decode(message.cdr, zone_)) {
      found_.zone_messages.push_back(
          {zone_->zone, message.log_ns, {message.cdr.begin(), message.cdr.end()}});
      take_zone(message.log_ns);
    } else if (message.kind == TopicKind::kSeparation &&
               decoder_.decode(message.cdr, separation_)) {
      // The curves begin with the first report.
      if (!found_.reports.empty()) found_.history.take(*separation_, message.log_ns);
    } else if (message.kind == TopicKind::kHealth && decoder_.decode(message.cdr, health_)) {
      take_health(message.log_ns);
    }
  }
  [[nodiscard]] Timeline result();

 private:
  void take_report(std::int64_t log_ns);
  void change_scene(std::int64_t log_ns);
  void take_zone(std::int64_t log_ns);
  void take_health(std::int64_t log_ns);
  void add(std::int64_t time_ns, const char* kind, std::string text) {
    if (found_.moments.size() < kMostMoments) {
      found_.moments.push_back({time_ns, kind, std::move(text)});
    }
  }
  void add_least();

  SceneHistory& scenes_;
  const Scene* scene_;  // of the last report
  std::string least_pair_;
  double least_ = std::numeric_limits<double>::infinity();
  CdrDecoder decoder_;
  Sample<clearance_msg_Distances> report_;
  Sample<clearance_msg_ZoneState> zone_;
  Sample<clearance_msg_Separation> separation_;
  Sample<clearance_msg_Health> health_;
  Timeline found_;
  std::map<std::uint32_t, std::int64_t> active_;  // by zone: active since then
  std::optional<std::uint64_t> overruns_;
};

// Pairs of a changed scene have other ids.
void Scan::take_report(std::int64_t log_ns) {
  const bool changes =
      found_.scenes.empty() || found_.scenes.back().revision != report_->scene_revision;
  if (changes) change_scene(log_ns);
  found_.reports.push_back(log_ns);
  const bool known = report_->minimum_known &&
                     report_->minimum.status < static_cast<std::uint8_t>(PairStatus::kStale);
  if (known && report_->minimum.distance < least_) {
    least_ = report_->minimum.distance;
    least_pair_ = pair_name(*scene_, report_->minimum.pair);
  }
  found_.history.take(*report_, log_ns);
}

// The state of every zone is recorded again after a change.
void Scan::change_scene(std::int64_t log_ns) {
  auto& scenes = found_.scenes;
  const bool is_first = scenes.empty();
  const Scene& before = *scene_;
  const Cell* const cell = scenes_.cell(report_->scene_revision);
  if (cell != nullptr) scene_ = &cell->scene;
  found_.history.change_scene(*scene_);
  const SceneBegin begin{
      .cycle = report_->cycle,
      .seconds = is_first ? 0.0 : 1e-9 * static_cast<double>(log_ns - scenes.front().log_ns),
      .is_first = is_first};
  auto attached =
      attached_in(*scene_, is_first ? std::vector<Attached>() : scenes.back().attached, begin);
  scenes.push_back({log_ns, report_->scene_revision, std::move(attached)});
  if (is_first) return;
  for (const auto& [zone, since] : active_) found_.zones.push_back({zone, since, log_ns});
  active_.clear();
  const std::string changes = changes_text(before, *scene_);
  add(log_ns, "cell",
      fmt::format("the cell changes to {:016x}{}{}", report_->scene_revision,
                  changes.empty() ? "" : ": ", changes));
}

void Scan::take_zone(std::int64_t log_ns) {
  const auto since = active_.find(zone_->zone);
  if (zone_->active && since == active_.end()) {
    active_[zone_->zone] = log_ns;
    const bool goes_on = found_.scenes.size() > 1 && zone_->since_cycle < zone_->cycle;
    if (goes_on) return;
    if (!found_.reports.empty() || zone_->cause == static_cast<std::uint8_t>(ZoneCause::kNear)) {
      add(log_ns, "zone",
          fmt::format("zone {} entered: {}", zone_->name, pair_name(*scene_, zone_->pair)));
    }
  } else if (!zone_->active && since != active_.end()) {
    found_.zones.push_back({zone_->zone, since->second, log_ns});
    active_.erase(since);
  }
}

// Health comes once per second: the moment is that of the message.
void Scan::take_health(std::int64_t log_ns) {
  if (overruns_ && health_->overruns > *overruns_) {
    add(log_ns, "overrun",
        fmt::format("{} overruns within the second before; the longest tick took {:.0f} us",
                    health_->overruns - *overruns_, health_->tick_second_max_us));
  }
  overruns_ = health_->overruns;
  if (!found_.reports.empty()) found_.history.take(*health_, log_ns);
}

void Scan::add_least() {
  const RunHistory::Piece least = found_.history.least();
  if (std::isnan(least.distance)) return;
  found_.moments.push_back(
      {least.time_ns, "closest",
       fmt::format("least distance: {:.2f} mm, {}", 1e3 * least.distance, least_pair_)});
}

Timeline Scan::result() {
  if (found_.reports.empty()) return std::move(found_);
  found_.begin_ns = found_.reports.front();
  found_.end_ns = found_.reports.back();
  for (const auto& [zone, since] : active_) found_.zones.push_back({zone, since, found_.end_ns});
  add_least();
  std::ranges::stable_sort(found_.moments, {}, &Moment::time_ns);
  return std::move(found_);
}

}  // namespace

Timeline read_timeline(SceneHistory& scenes, const std::filesystem::path& file,
                       const std::function<void(double)>& progress) {
  RecordingReader reader(file);
  RecordedMessage message;
  Scan scan(scenes);
  while (reader.next(message)) {
    scan.take(message);
    if (progress) progress(reader.progress());
  }
  Timeline found = scan.result();
  if (!reader.readable()) {
    found.error = reader.error();
  } else if (found.reports.empty()) {
    found.error = fmt::format(
        "{} holds no reports; --offline computes them from the recorded inputs", file.string());
  }
  return found;
}

// Times are seconds after the begin. The begin is a text, since a double does not hold its
// nanoseconds.
std::string Timeline::json() const {
  const auto after = [this](std::int64_t ns) { return 1e-9 * static_cast<double>(ns - begin_ns); };
  const auto number = [](double value) {
    return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
  };
  nlohmann::json all = {{"begin_ns", std::to_string(begin_ns)},
                        {"duration", after(end_ns)},
                        {"reports", reports.size()},
                        {"stretches", nlohmann::json::array()},
                        {"zones", nlohmann::json::array()},
                        {"moments", nlohmann::json::array()}};
  for (const RunHistory::Piece& each : history.pieces(kMostStretches)) {
    all["stretches"].push_back({after(each.time_ns), number(each.distance), number(each.lower)});
  }
  for (const ZoneSpan& each : zones) {
    all["zones"].push_back(
        {{"zone", each.zone}, {"begin", after(each.begin_ns)}, {"end", after(each.end_ns)}});
  }
  for (const Moment& each : moments) {
    all["moments"].push_back(
        {{"time", after(each.time_ns)}, {"kind", each.kind}, {"text", each.text}});
  }
  return all.dump();
}

}  // namespace clearance::view
