// A person and a robot never touch: what cells, commands and questions refuse of a contact.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "config/scene/scene.hpp"

namespace clearance {

// Says why no contact of two objects may be meant: a zone with `separation` has the pair. Returns
// nothing if one may be. What a payload may touch is a contact, too.
[[nodiscard]] std::optional<std::string> contact_with_people(std::span<const Object> objects,
                                                             std::span<const ObjectPair> pairs,
                                                             std::span<const Zone> zones,
                                                             std::uint32_t a, std::uint32_t b);

// The sentence of that refusal.
[[nodiscard]] std::string no_contact_with_people(const Object& a, const Object& b,
                                                 const Zone& zone);

}  // namespace clearance
