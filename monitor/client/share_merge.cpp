#include "monitor/client/share_merge.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <span>
#include <string_view>

#include "config/text/fnv1a.hpp"
#include "monitor/client/complete_reports.hpp"
#include "monitor/client/sequence_view.hpp"
#include "monitor/interface/report.hpp"
#include "monitor/interface/tight_bounds.hpp"
#include "monitor/wire/dds_sample.hpp"
#include "monitor/wire/message_fields.hpp"

namespace clearance::client {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

// Lists the fields that joining treats, so that a new field does not compile before it is treated.
constexpr std::string_view kJoined[] = {
    // of the cell: the caller names itself, and seals the message
    "daemon", "partner", "lineage", "checksum", "state_checksum", "delivery_checksum", "period_ns",
    "address", "changes_since", "cycle", "scene_revision",
    // none: the shares may have used different batches of a source
    "source_contents",
    // join_reports, add_counts, join_pairs and join_sources
    "now_ns", "publish_ns", "clock_offset_ns", "report_delay_ns", "newest_pose_ns",
    "oldest_pose_ns", "pairs_total", "unknown", "stale", "evaluated", "carried", "queries",
    "oldest_evaluation_cycles", "minimum_known", "minimum_certified", "minimum", "lower_all",
    "swept_lower_all", "pairs", "contacts", "hidden", "sources", "active_zones"};
constexpr bool joins_all() {
  bool all = true;
  FieldsOf<clearance_msg_Distances>::for_each([&all](Field field) {
    all = all && std::ranges::find(kJoined, field.name) != std::end(kJoined);
  });
  return all;
}
static_assert(joins_all(), "a field of Distances is not joined: see kJoined");

// Empties a sequence whose elements own nothing, with capacity for `count` of them.
template <class Sequence>
void begin(Sequence& sequence, std::size_t count) {
  if (sequence._maximum < count) {
    if (sequence._release) dds_free(sequence._buffer);
    reserve_sequence(sequence, count);
  }
  sequence._length = 0;
}

template <class Sequence, class Element>
void append(Sequence& sequence, const Element& element) {
  if (sequence._length < sequence._maximum) sequence._buffer[sequence._length++] = element;
}

bool is_nearer(const clearance_msg_PairDistance& one, const clearance_msg_PairDistance& other) {
  if (one.upper != other.upper) return one.upper < other.upper;
  return one.lower != other.lower ? one.lower < other.lower : one.pair < other.pair;
}

// Both lists are in the order of the cell.
void join_pairs(const ShareMap& map, std::span<const ShareView> views,
                clearance_msg_Distances& out) {
  begin(out.pairs, map.published().size());
  std::vector<std::uint32_t> next(views.size(), 0);
  for (const ShareMap::Published& published : map.published()) {
    const ShareView& view = views[published.share];
    const clearance_msg_PairDistance* found = nullptr;
    if (view.state == ShareState::kWhole) {
      const auto pairs = list(view.report->pairs);
      std::uint32_t& at = next[published.share];
      while (at < pairs.size() && pairs[at].pair < published.pair) ++at;
      if (at < pairs.size() && pairs[at].pair == published.pair) found = &pairs[at];
    }
    append(out.pairs, found != nullptr ? *found : unknown_pair(published.pair));
  }
}

void add_counts(const clearance_msg_Distances& report, clearance_msg_Distances& out) {
  out.evaluated += report.evaluated;
  out.carried += report.carried;
  out.stale += report.stale;
  out.unknown += report.unknown;
  out.queries += report.queries;
  out.oldest_evaluation_cycles =
      std::max(out.oldest_evaluation_cycles, report.oldest_evaluation_cycles);
  const bool measured = out.report_delay_ns >= 0 && report.report_delay_ns >= 0;
  out.report_delay_ns = measured ? std::max(out.report_delay_ns, report.report_delay_ns) : -1;
  out.lower_all = std::min(out.lower_all, report.lower_all);
  out.swept_lower_all = std::min(out.swept_lower_all, report.swept_lower_all);
  out.newest_pose_ns = std::max(out.newest_pose_ns, report.newest_pose_ns);
  const auto older = [](std::int64_t a, std::int64_t b) {
    return a == 0 || (b != 0 && b < a) ? b : a;
  };
  out.oldest_pose_ns = older(out.oldest_pose_ns, report.oldest_pose_ns);
  out.now_ns = older(out.now_ns, report.now_ns);
  out.publish_ns = older(out.publish_ns, report.publish_ns);
  if (report.minimum_known && (!out.minimum_known || is_nearer(report.minimum, out.minimum))) {
    out.minimum_known = true;
    out.minimum = report.minimum;
    out.clock_offset_ns = report.clock_offset_ns;
  }
}

// The batches that every share has used.
void join_sources(std::span<const ShareView> views, clearance_msg_Distances& out) {
  begin(out.sources, clearance_msg_kMaxSources);
  bool is_first = true;
  for (const ShareView& view : views) {
    if (view.state != ShareState::kWhole) continue;
    const auto uses = list(view.report->sources);
    if (is_first) {
      for (const clearance_msg_SourceUse& use : uses) append(out.sources, use);
    }
    is_first = false;
    std::uint32_t kept = 0;
    for (clearance_msg_SourceUse& use : list(out.sources)) {
      const auto same = std::ranges::find_if(uses, [&use](const clearance_msg_SourceUse& other) {
        return std::strcmp(use.source, other.source) == 0;
      });
      if (same == uses.end()) continue;
      use.sequence_number = std::min(use.sequence_number, same->sequence_number);
      out.sources._buffer[kept++] = use;
    }
    out.sources._length = kept;
  }
}

// No pair of a share is nearer than its lower_all. If its minimum is certified, none of its other
// pairs is nearer than that minimum's upper bound. The pair of the minimum may be nearer, unless
// its bounds are tight.
bool allows_minimum(const clearance_msg_Distances& report,
                    const clearance_msg_PairDistance& least) {
  const bool is_tight =
      report.minimum.pair == least.pair || are_tight(report.minimum.lower, report.minimum.upper);
  return report.lower_all >= least.upper || (report.minimum_certified && is_tight);
}

// A robot is clear if it is clear in each share. Shares without pairs of it report it as well.
clearance_msg_RobotStop joined_stop(const ShareMap& map, std::span<const ShareView> views,
                                    std::uint32_t robot) {
  clearance_msg_RobotStop joined{};
  bool is_known = true, has_any = false;
  for (std::size_t share = 0; share < views.size(); ++share) {
    if (map.pairs(share) == 0) continue;
    const bool is_heard =
        views[share].state == ShareState::kWhole && views[share].separation != nullptr;
    const auto stops =
        is_heard ? list(views[share].separation->stops) : std::span<clearance_msg_RobotStop>();
    const auto found = std::ranges::find(stops, robot, &clearance_msg_RobotStop::robot);
    if (found == stops.end()) {
      is_known = false;
      continue;
    }
    const auto rank = [](const clearance_msg_RobotStop& of) {
      return std::pair(of.scaling, of.clearance);
    };
    const clearance_msg_RobotStop worst = !has_any || rank(*found) < rank(joined) ? *found : joined;
    const auto before = has_any ? joined : *found;
    joined = worst;
    joined.validity = std::min(before.validity, found->validity);
    joined.clearance = std::min(before.clearance, found->clearance);
    joined.share = std::min(before.share, found->share);
    joined.time = found->time > before.time || std::isnan(found->time) ? found->time : before.time;
    has_any = true;
  }
  if (is_known && has_any) return joined;
  return {robot, 0, 0.0, -kNone, 0, 0.0, std::numeric_limits<double>::quiet_NaN()};
}

}  // namespace

