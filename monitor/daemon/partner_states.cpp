#include "monitor/daemon/partner_states.hpp"

#include <chrono>
#include <cstddef>
#include <span>
#include <thread>
#include <utility>
#include <vector>

#include "monitor/app/log_lines.hpp"

namespace clearance {
namespace {

constexpr std::chrono::microseconds kLook{100};

}  // namespace

// A state is used at once: the partner's ticks since then must still be known. Its bytes are copied
// for the scene thread.
PartnerPort::Actions PartnerStates::actions() {
  return {
      .wants_state = [this] { put([this] { prepare(); }); },
      .send_state = [this] { put([this] { send(); }); },
      .take_state =
          [this](const PartnerStateView& state) {
            put([this, own = state,
                 bytes = std::vector<std::byte>(state.bytes.begin(), state.bytes.end())]() mutable {
              own.bytes = bytes;
              join(own);
            });
          }};
}

// A full queue drops it; the port asks again.
void PartnerStates::put(std::function<void()> task) {
  QueuedCommand queued;
  queued.is_own = true;
  queued.task = std::move(task);
  static_cast<void>(thread_.put(std::move(queued)));
}

// The monitor of a large cell takes long to make: it is made before the state is asked for.
void PartnerStates::prepare() {
  if (!ticks_.wants_state()) return;
  const std::shared_ptr<const Cell> cell = changer_.shared_cell();
  if (prepared_ == nullptr || prepared_->cell != cell) prepared_ = std::make_unique<Prepared>(cell);
  port_.request_state(cell->scene.revision);
}

void PartnerStates::send() {
  if (ticks_.standing() != PartnerStanding::kLeading) return;
  const auto outcome = changer_.renew(loop_ended_, [this](const Successor& successor) {
    std::vector<std::byte> bytes;
    save_state(successor.numbers(), loop_.ids(), successor.monitor(), bytes);
    port_.send_state({.revision = successor.scene().revision,
                      .lineage = ticks_.becoming(),
                      .cycle = successor.began_after(),
                      .bytes = bytes});
  });
  if (!outcome.refusal.empty()) log_line(lines::kPartnerStateRefused, outcome.refusal);
}

// The cell may have changed since prepare(). The loop must not tick the scene of another cell, also
// if that one has the same revision: no other part keeps the former cell.
void PartnerStates::join(const PartnerStateView& state) {
  const std::unique_ptr<Prepared> prepared = std::move(prepared_);
  if (prepared == nullptr || !ticks_.wants_state()) return;
  if (prepared->cell != changer_.shared_cell()) {
    log_line(lines::kPartnerStateRefused, "the cell has changed since it was asked for");
    return;
  }
  JoinedState& joined = prepared->state;
  if (state.revision != joined.revision()) {
    log_line(lines::kPartnerStateRefused, "it is of another scene");
    return;
  }
  if (!joined.restore(state.bytes, state.lineage)) {
    log_line(lines::kPartnerStateRefused, "its bytes do not fit the scene");
    return;
  }
  if (!loop_.offer(joined)) return;
  while (!loop_.has_joined() && !loop_ended_) std::this_thread::sleep_for(kLook);
}

}  // namespace clearance
