#include "monitor/loop/successor.hpp"

#include <utility>

namespace clearance {
namespace {

// Nothing else than evaluations is missing for a certified minimum: what is late, unknown or absent
// would wait for inputs.
bool awaits_evaluations(const Report& report) noexcept {
  return !report.minimum_certified && report.unknown + report.stale == 0 &&
         absent_pairs(report) < report.pairs_total;
}

}  // namespace

Successor::Successor(const Scene& before, const Monitor& running, const Scene& scene,
                     std::vector<ReportSink*> sinks, TickRecords& records)
    : scene_(scene),
      map_(scene_map(before, scene)),
      monitor_(std::make_unique<Monitor>(scene, &running)),
      numbers_(scene),
      statistics_(scene),
      sinks_(std::move(sinks)),
      records_(records) {
  records_.clear();
}

void Successor::begin(const Monitor& running, SourceNumbers& numbers) noexcept {
  if (!monitor_->take_over(running, map_, numbers)) {
    state_.store(State::kTooManyNames, std::memory_order_release);
    return;
  }
  numbers_ = numbers;
  began_after_ = running.cycle();
  state_.store(State::kCatchingUp, std::memory_order_release);
}

// Samples come before the tick that has them.
void Successor::record(std::span<const PoseSample> samples, std::span<const JointSample> joints,
                       const TickTime& time, bool certified) noexcept {
  const auto fill = [](const auto& from, auto& ring) {
    for (const auto& sample : from) {
      auto* slot = ring.back();
      if (slot == nullptr) return false;
      *slot = sample;
      ring.push();
    }
    return true;
  };
  TickRecords::Tick* tick = records_.ticks.back();
  if (tick == nullptr || !fill(samples, records_.poses) || !fill(joints, records_.joints)) {
    state_.store(State::kTooSlow, std::memory_order_release);
    return;
  }
  *tick = {time, samples.size(), joints.size(), certified};
  records_.ticks.push();
}

template <class Sample>
void Successor::take(SpscRing<Sample>& ring, std::size_t count, std::span<const std::uint32_t> now,
                     std::uint32_t Sample::*input, std::vector<Sample>& taken) noexcept {
  taken.clear();
  for (; count > 0; --count, ring.pop()) taken.push_back(*ring.front());
  keep_mapped(now, input, 0, taken);
}

std::size_t Successor::catch_up() noexcept {
  std::size_t count = 0;
  TickRecords& r = records_;
  for (TickRecords::Tick* tick = r.ticks.front(); tick != nullptr && state() == State::kCatchingUp;
       tick = r.ticks.front(), ++count) {
    take(r.poses, tick->poses, map_.objects_now, &PoseSample::object, r.taken_poses);
    take(r.joints, tick->joints, map_.variables_now, &JointSample::variable, r.taken_joints);
    const bool certified = tick->certified;
    const Report& report = monitor_->tick(r.taken_poses, r.taken_joints, tick->time);
    r.ticks.pop();
    uncertified_ = certified && awaits_evaluations(report) ? uncertified_ + 1 : 0;
    if (uncertified_ == 0 || uncertified_ > kMostUncertified)
      caught_up_at_.store(report.cycle, std::memory_order_release);
  }
  return count;
}

void Successor::succeed(std::unique_ptr<Monitor>& monitor, LoopStatistics& statistics,
                        std::vector<ReportSink*>& sinks, SceneIds& ids) noexcept {
  statistics_.continue_from(statistics);
  std::swap(statistics_, statistics);
  std::swap(monitor_, monitor);
  std::swap(sinks_, sinks);
  ids.change(scene_.revision, map_);
  in_force_from_ = monitor->cycle() + 1;
  state_.store(State::kSucceeded, std::memory_order_release);
}

}  // namespace clearance