const char* name(ShareState state) noexcept {
  constexpr std::array kNames = {
      "whole", "missing", "late", "of another revision", "divided otherwise", "held"};
  const auto index = static_cast<std::size_t>(state);
  return index < kNames.size() ? kNames[index] : "";
}

std::uint64_t division_of(const clearance_msg_Catalogue& catalogue) {
  Fnv1a hash;
  for (const clearance_msg_CatalogueShare& share : list(catalogue.shares)) {
    hash.add(std::string_view(share.name));
    hash.add(std::uint64_t{share.pairs_total});
  }
  hash.add(std::as_bytes(list(catalogue.pair_shares)));
  return hash.value();
}

ShareMap::ShareMap(const clearance_msg_Catalogue& catalogue)
    : revision_(catalogue.scene_revision),
      division_(division_of(catalogue)),
      zones_(catalogue.zones._length) {
  const auto shares = list(catalogue.shares);
  first_pairs_.assign(shares.size(), 0);
  std::vector<bool> has_first(shares.size());
  for (std::size_t share = 0; share < shares.size(); ++share) {
    names_.emplace_back(shares[share].name);
    pairs_.push_back(shares[share].pairs_total);
    for (const std::uint32_t zone : list(shares[share].zones)) {
      if (zone < zones_.size()) zones_[zone].push_back(share);
    }
  }
  const auto share_of = list(catalogue.pair_shares);
  const auto pairs = list(catalogue.pairs);
  for (std::uint32_t i = 0; i < pairs.size() && i < share_of.size(); ++i) {
    const std::uint8_t share = share_of[i];
    if (share >= shares.size()) continue;
    if (!has_first[share]) first_pairs_[share] = i;
    has_first[share] = true;
    if (pairs[i].published) published_.push_back({i, share});
  }
  for (const std::uint32_t zone : list(catalogue.separated_zones)) {
    if (zone < zones_.size() && !zones_[zone].empty()) separated_.push_back(zone);
  }
  const auto stopping = list(catalogue.stopping_robots);
  stopping_.assign(stopping.begin(), stopping.end());
}

