// The names of sources, as cells state them and as inputs are heard: which writer of a name one is.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace clearance {

inline constexpr std::size_t kMaxSourceLength = 32;  // bytes; idl/clearance.idl

// Returns the end of a name that numbers the writers of one name: "#2" of NAME#2. It is empty if
// the name does not end in '#' and digits.
[[nodiscard]] inline std::string_view writer_suffix(std::string_view source) noexcept {
  const std::size_t last = source.find_last_not_of("0123456789");
  const bool is_numbered = last != source.npos && source[last] == '#' && last + 1 < source.size();
  return is_numbered ? source.substr(last) : std::string_view();
}

// The source name for the bases of robots: NAME:bases, and NAME:bases#2 of NAME#2. Sequence numbers
// count samples of one kind, so bases need a source beside that of the poses.
[[nodiscard]] inline std::string base_source(const std::string& source) {
  const std::string suffix(writer_suffix(source));
  return source.substr(0, source.size() - suffix.size()) + ":bases" + suffix;
}

}  // namespace clearance
