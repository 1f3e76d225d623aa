#include "permit_reader.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <span>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace clearance_control {
namespace {

using clearance::ReportError;
namespace client = clearance::client;

// PairStatus of monitor/interface/report.hpp. Any other value is unknown.
constexpr std::uint8_t kCarried = 4, kAbsent = 7;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

constexpr std::chrono::milliseconds kWait(5);

template <class Sequence>
auto list(const Sequence& sequence) {
  return std::span(sequence._buffer, sequence._length);
}

std::pair<std::string, std::string> objects_of(const std::string& pair) {
  constexpr std::string_view kBetween = " - ";
  const std::size_t at = pair.find(kBetween);
  if (at == std::string::npos)
    throw std::invalid_argument("'" + pair + "' is no pair: expected \"OBJECT - OBJECT\"");
  return {pair.substr(0, at), pair.substr(at + kBetween.size())};
}

void check(const PermitOptions& options) {
  const bool has_stop = std::isfinite(options.stop_at), has_slow = std::isfinite(options.slow_from);
  if (has_stop != has_slow || (has_stop && !(options.stop_at < options.slow_from)))
    throw std::invalid_argument("stop_at and slow_from have to be two distances, the first less");
  if (!options.pairs.empty() && !has_stop)
    throw std::invalid_argument("pairs need stop_at and slow_from");
  if (!has_stop && options.zones.empty() && !options.obeys_scaling)
    throw std::invalid_argument(
        "nothing limits: state stop_at and slow_from, zones, or obey_scaling");
}

void reduce(Permit& permit, double scaling, Cause cause) {
  if (scaling >= permit.scaling) return;
  permit.scaling = scaling;
  permit.cause = cause;
}

}  // namespace

const char* name(Cause cause) noexcept {
  constexpr std::array kNames = {"none",
                                 "no report may be relied on",
                                 "faulty reports, until they are acknowledged",
                                 "not known",
                                 "a distance",
                                 "a zone",
                                 "the daemon's scaling",
                                 "positions that are away from where the joints stand"};
  return kNames[static_cast<std::size_t>(cause)];
}

ReportError Permit::error(std::int64_t at_ns) const noexcept {
  const ReportError error = reports.error(at_ns);
  return error != ReportError::kGood || !has_separations ? error : separations.error(at_ns);
}

Cause Permit::cause_at(std::int64_t at_ns) const noexcept {
  if (reports.is_held() || (has_separations && separations.is_held())) return Cause::kHeld;
  return error(at_ns) != ReportError::kGood ? Cause::kNotRelied : cause;
}

PermitReader::PermitReader(const clearance::DdsOptions& dds, PermitOptions options, Tell tell)
    : options_((check(options), std::move(options))),
      tell_(std::move(tell)),
      connection_(dds),
      reports_(connection_, options_.stream),
      names_(connection_),
      newest_({.reports = reports_.judge(), .separations = reports_.judge()}) {
  if (options_.obeys_scaling) separation_.emplace(connection_, options_.stream);
  for (const std::string& pair : options_.pairs) {
    auto [a, b] = objects_of(pair);
    pairs_.emplace_back(names_, std::move(a), std::move(b));
  }
  thread_ = std::thread([this] { run(); });
}

PermitReader::~PermitReader() {
  stop_ = true;
  thread_.join();
}

// A refused message changes the judges, too, so each turn writes a permit.
void PermitReader::run() {
  while (!stop_) {
    reports_.newest(kWait);
    if (separation_) separation_->newest();
    if (is_acknowledged_.exchange(false)) {
      reports_.acknowledge();
      if (separation_) separation_->acknowledge();
    }
    const Permit permit = judged();
    newest_.put(permit);
    tell_changes(permit);
  }
}

Permit PermitReader::judged() {
  Permit permit{.reports = reports_.judge(),
                .separations = separation_ ? separation_->judge() : reports_.judge(),
                .has_separations = separation_.has_value(),
                .scaling = 1.0,
                .of_present = 1.0,
                .cause = Cause::kNone};
  if (std::isfinite(options_.stop_at)) limit_by_distances(permit);
  if (!options_.zones.empty()) limit_by_zones(permit);
  if (separation_) limit_by_scaling(permit);
  return permit;
}

