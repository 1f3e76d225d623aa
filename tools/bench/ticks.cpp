#include "tools/bench/ticks.hpp"

#include <fmt/format.h>

#include <malloc.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "config/cell/shares.hpp"
#include "config/text/fnv1a.hpp"
#include "tools/bench/clocks.hpp"
#include "tools/bench/peers/peers.hpp"
#include "tools/bench/plain_arithmetic.hpp"
#include "tools/bench/tick_run.hpp"

namespace clearance::bench {
namespace {

double allocated_bytes() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
}

double quantile(const std::vector<double>& sorted, double q) {
  return sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1))];
}

double median(std::vector<double> times) {
  std::sort(times.begin(), times.end());
  return quantile(times, 0.5);
}

// A hash of the reports, so that a faster answer which is a different answer shows.
class Hash {
 public:
  void add(const Report& report) {
    hash_.add(std::bit_cast<std::uint64_t>(report.minimum.distance));
    hash_.add(report.minimum.pair + (report.minimum_certified ? 1ull << 32 : 0ull));
  }
  // 24 bits: exact in the printed double.
  [[nodiscard]] double value() const { return static_cast<double>(hash_.value() >> 40); }

 private:
  Fnv1a hash_;
};

// Measures a run and counts its work; returns the time of each tick, ns.
std::vector<double> time_run(benchmark::State& state, const Crowd& crowd) {
  const double bytes_before = allocated_bytes(), start = wall_ns();
  TickRun run(crowd);
  const double construction = wall_ns() - start;
  const double bytes = allocated_bytes() - bytes_before;
  const std::vector<double> start_up = run.start_up();
  PlainArithmetic control(median({start_up.begin() + start_up.size() / 2, start_up.end()}));

  std::vector<double> times, control_times;
  std::uint64_t queries = 0, certified = 0;
  Hash hash;
  for (auto _ : state) {
    run.prepare();
    const double ns = run.tick();
    state.SetIterationTime(1e-9 * ns);
    times.push_back(ns);
    queries += run.report().queries;
    certified += run.report().minimum_certified;
    hash.add(run.report());
  }
  // This is measured after the ticks, because between them it would leave colder caches.
  for (std::size_t i = 0; i < times.size(); ++i) control_times.push_back(control.time());
  const double ticks = static_cast<double>(times.size());
  const double pairs = static_cast<double>(crowd.scene.pairs.size());
  count_times(times, state);
  count_times(control_times, state, "control_");
  state.counters["queries"] = static_cast<double>(queries) / ticks;
  state.counters["proved"] = static_cast<double>(certified) / ticks;
  state.counters["pairs"] = pairs;
  state.counters["bytes_per_pair"] = bytes / pairs;
  state.counters["start_ms"] = 1e-6 * construction;
  state.counters["start_tick_max_us"] = 1e-3 * std::ranges::max(start_up);
  state.counters["hash"] = hash.value();
  for (const auto& [what, value] : crowd.swept) state.counters[what] = value;
  return times;
}

void register_crowd(const std::string& name, int ticks, int runs, const MakeCrowd& make) {
  register_tick_row(name, ticks, [make, runs](benchmark::State& state) {
    const Crowd crowd = make();
    std::vector<double> least = time_run(state, crowd);
    if (runs == 1) return;
    keep_least(crowd, runs - 1, least);
    count_times(least, state, "own_");
    state.counters["own_runs"] = runs;
  });
}

// The same with a budget that covers every pair: each is evaluated in every tick.
Crowd all_evaluated(Crowd crowd) {
  crowd.scene.evaluate_all = true;
  std::uint64_t rows = 0;
  for (const ObjectPair& pair : crowd.scene.pairs) {
    rows += crowd.scene.objects[pair.first].parts.size() *
            crowd.scene.objects[pair.second].parts.size();
  }
  crowd.scene.budget = static_cast<std::uint32_t>(rows);
  return crowd;
}

void register_plain(const std::string& name, int ticks, const MakeCrowd& make) {
  register_crowd(fmt::format("{}/plain", name), ticks, 1, [make] { return all_evaluated(make()); });
}

struct Ticks {
  int ours, plain, fcl;  // how many are timed; 0: none
  int runs = 1;          // of our monitor, for the least time of each tick
};

void register_all(const std::string& name, const Ticks& ticks, const MakeCrowd& make) {
  register_crowd(name, ticks.ours, ticks.runs, make);
  if (ticks.plain > 0) register_plain(name, ticks.plain, make);
#ifdef CLEARANCE_BENCH_FCL
  if (ticks.fcl > 0) register_fcl_manager(fmt::format("{}/fcl", name), ticks.fcl, make);
#endif
}

