// Finds groups and objects by name, for `between: [A, B]`, which may name either.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "config/cell/object_reader.hpp"
#include "config/cell/pair_key.hpp"
#include "config/yaml/map_reader.hpp"

namespace clearance {

// A `between:` that could be read.
struct Between {
  std::array<std::string, 2> names;
  std::array<const std::vector<std::uint32_t>*, 2> objects;  // ascending; owned by GroupIndex
  // True if covering no pair is no mistake: the cell says so, or a side is a declared group, whose
  // members come and go.
  bool may_be_empty = false;
};

// Names of groups and objects share one namespace, so that `between` needs no prefix. A rule that
// names a group marks it as used.
class GroupIndex {
 public:
  // Reports a group that has an object's name. The list must outlive this.
  GroupIndex(const ObjectList& list, Diagnostics& diagnostics);

  // Makes the name of a group known that may get members later. `place` is where the cell asks for
  // it, and `why` begins a message if nothing names the group.
  void declare(const std::string& group, const YamlNode& place, std::string why);

  // Objects that are attached to an object count where that one is named, or do not.
  enum class Attached : std::uint8_t { kCount, kDoNot };

  // Reads the keys `between` and `may_be_empty` of a map. Returns nothing after a diagnostic.
  [[nodiscard]] std::optional<Between> read_between(MapReader& map,
                                                    Attached attached = Attached::kCount);

  // Returns every two objects, one of each side, ascending, each once. An object has no distance
  // from itself, two fixed objects need no watching, and ObjectList::left_out is left out. What a
  // sensor sees has pairs with bounded objects only, fixed ones too, and none with what another
  // sensor sees.
  [[nodiscard]] std::vector<PairKey> pairs(const Between& between) const;

  // Tells whether one of the pairs is of ObjectList::rigid: it may touch anyway.
  [[nodiscard]] bool has_rigid(const Between& between) const;

  // Reports groups that no `between` names: a misspelt group would leave its objects
  // unwatched.
  void refuse_unused_groups() const;

 private:
  // A named group of objects, or a single object.
  struct Entry {
    std::vector<std::uint32_t> objects;
    bool is_group = false;
    bool used = false;
    std::vector<std::uint32_t> with_attached = {};  // empty: as `objects`
    const YamlNode* declared = nullptr;             // the place; null: by its members only
    std::string why = {};
  };
  void count_attached();
  const std::vector<std::uint32_t>* find(const YamlNode& node, const std::string& name,
                                         Attached attached);

  const ObjectList& list_;
  Diagnostics& diagnostics_;
  std::map<std::string, Entry> entries_;
};

}  // namespace clearance
