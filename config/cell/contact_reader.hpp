// Reads `contacts:`: contact that is meant, and allowed down to a depth until an end.
#pragma once

#include <vector>

#include "config/cell/pair_reader.hpp"
#include "config/scene/scene.hpp"
#include "config/yaml/quantities.hpp"

namespace clearance {

// Reads `until:`, with at least one condition.
[[nodiscard]] ContactEnd read_contact_end(const YamlNode& node, const Quantities& quantities);

// The pairs become published ones. Refuses a contact over no watched pair, since an ended one would
// come into force again with its pair. Refuses a pair of two contacts, and one of a person
// (contact_with_people).
[[nodiscard]] std::vector<AllowedContact> read_contacts(
    const YamlNode& node, const ObjectList& objects, const std::vector<Robot>& robots,
    const std::vector<Zone>& zones, GroupIndex& group_index, const Quantities& quantities,
    PairList& pairs);

}  // namespace clearance
