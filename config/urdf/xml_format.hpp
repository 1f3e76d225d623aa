// The words of URDF and SRDF that no reader asks for, and what may be said of them.
#pragma once

#include <span>
#include <string_view>

namespace clearance {

// Lists of words are separated by blanks.
struct OtherWords {
  std::string_view element;  // in which they stand
  std::string_view silent;   // of other programs; they change no collision shape and no place
  std::string_view named;    // they have places or lengths, but of nothing that is read
};

struct XmlFormat {
  std::span<const OtherWords> others;
  std::string_view strict;    // elements that are geometry throughout: any unread word is refused
  std::string_view geometry;  // words that place or size what they stand in, wherever that is
};

// "name" is silent everywhere.
[[nodiscard]] const XmlFormat& urdf_format();
[[nodiscard]] const XmlFormat& srdf_format();

}  // namespace clearance
