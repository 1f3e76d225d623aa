// Hides elements that too few of the last frames of a sensor have: speckle.
//
// An element stays if at least `frames` of the last `of` frames, its own included, have an element
// near it: within the largest speed of what is seen times the time between the two frames, and both
// errors. It may also stay without one, since places are compared by cells, whose marks share bits.
// So a body that moves at most at this speed is hidden for less than `frames` frames after it comes
// into view, and is never hidden later while it is seen in `frames` of `of` frames.
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

  // Hides elements of the newest frame, and keeps its places for the next ones. The cloud's own
  // image of the robot is left out before. `error`: m, of the place of any element. The cone of
  // a hidden pixel becomes an unseen place of each of the other clouds. The caller calls refit()
  // after it. Returns how many elements are hidden. Deterministic.
  std::size_t hide(SeenCloud& cloud, const Pose& world_from_sensor, double error,
                   std::int64_t stamp_ns, std::span<DepthCloud> unseen);

 private:
  // The cells that the elements of a frame touch, as a set of hashes.
  struct Marks {
    std::vector<std::uint64_t> bits;
    std::int64_t stamp_ns = 0;
    double error = 0.0;  // m: of the place of any element
  };
  // A box of cells.
  struct Cells {
    std::array<std::int32_t, 3> low{}, high{};
    friend bool operator==(const Cells&, const Cells&) = default;
  };
  // What was found for a box of the newest frame.
  struct Known {
    Cells cells;
    std::uint64_t frame = 0;
    bool stays = false;
  };

  [[nodiscard]] Cells touched(const Vec3& centre, double radius) const noexcept;
  [[nodiscard]] bool stays(const Cells& cells, double error, std::int64_t stamp_ns) const noexcept;

  std::uint32_t frames_, of_;
  double max_speed_, stamp_errors_s_;  // the latter of two frames
  double side_;
  std::vector<Marks> earlier_;  // a ring
  Marks newest_;
  std::vector<Known> known_;
  std::uint64_t count_ = 0;  // of frames so far
};

}  // namespace clearance
