// A robot cell as the tick needs it: plain structs, already checked. config/cell/cell.hpp has the
// rest of a cell; config/cell/cell_file.hpp reads both from YAML.
//
// Ids are indices: object i is scene.objects[i], in the order of the file. SI units; stamps in ns.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "config/scene/contact.hpp"
#include "config/scene/place_error.hpp"
#include "config/scene/robot.hpp"
#include "config/scene/sensor.hpp"
#include "config/scene/separation.hpp"
#include "core/convex_body.hpp"
#include "core/pose.hpp"

namespace clearance {

// One convex part of an object, with its pose in the object's frame.
struct Part {
  std::string name;
  ConvexBody shape;
  Pose object_from_part;
};

// The speed above which the poses of an object that states no max_speed are not plausible, m/s. It
// does not bound the unobserved motion of late objects.
inline constexpr double kFastestUnstated = 20.0;

// A rigid body of one or more convex parts. Fixed objects have a pose; the poses of moving ones
// arrive at run time.
struct Object {
  std::string name;
  std::vector<std::string> groups;
  std::vector<Part> parts;
  bool fixed = false;
  Pose world_from_object;        // of a fixed object; a moving one's arrives at run time
  double margin = 0.0;           // m, >= 0: zones subtract it; published distances do not
  double max_speed = kInfinity;  // m/s: no point is faster; infinity: not stated
  // An older pose makes the object's pairs stale; unused by fixed objects.
  std::int64_t age_limit_ns = 0;
  // A pose that repeats bit for bit for longer than this is frozen; 0: it may repeat, as that of an
  // object at rest.
  std::int64_t frozen_limit_ns = 0;
  // For a link, or an object that moves with one or with another object: the largest distance of a
  // point from its place by forward kinematics, m. The errors of its parts include it. 0: poses are
  // sent.
  double pose_error = 0.0;
  // Stated: of the pose of a fixed object, of poses as sent, or of a sensor's mount; not of a link.
  PlaceError place_error = {};
  PlaceError attached_error = {};  // stated: of its place in a link that a question lets carry it
  double mesh_error = 0.0;         // m: no point of its parts is farther from its meshes than this
  double shape_error = 0.0;        // stated, m: no point of the true body is farther from its parts
  RestingOn resting_on = {};       // of a fixed object that is attached to another
  double mass = kInfinity;         // kg; infinity: not stated
  // The speed at which this part of a person may come towards a robot, whatever it does, m/s
  // (ISO 13855). Zones with `separation` count it unless they state one.
  double approach_speed = 1.6;
  bool may_jump = false;  // its poses may jump, as a simulation's do
  bool absent = false;    // known not to be there when the monitor starts (Monitor::set_absent)
  bool is_read = true;    // false: no pair of this share of a cell depends on it (select_share)
  // The only source whose poses are used; empty: the first that sends some, while it does.
  std::string source;
  std::string frame;  // of tf: its pose is the object's; empty: none
  // Index into Scene::sensors. It is what that sensor sees: its only part is a ball around all that
  // the sensor can see, in the frame of the sensor, and its pose and content come with each frame.
  static constexpr std::uint32_t kNoSensor = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t sensor = kNoSensor;

