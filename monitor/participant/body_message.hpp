// A convex body as a message of idl/questions.idl, in both directions.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <variant>

#include "core/shapes.hpp"
#include "questions.h"

namespace clearance {

// The most points of a body on the wire. More are refused: the hull is made by exact arithmetic.
inline constexpr std::size_t kMostBodyPoints = 256;

// Makes the body that a message states; kind 0 states none. Fails as the factories of
// core/shapes.hpp do, and on numbers that are not finite.
[[nodiscard]] std::variant<std::optional<ConvexBody>, ShapeError> from_wire(
    const clearance_msg_StatedBody& message);

// Returns why a message cannot state exactly this body; empty: it can. A message has no
// room for unbounded bodies, for too many vertices, and for those whose vertices were rounded. It
// makes the body once more, which may take milliseconds.
[[nodiscard]] std::string unsent_part(const ConvexBody& body);

// Fills a message that is empty. The body must be one that unsent_part() finds complete.
void put_value(const ConvexBody& body, clearance_msg_StatedBody& to);

}  // namespace clearance
