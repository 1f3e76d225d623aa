// Contact that is meant: between some watched objects, down to a depth, until an end.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/convex_body.hpp"

namespace clearance {

// When the allowance of a contact ends: with the first of these. It begins with the first tick of a
// monitor that has it. All are for each pair alone.
struct ContactEnd {
  static constexpr std::int64_t kNoTime = std::numeric_limits<std::int64_t>::max();
  static constexpr std::uint64_t kNoCycle = std::numeric_limits<std::uint64_t>::max();

  // After the tick in which the pair is certified to be at least this far from each other, m.
  double distance = kInfinity;
  std::int64_t duration_ns = kNoTime;   // the last tick is no later than this after the first
  std::int64_t time_ns = kNoTime;       // the last tick is no later than this (TickTime::now_ns)
  std::uint64_t last_cycle = kNoCycle;  // the number of the last tick
  friend bool operator==(const ContactEnd&, const ContactEnd&) = default;
};

// An allowance for the pairs between two groups. While it is in force, a zone does not count such a
// pair as near, as long as the pair is certified to be no deeper than `depth`.
struct AllowedContact {
  std::string name;
  std::string group_a, group_b;  // a group, or one object by its name
  double depth = 0.0;            // m, > 0: distances are at least -depth
  ContactEnd end = {};
  std::string by, reason;  // who allowed it, and why; for people
  std::vector<std::uint32_t>
      pairs;  // indices into Scene::pairs; no two contacts have one in common
};

struct Scene;

// A pair and the contact that is allowed for it.
struct ContactPair {
  std::uint32_t contact = 0, pair = 0;  // indices into Scene::contacts and Scene::pairs
};

// Returns all pairs for which a contact is allowed, in ascending order. Every report has an entry
// for each.
[[nodiscard]] std::vector<ContactPair> contact_pairs(const Scene& scene);

}  // namespace clearance