  // Poses that need a higher speed contradict it, m/s.
  [[nodiscard]] double plausible_speed() const noexcept {
    return max_speed < kInfinity ? max_speed : kFastestUnstated;
  }
  [[nodiscard]] bool is_seen() const noexcept { return sensor != kNoSensor; }
};

// Two objects that are watched. first < second; every pair stands once.
struct ObjectPair {
  std::uint32_t first = 0, second = 0;
  bool publish = false;  // in every report's pair list, not only when it is the minimum
};

// An object that is attached to another one, or a link of a robot that is.
struct Attachment {
  std::uint32_t object = 0, carrier = 0;  // indices into Scene::objects
};

// The two sides of a rule of the cell: groups, or objects by their names.
struct NamedPair {
  std::string a, b;
};

// A named threshold on the distance less both margins, for every watched pair between two groups.
struct Zone {
  std::string name;
  std::string group_a, group_b;               // a group, or one object by its name
  double enter_below = 0.0;                   // m
  double leave_above = 0.0;                   // m, >= enter_below: hysteresis
  std::vector<std::uint32_t> pairs;           // indices into Scene::pairs
  std::optional<Separation> separation = {};  // between people and a robot; its pairs are published
  // The least clearance, m, that its pairs keep until their robots stand; nothing: not stated. At
  // least one pair then has a link of a robot whose stops are stated.
  std::optional<double> stop_margin = {};
};

// All that the tick reads. Indices are valid, names unique, pairs sorted by (first, second), and
// the budget covers the refreshing: nothing of this is checked again.
struct Scene {
  std::string name;
  std::uint64_t revision = 0;  // FNV-1a of the cell file's bytes (and of referenced meshes): two
                               // scenes that differ have different revisions; never 0
  double rate_hz = 1000.0;
  // Ticks follow the joint states of this robot, or the poses of this object: indices.
  static constexpr std::uint32_t kFreeRunning = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t tick_on = kFreeRunning, tick_on_object = kFreeRunning;
  [[nodiscard]] bool is_free_running() const noexcept {
    return tick_on == kFreeRunning && tick_on_object == kFreeRunning;
  }
  // The time between two ticks, s: those that follow a source may be faster or slower by a 64th.
  [[nodiscard]] double shortest_period() const noexcept { return (1.0 - slew()) / rate_hz; }
  [[nodiscard]] double longest_period() const noexcept { return (1.0 + slew()) / rate_hz; }
  [[nodiscard]] double slew() const noexcept { return is_free_running() ? 0.0 : 1.0 / 64; }
  std::uint32_t budget = 2000;  // distance queries a tick, at most: part pairs
  double refresh_s = 10.0;      // every pair is refreshed this often, even if nothing moves, and
                                // whatever else is urgent: the budget covers it (RefreshShare)
  bool evaluate_all = false;    // every pair in every tick, as if all were published; as far as the
                              // budget allows. For tables and measurements: cells do not ask for it
  std::int64_t future_limit_ns = 5'000'000;  // a stamp farther than this ahead of now is refused
  // An input is unknown while its age and the time that reports take exceed this.
  static constexpr std::int64_t kNoLimit = std::numeric_limits<std::int64_t>::max();
  std::int64_t response_limit_ns = kNoLimit;
  double added_shape_error = 0.0;  // stated, m; of shapes that are added later
  double added_margin = 0.0;       // m; of objects that are added later
  PlaceError attached_error = {};  // stated; of what is attached and states none of its own
  bool gradients = false;          // of published pairs by the joints of robots, in every report
  std::vector<Object> objects;
  std::vector<Sensor> sensors;  // in the order of their objects, which come before all links
  // Each stands on the world, an object, or an earlier robot. Their links come after all other
  // objects, and attached objects (Robot::is_attached) after all others.
  std::vector<Robot> robots;
  std::vector<JointVariable> variables;  // of all robots
  std::vector<ObjectPair> pairs;
  // The rules that make the pairs, kept for objects that are attached later
  // (config/scene/attached.hpp).
  std::vector<NamedPair> rules, exceptions;
  std::vector<ObjectPair> may_touch;    // by collision matrices and `touch`
  std::vector<Attachment> attachments;  // each object once
  std::vector<Zone> zones;
  std::vector<AllowedContact>
      contacts;  // their pairs are published, and in no zone with `separation`
};

// Counts the zones with `separation`, their pairs, each once per zone, and the robots that state
// how they stop: what the message Separation has.
struct SeparatedCount {
  std::size_t zones = 0, pairs = 0, stops = 0;
  [[nodiscard]] bool any() const noexcept { return zones + stops > 0; }
};
[[nodiscard]] SeparatedCount separated_count(const Scene& scene) noexcept;

// Returns one line: how many objects, robots, parts, facets, pairs and zones.
[[nodiscard]] std::string summary(const Scene& scene);

}  // namespace clearance
