// The field lists of a report. Each list stands here only once. The conversion to the wire,
// comparison, tables and tests iterate over it.
//
// A list names members, not a type. It visits our struct, its message on the wire, or both side by
// side. A new field of a report is one line in report.hpp, one in idl/clearance.idl and one here. A
// member that is missing in a list does not compile (the assertions below). A message field that is
// missing in all lists fails a test.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>
#include <type_traits>

#include "monitor/interface/report.hpp"

namespace clearance {

// The meaning of the number in a field.
enum class Meaning : std::uint8_t {
  kFigure,      // a plain value: a count, a length, a time, a flag
  kBound,       // a figure that is never NaN: one that is not known is at the end of its range
  kShare,       // a figure from 0 to 1: one that is not known is 0
  kCycle,       // a tick number, which a replay may count from another start; 0: never
  kPair,        // index into Scene::pairs
  kObject,      // index into Scene::objects
  kZone,        // index into Scene::zones
  kContact,     // index into Scene::contacts
  kPairStatus,  // this and the next five: the values of an enumeration
  kZoneCause,
  kValidity,
  kGradientStatus,
  kContactStatus,
  kContactEnded,
  kDelivery,  // sender, time and inputs of the message: not a result of the tick
};
// The last value of an enumeration; of any other meaning, the largest number.
[[nodiscard]] constexpr std::uint64_t last_value(Meaning meaning) noexcept {
  const auto number = [](auto last) { return static_cast<std::uint64_t>(last); };
  switch (meaning) {
    case Meaning::kPairStatus:
      return number(PairStatus::kAbsent);
    case Meaning::kZoneCause:
      return number(ZoneCause::kNoShare);
    case Meaning::kValidity:
      return number(SeparationValidity::kAbsent);
    case Meaning::kGradientStatus:
      return number(GradientStatus::kPartsCompared);
    case Meaning::kContactStatus:
      return number(ContactStatus::kAbsent);
    case Meaning::kContactEnded:
      return number(ContactEnded::kByCycle);
    default:
      return std::numeric_limits<std::uint64_t>::max();
  }
}

// Passed to the visitor beside the values.
struct Field {
  std::string_view name;
  Meaning meaning = Meaning::kFigure;
};

// PairReport, and PairDistance on the wire. The order of the message lets the conversion copy
// neighbours together, which saves a fifth of its time where there are many pairs.
struct PairFields {
  template <class Visit, class... Pair>
  static constexpr void for_each(Visit&& visit, Pair&... pair) {
    visit(Field{"pair", Meaning::kPair}, pair.pair...);
    visit(Field{"part_a"}, pair.part_a...);
    visit(Field{"part_b"}, pair.part_b...);
    visit(Field{"status", Meaning::kPairStatus}, pair.status...);
    visit(Field{"distance"}, pair.distance...);
    visit(Field{"lower", Meaning::kBound}, pair.lower...);
    visit(Field{"upper", Meaning::kBound}, pair.upper...);
    visit(Field{"swept_lower", Meaning::kBound}, pair.swept_lower...);
    visit(Field{"model_error"}, pair.model_error...);
    visit(Field{"stop_lower"}, pair.stop_lower...);
    visit(Field{"witness_a"}, pair.witness_a...);
    visit(Field{"witness_b"}, pair.witness_b...);
    visit(Field{"normal"}, pair.normal...);
    visit(Field{"closing_speed"}, pair.closing_speed...);
    visit(Field{"time_to_contact"}, pair.time_to_contact...);
    visit(Field{"age_a_ns"}, pair.age_a_ns...);
    visit(Field{"age_b_ns"}, pair.age_b_ns...);
    visit(Field{"evaluated_cycle", Meaning::kCycle}, pair.evaluated_cycle...);
    visit(Field{"refresh_age_cycles"}, pair.refresh_age_cycles...);
  }
};

// The fields that ZoneReport shares with ZoneState on the wire.
struct PublishedZoneFields {
  template <class Visit, class... Zone>
  static constexpr void for_each(Visit&& visit, Zone&... zone) {
    visit(Field{"active"}, zone.active...);
    visit(Field{"cause", Meaning::kZoneCause}, zone.cause...);
    visit(Field{"cause_object", Meaning::kObject}, zone.cause_object...);
    visit(Field{"pair", Meaning::kPair}, zone.pair...);
    visit(Field{"clearance", Meaning::kBound}, zone.clearance...);
    visit(Field{"swept_clearance", Meaning::kBound}, zone.swept_clearance...);
    visit(Field{"certified"}, zone.certified...);
    visit(Field{"since_cycle", Meaning::kCycle}, zone.since_cycle...);
  }
};
struct ZoneFields {
  template <class Visit, class... Zone>
  static constexpr void for_each(Visit&& visit, Zone&... zone) {
    PublishedZoneFields::for_each(visit, zone...);
    visit(Field{"changed"}, zone.changed...);
  }
};

// PairSeparation, in the report and on the wire.
struct PairSeparationFields {
  template <class Visit, class... Pair>
  static constexpr void for_each(Visit&& visit, Pair&... pair) {
    visit(Field{"zone", Meaning::kZone}, pair.zone...);
    visit(Field{"pair", Meaning::kPair}, pair.pair...);
    visit(Field{"validity", Meaning::kValidity}, pair.validity...);
    visit(Field{"clearance", Meaning::kBound}, pair.clearance...);
    visit(Field{"human_speed"}, pair.human_speed...);
    visit(Field{"robot_speed"}, pair.robot_speed...);
    visit(Field{"human_term"}, pair.human_term...);
    visit(Field{"robot_term"}, pair.robot_term...);
    visit(Field{"stopping_term"}, pair.stopping_term...);
    visit(Field{"protective_distance"}, pair.protective_distance...);
    visit(Field{"remaining", Meaning::kBound}, pair.remaining...);
    visit(Field{"speed_limit", Meaning::kBound}, pair.speed_limit...);
    visit(Field{"scaling", Meaning::kShare}, pair.scaling...);
    visit(Field{"age_human_ns"}, pair.age_human_ns...);
    visit(Field{"age_robot_ns"}, pair.age_robot_ns...);
  }
};

// ZoneSeparation, in the report and on the wire.
struct ZoneSeparationFields {
  template <class Visit, class... Zone>
  static constexpr void for_each(Visit&& visit, Zone&... zone) {
    visit(Field{"zone", Meaning::kZone}, zone.zone...);
    visit(Field{"pair", Meaning::kPair}, zone.pair...);
    visit(Field{"validity", Meaning::kValidity}, zone.validity...);
    visit(Field{"remaining", Meaning::kBound}, zone.remaining...);
    visit(Field{"speed_limit", Meaning::kBound}, zone.speed_limit...);
    visit(Field{"scaling", Meaning::kShare}, zone.scaling...);
  }
};

// RobotStop, in the report and on the wire.
struct RobotStopFields {
  template <class Visit, class... Stop>
  static constexpr void for_each(Visit&& visit, Stop&... stop) {
    visit(Field{"robot"}, stop.robot...);
    visit(Field{"validity", Meaning::kValidity}, stop.validity...);
    visit(Field{"scaling", Meaning::kShare}, stop.scaling...);
    visit(Field{"clearance", Meaning::kBound}, stop.clearance...);
    visit(Field{"pair", Meaning::kPair}, stop.pair...);
    visit(Field{"share", Meaning::kShare}, stop.share...);
    visit(Field{"time"}, stop.time...);
  }
};

// ContactReport, and ContactState on the wire.
struct ContactFields {
  template <class Visit, class... Contact>
  static constexpr void for_each(Visit&& visit, Contact&... contact) {
    visit(Field{"contact", Meaning::kContact}, contact.contact...);
    visit(Field{"pair", Meaning::kPair}, contact.pair...);
    visit(Field{"status", Meaning::kContactStatus}, contact.status...);
    visit(Field{"ended", Meaning::kContactEnded}, contact.ended...);
    visit(Field{"depth", Meaning::kBound}, contact.depth...);
    visit(Field{"since_cycle", Meaning::kCycle}, contact.since_cycle...);
    visit(Field{"since_ns"}, contact.since_ns...);
    visit(Field{"ended_cycle", Meaning::kCycle}, contact.ended_cycle...);
    visit(Field{"ended_ns"}, contact.ended_ns...);
  }
};

// HiddenReport, and HiddenState on the wire.
struct HiddenFields {
  template <class Visit, class... Hidden>
  static constexpr void for_each(Visit&& visit, Hidden&... hidden) {
    visit(Field{"pair", Meaning::kPair}, hidden.pair...);
    visit(Field{"elements"}, hidden.elements...);
    visit(Field{"thickness", Meaning::kBound}, hidden.thickness...);
    visit(Field{"unseen", Meaning::kBound}, hidden.unseen...);
    visit(Field{"unseen_at"}, hidden.unseen_at...);
  }
};

// GradientAlternative, in the report and on the wire.
struct GradientAlternativeFields {
  template <class Visit, class... Alternative>
  static constexpr void for_each(Visit&& visit, Alternative&... alternative) {
    visit(Field{"status", Meaning::kGradientStatus}, alternative.status...);
    visit(Field{"farther"}, alternative.farther...);
    visit(Field{"tilt"}, alternative.tilt...);
  }
};

// Gradients in the report. On the wire each pair has its own rates
// (monitor/wire/message_fields.hpp).
struct GradientFields {
  template <class Visit, class... Gradients>
  static constexpr void for_each(Visit&& visit, Gradients&... gradients) {
    visit(Field{"rates"}, gradients.rates...);
    visit(Field{"drifts"}, gradients.drifts...);
    visit(Field{"alternatives"}, gradients.alternatives...);
  }
};

// The fields of a report that every message of its tick repeats.
struct TickFields {
  template <class Visit, class... Report>
  static constexpr void for_each(Visit&& visit, Report&... report) {
    visit(Field{"cycle", Meaning::kCycle}, report.cycle...);
    visit(Field{"now_ns"}, report.now_ns...);
    visit(Field{"scene_revision"}, report.scene_revision...);
  }
};

// The fields that Report shares with Distances on the wire. Their order is that in which a person
// looks for a cause: time and scene, then counts, then distances.
struct DistanceFields {
  template <class Visit, class... Report>
  static constexpr void for_each(Visit&& visit, Report&... report) {
    TickFields::for_each(visit, report...);
    visit(Field{"clock_offset_ns"}, report.clock_offset_ns...);
    visit(Field{"report_delay_ns"}, report.report_delay_ns...);
    visit(Field{"newest_pose_ns"}, report.newest_pose_ns...);
    visit(Field{"oldest_pose_ns"}, report.oldest_pose_ns...);
    visit(Field{"pairs_total"}, report.pairs_total...);
    visit(Field{"unknown"}, report.unknown...);
    visit(Field{"stale"}, report.stale...);
    visit(Field{"evaluated"}, report.evaluated...);
    visit(Field{"carried"}, report.carried...);
    visit(Field{"queries"}, report.queries...);
    visit(Field{"oldest_evaluation_cycles"}, report.oldest_evaluation_cycles...);
    visit(Field{"minimum_known"}, report.minimum_known...);
    visit(Field{"minimum_certified"}, report.minimum_certified...);
    visit(Field{"minimum"}, report.minimum...);
    visit(Field{"lower_all", Meaning::kBound}, report.lower_all...);
    visit(Field{"swept_lower_all", Meaning::kBound}, report.swept_lower_all...);
    visit(Field{"pairs"}, report.pairs...);
    visit(Field{"contacts"}, report.contacts...);
    visit(Field{"hidden"}, report.hidden...);
  }
};
struct ReportFields {
  template <class Visit, class... Report>
  static constexpr void for_each(Visit&& visit, Report&... report) {
    DistanceFields::for_each(visit, report...);
    visit(Field{"zones"}, report.zones...);
    visit(Field{"separated_pairs"}, report.separated_pairs...);
    visit(Field{"separated_zones"}, report.separated_zones...);
    visit(Field{"stops"}, report.stops...);
    visit(Field{"gradients"}, report.gradients...);
    visit(Field{"rejected"}, report.rejected...);
  }
};

// The field list of a type. A type without a list has no `for_each`.
template <class T>
struct FieldsOf {};
template <>
struct FieldsOf<PairReport> : PairFields {};
template <>
struct FieldsOf<ZoneReport> : ZoneFields {};
template <>
struct FieldsOf<PairSeparation> : PairSeparationFields {};
template <>
struct FieldsOf<ZoneSeparation> : ZoneSeparationFields {};
template <>
struct FieldsOf<RobotStop> : RobotStopFields {};
template <>
struct FieldsOf<ContactReport> : ContactFields {};
template <>
struct FieldsOf<HiddenReport> : HiddenFields {};
template <>
struct FieldsOf<GradientAlternative> : GradientAlternativeFields {};
template <>
struct FieldsOf<Gradients> : GradientFields {};
template <>
struct FieldsOf<Report> : ReportFields {};

// Calls visit(Field, first.member, others.member...) for every field of `first`.
template <class Visit, class First, class... Others>
constexpr void for_each_field(Visit&& visit, First& first, Others&... others) {
  FieldsOf<std::remove_const_t<First>>::for_each(visit, first, others...);
}

// True if T has a field list.
template <class T>
concept HasFields = requires {
  FieldsOf<T>::for_each([](Field) {});
};

namespace fields_detail {

template <class List>
constexpr std::size_t listed() {
  std::size_t count = 0;
  List::for_each([&count](Field) { ++count; });
  return count;
}

struct Anything {
  template <class T>
  operator T() const;  // NOLINT(google-explicit-constructor): stands for any member's value
};

// The largest number of values that T{...} takes: the number of its members.
template <class T, class... Values>
constexpr std::size_t members() {
  if constexpr (requires { T{Values{}..., Anything{}}; }) {
    return members<T, Values..., Anything>();
  } else {
    return sizeof...(Values);
  }
}

template <class T>
inline constexpr bool kListIsComplete = listed<FieldsOf<T>>() == members<T>();

}  // namespace fields_detail

static_assert(fields_detail::kListIsComplete<PairReport>);
static_assert(fields_detail::kListIsComplete<ZoneReport>);
static_assert(fields_detail::kListIsComplete<PairSeparation>);
static_assert(fields_detail::kListIsComplete<ZoneSeparation>);
static_assert(fields_detail::kListIsComplete<RobotStop>);
static_assert(fields_detail::kListIsComplete<ContactReport>);
static_assert(fields_detail::kListIsComplete<HiddenReport>);
static_assert(fields_detail::kListIsComplete<GradientAlternative>);
static_assert(fields_detail::kListIsComplete<Gradients>);
static_assert(fields_detail::kListIsComplete<Report>);

}  // namespace clearance
