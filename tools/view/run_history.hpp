// A recorded run in short pieces of time: the time line is drawn from it, and the plots of what was
// before any moment that is jumped to.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "clearance.h"
#include "config/scene/scene.hpp"
#include "tools/plot/stretches.hpp"

namespace clearance::view {

class RunHistory {
 public:
  static constexpr std::int64_t kWindowNs = 30'000'000'000;  // of a plot
  static constexpr std::size_t kMostPoints = 600;            // of a curve: more than pixels show

  // The least of a stretch of time; NaN where no minimum was known in it.
  struct Piece {
    std::int64_t begin_ns = 0;  // of the stretch: log time of its first report
    std::int64_t time_ns = 0;   // of the least; without one, `begin_ns`
    double distance = std::numeric_limits<double>::quiet_NaN();  // m
    double lower = distance;
    std::uint32_t pair = 0;     // that is it
    double tick_us = distance;  // the longest from telling a tick its time to its report
  };

  // Of a published pair, m; NaN where it was not known.
  struct Least {
    float distance = std::numeric_limits<float>::quiet_NaN();
  };

  explicit RunHistory(const Scene& scene);

  // Reports in the order of their log times.
  void take(const clearance_msg_Distances& report, std::int64_t log_ns);

  // The least of the whole run; without any, NaN.
  [[nodiscard]] Piece least() const;
  // The run in at most so many pieces of equal length; those without a report are left out.
  [[nodiscard]] std::vector<Piece> pieces(std::size_t most) const;
  // The last kWindowNs up to `end_ns`, as JSON: {"s": [...], "distance": [...], "lower": [...],
  // "tick": [...], "pairs": {"ID": [...]}}; s after the first report, m, us; null: not known.
  // Distances of pairs that are not published are null.
  [[nodiscard]] std::string window(std::int64_t end_ns, std::span<const std::uint32_t> pairs) const;

 private:
  // Of the pieces from `first` to before `last`, m; NaN: of no published pair, or never known.
  [[nodiscard]] double least_of(std::uint32_t pair, std::size_t first, std::size_t last) const;

  static constexpr std::uint32_t kNotPublished = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> column_of_;  // by pair
  Stretches<Piece, Least> run_;           // a column a published pair
};

// As Stretches asks for it.
void merge(const RunHistory::Piece& later, RunHistory::Piece& into);
void merge(const RunHistory::Least& later, RunHistory::Least& into);

}  // namespace clearance::view
