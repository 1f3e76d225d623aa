// The fields of the messages that are not written in each tick, in the order of the IDL.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

#include "commands.h"
#include "monitor/wire/message_fields.hpp"
#include "questions.h"

namespace clearance {
namespace fields_detail {

// The names of "a, b, c".
template <std::size_t N>
constexpr std::array<std::string_view, N> split(std::string_view names) {
  std::array<std::string_view, N> each;
  for (std::string_view& name : each) {
    name = names.substr(0, names.find(','));
    names.remove_prefix(std::min(names.size(), name.size() + 2));
  }
  return each;
}

template <std::size_t I, class Visit, class... Members>
constexpr void visit_one(Visit& visit, std::string_view name, const Members&... members) {
  visit(Field{name}, std::get<I>(members)...);
}

template <class Visit, std::size_t N, std::size_t... I, class... Members>
constexpr void visit_all(Visit& visit, const std::array<std::string_view, N>& names,
                         std::index_sequence<I...>, const Members&... members) {
  (visit_one<I>(visit, names[I], members...), ...);
}

}  // namespace fields_detail

// A list that lacks a member does not compile.
#define CLEARANCE_MESSAGE_FIELDS(type, ...)                                              \
  template <>                                                                            \
  struct FieldsOf<clearance_msg_##type> {                                                \
    static constexpr std::string_view kType = #type, kNames = #__VA_ARGS__;              \
    static constexpr std::size_t kCount = 1 + std::ranges::count(kNames, ',');           \
    template <class Message>                                                             \
    static constexpr auto members(Message& message) {                                    \
      auto& [__VA_ARGS__] = message;                                                     \
      return std::tie(__VA_ARGS__);                                                      \
    }                                                                                    \
    template <class Visit, class... Message>                                             \
    static constexpr void for_each(Visit&& visit, Message&... message) {                 \
      fields_detail::visit_all(visit, fields_detail::split<kCount>(kNames),              \
                               std::make_index_sequence<kCount>(), members(message)...); \
    }                                                                                    \
  };

CLEARANCE_MESSAGE_FIELDS(RejectCount, object, cause, count, last)
CLEARANCE_MESSAGE_FIELDS(SourceHealth, source, batches, lost_batches, cut_poses, age_ns)
CLEARANCE_MESSAGE_FIELDS(InputAge, object, name, age_ns, stale, contradicted, follows_joints,
                         source, other_source)
CLEARANCE_MESSAGE_FIELDS(JointAge, variable, name, age_ns, stale, contradicted, source,
                         other_source)
CLEARANCE_MESSAGE_FIELDS(InputNote, input, takeovers, source, former_source, velocities_contradict)
CLEARANCE_MESSAGE_FIELDS(PartnerHealth, partner, other, standing, leads, other_publishes,
                         agrees_from, compared, different, other_inputs, missing, phase_ns)
CLEARANCE_MESSAGE_FIELDS(ShareHealth, share, state, daemon, cycle, scene_revision, age_ns)
CLEARANCE_MESSAGE_FIELDS(WitnessHealth, sensor, robot, link, agreeing, through, denied,
                         residual_p50, residual_p90)
CLEARANCE_MESSAGE_FIELDS(InputResponse, input, p50_us, max_us)
CLEARANCE_MESSAGE_FIELDS(Health, daemon, cycle, now_ns, scene_revision, clock_steps,
                         clock_offset_ns, tick_p50_us, tick_p999_us, tick_max_us, wakeup_p50_us,
                         wakeup_p999_us, wakeup_max_us, response_p50_us, response_p999_us,
                         response_max_us, tick_second_max_us, wakeup_second_max_us, overruns,
                         skipped_cycles, batches, lost_batches, undecodable_samples,
                         dropped_reports, other_writers, foreign_reports, rejected, inputs, joints,
                         sources, recording, recording_missing, notes, partner, shares, witnesses,
                         late_responses, responses, delivery_checksum, period_ns, address)

CLEARANCE_MESSAGE_FIELDS(CatalogueObject, id, name, is_fixed, parts)
CLEARANCE_MESSAGE_FIELDS(CataloguePair, id, object_a, object_b, published)
CLEARANCE_MESSAGE_FIELDS(CatalogueZone, id, name, group_a, group_b, enter_below, leave_above)
CLEARANCE_MESSAGE_FIELDS(CatalogueJoint, id, name)
CLEARANCE_MESSAGE_FIELDS(CatalogueContact, id, name, group_a, group_b, depth, end_distance,
                         end_duration_ns, end_time_ns, last_cycle, by, reason)
CLEARANCE_MESSAGE_FIELDS(CatalogueShare, name, pairs_total, zones)
CLEARANCE_MESSAGE_FIELDS(Catalogue, daemon, scene, scene_revision, rate_hz, objects, pairs, zones,
                         cell_yaml, joints, contacts, began_after, in_force_from, share, shares,
                         pair_shares, separated_zones, robots, stopping_robots, cell_hash, build,
                         delivery_checksum, address)

CLEARANCE_MESSAGE_FIELDS(CommandResult, client, request, daemon, status, change, path, reason,
                         scene_revision, in_force_from, delivery_checksum, address)
CLEARANCE_MESSAGE_FIELDS(MarginVerdict, margin, verdict, above_until, below_at, first, second, a, b)
CLEARANCE_MESSAGE_FIELDS(ProfilePart, begin, end, lower, upper, first, second)
CLEARANCE_MESSAGE_FIELDS(Answer, client, request, daemon, status, path, reason, scene_revision,
                         cycle, now_ns, lower, upper, time, first, second, point_on_first,
                         point_on_second, margins, profile, is_time_limited, time_factor,
                         time_factor_above, time_limit_at, time_limit_first, time_limit_second,
                         time_limit_zone, within_work_limit, queries, start_deviation, start_joint,
                         delivery_checksum, address)

#undef CLEARANCE_MESSAGE_FIELDS

}  // namespace clearance
