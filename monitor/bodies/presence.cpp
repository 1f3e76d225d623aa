#include "monitor/bodies/presence.hpp"

namespace clearance {

// The accumulated displacement continues, because pairs and motion wheels have stored values of it.
void make_absent(TrackedObject& state) noexcept {
  TrackedObject fresh;
  fresh.absent = true;
  fresh.landmarks = state.landmarks;
  fresh.bounding_radius = state.bounding_radius;
  fresh.accumulated = fresh.accumulated_last_tick = state.accumulated;
  fresh.accumulated_turn = state.accumulated_turn;
  fresh.input.rejected = state.input.rejected;
  fresh.input.owner = state.input.owner;
  state = fresh;
}

}  // namespace clearance
