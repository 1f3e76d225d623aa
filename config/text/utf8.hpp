// Tells whether a text is UTF-8.
#pragma once

#include <cstddef>
#include <string_view>

namespace clearance {

// Returns the position of the first byte that is not part of well-formed UTF-8, or the text's
// length when there is none. Overlong forms, surrogates and code points above U+10FFFF are not
// well-formed (RFC 3629).
[[nodiscard]] std::size_t end_of_utf8(std::string_view text);

}  // namespace clearance