void join_reports(const ShareMap& map, std::span<const ShareView> views,
                  clearance_msg_Distances& out) {
  join_pairs(map, views, out);
  std::size_t contacts = 0, hidden = 0;
  for (const ShareView& view : views) {
    if (view.state != ShareState::kWhole) continue;
    contacts += view.report->contacts._length;
    hidden += view.report->hidden._length;
  }
  begin(out.contacts, contacts);
  begin(out.hidden, hidden);
  begin(out.active_zones, map.zones().size());  // which the caller fills
  join_sources(views, out);
  out.scene_revision = map.revision();
  out.now_ns = out.publish_ns = out.clock_offset_ns = out.report_delay_ns = 0;
  out.newest_pose_ns = out.oldest_pose_ns = 0;
  out.minimum_known = false;
  out.minimum = unknown_pair(0);
  out.lower_all = out.swept_lower_all = kNone;
  out.pairs_total = out.evaluated = out.carried = out.stale = out.unknown = out.queries = 0;
  out.oldest_evaluation_cycles = 0;
  for (std::size_t share = 0; share < views.size(); ++share) {
    out.pairs_total += map.pairs(share);
    if (views[share].state == ShareState::kWhole) {
      add_counts(*views[share].report, out);
      for (const clearance_msg_ContactState& contact : list(views[share].report->contacts))
        append(out.contacts, contact);
      for (const clearance_msg_HiddenState& place : list(views[share].report->hidden))
        append(out.hidden, place);
    } else {
      out.unknown += map.pairs(share);
      if (map.pairs(share) > 0) out.lower_all = out.swept_lower_all = -kNone;
    }
  }
  std::ranges::sort(list(out.contacts), {}, &clearance_msg_ContactState::pair);
  std::ranges::sort(list(out.hidden), {}, &clearance_msg_HiddenState::pair);
  if (views.empty()) out.lower_all = out.swept_lower_all = -kNone;
  out.minimum_certified = out.minimum_known;
  for (std::size_t share = 0; share < views.size(); ++share) {
    if (map.pairs(share) == 0) continue;
    out.minimum_certified = out.minimum_certified && views[share].state == ShareState::kWhole &&
                            allows_minimum(*views[share].report, out.minimum);
  }
}

