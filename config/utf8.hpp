// Is a text UTF-8?
#pragma once

#include <cstddef>
#include <string_view>

namespace clearance {

// Where its first byte is that is no UTF-8: overlong forms, surrogates and what is beyond U+10FFFF
// are none either (RFC 3629). The text's length: all of it is.
[[nodiscard]] std::size_t end_of_utf8(std::string_view text);

}  // namespace clearance
