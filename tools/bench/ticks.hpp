// Whole ticks of the shipped cells and of generated ones, up to millions of pairs.
#pragma once

#include <benchmark/benchmark.h>

#include <functional>
#include <string>
#include <vector>

#include "tools/bench/crowd.hpp"

namespace clearance::bench {

// tick/NAME and sweep/WHAT/VALUE: ours. With /plain: with a budget that covers every pair. With
// /fcl: another library on the same poses.
void register_ticks();

// The counters p50_us, p99.9_us and max_us of times in ns, each behind `prefix`.
void count_times(std::vector<double> times, benchmark::State& state,
                 const std::string& prefix = "");

using MakeCrowd = std::function<Crowd()>;
void register_tick_row(const std::string& name, int ticks,
                       const std::function<void(benchmark::State&)>& run);

}  // namespace clearance::bench