void join_separations(const ShareMap& map, std::span<const ShareView> views,
                      clearance_msg_Separation& out) {
  std::size_t pairs = 0;
  for (const ShareView& view : views)
    pairs += view.separation == nullptr ? 0 : view.separation->pairs._length;
  begin(out.pairs, pairs);
  begin(out.zones, map.separated().size());
  for (const std::uint32_t zone : map.separated()) {
    clearance_msg_ZoneSeparation least{};
    bool is_known = true, has_any = false;
    for (const std::size_t share : map.zones()[zone]) {
      const clearance_msg_Separation* const of =
          views[share].state == ShareState::kWhole ? views[share].separation : nullptr;
      const clearance_msg_ZoneSeparation* found = nullptr;
      if (of != nullptr) {
        const auto in = list(of->zones);
        const auto at = std::ranges::find(in, zone, &clearance_msg_ZoneSeparation::zone);
        if (at != in.end()) found = &*at;
        for (const clearance_msg_PairSeparation& pair : list(of->pairs)) {
          if (pair.zone == zone) append(out.pairs, pair);
        }
      }
      is_known = is_known && found != nullptr;
      if (found == nullptr) continue;
      // Absent (3) limits nothing and is no measure of the others.
      const auto validity = [](const clearance_msg_ZoneSeparation& each) { return each.validity; };
      const bool is_nearer =
          !has_any || found->scaling < least.scaling ||
          (found->scaling == least.scaling && found->remaining < least.remaining);
      const auto worst = has_any ? std::min(validity(*found), validity(least)) : validity(*found);
      const auto less = [&](double a, double b) { return has_any ? std::min(a, b) : a; };
      const double speed = less(found->speed_limit, least.speed_limit);
      const double remaining = less(found->remaining, least.remaining);
      if (is_nearer) least = *found;
      least.validity = worst;
      least.speed_limit = speed;
      least.remaining = remaining;
      has_any = true;
    }
    if (!is_known || !has_any) {
      const std::size_t share = map.zones()[zone].front();
      least = {zone, 0, map.pairs(share) > 0 ? map.first_pair(share) : 0, -kNone, 0.0, 0.0};
    }
    append(out.zones, least);
  }
  begin(out.stops, map.stopping().size());
  for (const std::uint32_t robot : map.stopping())
    append(out.stops, joined_stop(map, views, robot));
}

void join_gradients(const ShareMap& map, std::span<const ShareView> views,
                    clearance_msg_Gradients& out) {
  reserve_sequence(out.pairs, map.published().size());
  reserve_sequence(out.alternatives, map.published().size());
  std::vector<std::uint32_t> next(views.size(), 0);
  for (const ShareMap::Published& published : map.published()) {
    const ShareView& view = views[published.share];
    if (view.state != ShareState::kWhole || view.gradients == nullptr) continue;
    const auto pairs = list(view.gradients->pairs);
    const auto alternatives = list(view.gradients->alternatives);
    std::uint32_t& at = next[published.share];
    while (at < pairs.size() && pairs[at].pair < published.pair) ++at;
    if (at == pairs.size() || pairs[at].pair != published.pair) continue;
    clearance_msg_PairGradient& to = out.pairs._buffer[out.pairs._length++];
    to = pairs[at];
    to.joints = {};
    reserve_sequence(to.joints, pairs[at].joints._length);
    for (const clearance_msg_JointGradient& joint : list(pairs[at].joints))
      append(to.joints, joint);
    append(out.alternatives,
           at < alternatives.size() ? alternatives[at] : clearance_msg_GradientAlternative{});
  }
}

clearance_msg_ZoneState join_zone(const ShareMap& map, std::uint32_t zone,
                                  std::span<const clearance_msg_ZoneState* const> of_shares) {
  clearance_msg_ZoneState joined{};
  joined.zone = zone;
  joined.certified = true;
  joined.clearance = joined.swept_clearance = kNone;
  const auto unknown = [&joined](std::uint32_t pair) {
    joined.active = true;
    joined.certified = false;
    joined.cause = static_cast<std::uint8_t>(ZoneCause::kNoShare);
    joined.cause_object = 0;
    joined.pair = pair;
    joined.clearance = joined.swept_clearance = -kNone;
    return joined;
  };
  if (zone >= map.zones().size()) return unknown(0);
  for (const std::size_t share : map.zones()[zone]) {
    const clearance_msg_ZoneState* const state = of_shares[share];
    if (state == nullptr) return unknown(map.first_pair(share));
    const bool decides =
        (state->active && !joined.active) ||
        (state->active == joined.active && state->swept_clearance < joined.swept_clearance);
    joined.certified = joined.certified && state->certified;
    if (!decides && joined.name[0] != '\0') continue;
    const bool is_certified = joined.certified;
    joined = *state;
    joined.certified = is_certified;
  }
  return joined;
}

}  // namespace clearance::client
