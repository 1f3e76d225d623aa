// Finds groups and objects by name, for `between: [A, B]`, which may name either.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "config/cell/object_reader.hpp"
#include "config/yaml/map_reader.hpp"

namespace clearance {

// Two objects in one number, the smaller index first: the order of keys is the order of pairs in
// the scene.
using PairKey = std::uint64_t;

// The arguments may stand in either order.
[[nodiscard]] inline PairKey pair_key(std::uint32_t a, std::uint32_t b) {
  return a < b ? PairKey{a} << 32 | b : PairKey{b} << 32 | a;
}
[[nodiscard]] inline std::uint32_t first_of(PairKey key) {
  return static_cast<std::uint32_t>(key >> 32);
}
[[nodiscard]] inline std::uint32_t second_of(PairKey key) {
  return static_cast<std::uint32_t>(key);
}

// A `between:` that could be read.
struct Between {
  std::array<std::string, 2> names;
  std::array<const std::vector<std::uint32_t>*, 2> objects;  // ascending; owned by GroupIndex
};

// Names of groups and objects share one namespace, so that `between` needs no prefix. A rule that
// names a group marks it as used.
class GroupIndex {
 public:
  // Reports a group that has an object's name. The list must outlive this.
  GroupIndex(const ObjectList& list, Diagnostics& diagnostics);

  // Reads the key `between` of a map. Returns nothing after a diagnostic.
  [[nodiscard]] std::optional<Between> read_between(MapReader& map);

  // Returns every two objects, one of each side, ascending, each once. An object has no distance
  // from itself, and two fixed objects need no watching.
  [[nodiscard]] std::vector<PairKey> pairs(const Between& between) const;

  // Reports groups that no `between` names: a misspelt group would leave its objects
  // unwatched.
  void refuse_unused_groups() const;

 private:
  // A named group of objects, or a single object.
  struct Entry {
    std::vector<std::uint32_t> objects;
    bool is_group = false;
    bool used = false;
  };
  const std::vector<std::uint32_t>* find(const YamlNode& node, const std::string& name);

  const ObjectList& list_;
  Diagnostics& diagnostics_;
  std::map<std::string, Entry> entries_;
};

}  // namespace clearance