// The pairs of one of two shares, as `shares: {auto: 2}` divides them.
Crowd half_of(Crowd crowd, bool second) {
  std::vector<ObjectPair>& pairs = crowd.scene.pairs;
  const auto middle =
      pairs.begin() + balanced_begins(expected_costs(crowd.scene.objects, pairs), 2).front();
  second ? pairs.erase(pairs.begin(), middle) : pairs.erase(middle, pairs.end());
  return crowd;
}

Crowd swept_crowd(const OrbitingOptions& options) {
  Crowd crowd = orbiting_crowd(options);
  crowd.swept = {{"objects", options.count},
                 {"speed", options.speed},
                 {"density", std::pow(options.spacing, -3.0)}};
  return crowd;
}

// Cost against the number of pairs, speed and density.
void register_sweeps() {
  const auto sweep = [](const std::string& name, const OrbitingOptions& options) {
    const int plain = options.count > 500 ? 10 : 50;
    register_all(fmt::format("sweep/{}", name), {1'000, plain, 100},
                 [options] { return swept_crowd(options); });
  };
  for (const std::uint32_t count : {30u, 100u, 300u, 1000u}) {
    sweep(fmt::format("objects/{}", count), {.count = count, .moving = count});
  }
  for (const char* speed : {"0.1", "0.3", "1", "3", "10"}) {
    sweep(std::string("speed/") + speed, {.count = 300, .moving = 300, .speed = std::stod(speed)});
  }
  for (const char* spacing : {"1", "1.5", "2.2", "3.2", "4.6"}) {
    sweep(std::string("spacing/") + spacing,
          {.count = 300, .moving = 300, .spacing = std::stod(spacing)});
  }
}

}  // namespace

void count_times(std::vector<double> times, benchmark::State& state, const std::string& prefix) {
  std::sort(times.begin(), times.end());
  state.counters[fmt::format("{}p50_us", prefix)] = 1e-3 * quantile(times, 0.5);
  state.counters[fmt::format("{}p99.9_us", prefix)] = 1e-3 * quantile(times, 0.999);
  state.counters[fmt::format("{}max_us", prefix)] = 1e-3 * times.back();
}

void register_tick_row(const std::string& name, int ticks,
                       const std::function<void(benchmark::State&)>& run) {
  benchmark::RegisterBenchmark(name.c_str(), run)
      ->Iterations(ticks)
      ->UseManualTime()
      ->Unit(benchmark::kMicrosecond);
}

void register_ticks() {
  const auto all_moving = [](std::uint32_t count) {
    return [count] { return orbiting_crowd({.count = count, .moving = count}); };
  };
  // FCL has no distances to half-spaces, which these have for floors.
  register_all("tick/mcintyre", {100'000, 100'000, 0, 10},
               [] { return shipped_crowd("mcintyre"); });
  register_all("tick/two_arms", {20'000, 20'000, 0, 10}, [] { return shipped_crowd("two_arms"); });
  register_all("tick/robot_2k", {20'000, 2'000, 1'000, 10}, [] { return robot_in_crowd(100); });
  register_all("tick/100_all_moving_5k", {20'000, 2'000, 1'000, 10}, all_moving(100));
  register_all("tick/300_all_moving_45k", {10'000, 200, 300, 7}, all_moving(300));
  register_all("tick/300_of_510_facets_45k", {10'000, 50, 100, 7},
               [] { return orbiting_crowd({.count = 300, .moving = 300, .order = 20}); });
  register_all("tick/warehouse_49k", {10'000, 100, 300, 7}, [] { return warehouse_crowd(1000); });
  register_all("tick/1000_all_moving_500k", {5'000, 20, 100, 5}, all_moving(1000));
  // Plain evaluation of these would take up to seconds a tick.
  register_all("tick/2000_all_moving_2000k", {2'000, 0, 0, 3}, all_moving(2000));
  for (const bool second : {false, true})
    register_all(fmt::format("tick/2000_all_moving_share_{}_of_2", second ? 2 : 1),
                 {2'000, 0, 0, 3}, [=] { return half_of(all_moving(2000)(), second); });
  register_all("tick/3000_few_moving_4500k", {5'000, 0, 100, 5},
               [] { return orbiting_crowd({.count = 3000, .moving = 150}); });
  register_sweeps();
}

}  // namespace clearance::bench
