#include "tools/watch/view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <span>

#include "monitor/app/log_line.hpp"
#include "monitor/interface/age_text.hpp"
#include "monitor/interface/report.hpp"
#include "tools/watch/contact_lines.hpp"
#include "tools/watch/feed_words.hpp"
#include "tools/watch/number_text.hpp"
#include "tools/watch/separation_lines.hpp"
#include "tools/watch/witness_lines.hpp"

namespace clearance::watch {
namespace {

constexpr std::size_t kWideColumns = 160;  // enough for witness points beside each pair

// The words of idl/README.md. A status of a later version counts as unknown, as it says there.
const char* status_name(std::uint8_t status) {
  const char* const known = name(static_cast<PairStatus>(status));
  return *known != 0 ? known : name(PairStatus::kUnknown);
}

// The name of a zone comes with its first message; the catalogue may have it before.
std::string name_of(const Feed& feed, std::uint32_t zone, const char* name) {
  return name != nullptr && *name != 0 ? std::string(name) : feed.zone_name(zone);
}

Style status_style(std::uint8_t status) {
  switch (static_cast<PairStatus>(status)) {
    case PairStatus::kConverged:
      return Style::kPlain;
    case PairStatus::kTouching:
    case PairStatus::kOverlapping:
      return Style::kAlarm;
    case PairStatus::kCarried:
    case PairStatus::kAbsent:
      return Style::kDim;
    default:
      return Style::kWarning;
  }
}

bool is_stale(const clearance_msg_PairDistance& pair) {
  return static_cast<PairStatus>(pair.status) == PairStatus::kStale;
}

// Says whether both partners report the same.
std::string partner_text(const client::PartnerCheck& check) {
  using client::PartnerState;
  if (check.state == PartnerState::kAlone) return "no partner yet";
  if (check.state == PartnerState::kAgrees) return "partners agree";
  return fmt::format("partner '{}': {}", check.partner, name(check.state));
}

// Says how many reports came in each state of the partners, as "988 agree, 12 missing".
std::string counted_partners(const PartnerCounts& counts) {
  constexpr std::array kWords = {"without a partner", "agree",     "missing",
                                 "on other inputs",   "different", "corrupt"};
  std::string text;
  for (std::size_t state = 0; state < counts.size(); ++state) {
    if (counts[state] == 0) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", counts[state], kWords[state]);
  }
  return text;
}

// Whether both partners reported the same since the last line.
std::string partners_since(const Feed& feed, const PartnerCounts& counts) {
  const auto agree = static_cast<std::size_t>(client::PartnerState::kAgrees);
  const auto all = std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
  const std::string text = partner_text(feed.partner());
  if (counts[agree] == all || all == counts[0]) return text;
  return fmt::format("{} ({})", text, counted_partners(counts));
}

Line& add_partner(Line& line, const Feed& feed) {
  using client::PartnerState;
  const PartnerState state = feed.partner().state;
  const bool is_fault = state == PartnerState::kDifferent || state == PartnerState::kCorrupt;
  const Style style = state == PartnerState::kAlone    ? Style::kDim
                      : state == PartnerState::kAgrees ? Style::kGood
                      : is_fault                       ? Style::kAlarm
                                                       : Style::kWarning;
  return line.add("  " + partner_text(feed.partner()), style);
}

Line title_line(const Feed& feed, const ViewContext& context, std::size_t width) {
  Line line(width);
  line.add("clearance", Style::kBold).add("  ");
  if (const auto* catalogue = feed.catalogue()) {
    line.add(fmt::format("{} at {:.0f} Hz, ", catalogue->scene, catalogue->rate_hz));
  }
  line.add(context.where).add("  ");
  if (!feed.any()) {
    const bool is_refused = !feed.refusal().empty();
    return line.add(is_refused ? feed.refusal() : what_it_waits_for(feed),
                    is_refused ? Style::kAlarm : Style::kWarning);
  }
  if (!trouble(feed, context.now_ns).empty()) return line.add("not live", Style::kAlarm);
  if (feed.publishers() > 1 && !feed.has_partner()) {
    return line.add(fmt::format("{} daemons publish here: figures are mixed", feed.publishers()),
                    Style::kAlarm);
  }
  line.add("live", Style::kGood).add(fmt::format("  cycle {}", feed.distances().cycle));
  if (!feed.refused().empty()) line.add("  " + feed.refused(), Style::kAlarm);
  return feed.has_partner() ? add_partner(line, feed) : line;
}

void add_minimum(std::vector<Line>& lines, const Feed& feed, std::int64_t now_ns,
                 std::size_t width) {
  const clearance_msg_Distances& report = feed.distances();
  Line& line = lines.emplace_back(width);
  line.add("minimum   ", Style::kDim);
  if (!report.minimum_known) {
    line.add(fmt::format("none yet: no {} of any pair's objects have come", inputs_of(feed)),
             Style::kWarning);
    return;
  }
  const clearance_msg_PairDistance& pair = report.minimum;
  if (is_stale(pair)) {
    line.add(fmt::format("not known, {} are late; the least upper bound is {:.4f} m, of {}",
                         inputs_of(feed), pair.upper, feed.pair_name(pair)),
             Style::kWarning);
    return;
  }
  if (!frozen(feed, now_ns).empty()) line.add("was ", Style::kAlarm);
  line.add(fmt::format("{:.4f} m  ", pair.distance), Style::kBold)
      .add(feed.pair_name(pair), Style::kBold);
  lines.emplace_back(width)
      .add("          ")
      .add(fmt::format("in [{:.6f}, {:.6f}] m, since the last tick at least {:.6f} m  ", pair.lower,
                       pair.upper, pair.swept_lower))
      .add(report.minimum_certified ? "certified" : "not certified",
           report.minimum_certified ? Style::kGood : Style::kWarning);
  lines.emplace_back(width).add(fmt::format("          {}  normal ({:.2f} {:.2f} {:.2f})",
                                            approach(pair), pair.normal.x, pair.normal.y,
                                            pair.normal.z));
  lines.emplace_back(width).add(
      fmt::format("          from {} to {}", point(pair.witness_a), point(pair.witness_b)));
}

void add_counts(std::vector<Line>& lines, const Feed& feed, std::size_t width) {
  const clearance_msg_Distances& report = feed.distances();
  Line& line = lines.emplace_back(width);
  line.add("pairs     ", Style::kDim)
      .add(fmt::format("{}: {} evaluated, {} carried, ", report.pairs_total, report.evaluated,
                       report.carried))
      .add(fmt::format("{} stale", report.stale),
           report.stale != 0 ? Style::kWarning : Style::kPlain)
      .add(", ")
      .add(fmt::format("{} unknown", report.unknown),
           report.unknown != 0 ? Style::kWarning : Style::kPlain)
      .add(absent_pairs(report) != 0 ? fmt::format(", {} absent", absent_pairs(report)) : "")
      .add(fmt::format("; all at least {:.4f} m, since the last tick {:.4f} m; refreshed no more "
                       "than {} ticks ago",
                       report.lower_all, report.swept_lower_all, report.oldest_evaluation_cycles));
}

void add_zones(std::vector<Line>& lines, const Feed& feed, std::size_t width) {
  Line& line = lines.emplace_back(width);
  line.add("zones     ", Style::kDim);
  for (const auto& [id, zone] : feed.zones()) {
    line.add(fmt::format("{} {}{}", name_of(feed, id, zone.name), zone.active ? "ACTIVE" : "clear",
                         cause(feed, zone)),
             zone.active ? Style::kAlarm : Style::kGood)
        .add("  ");
  }
  if (feed.zones().empty()) line.add("none");
}

void add_shares(std::vector<Line>& lines, const Feed& feed, std::size_t width) {
  const std::string absent = absent_shares(feed);
  if (absent.empty()) return;
  lines.emplace_back(width).add("shares    ", Style::kDim).add(absent, Style::kAlarm);
}

void add_health(std::vector<Line>& lines, const Feed& feed, const ViewContext& context,
                std::size_t width) {
  const clearance_msg_Health* health = feed.health();
  if (health == nullptr) return;
  lines.emplace_back(width)
      .add("tick      ", Style::kDim)
      .add(fmt::format("p50 {:.1f} us  p99.9 {:.1f} us  max {:.1f} us  (1 s: {:.1f} us)",
                       health->tick_p50_us, health->tick_p999_us, health->tick_max_us,
                       health->tick_second_max_us));
  const bool trouble = health->overruns + health->skipped_cycles + health->dropped_reports > 0;
  lines.emplace_back(width)
      .add("          ")
      .add(fmt::format("{}  {}  {} dropped", counted(health->overruns, "overrun"),
                       counted(health->skipped_cycles, "skipped cycle"),
                       counted(health->dropped_reports, "report")),
           trouble ? Style::kWarning : Style::kPlain);
  lines.emplace_back(width)
      .add("wake-up   ", Style::kDim)
      .add(fmt::format("p50 {:.1f} us  p99.9 {:.1f} us  max {:.1f} us", health->wakeup_p50_us,
                       health->wakeup_p999_us, health->wakeup_max_us));
  lines.emplace_back(width)
      .add("response  ", Style::kDim)
      .add(fmt::format("p50 {:.1f} us  p99.9 {:.1f} us  max {:.1f} us", health->response_p50_us,
                       health->response_p999_us, health->response_max_us));
  if (health->responses._length > 0) {
    const clearance_msg_InputResponse& slowest = health->responses._buffer[0];
    lines.back().add(fmt::format("  (slowest: {})", slowest.input),
                     health->late_responses > 0 ? Style::kWarning : Style::kPlain);
  }
  lines.emplace_back(width)
      .add("reports   ", Style::kDim)
      .add(fmt::format("{:.0f} a second  {} missed here", context.reports_a_second, feed.missed()));
}

void add_inputs(std::vector<Line>& lines, const Feed& feed, std::size_t width) {
  const clearance_msg_Distances& report = feed.distances();
  Line& ages = lines.emplace_back(width);
  ages.add("inputs    ", Style::kDim);
  if (report.newest_pose_ns == 0) {
    ages.add(fmt::format("no {} have come", inputs_of(feed)), Style::kWarning);
  } else {
    ages.add(fmt::format("{} in use {} old, {} {}", inputs_of(feed),
                         precise_age(report.now_ns - report.newest_pose_ns), oldest_input(feed),
                         precise_age(report.now_ns - report.oldest_pose_ns)));
  }
  const clearance_msg_Health* health = feed.health();
  if (health == nullptr) return;
  for (std::uint32_t i = 0; i < health->sources._length; ++i) {
    const clearance_msg_SourceHealth& source = health->sources._buffer[i];
    ages.add(fmt::format("  {}: {}, {} lost", source.source,
                         counted(source.batches, "batch", "batches"), source.lost_batches),
             source.lost_batches != 0 ? Style::kWarning : Style::kPlain);
  }
  Line late(width);
  std::size_t late_count = 0;
  for (std::uint32_t i = 0; i < health->inputs._length; ++i) {
    const clearance_msg_InputAge& input = health->inputs._buffer[i];
    if (!input.stale) continue;
    if (late_count++ == 0) late.add("late      ", Style::kDim);
    late.add(fmt::format("{} {}  ", input.name, age_text(input.age_ns)), Style::kWarning);
  }
  if (late_count > 0) lines.push_back(late);
  if (health->rejected._length == 0) return;
  Line& refused = lines.emplace_back(width);
  refused.add("refused   ", Style::kDim);
  for (std::uint32_t i = 0; i < health->rejected._length; ++i) {
    const clearance_msg_RejectCount& entry = health->rejected._buffer[i];
    refused.add(fmt::format("{}: {} ({}{}{})  ", entry.object, entry.cause, entry.count,
                            *entry.last == '\0' ? "" : ", last ", entry.last),
                Style::kWarning);
  }
}

Line pair_line(const Feed& feed, const clearance_msg_PairDistance& pair, std::size_t width) {
  Line line(width);
  line.add(metres(pair.distance), Style::kBold)
      .add(metres(pair.lower) + metres(pair.upper))
      .add(fmt::format("  {}  {}  ", speed(pair.closing_speed), contact_time(pair.time_to_contact)))
      .add(fmt::format("{:15}  ", status_name(pair.status)), status_style(pair.status))
      .add(fmt::format("{:9}  ", pair.refresh_age_cycles), Style::kDim);
  if (width >= kWideColumns)
    line.add(fmt::format("{}  {}  ", point(pair.witness_a), point(pair.witness_b)));
  return line.add(feed.pair_name(pair));
}

// Pairs are sorted by lower bound, so that an unknown pair is not hidden behind a known one.
std::vector<const clearance_msg_PairDistance*> closest_first(
    const clearance_msg_Distances& report) {
  std::vector<const clearance_msg_PairDistance*> pairs(report.pairs._length);
  for (std::uint32_t i = 0; i < report.pairs._length; ++i) pairs[i] = &report.pairs._buffer[i];
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const auto* a, const auto* b) { return a->lower < b->lower; });
  return pairs;
}

