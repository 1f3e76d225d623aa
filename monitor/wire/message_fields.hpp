// The fields of the messages that a tick publishes: the lists of
// monitor/interface/report_fields.hpp and the fields that only messages have.
#pragma once

#include "clearance.h"
#include "monitor/interface/report_fields.hpp"

namespace clearance {

struct SourceUseFields {
  template <class Visit, class... Use>
  static constexpr void for_each(Visit&& visit, Use&... use) {
    visit(Field{"source"}, use.source...);
    visit(Field{"sequence_number"}, use.sequence_number...);
  }
};

// The fields that every message of a tick has beside the report.
struct DeliveryFields {
  template <class Visit, class... Message>
  static constexpr void for_each(Visit&& visit, Message&... message) {
    visit(Field{"daemon", Meaning::kDelivery}, message.daemon...);
    visit(Field{"publish_ns", Meaning::kDelivery}, message.publish_ns...);
    visit(Field{"period_ns", Meaning::kDelivery}, message.period_ns...);
    visit(Field{"address", Meaning::kDelivery}, message.address...);
    visit(Field{"delivery_checksum", Meaning::kDelivery}, message.delivery_checksum...);
  }
};

struct DistancesMessageFields {
  template <class Visit, class... Message>
  static constexpr void for_each(Visit&& visit, Message&... message) {
    DeliveryFields::for_each(visit, message...);
    visit(Field{"sources", Meaning::kDelivery}, message.sources...);
    visit(Field{"partner", Meaning::kDelivery}, message.partner...);
    visit(Field{"lineage", Meaning::kDelivery}, message.lineage...);
    visit(Field{"checksum", Meaning::kDelivery}, message.checksum...);
    visit(Field{"state_checksum", Meaning::kDelivery}, message.state_checksum...);
    visit(Field{"changes_since", Meaning::kDelivery}, message.changes_since...);
    visit(Field{"active_zones", Meaning::kDelivery}, message.active_zones...);
    visit(Field{"source_contents", Meaning::kDelivery}, message.source_contents...);
    DistanceFields::for_each(visit, message...);
  }
};

struct ZoneStateFields {
  template <class Visit, class... Zone>
  static constexpr void for_each(Visit&& visit, Zone&... zone) {
    visit(Field{"daemon", Meaning::kDelivery}, zone.daemon...);
    visit(Field{"zone", Meaning::kZone}, zone.zone...);
    visit(Field{"name"}, zone.name...);
    visit(Field{"cycle", Meaning::kCycle}, zone.cycle...);
    visit(Field{"now_ns"}, zone.now_ns...);
    PublishedZoneFields::for_each(visit, zone...);
    visit(Field{"delivery_checksum", Meaning::kDelivery}, zone.delivery_checksum...);
    visit(Field{"address", Meaning::kDelivery}, zone.address...);
  }
};

// Pairs come first: their zone follows from them.
struct SeparationMessageFields {
  template <class Visit, class... Message>
  static constexpr void for_each(Visit&& visit, Message&... message) {
    DeliveryFields::for_each(visit, message...);
    TickFields::for_each(visit, message...);
    visit(Field{"pairs"}, message.pairs...);
    visit(Field{"zones"}, message.zones...);
    visit(Field{"stops"}, message.stops...);
  }
};

struct JointGradientFields {
  template <class Visit, class... Joint>
  static constexpr void for_each(Visit&& visit, Joint&... joint) {
    visit(Field{"joint"}, joint.joint...);
    visit(Field{"rate"}, joint.rate...);
  }
};

// The fields that a gradient repeats of its pair's report.
struct GradientPairFields {
  template <class Visit, class... Pair>
  static constexpr void for_each(Visit&& visit, Pair&... pair) {
    visit(Field{"pair", Meaning::kPair}, pair.pair...);
    visit(Field{"status", Meaning::kPairStatus}, pair.status...);
    visit(Field{"distance"}, pair.distance...);
    visit(Field{"lower", Meaning::kBound}, pair.lower...);
  }
};
struct PairGradientFields {
  template <class Visit, class... Pair>
  static constexpr void for_each(Visit&& visit, Pair&... pair) {
    GradientPairFields::for_each(visit, pair...);
    visit(Field{"drift"}, pair.drift...);
    visit(Field{"joints"}, pair.joints...);
  }
};

struct GradientsMessageFields {
  template <class Visit, class... Message>
  static constexpr void for_each(Visit&& visit, Message&... message) {
    DeliveryFields::for_each(visit, message...);
    TickFields::for_each(visit, message...);
    visit(Field{"pairs"}, message.pairs...);
    visit(Field{"alternatives"}, message.alternatives...);
  }
};

// kType: the type's name in idl/clearance.idl.
template <>
struct FieldsOf<clearance_msg_SourceUse> : SourceUseFields {
  static constexpr std::string_view kType = "SourceUse";
};
template <>
struct FieldsOf<clearance_msg_PairDistance> : PairFields {
  static constexpr std::string_view kType = "PairDistance";
};
template <>
struct FieldsOf<clearance_msg_ContactState> : ContactFields {
  static constexpr std::string_view kType = "ContactState";
};
template <>
struct FieldsOf<clearance_msg_HiddenState> : HiddenFields {
  static constexpr std::string_view kType = "HiddenState";
};
template <>
struct FieldsOf<clearance_msg_Distances> : DistancesMessageFields {
  static constexpr std::string_view kType = "Distances";
};
template <>
struct FieldsOf<clearance_msg_ZoneState> : ZoneStateFields {
  static constexpr std::string_view kType = "ZoneState";
};
template <>
struct FieldsOf<clearance_msg_PairSeparation> : PairSeparationFields {
  static constexpr std::string_view kType = "PairSeparation";
};
template <>
struct FieldsOf<clearance_msg_ZoneSeparation> : ZoneSeparationFields {
  static constexpr std::string_view kType = "ZoneSeparation";
};
template <>
struct FieldsOf<clearance_msg_RobotStop> : RobotStopFields {
  static constexpr std::string_view kType = "RobotStop";
};
template <>
struct FieldsOf<clearance_msg_Separation> : SeparationMessageFields {
  static constexpr std::string_view kType = "Separation";
};
template <>
struct FieldsOf<clearance_msg_JointGradient> : JointGradientFields {
  static constexpr std::string_view kType = "JointGradient";
};
template <>
struct FieldsOf<clearance_msg_PairGradient> : PairGradientFields {
  static constexpr std::string_view kType = "PairGradient";
};
template <>
struct FieldsOf<clearance_msg_GradientAlternative> : GradientAlternativeFields {
  static constexpr std::string_view kType = "GradientAlternative";
};
template <>
struct FieldsOf<clearance_msg_Gradients> : GradientsMessageFields {
  static constexpr std::string_view kType = "Gradients";
};

// A sequence of a message: Cyclone's buffer, length and capacity.
template <class T>
concept MessageSequence = requires(T sequence) {
  sequence._buffer;
  sequence._length;
  sequence._maximum;
};

}  // namespace clearance
