#include "tools/bench/ticks.hpp"

#include <benchmark/benchmark.h>
#include <malloc.h>

#include <algorithm>
#include <bit>
#include <functional>
#include <string>
#include <vector>

#include "monitor/monitor.hpp"
#include "tools/bench/cpu_clock.hpp"
#include "tools/bench/crowd.hpp"

namespace clearance::bench {
namespace {

// Until everything is known and has been looked at once.
constexpr int kStartUpTicks = 500;
constexpr std::int64_t kPeriod = 1'000'000;  // ns

double allocated_bytes() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
}

double quantile(const std::vector<double>& sorted, double q) {
  return sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1))];
}

// What the ticks said, in one number: a faster answer that is a different answer shows.
class Hash {
 public:
  void add(const Report& report) {
    add(std::bit_cast<std::uint64_t>(report.minimum.distance));
    add(report.minimum.pair + (report.minimum_proved ? 1ull << 32 : 0ull));
  }
  // 24 bits: exact in the printed double.
  [[nodiscard]] double value() const { return static_cast<double>(hash_ >> 40); }

 private:
  void add(std::uint64_t word) { hash_ = (hash_ ^ word) * 0x100000001b3ull; }
  std::uint64_t hash_ = 0xcbf29ce484222325ull;
};

// A monitor of a crowd and the time in its world.
class Run {
 public:
  explicit Run(const Crowd& crowd) : crowd_(crowd), monitor_(crowd.scene) {}

  void prepare() {
    now_ns_ += kPeriod;
    crowd_.samples_at(1e-9 * static_cast<double>(now_ns_), now_ns_, samples_);
  }
  // Thread CPU time of one tick, ns.
  double tick() {
    const double start = cpu_ns();
    report_ = &monitor_.tick(samples_, now_ns_);
    return cpu_ns() - start;
  }
  [[nodiscard]] const Report& report() const { return *report_; }

 private:
  const Crowd& crowd_;
  Monitor monitor_;
  std::vector<PoseSample> samples_;
  std::int64_t now_ns_ = 1'000'000'000;
  const Report* report_ = nullptr;
};

void time_crowd(benchmark::State& state, const std::function<Crowd()>& make) {
  const Crowd crowd = make();
  const double bytes_before = allocated_bytes(), start = cpu_ns();
  Run run(crowd);
  const double construction = cpu_ns() - start;
  const double bytes = allocated_bytes() - bytes_before;
  double start_up_max = 0.0;
  const bool plain = crowd.scene.evaluate_all;
  for (int t = 0; t < (plain ? 10 : kStartUpTicks); ++t) {
    run.prepare();
    start_up_max = std::max(start_up_max, run.tick());
  }

  std::vector<double> times;
  std::uint64_t queries = 0, proved = 0;
  Hash hash;
  for (auto _ : state) {
    run.prepare();
    const double ns = run.tick();
    state.SetIterationTime(1e-9 * ns);
    times.push_back(ns);
    queries += run.report().queries;
    proved += run.report().minimum_proved;
    hash.add(run.report());
  }
  std::sort(times.begin(), times.end());
  const double ticks = static_cast<double>(times.size());
  const double pairs = static_cast<double>(crowd.scene.pairs.size());
  state.counters["p50_us"] = 1e-3 * quantile(times, 0.5);
  state.counters["p99.9_us"] = 1e-3 * quantile(times, 0.999);
  state.counters["max_us"] = 1e-3 * times.back();
  state.counters["queries"] = static_cast<double>(queries) / ticks;
  state.counters["proved"] = static_cast<double>(proved) / ticks;
  state.counters["pairs"] = pairs;
  state.counters["bytes_per_pair"] = bytes / pairs;
  state.counters["start_ms"] = 1e-6 * construction;
  state.counters["start_tick_max_us"] = 1e-3 * start_up_max;
  state.counters["hash"] = hash.value();
}

void register_crowd(const std::string& name, int ticks, const std::function<Crowd()>& make) {
  benchmark::RegisterBenchmark(name.c_str(), [make](benchmark::State& s) { time_crowd(s, make); })
      ->Iterations(ticks)
      ->UseManualTime()
      ->Unit(benchmark::kMicrosecond);
}

// The same with a budget that covers every pair: each is evaluated in every tick.
void register_plain(const std::string& name, int ticks, const std::function<Crowd()>& make) {
  register_crowd(name + "/plain", ticks, [make] {
    Crowd crowd = make();
    crowd.scene.evaluate_all = true;
    crowd.scene.budget = static_cast<std::uint32_t>(crowd.scene.pairs.size());
    return crowd;
  });
}

}  // namespace

void register_ticks() {
  const auto robot = [] { return robot_in_crowd(100); };
  const auto all_moving = [](std::uint32_t count) {
    return [count] { return orbiting_crowd(count, count); };
  };
  register_crowd("tick/robot_2k", 20'000, robot);
  register_plain("tick/robot_2k", 2'000, robot);
  register_crowd("tick/100_all_moving_5k", 20'000, all_moving(100));
  register_plain("tick/100_all_moving_5k", 2'000, all_moving(100));
  register_crowd("tick/300_all_moving_45k", 10'000, all_moving(300));
  register_plain("tick/300_all_moving_45k", 200, all_moving(300));
  register_crowd("tick/1000_all_moving_500k", 5'000, all_moving(1000));
  register_plain("tick/1000_all_moving_500k", 20, all_moving(1000));
  register_crowd("tick/3000_few_moving_4500k", 5'000, [] { return orbiting_crowd(3000, 150); });
}

}  // namespace clearance::bench
