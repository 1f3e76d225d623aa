#include "monitor/publish/cell_diagnostics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "config/text/sentences.hpp"
#include "monitor/client/share_merge.hpp"
#include "monitor/interface/age_text.hpp"
#include "monitor/interface/pair_name.hpp"
#include "monitor/interface/zone_cause.hpp"

namespace clearance {
namespace {

using Status = DiagnosticText;

std::string milliseconds(std::int64_t ns) {
  return fmt::format("{:.1f} ms", 1e-6 * static_cast<double>(ns));
}

Status tick_status(const clearance_msg_Health& health, std::uint64_t overruns,
                   std::uint64_t dropped) {
  Status status{.name = "tick", .message = "on time"};
  if (dropped > 0)
    status.raise(DiagnosticLevel::kWarn,
                 fmt::format("{} not published in the last second", counted(dropped, "report")));
  if (overruns > 0)
    status.raise(DiagnosticLevel::kWarn,
                 fmt::format("{} ended late in the last second", counted(overruns, "tick")));
  const auto us = [](double value) { return fmt::format("{:.1f} us", value); };
  status.values = {
      {"cycle", std::to_string(health.cycle)},
      {"tick p50", us(health.tick_p50_us)},
      {"tick p99.9", us(health.tick_p999_us)},
      {"tick max", us(health.tick_max_us)},
      {"response p99.9", us(health.response_p999_us)},
      {"response max", us(health.response_max_us)},
      {"slowest input", health.responses._length == 0 ? "none" : health.responses._buffer[0].input},
      {"overruns", std::to_string(health.overruns)},
      {"skipped cycles", std::to_string(health.skipped_cycles)},
      {"lost batches", std::to_string(health.lost_batches)},
      {"dropped reports", std::to_string(health.dropped_reports)}};
  return status;
}

Status distances_status(const Scene& scene, const Report& report) {
  Status status{.name = "distances", .message = "all pairs are known"};
  if (!report.minimum_certified)
    status.raise(DiagnosticLevel::kWarn, "the minimum is not certified");
  if (report.stale > 0) {
    status.level = DiagnosticLevel::kWarn;
    status.message = fmt::format("{} stale", counted(report.stale, "pair"));
  }
  if (report.unknown > 0)
    status.raise(DiagnosticLevel::kError,
                 fmt::format("{} unknown", counted(report.unknown, "pair")));
  status.values = {{"pairs", std::to_string(report.pairs_total)},
                   {"stale", std::to_string(report.stale)},
                   {"unknown", std::to_string(report.unknown)},
                   {"least lower bound", fmt::format("{:.6f} m", report.lower_all)}};
  if (report.minimum_known) {
    status.values.emplace_back("closest pair", pair_name(scene, report.minimum));
    status.values.emplace_back("closest distance",
                               fmt::format("{:.6f} m", report.minimum.distance));
  }
  return status;
}

// Adds the age of a pose or a position as a value, and its fault if it has one.
template <class Age>
void add_input(const Age& input, Status& status) {
  const std::string name = input.name;
  const bool is_age = 0 <= input.age_ns && input.age_ns < kForgottenNs;
  status.values.emplace_back(name, is_age ? milliseconds(input.age_ns) : age_text(input.age_ns));
  if (input.age_ns < 0) {
    status.raise(DiagnosticLevel::kError, name + " was never seen");
  } else if (input.contradicted) {
    status.raise(DiagnosticLevel::kError, name + " is contradicted");
  } else if (input.stale) {
    status.raise(DiagnosticLevel::kWarn, name + " is late");
  }
}

// Links that follow joints have no poses of their own.
Status poses_status(const clearance_msg_Health& health) {
  Status status{.name = "poses", .message = "on time"};
  for (std::uint32_t i = 0; i < health.inputs._length; ++i) {
    const clearance_msg_InputAge& input = health.inputs._buffer[i];
    if (!input.follows_joints) add_input(input, status);
  }
  return status;
}

Status joints_status(const Scene& scene, std::uint32_t robot, const clearance_msg_Health& health) {
  Status status{.name = "joints of " + scene.robots[robot].name, .message = "on time"};
  for (std::uint32_t i = 0; i < health.joints._length; ++i) {
    const clearance_msg_JointAge& joint = health.joints._buffer[i];
    if (joint.variable < scene.variables.size() && scene.variables[joint.variable].robot == robot)
      add_input(joint, status);
  }
  return status;
}

Status zone_status(const Scene& scene, std::uint32_t index, const ZoneReport& zone) {
  Status status{.name = "zone " + scene.zones[index].name, .message = "not active"};
  const std::string cause = zone.active ? cause_text(scene, zone) : "clear";
  const std::string pair = pair_name(scene, zone.pair);
  if (zone.active) status.raise(DiagnosticLevel::kWarn, fmt::format("active: {}, {}", pair, cause));
  if (zone.active && zone.cause > ZoneCause::kLate) status.level = DiagnosticLevel::kError;
  status.values = {{"active", zone.active ? "true" : "false"},
                   {"certified", zone.certified ? "true" : "false"},
                   {"cause", cause},
                   {"pair", pair},
                   {"clearance", fmt::format("{:.6f} m", zone.clearance)},
                   {"swept clearance", fmt::format("{:.6f} m", zone.swept_clearance)},
                   {"since cycle", std::to_string(zone.since_cycle)}};
  return status;
}

Status recording_status(const clearance_msg_Health& health) {
  Status status{.name = "recording", .message = health.recording};
  if (!status.message.starts_with("recording "))
    status.level = DiagnosticLevel::kError;
  else if (health.recording_missing > 0)
    status.level = DiagnosticLevel::kWarn;
  status.values = {{"missing", std::to_string(health.recording_missing)}};
  return status;
}

Status share_status(const clearance_msg_ShareHealth& share) {
  Status status{.name = fmt::format("share {}", share.share),
                .message = client::name(static_cast<client::ShareState>(share.state))};
  if (share.state != 0) status.level = DiagnosticLevel::kError;
  status.values = {{"cycle", std::to_string(share.cycle)},
                   {"age", share.age_ns < 0 ? "never heard" : milliseconds(share.age_ns)}};
  return status;
}

// Returns by how much a count has grown. A sum over shares falls while one is not heard, and grows
// again when that one is back.
std::uint64_t more_than(std::uint64_t& largest, std::uint64_t count) {
  const std::uint64_t before = std::exchange(largest, std::max(largest, count));
  return count > before ? count - before : 0;
}

}  // namespace

Sample<DiagnosticArray> CellDiagnostics::make(const clearance_msg_Health& health,
                                              const Report& report, std::int64_t stamp_ns) {
  std::vector<Status> statuses = {tick_status(health, more_than(overruns_, health.overruns),
                                              more_than(dropped_, health.dropped_reports)),
                                  distances_status(scene_, report), poses_status(health)};
  for (std::uint32_t robot = 0; robot < scene_.robots.size(); ++robot)
    if (!scene_.robots[robot].is_attached) statuses.push_back(joints_status(scene_, robot, health));
  for (std::uint32_t zone = 0; zone < report.zones.size(); ++zone)
    statuses.push_back(zone_status(scene_, zone, report.zones[zone]));
  for (std::uint32_t share = 0; share < health.shares._length; ++share)
    statuses.push_back(share_status(health.shares._buffer[share]));
  if (*health.recording != '\0') statuses.push_back(recording_status(health));
  return diagnostic_array(scene_.name, statuses, stamp_ns);
}

}  // namespace clearance
