// Which objects' poses come less often than their age limits need: such an object is late again and
// again, and its zones flicker without anything being wrong.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "config/scene.hpp"

namespace clearance {

class SlowPoses {
 public:
  // In a row, all longer than the age limit: a pause or lost batches are no rate.
  static constexpr std::size_t kIntervals = 8;

  explicit SlowPoses(const Scene& scene);

  // To be called with every pose, its stamp in ns. The median interval, once an object: when it is
  // found that its poses come too seldom.
  [[nodiscard]] std::optional<std::int64_t> note(std::uint32_t object, std::int64_t stamp_ns);

 private:
  struct Rate {
    std::int64_t limit_ns = 0;  // 0: found already, or a fixed object
    std::int64_t stamp_ns = 0;
    std::size_t count = 0;
    std::array<std::int64_t, kIntervals> intervals_ns{};
  };
  std::vector<Rate> rates_;  // by object
};

// An age limit that fits poses at this interval: two of them, to the next 10 ms.
[[nodiscard]] std::int64_t fitting_age_limit_ms(std::int64_t interval_ns) noexcept;

}  // namespace clearance
