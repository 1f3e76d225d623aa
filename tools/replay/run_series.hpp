// A replay as curves: of every published pair the least distance, least bound and largest closing
// speed over stretches of time, as many as a picture has columns, however long the run.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "config/scene.hpp"
#include "monitor/replay/offline_replay.hpp"

namespace clearance {

// Of one stretch; NaN where nothing was known in it.
struct StretchOfPair {
  float distance, lower;  // m, the least
  float closing_speed;    // m/s, the largest
};

// The tick in which a pair was nearest.
struct NearestTick {
  bool known = false;
  double time_s = 0.0;  // after the first tick
  double distance = 0.0, lower = 0.0, upper = 0.0;
};

struct ZoneVisit {
  std::uint32_t zone = 0, pair = 0;
  double begin_s = 0.0, end_s = 0.0;
  double clearance = 0.0;  // the least while it was active, m
};

class RunSeries {
 public:
  explicit RunSeries(const Scene& scene);

  void add(const ReplayedTick& tick);

  [[nodiscard]] const std::vector<double>& times_s() const noexcept { return times_s_; }
  // One a stretch; `place`: into the list of published pairs.
  [[nodiscard]] const std::vector<StretchOfPair>& of(std::size_t place) const {
    return curves_[place];
  }
  [[nodiscard]] const std::vector<std::uint32_t>& pairs() const noexcept { return pairs_; }
  [[nodiscard]] const NearestTick& nearest(std::size_t place) const { return nearest_[place]; }
  // Finished ones and, until the last tick, those that are active.
  [[nodiscard]] std::vector<ZoneVisit> visits() const;
  [[nodiscard]] double duration_s() const noexcept { return last_s_; }

  // The places of these pairs; of none: of those that came nearest, at most `most`, nearest first.
  [[nodiscard]] std::vector<std::size_t> choose(
      const std::vector<std::pair<std::string, std::string>>& objects, std::size_t most) const;

 private:
  void begin_stretch();
  void halve();
  void add_pair(std::size_t place, const PairReport& pair);
  void add_zones(const Report& report);

  const Scene& scene_;
  std::vector<std::uint32_t> pairs_;
  std::vector<std::vector<StretchOfPair>> curves_;
  std::vector<NearestTick> nearest_;
  std::vector<double> times_s_;
  std::vector<ZoneVisit> visits_;
  std::vector<std::int64_t> visit_of_;  // by zone: into visits_; -1: not active
  std::int64_t first_ns_ = 0;
  double last_s_ = 0.0;
  std::uint64_t ticks_ = 0, stride_ = 1, in_stretch_ = 0;
};

}  // namespace clearance
