#include "monitor/sensors/persistence.hpp"

#include <algorithm>
#include <cmath>

#include "monitor/inputs/elapsed.hpp"

namespace clearance {
namespace {

constexpr std::size_t kMarkBits = std::size_t{1} << 23;
constexpr std::size_t kKnownBoxes = 16384;
// A search for a near element enlarges a box by at most this many cells on each side. A frame that
// needs more counts as one that has a near element.
constexpr int kMostCells = 4;
// The least side of a cell, m, and the least time in which a body at the largest speed crosses it,
// s. The side is also at least the largest error of a depth, so that an element touches few cells.
constexpr double kLeastSide = 0.02, kSideTime = 0.02;
// An element that touches more cells than this stays, and counts as near to every other one.
constexpr double kMostTouched = 1000.0;

std::size_t hash(std::int32_t x, std::int32_t y, std::int32_t z) noexcept {
  std::uint64_t h = static_cast<std::uint32_t>(x) * 0x9E3779B97F4A7C15ULL;
  h = (h ^ h >> 32 ^ static_cast<std::uint32_t>(y)) * 0xBF58476D1CE4E5B9ULL;
  h = (h ^ h >> 32 ^ static_cast<std::uint32_t>(z)) * 0x94D049BB133111EBULL;
  return static_cast<std::size_t>(h ^ h >> 32);
}

// Visits the bits of a box of cells, enlarged by `more` cells on each side, until `visit` returns
// true. Returns whether it did.
template <class Cells, class Visit>
bool visit_bits(const Cells& cells, int more, const Visit& visit) noexcept {
  for (std::int32_t x = cells.low[0] - more; x <= cells.high[0] + more; ++x) {
    for (std::int32_t y = cells.low[1] - more; y <= cells.high[1] + more; ++y) {
      for (std::int32_t z = cells.low[2] - more; z <= cells.high[2] + more; ++z) {
        const std::size_t bit = hash(x, y, z) % kMarkBits;
        if (visit(bit / 64, std::uint64_t{1} << bit % 64)) return true;
      }
    }
  }
  return false;
}

}  // namespace

Persistence::Persistence(const Sensor& sensor, double max_speed)
    : frames_(sensor.persist_frames),
      of_(sensor.persist_of),
      max_speed_(max_speed),
      stamp_errors_s_(2e-9 * static_cast<double>(sensor.stamp_error_ns)),
      side_(std::max({kLeastSide, kSideTime * max_speed, sensor.error_at(sensor.greatest_depth)})),
      earlier_(std::max<std::size_t>(of_, 2) - 1),
      known_(kKnownBoxes) {
  for (Marks& marks : earlier_) marks.bits.resize(kMarkBits / 64);
  newest_.bits.resize(kMarkBits / 64);
}

Persistence::Cells Persistence::touched(const Vec3& centre, double radius) const noexcept {
  Cells cells;
  for (int k = 0; k < 3; ++k) {
    const auto number = [&](double x) {
      return static_cast<std::int32_t>(std::clamp(std::floor(x / side_), -1e9, 1e9));
    };
    cells.low[static_cast<std::size_t>(k)] = number(centre[k] - radius);
    cells.high[static_cast<std::size_t>(k)] = number(centre[k] + radius);
  }
  return cells;
}

// Compares with earlier frames only. The newest frame has the element itself, so it counts as one.
bool Persistence::stays(const Cells& cells, double error, std::int64_t stamp_ns) const noexcept {
  std::uint32_t found = 1;
  const std::size_t kept = std::min<std::size_t>(count_, earlier_.size());
  for (std::size_t i = 0; i < kept && found < frames_; ++i) {
    const Marks& marks = earlier_[i];
    // An earlier frame may have a later stamp, if its clock was set back.
    const double seconds = 1e-9 * static_cast<double>(elapsed(marks.stamp_ns, stamp_ns) +
                                                      elapsed(stamp_ns, marks.stamp_ns));
    const double distance =
        max_speed_ * std::max(0.0, seconds + stamp_errors_s_) + error + marks.error;
    // The cells of two points at this distance differ by at most `more` along an axis.
    const double more = std::ceil(distance / side_ * (1.0 + 0x1p-40));
    const bool is_near =
        marks.has_wide || !(more <= kMostCells) ||
        visit_bits(cells, static_cast<int>(more), [&](std::size_t word, std::uint64_t bit) {
          return (marks.bits[word] & bit) != 0;
        });
    found += is_near ? 1 : 0;
  }
  return found >= frames_;
}

std::size_t Persistence::hide(SeenCloud& cloud, const Pose& world_from_sensor, double error,
                              std::int64_t stamp_ns, std::span<DepthCloud> unseen) {
  std::ranges::fill(newest_.bits, 0);
  newest_.stamp_ns = stamp_ns;
  newest_.error = error;
  newest_.has_wide = false;
  std::size_t hidden = 0;
  const std::uint64_t frame = count_ + 1;
  const Mat3 turn = world_from_sensor.orientation.toRotationMatrix();
  cloud.for_each([&](std::size_t block, std::size_t lane, const Vec3& centre, double radius) {
    const double along = 2.0 * radius / side_ + 2.0;
    if (along * along * along > kMostTouched) {
      newest_.has_wide = true;
      return;
    }
    const Cells cells = touched(turn * centre + world_from_sensor.position, radius);
    Known& known = known_[hash(cells.low[0] + cells.high[0], cells.low[1] + cells.high[1],
                               cells.low[2] + cells.high[2]) %
                          kKnownBoxes];
    if (known.frame != frame || !(known.cells == cells)) {
      visit_bits(cells, 0, [&](std::size_t word, std::uint64_t bit) {
        newest_.bits[word] |= bit;
        return false;
      });
      known = {cells, frame, stays(cells, error, stamp_ns)};
    }
    if (known.stays) return;
    ++hidden;
    cloud.remove(block, lane);
    for (DepthCloud& each : unseen) each.leave_open(block, lane);
  });
  std::swap(earlier_[count_ % earlier_.size()], newest_);
  ++count_;
  return hidden;
}

}  // namespace clearance
