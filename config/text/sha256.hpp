// A hash of 256 bits for contents that an adversary may have made.
#pragma once

#include <string>
#include <string_view>

namespace clearance {

// SHA-256 (FIPS 180-4) in 64 lower-case hexadecimal digits, as sha256sum prints it.
[[nodiscard]] std::string sha256(std::string_view bytes);

}  // namespace clearance
