// The present cell as MoveIt's messages speak of it: bodies, frames and pairs by their names.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "config/cell/cell.hpp"
#include "config/yaml/quantities.hpp"
#include "config/yaml/yaml_node.hpp"
#include "core/pose.hpp"

namespace clearance::moveit {

// Returns where a link of a robot, or an object whose poses arrive, is now in the world. Nothing:
// that is not known.
using PresentPoses = std::function<std::optional<Pose>(const std::string& body)>;

// The reason of exceptions from pairs that follow MoveIt's collision matrix. It marks them.
inline constexpr std::string_view kMatrixReason = "MoveIt's collision matrix allows it";

struct KnownObject {
  enum class Where : std::uint8_t {
    kFixed,     // `pose` is in the world
    kAttached,  // `pose` is in the frame of `carrier`
    kMoving,    // its poses arrive
    kLink,      // of a robot
  };
  Where where = Where::kFixed;
  bool is_in_objects = false;  // in `objects` of the cell, which changes edit
  bool is_moveits = false;     // MoveIt has added it: it is in the group of such objects
  bool is_gone = false;        // MoveIt has dropped it, and the message may bring it again
  Pose pose = {};
  double margin = 0.0;  // m
  std::string carrier = {};
  YamlNode entry = {};  // of an object in `objects`
};

// A robot of the cell, which is a tool if something carries it.
struct KnownRobot {
  std::string root;     // its root link
  std::string carrier;  // what it is attached to; empty: nothing
};

using NamePair = std::pair<std::string, std::string>;  // in alphabetic order

struct KnownScene {
  std::map<std::string, KnownObject> objects;        // every object of the scene
  std::map<std::string, std::optional<Pose>> links;  // where nothing moves the link: in the world
  std::map<std::string, KnownRobot> robots;
  std::set<NamePair> watched;     // watched_pairs()
  std::set<NamePair> exceptions;  // that follow MoveIt's collision matrix
  std::set<std::string> margins;  // links with an entry of `margins`
  LengthUnit unit = LengthUnit::kMetre;
  std::string world;                // the frame that is the cell's world
  std::string group;                // of objects that MoveIt has added
  bool has_octomap_sensor = false;  // a sensor of the cell takes the octomaps of scenes
};

[[nodiscard]] NamePair name_pair(const std::string& a, const std::string& b);

// The pairs that a matrix may leave out: all but those of a person of the cell and what moves.
[[nodiscard]] std::set<NamePair> watched_pairs(const Scene& scene);

// Cell::yaml has to be the text of the cell.
[[nodiscard]] KnownScene known_scene(const Cell& cell);

}  // namespace clearance::moveit