void add_pairs(std::vector<Line>& lines, const Feed& feed, Size size) {
  if (lines.size() + 3 > size.rows) return;
  lines.emplace_back(size.columns);
  Line& header = lines.emplace_back(size.columns);
  header.add(" distance    lower    upper  closing  contact  status           ticks old  ",
             Style::kDim);
  if (size.columns >= kWideColumns) {
    header.add("witness point on the first  on the second              ", Style::kDim);
  }
  header.add("published pairs, m, m/s, s", Style::kDim);
  for (const auto* pair : closest_first(feed.distances())) {
    if (lines.size() == size.rows) return;
    lines.push_back(pair_line(feed, *pair, size.columns));
  }
}

}  // namespace

std::vector<Line> screen_lines(const Feed& feed, const ViewContext& context, Size size) {
  std::vector<Line> lines;
  lines.push_back(title_line(feed, context, size.columns));
  if (feed.any()) {
    if (const std::string why = trouble(feed, context.now_ns); !why.empty()) {
      lines.emplace_back(size.columns).add(why, Style::kAlarm);
    }
    add_minimum(lines, feed, context.now_ns, size.columns);
    add_zones(lines, feed, size.columns);
    add_separation(lines, feed, size.columns);
    add_contacts(lines, feed, size.columns);
    add_counts(lines, feed, size.columns);
    add_shares(lines, feed, size.columns);
    add_health(lines, feed, context, size.columns);
    add_inputs(lines, feed, size.columns);
    add_witnesses(lines, feed, size.columns);
    add_pairs(lines, feed, size);
  }
  if (lines.size() > size.rows)
    lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(size.rows), lines.end());
  return lines;
}

