#include "config/cell/cell.hpp"

namespace clearance {

// Partition names are matched as POSIX fnmatch patterns (DDS 1.4, section 2.2.3.13), hence no *, ?
// and [.
bool is_partition(const std::string& name) noexcept {
  constexpr std::size_t kLongest = 255;
  return name.find_first_of("*?[") == std::string::npos && name.size() <= kLongest;
}

}  // namespace clearance
