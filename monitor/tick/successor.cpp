#include "monitor/tick/successor.hpp"

#include <utility>

#include "monitor/tick/tick_state.hpp"

namespace clearance {
namespace {

// Nothing else than evaluations is missing for a certified minimum: what is late, unknown or absent
// would wait for inputs.
bool awaits_evaluations(const Report& report) noexcept {
  return !report.minimum_certified && report.unknown + report.stale == 0 &&
         absent_pairs(report) < report.pairs_total;
}

}  // namespace

Successor::Successor(const TickState& running, const Scene& scene, TickRecords& records)
    : scene_(scene),
      map_(scene_map(running.scene(), scene)),
      monitor_(std::make_unique<Monitor>(scene, &running.monitor())),
      numbers_(scene),
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
  if (!records_.has_room) {
    records_.own_poses.assign(samples.begin(), samples.end());
    records_.own_joints.assign(joints.begin(), joints.end());
    return run(time, certified);
  }
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

std::size_t Successor::catch_up() noexcept {
  const auto empty = [](auto& ring, std::size_t count, auto& into) {
    into.clear();
    for (; count > 0; --count, ring.pop()) into.push_back(*ring.front());
  };
  std::size_t count = 0;
  TickRecords& r = records_;
  for (TickRecords::Tick* tick = r.ticks.front(); tick != nullptr && state() == State::kCatchingUp;
       tick = r.ticks.front(), ++count) {
    empty(r.poses, tick->poses, r.own_poses);
    empty(r.joints, tick->joints, r.own_joints);
    run(tick->time, tick->certified);
    r.ticks.pop();
  }
  return count;
}

// Runs the tick of the samples in own_poses and own_joints, which have the ids of the scene before.
void Successor::run(const TickTime& time, bool certified) noexcept {
  TickRecords& r = records_;
  keep_mapped(map_.objects_now, &PoseSample::object, 0, r.own_poses);
  keep_mapped(map_.variables_now, &JointSample::variable, 0, r.own_joints);
  const Report& report = monitor_->tick(r.own_poses, r.own_joints, time);
  uncertified_ = certified && awaits_evaluations(report) ? uncertified_ + 1 : 0;
  if (uncertified_ == 0 || uncertified_ > kMostUncertified)
    caught_up_at_.store(report.cycle, std::memory_order_release);
}

void Successor::succeed(std::unique_ptr<Monitor>& monitor, SceneIds& ids) noexcept {
  std::swap(monitor_, monitor);
  ids.change(scene_.revision, map_);
  in_force_from_ = monitor->cycle() + 1;
  state_.store(State::kSucceeded, std::memory_order_release);
}

}  // namespace clearance
