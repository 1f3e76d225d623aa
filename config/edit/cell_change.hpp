// The changes that a command can make in a cell. Each is an edit of the cell's text.
//
// Lengths are in metres, poses are of the object in the named frame. Names are those of the cell.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "config/scene/contact.hpp"
#include "core/pose.hpp"

namespace clearance {

// Appends an object. `yaml` is one entry of `objects`, in the units of the cell: "{name: box,
// ...}".
struct AddObject {
  std::string yaml;
};

// Puts another entry in the place of the one with the same name. Rules that name the object stay.
struct ReplaceObject {
  std::string yaml;
};

// Appends a fixed object with the body of a template of the cell.
struct AddFromTemplate {
  std::string template_name;
  std::string object;
  std::vector<std::string> groups = {};
  Pose world_from_object = {};
};

// Refused while a rule, a zone or another entry names the object. Groups may lose it.
struct RemoveObject {
  std::string object;
};

// An absent object, or robot, is known not to be there. What is attached to it is absent, too.
struct SetAbsent {
  std::string object;
  bool absent = true;
  // The id of the body that stands for a person from now on, as in /humans/bodies. Empty: no
  // tracker says where the person is. Without a value, the id stays.
  std::optional<std::string> id = {};
};

// Attaches an object to a link or to another object. It loses all keys that say where it is or
// which poses count: pose, max_speed, source ...
struct Attach {
  std::string object;
  std::string to;
  // Nothing: where it is now relative to the carrier. Only a running monitor knows that: it fills
  // this in before the change is made (monitor/requests).
  std::optional<Pose> carrier_from_object = {};
  std::vector<std::string> touch = {};
  // The greatest depth by which it may overlap its carrier and what it may touch, m. A running
  // monitor checks that once, when the object is attached. Nothing: the monitor's default.
  std::optional<double> overlap = {};
  // True if it may lie farther than 0.5 m from its carrier and from all that it may touch. A
  // running daemon refuses that otherwise.
  bool far = false;
  std::optional<double> mass = {};  // kg; nothing: what its entry says
};

// An attached object becomes a fixed one.
struct Detach {
  std::string object;
  std::optional<Pose> world_from_object = {};  // nothing: where it is now, as with Attach
};

// Attaches a robot, such as a gripper, to a link of a robot before it, or to an object. It loses
// its base, its joints are read, and it is there.
struct AttachRobot {
  std::string robot;
  std::string to;
  std::optional<Pose> carrier_from_root = {};  // of its root link; nothing: as with Attach
  std::optional<double> overlap = {};          // m, of its root link, as with Attach
  // True if it may be farther than 0.5 m from its carrier, or from where it is now. A running
  // daemon refuses that otherwise.
  bool far = false;
};

// A joint of one position stands here, rad or m. The name is that of the URDF.
struct JointPosition {
  std::string joint;
  double position = 0.0;
};

// An attached robot gets a base that stands still. Its joints stand, too, unless it has power, and
// its joint states do not count until it is attached again.
struct DetachRobot {
  std::string robot;
  std::optional<Pose> world_from_root = {};  // nothing: where it is now, as with Attach
  // Where joints stand. All others of one position stand where they are now, which only a running
  // monitor knows, as with a pose. The joints of an absent robot need not be known.
  std::vector<JointPosition> joints = {};
  bool powered = false;  // its joints are read on
  bool absent = false;   // it is known not to be there
};

// Places a fixed object elsewhere.
struct Place {
  std::string object;
  Pose world_from_object = {};
};

// Nothing: the default of the cell.
struct SetMaxSpeed {
  std::string object;
  std::optional<double> m_per_s;
};
struct SetMargin {
  std::string object;  // or a link of a robot; nothing is then the margin of its robot
  std::optional<double> m;
};
struct SetAgeLimit {
  std::string object;
  std::optional<std::int64_t> ns;
};
struct SetSource {
  std::string object;
  std::optional<std::string> source;
};

// Sets the rule for two objects or groups by exactly these two names, in either order. It is
// refused where rules with other names prevent it: a rule that publishes two objects that shall
// only be watched, or an exception from them.
struct SetPair {
  enum class Rule : std::uint8_t {
    kPublish,      // a rule: watched, and in every report
    kWatch,        // a rule: watched
    kLeaveOut,     // an exception: they may touch; needs a reason
    kUnstated,     // neither: only what rules with other names say
    kNoException,  // no exception; a rule stays
  };
  std::string a, b;
  Rule rule = Rule::kPublish;
  std::string reason = {};
};

struct SetZoneThresholds {
  std::string zone;
  double enter_below = 0.0, leave_above = 0.0;
};

// Allows a contact between two objects or groups. An entry of the same name is replaced: with the
// same depth and end it goes on, with others it begins anew.
struct AllowContact {
  std::string contact;  // its name
  std::string a, b;
  double depth = 0.0;  // m, > 0
  ContactEnd end = {};
  std::string by, reason;
};
struct WithdrawContact {
  std::string contact;
};

// The text of another cell, or of this one after a person has changed the file. Files that it names
// are read anew.
struct ReplaceCell {
  std::string yaml;
};

// The same with the text of a file: a running monitor reads it and makes this a ReplaceCell.
struct ReadCellAgain {
  std::string file;  // absolute, or relative to the cell's folder; empty: the cell's own file
};

// Changes nothing: a running daemon logs the text, such as what a person has acknowledged, or why
// the other changes are made.
struct Note {
  std::string text;
};

using CellChange =
    std::variant<AddObject, ReplaceObject, AddFromTemplate, RemoveObject, SetAbsent, Attach, Detach,
                 Place, SetMaxSpeed, SetMargin, SetAgeLimit, SetSource, SetPair, SetZoneThresholds,
                 AllowContact, WithdrawContact, ReplaceCell, ReadCellAgain, AttachRobot,
                 DetachRobot, Note>;

// The names of the changes for people, in the order of CellChange.
inline constexpr std::array<std::string_view, std::variant_size_v<CellChange>> kChangeNames = {
    "add_object",
    "replace_object",
    "add_from_template",
    "remove_object",
    "set_absent",
    "attach",
    "detach",
    "place",
    "set_max_speed",
    "set_margin",
    "set_age_limit",
    "set_source",
    "set_pair",
    "set_zone_thresholds",
    "allow_contact",
    "withdraw_contact",
    "replace_cell",
    "read_cell_again",
    "attach_robot",
    "detach_robot",
    "note"};

}  // namespace clearance
