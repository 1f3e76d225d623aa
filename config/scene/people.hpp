// A person and a robot never touch: what cells, commands and questions refuse of a contact.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "config/scene/scene.hpp"

namespace clearance {

// Says why no contact of two objects may be meant: one is of a person of the cell and the other one
// of none, or they are on the two sides of a zone with `separation`. Returns nothing if one may be:
// what is fixed moves against no person. What a payload may touch is a contact, too.
[[nodiscard]] std::optional<std::string> contact_with_people(std::span<const Object> objects,
                                                             std::span<const Robot> robots,
                                                             std::span<const ObjectPair> pairs,
                                                             std::span<const Zone> zones,
                                                             std::uint32_t a, std::uint32_t b);

// The sentence of that refusal for a zone. Exceptions from pairs, which are read before zones,
// are refused by the same rule.
[[nodiscard]] std::string no_contact_with_people(const Object& a, const Object& b,
                                                 const Zone& zone);

}  // namespace clearance
