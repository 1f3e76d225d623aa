// The fields of the changes and the kinds of changes: the one list that both conversions, the
// checks and the paths of refusals use.
#pragma once

#include <cstddef>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <variant>

#include "commands.h"
#include "config/edit/cell_change.hpp"

namespace clearance {

// The kind of a text in a change, which decides its greatest length.
enum class ChangeText { kName, kMayBeEmpty, kYaml };

// Calls visit(name, field of the message, field of the change) for every field, and for texts with
// their ChangeText as a fourth argument.
template <class Change, class Visit, class Message, class Of>
void visit_fields(const Visit& visit, Message& m, Of& c) {
  using enum ChangeText;
  if constexpr (requires { c.yaml; }) {
    visit("yaml", m.yaml, c.yaml, kYaml);
  } else if constexpr (std::is_same_v<Change, AddFromTemplate>) {
    visit("template_name", m.template_name, c.template_name, kName);
    visit("object", m.object, c.object, kName);
    visit("groups", m.groups, c.groups, kName);
    visit("world_from_object", m.world_from_object, c.world_from_object);
  } else if constexpr (std::is_same_v<Change, RemoveObject>) {
    visit("object", m.object, c.object, kName);
  } else if constexpr (std::is_same_v<Change, SetAbsent>) {
    visit("object", m.object, c.object, kName);
    visit("absent", m.absent, c.absent);
    visit("id", m.id, c.id, kMayBeEmpty);
  } else if constexpr (std::is_same_v<Change, Attach>) {
    visit("object", m.object, c.object, kName);
    visit("to", m.to, c.to, kName);
    visit("carrier_from_object", m.carrier_from_object, c.carrier_from_object);
    visit("touch", m.touch, c.touch, kName);
    visit("overlap", m.overlap, c.overlap);
    visit("far", m.far, c.far);
    visit("mass", m.mass, c.mass);
  } else if constexpr (std::is_same_v<Change, Detach> || std::is_same_v<Change, Place>) {
    visit("object", m.object, c.object, kName);
    visit("world_from_object", m.world_from_object, c.world_from_object);
  } else if constexpr (std::is_same_v<Change, AttachRobot>) {
    visit("robot", m.robot, c.robot, kName);
    visit("to", m.to, c.to, kName);
    visit("carrier_from_root", m.carrier_from_root, c.carrier_from_root);
    visit("overlap", m.overlap, c.overlap);
    visit("far", m.far, c.far);
  } else if constexpr (std::is_same_v<Change, DetachRobot>) {
    visit("robot", m.robot, c.robot, kName);
    visit("world_from_root", m.world_from_root, c.world_from_root);
    visit("joints", m.joints, c.joints);
    visit("powered", m.powered, c.powered);
    visit("absent", m.absent, c.absent);
  } else if constexpr (std::is_same_v<Change, SetMaxSpeed>) {
    visit("object", m.object, c.object, kName);
    visit("m_per_s", m.m_per_s, c.m_per_s);
  } else if constexpr (std::is_same_v<Change, SetMargin>) {
    visit("object", m.object, c.object, kName);
    visit("m", m.m, c.m);
  } else if constexpr (std::is_same_v<Change, SetAgeLimit>) {
    visit("object", m.object, c.object, kName);
    visit("ns", m.ns, c.ns);
  } else if constexpr (std::is_same_v<Change, SetSource>) {
    visit("object", m.object, c.object, kName);
    visit("source", m.source, c.source, kName);
  } else if constexpr (std::is_same_v<Change, SetPair>) {
    visit("a", m.a, c.a, kName);
    visit("b", m.b, c.b, kName);
    visit("rule", m.rule, c.rule);
    visit("reason", m.reason, c.reason, kMayBeEmpty);
  } else if constexpr (std::is_same_v<Change, SetZoneThresholds>) {
    visit("zone", m.zone, c.zone, kName);
    visit("enter_below", m.enter_below, c.enter_below);
    visit("leave_above", m.leave_above, c.leave_above);
  } else if constexpr (std::is_same_v<Change, AllowContact>) {
    visit("contact", m.contact, c.contact, kName);
    visit("a", m.a, c.a, kName);
    visit("b", m.b, c.b, kName);
    visit("depth", m.depth, c.depth);
    visit("distance", m.distance, c.end.distance);
    visit("duration_ns", m.duration_ns, c.end.duration_ns);
    visit("time_ns", m.time_ns, c.end.time_ns);
    visit("last_cycle", m.last_cycle, c.end.last_cycle);
    visit("by", m.by, c.by, kMayBeEmpty);
    visit("reason", m.reason, c.reason, kMayBeEmpty);
  } else if constexpr (std::is_same_v<Change, WithdrawContact>) {
    visit("contact", m.contact, c.contact, kName);
  } else if constexpr (std::is_same_v<Change, Note>) {
    visit("text", m.text, c.text, kMayBeEmpty);
  } else {
    static_assert(std::is_same_v<Change, ReadCellAgain>, "a change without its list of fields");
    visit("file", m.file, c.file, kMayBeEmpty);
  }
}

// A kind of change: its name in the message, and its member of the union.
using ChangeUnion = decltype(clearance_msg_Change::_u);
template <class Change, class Member>
struct ChangeKind {
  using Type = Change;
  clearance_msg_ChangeKind kind;
  std::string_view name;
  Member ChangeUnion::*member;
};
template <class Change, class Member>
constexpr ChangeKind<Change, Member> change_kind(clearance_msg_ChangeKind kind,
                                                 std::string_view name,
                                                 Member ChangeUnion::*member) {
  return {kind, name, member};
}

// The kinds stand in the order of CellChange.
inline constexpr std::tuple kChangeKinds{
    change_kind<AddObject>(clearance_msg_CHANGE_ADD_OBJECT, "add_object", &ChangeUnion::add_object),
    change_kind<ReplaceObject>(clearance_msg_CHANGE_REPLACE_OBJECT, "replace_object",
                               &ChangeUnion::replace_object),
    change_kind<AddFromTemplate>(clearance_msg_CHANGE_ADD_FROM_TEMPLATE, "add_from_template",
                                 &ChangeUnion::add_from_template),
    change_kind<RemoveObject>(clearance_msg_CHANGE_REMOVE_OBJECT, "remove_object",
                              &ChangeUnion::remove_object),
    change_kind<SetAbsent>(clearance_msg_CHANGE_SET_ABSENT, "set_absent", &ChangeUnion::set_absent),
    change_kind<Attach>(clearance_msg_CHANGE_ATTACH, "attach", &ChangeUnion::attach),
    change_kind<Detach>(clearance_msg_CHANGE_DETACH, "detach", &ChangeUnion::detach),
    change_kind<Place>(clearance_msg_CHANGE_PLACE, "place", &ChangeUnion::place),
    change_kind<SetMaxSpeed>(clearance_msg_CHANGE_SET_MAX_SPEED, "set_max_speed",
                             &ChangeUnion::set_max_speed),
    change_kind<SetMargin>(clearance_msg_CHANGE_SET_MARGIN, "set_margin", &ChangeUnion::set_margin),
    change_kind<SetAgeLimit>(clearance_msg_CHANGE_SET_AGE_LIMIT, "set_age_limit",
                             &ChangeUnion::set_age_limit),
    change_kind<SetSource>(clearance_msg_CHANGE_SET_SOURCE, "set_source", &ChangeUnion::set_source),
    change_kind<SetPair>(clearance_msg_CHANGE_SET_PAIR, "set_pair", &ChangeUnion::set_pair),
    change_kind<SetZoneThresholds>(clearance_msg_CHANGE_SET_ZONE_THRESHOLDS, "set_zone_thresholds",
                                   &ChangeUnion::set_zone_thresholds),
    change_kind<AllowContact>(clearance_msg_CHANGE_ALLOW_CONTACT, "allow_contact",
                              &ChangeUnion::allow_contact),
    change_kind<WithdrawContact>(clearance_msg_CHANGE_WITHDRAW_CONTACT, "withdraw_contact",
                                 &ChangeUnion::withdraw_contact),
    change_kind<ReplaceCell>(clearance_msg_CHANGE_REPLACE_CELL, "replace_cell",
                             &ChangeUnion::replace_cell),
    change_kind<ReadCellAgain>(clearance_msg_CHANGE_READ_CELL_AGAIN, "read_cell_again",
                               &ChangeUnion::read_cell_again),
    change_kind<AttachRobot>(clearance_msg_CHANGE_ATTACH_ROBOT, "attach_robot",
                             &ChangeUnion::attach_robot),
    change_kind<DetachRobot>(clearance_msg_CHANGE_DETACH_ROBOT, "detach_robot",
                             &ChangeUnion::detach_robot),
    change_kind<Note>(clearance_msg_CHANGE_NOTE, "note", &ChangeUnion::note),
};
static_assert(std::tuple_size_v<decltype(kChangeKinds)> == std::variant_size_v<CellChange>);

// Calls visit(row) for every row of the table.
template <class Visit>
constexpr void for_each_change_kind(const Visit& visit) {
  std::apply([&](const auto&... row) { (visit(row), ...); }, kChangeKinds);
}

}  // namespace clearance
