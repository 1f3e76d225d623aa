// Detects inputs (poses of objects or positions of joints) that come less often than their age
// limits need. Such an input is late again and again, and its zones flicker although nothing is
// wrong.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/inputs/pose_batch.hpp"
#include "monitor/intake/decoder.hpp"

namespace clearance {

// The intervals of all inputs of one kind, by input number.
class SlowIntervals {
 public:
  // The number of consecutive intervals that must all exceed the age limit. A single pause or loss
  // does not count.
  static constexpr std::size_t kIntervals = 8;

  // Age limits in ns; 0 for an input that never comes, such as the pose of a fixed object.
  explicit SlowIntervals(const std::vector<std::int64_t>& limits_ns);

  // Returns the median interval once per input, ns, when the input first proves too slow.
  [[nodiscard]] std::optional<std::int64_t> note(std::uint32_t input, std::int64_t stamp_ns);

 private:
  struct Rate {
    std::int64_t limit_ns = 0;  // 0: already reported, or never comes
    std::int64_t stamp_ns = 0;
    std::size_t count = 0;
    std::array<std::int64_t, kIntervals> intervals_ns{};
  };
  std::vector<Rate> rates_;  // by input
};

// All inputs of a scene.
class SlowInputs {
 public:
  // The scene must outlive this.
  explicit SlowInputs(const Scene& scene);
  // Call this with every batch. Tells `out` of each slow input once.
  void note(const PoseBatch& batch, Outlet& out);

 private:
  void note_poses(const PoseBatch& batch, Outlet& out);
  void note_joints(const PoseBatch& batch, Outlet& out);

  const Scene* scene_;
  SlowIntervals poses_, joints_;
};

// The age limit that suits an interval: two intervals, rounded to the next 10 ms.
[[nodiscard]] std::int64_t fitting_age_limit_ms(std::int64_t interval_ns) noexcept;

}  // namespace clearance