void PermitReader::limit_by_distances(Permit& permit) {
  const auto by = [&](bool is_known, double lower) {
    const double above = (lower - options_.stop_at) / (options_.slow_from - options_.stop_at);
    if (is_known && lower > -kInfinity)
      reduce(permit, std::clamp(above, 0.0, 1.0), Cause::kDistance);
    else
      reduce(permit, 0.0, Cause::kUnknown);
  };
  if (pairs_.empty()) by(reports_->minimum_certified, reports_->lower_all);
  for (client::Pair& pair : pairs_) {
    const clearance_msg_PairDistance* const found = pair.in(*reports_);
    if (found == nullptr)
      reduce(permit, 0.0, Cause::kUnknown);
    else if (found->status != kAbsent)
      by(found->status <= kCarried, found->lower);
  }
}

const clearance_msg_Catalogue* PermitReader::names_of(std::uint64_t revision) {
  if (names_.message(revision) == nullptr) names_.update();
  return names_.message(revision);
}

// A cell may give the names of a robot's joints a prefix: one for all of them.
bool PermitReader::has_joints(std::uint64_t revision) {
  const clearance_msg_Catalogue* const names = names_of(revision);
  if (names == nullptr) return false;
  if (options_.joints.empty()) return true;
  const auto has = [&](const std::string& name) {
    return std::ranges::any_of(list(names->joints),
                               [&](const auto& of) { return name == of.name; });
  };
  return std::ranges::any_of(list(names->joints), [&](const auto& of) {
    std::string prefix = of.name;
    if (!prefix.ends_with(options_.joints.front())) return false;
    prefix.resize(prefix.size() - options_.joints.front().size());
    return std::ranges::all_of(options_.joints,
                               [&](const std::string& joint) { return has(prefix + joint); });
  });
}

void PermitReader::limit_by_zones(Permit& permit) {
  const clearance_msg_Catalogue* const names = names_of(reports_->scene_revision);
  for (const std::string& zone : options_.zones) {
    const clearance_msg_CatalogueZone* found = nullptr;
    if (names != nullptr) {
      for (const clearance_msg_CatalogueZone& each : list(names->zones))
        if (zone == each.name) found = &each;
    }
    if (found == nullptr)
      reduce(permit, 0.0, Cause::kUnknown);
    else if (std::ranges::count(list(reports_->active_zones), found->id) > 0)
      reduce(permit, 0.0, Cause::kZone);
  }
}

// A cell without separation and stops sends none of these messages, so nothing is relied on.
void PermitReader::limit_by_scaling(Permit& permit) {
  const clearance_msg_Separation& message = **separation_;
  double& scaling = permit.of_present;
  for (const clearance_msg_ZoneSeparation& zone : list(message.zones))
    scaling = std::min(scaling, zone.scaling);
  for (const clearance_msg_RobotStop& stop : list(message.stops))
    scaling = std::min(scaling, stop.scaling);
  if (message.stops._length > 0 && !has_joints(message.scene_revision))
    reduce(permit, 0.0, Cause::kUnknown);
  const std::int64_t age_ns = std::max<std::int64_t>(0, client::now_ns() - message.publish_ns);
  permit.since_ns = client::monotonic_ns() - age_ns - 2 * clearance::stated_period_ns(message);
  if (permit.of_present < 1.0 && permit.cause == Cause::kNone) permit.cause = Cause::kScaling;
}

// Says one change per second at most.
void PermitReader::tell_changes(const Permit& permit) {
  const std::int64_t now_ns = client::monotonic_ns();
  const ReportError error = permit.error(now_ns);
  std::string text = name(permit.cause_at(now_ns));
  if (error != ReportError::kGood) text += std::string(": ") + client::name(error);
  if (text == told_ || now_ns - told_ns_ < 1'000'000'000) return;
  told_ = std::move(text);
  told_ns_ = now_ns;
  tell_(told_);
}

}  // namespace clearance_control
