// The time at which an allowance of a contact ends.
#pragma once

#include <algorithm>
#include <cstdint>

#include "config/scene/contact.hpp"

namespace clearance {

// The last tick in which an allowance that came into force at `since_ns` is in force, by its
// duration and its time; ContactEnd::kNoTime: neither ends it.
[[nodiscard]] inline std::int64_t last_time_of(const ContactEnd& end,
                                               std::int64_t since_ns) noexcept {
  const bool is_endless =
      end.duration_ns > ContactEnd::kNoTime - std::max<std::int64_t>(since_ns, 0);
  return is_endless ? end.time_ns : std::min(end.time_ns, since_ns + end.duration_ns);
}

}  // namespace clearance