std::string plain_line(const Feed& feed, const ViewContext& context) {
  if (!feed.any() && !feed.refusal().empty()) return feed.refusal();
  if (!feed.any()) return fmt::format("{} on {}", what_it_waits_for(feed), context.where);
  if (const std::string why = frozen(feed, context.now_ns); !why.empty()) return why;
  const clearance_msg_Distances& report = feed.distances();
  std::string text = fmt::format("cycle {}", report.cycle);
  if (feed.has_partner()) text += fmt::format("  {}", partners_since(feed, context.partner_counts));
  if (const std::string why = not_fresh(feed, context.now_ns); !why.empty()) {
    text += fmt::format("  ({})", why);
  }
  if (report.minimum_known && is_stale(report.minimum)) {
    text += fmt::format("  no minimum known, {} are late: least upper bound {:.4f} m, {}",
                        inputs_of(feed), report.minimum.upper, feed.pair_name(report.minimum));
  } else if (report.minimum_known) {
    const clearance_msg_PairDistance& pair = report.minimum;
    text += fmt::format("  minimum {:.4f} m [{:.4f}, {:.4f}] {}  {}", pair.distance, pair.lower,
                        pair.upper, feed.pair_name(pair), approach(pair));
    if (!report.minimum_certified) text += "  not certified";
  } else {
    text += "  no pair known";
  }
  if (report.unknown != 0)
    text += fmt::format("  {} of {} pairs unknown", report.unknown, report.pairs_total);
  if (const std::string absent = absent_shares(feed); !absent.empty())
    text += fmt::format("  {}", absent);
  for (const auto& [id, zone] : feed.zones()) {
    if (!zone.active) continue;
    const std::string why = cause(feed, zone);
    text += fmt::format("  zone {}{}", name_of(feed, id, zone.name),
                        why.empty() ? fmt::format(" ({})", feed.pair_name(zone.pair)) : why);
  }
  for (const auto& texts : {separation_texts(feed), contact_texts(feed), witness_texts(feed)})
    for (const std::string& each : texts) text += fmt::format("  {}", each);
  if (const auto* health = feed.health()) {
    text += fmt::format("  tick p50 {:.1f} p99.9 {:.1f} max {:.1f} us  overruns {}",
                        health->tick_p50_us, health->tick_p999_us, health->tick_max_us,
                        health->overruns);
  }
  if (report.newest_pose_ns != 0) {
    text += fmt::format("  {} {}", oldest_input(feed),
                        precise_age(report.now_ns - report.oldest_pose_ns));
  }
  return text;
}

