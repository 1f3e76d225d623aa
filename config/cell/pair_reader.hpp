// Reads the watched pairs: `pairs:`, less `allowed_collisions:`.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "config/cell/group_index.hpp"
#include "config/scene/scene.hpp"

namespace clearance {

struct RobotList;

// The pairs to watch, and those that the cell allows to touch.
struct PairList {
  std::vector<ObjectPair> pairs;  // ascending by first, then second
  std::vector<PairKey> allowed;   // ascending: pairs that an exception removed
  // Ascending: pairs of rules that do not state `publish`, which are not published yet.
  std::vector<std::uint32_t> open = {};
  std::vector<NamedPair> rules = {}, exceptions = {};  // as in Scene
  bool complete = true;  // false: a rule could not be read, and its pairs are missing
};

// The largest number of pairs that a report can carry (idl/clearance.idl, kMaxPairs).
inline constexpr std::size_t kMaxPublished = 4096;

// Returns the place of a pair in a list that is sorted by key.
[[nodiscard]] std::optional<std::uint32_t> pair_index(const std::vector<ObjectPair>& pairs,
                                                      PairKey key);

// Pairs that may touch by a robot's description, and the line of the robot.
using PairExceptions = std::vector<std::pair<PairKey, int>>;

// `allowed` may be nullptr. Reports rules and exceptions that change nothing, exceptions of a
// person and a robot, objects without a watched pair, and more pairs with `publish: true` than a
// report can carry.
[[nodiscard]] PairList read_pairs(const YamlNode& pairs, const YamlNode* allowed,
                                  const ObjectList& objects, const RobotList& robots,
                                  GroupIndex& group_index, Diagnostics& diagnostics);

}  // namespace clearance
