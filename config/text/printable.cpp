// Goes character by character; a byte that begins no UTF-8 character is escaped alone.
#include "config/text/printable.hpp"

#include <fmt/format.h>

#include <iterator>

#include "config/text/utf8.hpp"

namespace clearance {
namespace {

// The length in bytes of the first character of a well-formed UTF-8 text.
std::size_t length_of(char first) {
  const auto byte = static_cast<unsigned char>(first);
  if (byte < 0xC0) return 1;
  if (byte < 0xE0) return 2;
  return byte < 0xF0 ? 3 : 4;
}

// U+2028 to U+202E (line separators and bidirectional embeddings), U+2066 to U+2069 (isolates).
bool changes_direction_or_line(std::string_view character) {
  return (character >= "\u2028" && character <= "\u202E") ||
         (character >= "\u2066" && character <= "\u2069");
}

// Control characters are U+0000 to U+001F, and U+007F to U+009F.
bool is_shown(std::string_view character, LineBreaks breaks) {
  const char first = character.front();
  if (character.size() == 1) {
    if (first == '\n' || first == '\r' || first == '\t') return breaks == LineBreaks::kKept;
    return first >= ' ' && first != '\x7F';
  }
  if (character.size() == 2) return character >= "\u00A0";
  return !changes_direction_or_line(character);
}

void escape(std::string_view bytes, std::string& out) {
  for (const char byte : bytes) {
    fmt::format_to(std::back_inserter(out), "\\x{:02X}", static_cast<unsigned char>(byte));
  }
}

}  // namespace

std::string printable(std::string_view text, LineBreaks breaks) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    std::string_view good = text.substr(0, end_of_utf8(text));
    text.remove_prefix(good.size());
    while (!good.empty()) {
      const std::string_view character = good.substr(0, length_of(good.front()));
      good.remove_prefix(character.size());
      if (is_shown(character, breaks)) {
        out += character;
      } else {
        escape(character, out);
      }
    }
    escape(text.substr(0, 1), out);
    text.remove_prefix(text.empty() ? 0 : 1);
  }
  return out;
}

std::string excerpt(std::string_view text) {
  constexpr std::size_t kMost = 300;
  return text.size() <= kMost ? printable(text) : printable(text.substr(0, kMost)) + "...";
}

}  // namespace clearance
