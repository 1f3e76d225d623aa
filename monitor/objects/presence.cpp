#include "monitor/objects/presence.hpp"

namespace clearance {

// Sums of displacement go on where they are, because pairs and wheels hold readings of them.
void make_absent(TrackedObject& state) noexcept {
  TrackedObject fresh;
  fresh.absent = true;
  fresh.landmarks = state.landmarks;
  fresh.reach = state.reach;
  fresh.accumulated = fresh.accumulated_last_tick = state.accumulated;
  fresh.accumulated_turn = state.accumulated_turn;
  fresh.input.rejected = state.input.rejected;
  fresh.input.owner = state.input.owner;
  state = fresh;
}

}  // namespace clearance
