// Hides elements that too few of the last frames of a sensor have: speckle.
//
// An element stays if at least `frames` of the last `of` frames, its own included, have an element
// near it. Near means: no farther than the largest speed of a seen body times the time between the
// two frames, plus the errors of both. Frames are compared by hashes of cells, so an element may
// also stay without a near one.
// A body that moves at most at this speed is therefore hidden in fewer than `frames` frames after
// it comes into view. Later it is never hidden while it is seen in `frames` of `of` frames.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "config/scene/sensor.hpp"
#include "monitor/clouds/seen_cloud.hpp"

namespace clearance {

class Persistence {
 public:
  // `max_speed` is finite. Allocates all memory.
  Persistence(const Sensor& sensor, double max_speed);

  // Hides elements of the newest frame, and keeps its places for the next frames. The caller has
  // already removed the robot's own image, and calls refit() afterwards. `error` bounds the error
  // of the place of any element, m. The cone of a hidden pixel becomes an unseen place of each
  // cloud in `unseen`. Returns how many elements are hidden. Deterministic.
  std::size_t hide(SeenCloud& cloud, const Pose& world_from_sensor, double error,
                   std::int64_t stamp_ns, std::span<DepthCloud> unseen);

 private:
  // The cells that the elements of a frame touch, as a set of hashes.
  struct Marks {
    std::vector<std::uint64_t> bits;
    std::int64_t stamp_ns = 0;
    double error = 0.0;     // bounds that of the place of any element, m
    bool has_wide = false;  // an element that touches too many cells to be marked
  };
  // A box of cells.
  struct Cells {
    std::array<std::int32_t, 3> low{}, high{};
    friend bool operator==(const Cells&, const Cells&) = default;
  };
  // The answer for a box of the newest frame, kept for further elements in the same box.
  struct Known {
    Cells cells;
    std::uint64_t frame = 0;
    bool stays = false;
  };

  [[nodiscard]] Cells touched(const Vec3& centre, double radius) const noexcept;
  [[nodiscard]] bool stays(const Cells& cells, double error, std::int64_t stamp_ns) const noexcept;

  std::uint32_t frames_, of_;
  double max_speed_, stamp_errors_s_;  // the second: those of two frames, added
  double side_;
  std::vector<Marks> earlier_;  // a ring
  Marks newest_;
  std::vector<Known> known_;
  std::uint64_t count_ = 0;  // frames so far
};

}  // namespace clearance
