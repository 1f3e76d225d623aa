#include "tools/bench/tick_run.hpp"

#include <algorithm>
#include <limits>

namespace clearance::bench {
namespace {

// Ticks until everything is known and has been evaluated once. The last of them give times without
// the effects of the start.
constexpr int kStartUpTicks = 3'000;
constexpr int kShortStartUpTicks = 10;       // where each pair is evaluated in every tick
constexpr std::int64_t kPeriod = 1'000'000;  // ns
constexpr std::int64_t kFirst = 1'000'000'000;

}  // namespace

std::int64_t stamp_ns(int tick) { return kFirst + (kStartUpTicks + tick) * kPeriod; }

TickRun::TickRun(const Crowd& crowd) : crowd_(crowd), monitor_(crowd.scene) {}

std::vector<double> TickRun::start_up() {
  std::vector<double> times;
  const int ticks = crowd_.scene.evaluate_all ? kShortStartUpTicks : kStartUpTicks;
  for (tick_ = -ticks; tick_ < 0;) {
    prepare();
    times.push_back(tick());
  }
  return times;
}

void TickRun::prepare() {
  now_ns_ = stamp_ns(tick_++);
  crowd_.samples_at(1e-9 * static_cast<double>(now_ns_), now_ns_, samples_);
}

double TickRun::tick() {
  const double start = wall_ns();
  report_ = &monitor_.tick(samples_, now_ns_);
  return std::max(0.0, wall_ns() - start - clock_cost_);
}

std::vector<double> certified_minima(const Crowd& crowd, int ticks) {
  TickRun run(crowd);
  run.start_up();
  std::vector<double> minima;
  for (int t = 0; t < ticks; ++t) {
    run.prepare();
    run.tick();
    minima.push_back(run.report().minimum_certified ? run.report().minimum.distance
                                                    : std::numeric_limits<double>::quiet_NaN());
  }
  return minima;
}

void keep_least(const Crowd& crowd, int runs, std::vector<double>& least) {
  for (int i = 0; i < runs; ++i) {
    TickRun run(crowd);
    run.start_up();
    for (double& time : least) {
      run.prepare();
      time = std::min(time, run.tick());
    }
  }
}

}  // namespace clearance::bench
