// Runs a monitor of a crowd tick by tick and measures the time of each tick.
#pragma once

#include <cstdint>
#include <vector>

#include "monitor/tick/monitor.hpp"
#include "tools/bench/clocks.hpp"
#include "tools/bench/crowd.hpp"

namespace clearance::bench {

// The time and the poses of tick `tick` of a run, counted from 0 after the start-up.
[[nodiscard]] std::int64_t stamp_ns(int tick);

// A monitor of a crowd and the time in its world. Two runs of the same crowd agree to the bit.
class TickRun {
 public:
  explicit TickRun(const Crowd& crowd);

  // Ticks until every pair has been evaluated or bounded once; returns the time of each tick, ns.
  std::vector<double> start_up();
  void prepare();
  // Runs one tick and returns its wall-clock time, ns.
  double tick();
  [[nodiscard]] const Report& report() const { return *report_; }

 private:
  const Crowd& crowd_;
  const double clock_cost_ = cost_of(wall_ns);
  Monitor monitor_;
  std::vector<PoseSample> samples_;
  int tick_ = 0;
  std::int64_t now_ns_ = 0;
  const Report* report_ = nullptr;
};

// Our minimum of each of the first `ticks` ticks after the start-up, m; NaN where it is not
// certified.
[[nodiscard]] std::vector<double> certified_minima(const Crowd& crowd, int ticks);

// Finds the time of the ticks without disturbances. `least` holds the time of each tick of a run,
// ns. Runs them again, `runs` times, with a new monitor each, and keeps the least time of each
// tick. The machine disturbs some tick in every run, but hardly the same tick in all.
void keep_least(const Crowd& crowd, int runs, std::vector<double>& least);

}  // namespace clearance::bench
