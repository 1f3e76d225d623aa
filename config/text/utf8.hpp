// Tells whether a text is UTF-8. In a header, so that clients need no library of the configuration.
//
// Follows the table of well-formed byte sequences (RFC 3629, section 4; Unicode, table 3-7): the
// first byte gives the length and the range of the second byte, which excludes overlong forms and
// surrogates.
#pragma once

#include <cstddef>
#include <string_view>

namespace clearance {
namespace utf8 {

// The shape of a character, given its first byte.
struct Form {
  std::size_t length = 0;                   // 0: no character begins so
  unsigned char least = 0x80, most = 0xBF;  // range of the second byte
};

// The rows of table 3-7, by first byte. C0, C1 and F5 to FF begin nothing.
[[nodiscard]] constexpr Form form_of(unsigned char first) {
  if (first < 0x80) return {.length = 1};
  if (first < 0xC2) return {};
  if (first < 0xE0) return {.length = 2};
  if (first == 0xE0) return {.length = 3, .least = 0xA0};
  if (first == 0xED) return {.length = 3, .most = 0x9F};
  if (first < 0xF0) return {.length = 3};
  if (first == 0xF0) return {.length = 4, .least = 0x90};
  if (first == 0xF4) return {.length = 4, .most = 0x8F};
  return {.length = first < 0xF4 ? 4u : 0u};
}

// Bytes after the second are always 80 to BF.
[[nodiscard]] constexpr bool begins_with(std::string_view text, const Form& form) {
  if (form.length == 0 || form.length > text.size()) return false;
  for (std::size_t i = 1; i < form.length; ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const bool second = i == 1;
    if (byte < (second ? form.least : 0x80) || byte > (second ? form.most : 0xBF)) return false;
  }
  return true;
}

}  // namespace utf8

// Returns the position of the first byte that is not part of well-formed UTF-8, or the text's
// length when there is none. Overlong forms, surrogates and code points above U+10FFFF are not
// well-formed (RFC 3629). Each character is judged by its own bytes only.
[[nodiscard]] constexpr std::size_t end_of_utf8(std::string_view text) {
  std::size_t at = 0;
  while (at < text.size()) {
    const utf8::Form form = utf8::form_of(static_cast<unsigned char>(text[at]));
    if (!utf8::begins_with(text.substr(at), form)) break;
    at += form.length;
  }
  return at;
}

}  // namespace clearance
