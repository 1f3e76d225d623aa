#include "tools/plc/report_figures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "monitor/client/sequence_view.hpp"
#include "monitor/interface/report.hpp"

namespace clearance::plc {
namespace {

using client::list;

// Two periods of messages may wait while the program is held up.
client::StreamOptions options(const Cell& cell) {
  const double waiting = 2e-9 * static_cast<double>(cell.plc.period_ns) * cell.scene.rate_hz;
  return {.old_after = std::chrono::nanoseconds(cell.plc.period_ns),
          .depth = 64 + static_cast<std::int32_t>(std::ceil(waiting)),
          .period = std::chrono::nanoseconds(cell.plc.period_ns)};
}

Cause cause_of(ReportError error) {
  switch (error) {
    case ReportError::kOld:
      return Cause::kOld;
    case ReportError::kClocksDisagree:
      return Cause::kClocksDisagree;
    case ReportError::kOtherSource:
      return Cause::kOtherDaemon;
    case ReportError::kRepeated:
    case ReportError::kCorrupt:
    case ReportError::kOtherAddress:
      return Cause::kFaulty;
    default:
      return Cause::kNone;  // silence, which HeldFigures notices
  }
}

// A margin to objects that are absent limits nothing, and one that is not known is the least.
double margin(double value, std::uint8_t validity) {
  if (validity == static_cast<std::uint8_t>(SeparationValidity::kAbsent)) return kInfinite;
  return value;
}

}  // namespace

ReportFigures::ReportFigures(client::Connection& connection, const Cell& cell)
    : cell_(cell),
      settings_(cell.plc),
      reports_(connection, options(cell)),
      separation_(connection, options(cell)),
      catalogue_(connection),
      held_(settings_.rows.size(), settings_.period_ns),
      places_(settings_.rows.size()),
      values_(settings_.rows.size()) {}

// A change of the cell keeps its name.
Cause ReportFigures::names_of(std::uint64_t revision) {
  if (revision == revision_) return Cause::kNone;
  catalogue_.update();
  const clearance_msg_Catalogue* const names = catalogue_.message(revision);
  if (names == nullptr) return Cause::kNoNames;
  if (names->scene != cell_.scene.name) return Cause::kOtherCell;
  revision_ = revision;
  has_zones_ = names->zones._length > 0;
  is_separated_ = names->separated_zones._length + names->stopping_robots._length > 0;
  held_.need_separation(is_separated_);
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const PlcRow& row = settings_.rows[i];
    places_[i] = {};
    for (const clearance_msg_CatalogueZone& zone : list(names->zones)) {
      if (row.zone == zone.name) places_[i].zone = zone.id;
    }
    for (std::uint32_t robot = 0; robot < names->robots._length; ++robot) {
      if (row.robot == names->robots._buffer[robot]) places_[i].robot = robot;
    }
  }
  return Cause::kNone;
}

void ReportFigures::fill(const clearance_msg_Distances& report) {
  const auto active = list(report.active_zones);
  for (std::size_t i = 0; i < values_.size(); ++i) {
    const PlcRow& row = settings_.rows[i];
    const bool is_scaling = row.value == PlcValue::kSpeedScaling;
    values_[i] = kInfinite;
    if (row.value == PlcValue::kLeastDistance) values_[i] = report.lower_all;
    const bool is_whole = row.zone.empty() && row.robot.empty();
    const bool is_by_zones = row.value == PlcValue::kClear || (is_scaling && is_whole);
    const bool is_of_separation = is_scaling || row.value == PlcValue::kStopMargin;
    if (is_of_separation && is_separated_) continue;  // the other message has it
    if (is_of_separation && !is_by_zones) values_[i] = -kInfinite;
    if (!is_by_zones) continue;
    const bool is_clear =
        is_whole ? has_zones_ && active.empty()
                 : places_[i].zone && std::ranges::find(active, *places_[i].zone) == active.end();
    values_[i] = is_clear ? 1.0 : 0.0;
  }
}

void ReportFigures::fill(const clearance_msg_Separation& separation) {
  for (std::size_t i = 0; i < values_.size(); ++i) {
    const PlcRow& row = settings_.rows[i];
    values_[i] = kInfinite;
    const bool is_scaling = row.value == PlcValue::kSpeedScaling;
    if (!is_scaling && row.value != PlcValue::kStopMargin) continue;
    const bool is_whole = row.zone.empty() && row.robot.empty();
    if (is_whole && !is_separated_) continue;  // by the zones of the report, if at all
    bool is_there = is_whole;
    const auto lower = [&](bool is_of_row, double scaling, double left, std::uint8_t validity) {
      if (!is_of_row && !is_whole) return;
      is_there = true;
      values_[i] = std::min(values_[i], is_scaling ? scaling : margin(left, validity));
    };
    for (const clearance_msg_ZoneSeparation& zone : list(separation.zones))
      lower(places_[i].zone == zone.zone, zone.scaling, zone.remaining, zone.validity);
    for (const clearance_msg_RobotStop& stop : list(separation.stops))
      lower(places_[i].robot == stop.robot, stop.scaling, stop.clearance, stop.validity);
    if (!is_there) values_[i] = -kInfinite;
  }
}

template <class Message>
void ReportFigures::take(client::Stream<Message>& stream, MessageKind kind, std::int64_t now_ns) {
  const std::int64_t period_ns = settings_.period_ns;
  while (stream.next()) {
    Cause cause = cause_of(stream.check().error);
    if (cause == Cause::kNone) cause = names_of(stream->scene_revision);
    if (cause != Cause::kNone) {
      if (kind == MessageKind::kDistances) held_.fail(cause, now_ns + period_ns);
      continue;
    }
    fill(*stream);
    const std::int64_t age_ns = std::max<std::int64_t>(0, stream.check().age_ns);
    held_.add(kind, values_, now_ns + period_ns - age_ns);
  }
  // What is not handed out shows here only.
  const Cause cause = stream.is_held() ? Cause::kHeld : cause_of(stream.reason());
  if (cause == Cause::kHeld || cause == Cause::kFaulty) held_.fail(cause, now_ns);
}

void ReportFigures::update(std::int64_t now_ns) {
  take(reports_, MessageKind::kDistances, now_ns);
  take(separation_, MessageKind::kSeparation, now_ns);
  held_.step(now_ns);
}

}  // namespace clearance::plc