std::string final_summary(const Feed& feed, double seconds, std::int64_t now_ns) {
  if (!feed.any()) return fmt::format("no report came in {:.1f} s\n", seconds);
  std::string text = fmt::format("{} in {:.1f} s, {} missed, {} of the daemon\n",
                                 counted(feed.reports(), "report"), seconds, feed.missed(),
                                 counted(feed.restarts(), "restart"));
  if (const OldReports& old = feed.old_reports(); old.count != 0) {
    text += fmt::format("{} of them were old when they were read, up to {:.1f} s\n", old.count,
                        seconds_of(old.oldest_ns));
  }
  for (const std::string& why : {frozen(feed, now_ns), feed.refused()})
    if (!why.empty()) text += fmt::format("{}\n", why);
  if (feed.has_partner())
    text += fmt::format("partners {}\n", counted_partners(feed.partner_counts()));
  if (feed.smallest().known) {
    const clearance_msg_PairDistance& pair = feed.smallest().pair;
    text += fmt::format("minimum  {:.6f} m in [{:.6f}, {:.6f}], {}, at cycle {}\n", pair.distance,
                        pair.lower, pair.upper, feed.smallest().name, feed.smallest().cycle);
  } else {
    text += "minimum  none: no pair was ever evaluated\n";
  }
  if (const auto* health = feed.health()) {
    text += fmt::format(
        "tick     p50 {:.1f} us  p99.9 {:.1f} us  max {:.1f} us\n"
        "daemon   {}, {}, {}, {} lost, as last told (each second)\n",
        health->tick_p50_us, health->tick_p999_us, health->tick_max_us,
        counted(health->overruns, "overrun"), counted(health->skipped_cycles, "skipped cycle"),
        counted(health->batches, "batch", "batches"), health->lost_batches);
  }
  return text;
}

}  // namespace clearance::watch
