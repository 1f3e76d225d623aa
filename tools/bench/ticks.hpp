// Whole ticks of the shipped cells and of generated ones, up to millions of pairs.
#pragma once

#include <benchmark/benchmark.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tools/bench/crowd.hpp"

namespace clearance::bench {

// tick/NAME and sweep/WHAT/VALUE: ours. With /plain: with a budget that covers every pair. With
// /fcl: another library on the same poses.
void register_ticks();

// For what answers a crowd's ticks in another way:

// Tick `tick` of a run, from 0, after the start-up: when, and where everything is.
[[nodiscard]] std::int64_t stamp_ns(int tick);
// Our minimum of each of the first `ticks` ticks after the start-up, m; NaN where it is not proved.
[[nodiscard]] std::vector<double> proved_minima(const Crowd& crowd, int ticks);
// Sorts the times (ns) and sets the counters p50_us, p99.9_us and max_us, each behind `prefix`.
void count_times(std::vector<double>& times, benchmark::State& state,
                 const std::string& prefix = "");

using MakeCrowd = std::function<Crowd()>;
void register_tick_row(const std::string& name, int ticks,
                       const std::function<void(benchmark::State&)>& run);

}  // namespace clearance::bench
