// A replay as curves: for every published pair the least distance, least bound and largest closing
// speed in each stretch of time. There are as many stretches as a picture has columns.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/replay/offline_replay.hpp"
#include "tools/plot/stretches.hpp"

namespace clearance {

// A pair in one stretch; NaN where nothing was known.
struct StretchOfPair {
  float distance = std::numeric_limits<float>::quiet_NaN(), lower = distance;  // m, the least
  float closing_speed = distance;                                              // m/s, the largest
};
struct StretchOfRun {
  std::int64_t begin_ns = 0;  // after the first tick
};
// Joins the values of two stretches of time; Stretches calls this when it joins stretches.
void merge(const StretchOfPair& later, StretchOfPair& into);
void merge(const StretchOfRun& later, StretchOfRun& into);

// The tick in which a pair was nearest.
struct NearestTick {
  bool known = false;
  double time_s = 0.0;  // after the first tick
  double distance = 0.0, lower = 0.0, upper = 0.0;
};

struct ZoneVisit {
  std::string zone, pair;
  double begin_s = 0.0, end_s = 0.0;
  double clearance = 0.0;  // the least while it was active, m
};

// The pairs are those that the first cell publishes. Where the cell changes in the run, they are
// found again by the names of their objects, and have no values while a cell lacks them.
class RunSeries {
 public:
  explicit RunSeries(const Scene& scene);

  void add(const ReplayedTick& tick);

  // The number of stretches, the begin of each, and a pair in it. `place`: index into the list of
  // published pairs.
  [[nodiscard]] std::size_t stretches() const noexcept { return curves_.heads().size(); }
  [[nodiscard]] double time_s(std::size_t stretch) const {
    return 1e-9 * static_cast<double>(curves_.heads()[stretch].begin_ns);
  }
  [[nodiscard]] const StretchOfPair& of(std::size_t place, std::size_t stretch) const {
    return curves_.cells(stretch)[place];
  }
  [[nodiscard]] const std::vector<std::uint32_t>& pairs() const noexcept { return pairs_; }
  [[nodiscard]] const NearestTick& nearest(std::size_t place) const { return nearest_[place]; }
  // Finished visits, and those that were active in the last tick.
  [[nodiscard]] std::vector<ZoneVisit> visits() const;
  [[nodiscard]] double duration_s() const noexcept { return last_s_; }

  // The places of these pairs. If none are given: of at most `most` pairs that came nearest,
  // nearest first.
  [[nodiscard]] std::vector<std::size_t> choose(
      const std::vector<std::pair<std::string, std::string>>& objects, std::size_t most) const;

 private:
  void follow(const Scene& scene);
  void add_pair(std::size_t place, const PairReport& pair, StretchOfPair& stretch);
  void add_zones(const Report& report);

  static constexpr std::size_t kNoPlace = std::numeric_limits<std::size_t>::max();

  const Scene& scene_;               // the first one
  const Scene* in_force_ = nullptr;  // that of the last tick
  std::vector<std::size_t>
      place_of_;  // by published pair of that scene; kNoPlace: the first has none
  std::vector<std::uint32_t> pairs_;
  Stretches<StretchOfRun, StretchOfPair> curves_;
  std::vector<NearestTick> nearest_;
  std::vector<ZoneVisit> visits_;
  std::vector<std::int64_t> visit_of_;  // by zone, index into visits_; -1: not active
  std::int64_t first_ns_ = 0;
  double last_s_ = 0.0;
  std::uint64_t ticks_ = 0;
};

}  // namespace clearance
