#include "monitor/requests/scene_changer.hpp"

#include <chrono>
#include <thread>
#include <utility>

namespace clearance {
namespace {

// A successor that was too slow is tried again, since a machine may have been busy.
constexpr int kAttempts = 3;
// The preparing thread asks for new ticks so often.
constexpr std::chrono::microseconds kPoll{50};

SceneChanger::Outcome refused(CommandStatus status, std::string why) {
  return {.status = status, .refusal = std::move(why), .in_force_from = 0};
}

}  // namespace

SceneChanger::Outcome SceneChanger::check(const Cell& cell) const {
  if (auto reason = restart_needed(*cell_, cell))
    return refused(CommandStatus::kNeedsRestart, *std::move(reason));
  if (auto reason = beyond_capacity(cell, capacity_))
    return refused(CommandStatus::kBeyondCapacity, *std::move(reason));
  return {};
}

SceneChanger::Outcome SceneChanger::change(std::shared_ptr<const Cell> cell,
                                           const std::atomic<bool>& loop_ended) {
  if (Outcome checked = check(*cell); !checked.refusal.empty()) return checked;
  return replace(std::move(cell), loop_ended, {});
}

SceneChanger::Outcome SceneChanger::renew(const std::atomic<bool>& loop_ended, const Began& began) {
  return replace(cell_, loop_ended, began);
}

SceneChanger::Outcome SceneChanger::replace(std::shared_ptr<const Cell> cell,
                                            const std::atomic<bool>& loop_ended,
                                            const Began& began) {
  const std::vector<ReportSink*> sinks = parts_.prepare(cell);
  try {
    return succeed(std::move(cell), sinks, loop_ended, began);
  } catch (...) {
    parts_.abandon();
    throw;
  }
}

SceneChanger::Outcome SceneChanger::succeed(std::shared_ptr<const Cell> cell,
                                            const std::vector<ReportSink*>& sinks,
                                            const std::atomic<bool>& loop_ended,
                                            const Began& began) {
  Successor::State state = Successor::State::kTooSlow;
  for (int i = 0; i < kAttempts && state == Successor::State::kTooSlow; ++i) {
    // The offer holds what the loop no longer ticks, and is deleted here.
    SceneOffer successor(loop_.state(), cell->scene, sinks, records_);
    state = run(successor, loop_ended, began);
    if (state != Successor::State::kSucceeded) continue;
    std::swap(cell_, cell);
    parts_.end(successor.statistics());
    parts_.follow(successor.in_force());
    return {.in_force_from = successor.in_force_from()};
  }
  parts_.abandon();
  if (state == Successor::State::kTooManyNames)
    return refused(CommandStatus::kBeyondCapacity,
                   "both cells together name more sources than the daemon has places for");
  if (state == Successor::State::kTooSlow)
    return refused(CommandStatus::kTooSlow,
                   "its pairs could not be evaluated as fast as the loop ticks");
  return refused(CommandStatus::kEnding, "the loop has ended");
}

// Waits until the loop has let go of the successor, too.
Successor::State SceneChanger::run(SceneOffer& successor, const std::atomic<bool>& loop_ended,
                                   const Began& began) {
  if (!loop_.offer(successor)) return Successor::State::kTooSlow;
  bool is_new = static_cast<bool>(began);
  while (loop_.busy() && !loop_ended) {
    if (is_new && successor.state() == Successor::State::kCatchingUp) {
      is_new = false;
      began(successor);
    }
    if (is_new || successor.catch_up() == 0) std::this_thread::sleep_for(kPoll);
  }
  return successor.state();
}

}  // namespace clearance
