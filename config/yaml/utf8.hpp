// Checks that a text is UTF-8, and makes texts of files fit for messages.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace clearance {

// The position of the first byte that is not part of well-formed UTF-8, or the text's length when
// all of it is. Overlong forms, surrogates and code points beyond U+10FFFF are not well-formed (RFC
// 3629).
[[nodiscard]] std::size_t end_of_utf8(std::string_view text);

// For messages: control characters, and in what is not UTF-8 all that is not ASCII, as '?'; of a
// long text the beginning.
[[nodiscard]] std::string printable(std::string text);

}  // namespace clearance
