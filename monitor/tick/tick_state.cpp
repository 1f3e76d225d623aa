#include "monitor/tick/tick_state.hpp"

#include <utility>

#include "monitor/interface/invariant.hpp"

namespace clearance {

TickState::TickState(const Scene& scene, const TickStateOptions& options)
    : scene_(&scene),
      monitor_(std::make_unique<Monitor>(scene)),
      ids_(scene, options.followed),
      frames_(options.frames),
      pace_(options.pace) {
  samples_.reserve(options.room);
  joints_.reserve(options.room);
}

const Report& TickState::tick(const TickTime& time) noexcept {
  if (frames_ != nullptr) {
    if (pace_ == nullptr) frames_->choose_all(scene_->revision);
    frames_->show(scene_->revision, *monitor_);
  }
  const Report& report = monitor_->tick(samples_, joints_, time);
  if (next_ != nullptr && next_->state() == Successor::State::kCatchingUp)
    next_->record(samples_, joints_, time, report.minimum_certified);
  if (pace_ != nullptr) pace_->ticked(*monitor_);
  return report;
}

void TickState::clear() noexcept {
  samples_.clear();
  joints_.clear();
  if (frames_ != nullptr) frames_->forget_shown();
}

// The pace knows of it first: another thread reads the pace's lineage as soon as it has begun.
bool TickState::begin(Successor& next) noexcept {
  CLEARANCE_INVARIANT(next_ == nullptr);
  if (pace_ != nullptr) pace_->successor_begins(next.scene().revision == scene_->revision);
  next_ = &next;
  next.begin(*monitor_, ids_.sources());
  return !next.failed();
}

void TickState::succeed() noexcept {
  CLEARANCE_INVARIANT(next_ != nullptr && next_->monitor_->cycle() == cycle());
  scene_ = &next_->scene();
  std::exchange(next_, nullptr)->succeed(monitor_, ids_);
  if (pace_ != nullptr) pace_->successor_followed();
}

void TickState::give_up() noexcept {
  next_ = nullptr;
  if (pace_ != nullptr) pace_->successor_gave_up();
}

// A successor that catches up has taken over from the monitor that would go.
bool TickState::may_join(const JoinedState& joined) const noexcept {
  return next_ == nullptr && joined.revision() == ids_.revision() &&
         (pace_ == nullptr || pace_->may_join()) &&
         (frames_ == nullptr || frames_->has_awaited(*joined.monitor_));
}

void TickState::join(JoinedState& joined) noexcept {
  CLEARANCE_INVARIANT(next_ == nullptr && joined.revision() == ids_.revision());
  std::swap(joined.monitor_, monitor_);
  std::swap(joined.ids_, ids_);
  joined.has_joined_ = true;
  if (frames_ != nullptr) frames_->show_awaited(*monitor_);
  if (pace_ != nullptr) pace_->joined(joined.lineage(), cycle());
}

bool TickState::uses(const SeenCloud* cloud) const noexcept {
  return monitor_->uses(cloud) || (next_ != nullptr && next_->monitor_->uses(cloud)) ||
         (frames_ != nullptr && frames_->is_used(cloud));
}

}  // namespace clearance
