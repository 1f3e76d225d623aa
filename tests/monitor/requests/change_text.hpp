// Changes as text, for the reports of tests.
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "config/edit/cell_change.hpp"

namespace clearance::test {

struct ChangeText {
  static std::string text(const std::string& name) { return "'" + name + "'"; }
  static std::string text(const std::vector<std::string>& names) {
    std::string list;
    for (const std::string& name : names) list += name + ' ';
    return "[" + list + "]";
  }
  static std::string text(const Pose& pose) {
    const Vec3& p = pose.position;
    const auto& q = pose.orientation;
    return fmt::format("xyz {} {} {} quaternion {} {} {} {}", p.x(), p.y(), p.z(), q.x(), q.y(),
                       q.z(), q.w());
  }
  static std::string text(const std::optional<Pose>& pose) { return pose ? text(*pose) : "-"; }
  static std::string text(const std::optional<std::string>& name) { return name ? *name : "-"; }
  template <class Number>
  static std::string text(const std::optional<Number>& number) {
    return number ? std::to_string(*number) : "-";
  }
  template <class... Fields>
  static std::string row(const char* kind, const Fields&... fields) {
    std::string row = kind;
    ((row += ' ' + text(fields)), ...);
    return row;
  }
  static std::string text(bool flag) { return flag ? "true" : "false"; }
  static std::string text(double number) { return fmt::format("{}", number); }

  std::string operator()(const AddObject& c) const { return "AddObject " + c.yaml; }
  std::string operator()(const ReplaceObject& c) const { return "ReplaceObject " + c.yaml; }
  std::string operator()(const AddFromTemplate& c) const {
    return row("AddFromTemplate", c.template_name, c.object, c.groups, c.world_from_object);
  }
  std::string operator()(const RemoveObject& c) const { return row("RemoveObject", c.object); }
  std::string operator()(const SetAbsent& c) const { return row("SetAbsent", c.object, c.absent); }
  std::string operator()(const Attach& c) const {
    return row("Attach", c.object, c.to, c.carrier_from_object, c.touch, c.overlap, c.far, c.mass);
  }
  std::string operator()(const Detach& c) const {
    return row("Detach", c.object, c.world_from_object);
  }
  std::string operator()(const AttachRobot& c) const {
    return row("AttachRobot", c.robot, c.to, c.carrier_from_root, c.overlap, c.far);
  }
  std::string operator()(const DetachRobot& c) const {
    std::string joints;
    for (const JointPosition& joint : c.joints)
      joints += fmt::format(" {} {}", joint.joint, joint.position);
    return row("DetachRobot", c.robot, c.world_from_root, c.powered, c.absent) + joints;
  }
  std::string operator()(const Place& c) const {
    return row("Place", c.object, c.world_from_object);
  }
  std::string operator()(const SetMaxSpeed& c) const {
    return row("SetMaxSpeed", c.object, c.m_per_s);
  }
  std::string operator()(const SetMargin& c) const { return row("SetMargin", c.object, c.m); }
  std::string operator()(const SetAgeLimit& c) const { return row("SetAgeLimit", c.object, c.ns); }
  std::string operator()(const SetSource& c) const { return row("SetSource", c.object, c.source); }
  std::string operator()(const SetPair& c) const {
    return row("SetPair", c.a, c.b, static_cast<double>(c.rule), c.reason);
  }
  std::string operator()(const SetZoneThresholds& c) const {
    return row("SetZoneThresholds", c.zone, c.enter_below, c.leave_above);
  }
  std::string operator()(const AllowContact& c) const {
    return row("AllowContact", c.contact, c.a, c.b, c.depth, c.end.distance,
               static_cast<double>(c.end.duration_ns), static_cast<double>(c.end.time_ns),
               static_cast<double>(c.end.last_cycle));
  }
  std::string operator()(const WithdrawContact& c) const {
    return row("WithdrawContact", c.contact);
  }
  std::string operator()(const ReplaceCell& c) const { return "ReplaceCell\n" + c.yaml; }
  std::string operator()(const Note& c) const { return row("Note", c.text); }
  std::string operator()(const ReadCellAgain& c) const { return row("ReadCellAgain", c.file); }
};

inline std::string text_of(const std::vector<CellChange>& list) {
  std::string lines;
  for (const CellChange& change : list) lines += "  " + std::visit(ChangeText(), change) + "\n";
  return lines;
}

}  // namespace clearance::test
