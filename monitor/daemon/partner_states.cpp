#include "monitor/daemon/partner_states.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstddef>
#include <exception>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "monitor/app/log_line.hpp"

namespace clearance {
namespace {

constexpr std::chrono::microseconds kPoll{100};
// A leader that was held up for a moment knows after this time whether it still leads.
constexpr std::chrono::milliseconds kLeadsAgain{100};
// The partner takes some ms for a changed cell, and longer while it is busy.
constexpr std::chrono::seconds kPatience{2};

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
          },
      .revision = revision_,
      .take_cell = [this](std::string text,
                          std::uint64_t revision) { take_cell(std::move(text), revision); }};
}

// A full queue drops it; the port asks again.
void PartnerStates::put(std::function<void()> task) {
  static_cast<void>(thread_.put(OtherWork{[task = std::move(task)] {
    try {
      task();
    } catch (const std::exception& error) {
      log_line(lines::kPartnerStateRefused, error.what());
    }
  }}));
}

// The monitor of a large cell takes long to make: it is made before the state is asked for.
void PartnerStates::prepare() {
  if (!ticks_.wants_state()) return;
  const std::shared_ptr<const Cell> cell = changer_.shared_cell();
  if (prepared_ == nullptr || prepared_->cell != cell)
    prepared_ = std::make_unique<Prepared>(cell, loop_.state().monitor());
  port_.request_state(cell->scene.revision);
}

void PartnerStates::send() {
  if (ticks_.standing() != PartnerStanding::kLeading) return;
  // The loop holds the successor meanwhile, so that nothing may leave this early.
  const auto outcome = changer_.renew(loop_ended_, [this](const Successor& successor) noexcept {
    try {
      const std::uint64_t lineage = ticks_.becoming();
      if (lineage == 0) return;  // it was given up: the partner asks again
      std::vector<std::byte> bytes;
      successor.save(loop_.state().ids(), bytes);
      port_.send_state({.revision = successor.scene().revision,
                        .lineage = lineage,
                        .cycle = successor.began_after(),
                        .bytes = bytes});
    } catch (const std::exception& error) {
      log_line(lines::kPartnerStateRefused, error.what());
    }
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
  if (recording_ != nullptr) recording_->note_state(state);
  if (!loop_.offer(joined)) return;
  while (!loop_.has_joined() && !loop_ended_) std::this_thread::sleep_for(kPoll);
}

// By its turn this daemon may lead, or have the cell.
void PartnerStates::take_cell(std::string text, std::uint64_t revision) {
  MadeCommand made{.sender = "partner"};
  made.bytes = text.size();
  made.make = [this, revision, text = std::move(text)](const Cell& cell, const AskPose&) {
    const bool has_it = cell.scene.revision == revision;
    if (has_it || ticks_.standing() == PartnerStanding::kLeading) return Command{};
    return Command{.changes = {ReplaceCell{text}}};
  };
  made.answer = [this, revision](const CommandResult& result) {
    if (result.done()) scenes_.took_over(revision);
    const bool is_taken = result.done() && result.scene_revision == revision;
    if (is_taken || std::exchange(refused_, revision) == revision) return;
    log_line(lines::kPartnerStateRefused,
             fmt::format("its cell of revision {:016x} is refused here: {}", revision,
                         result.done() ? "files or options differ" : result.reason));
  };
  static_cast<void>(put_command_(std::move(made)));
}

// Two daemons may both lead the ticks for a moment, but must not both take a command. A daemon that
// still has the former cell must not answer a question.
bool PartnerStates::takes_requests() const {
  const auto end = std::chrono::steady_clock::now() + kLeadsAgain;
  while (ticks_.standing() == PartnerStanding::kLeading && !loop_ended_) {
    if (port_.leads()) return true;
    if (std::chrono::steady_clock::now() > end) break;
    std::this_thread::sleep_for(kPoll);
  }
  return false;
}

// The client sends a command again until it has the result.
void PartnerStates::keep_files(Command command) {
  if (command.dry_run || command.files.empty()) return;
  KeptFiles kept;
  for (const SentFile& file : command.files) kept.bytes += file.bytes.size();
  kept.make = [files = std::move(command.files)](const Cell&) { return files; };
  kept.answer = [](const CommandResult& result) {
    if (!result.done()) log_line(lines::kPartnerFileNotKept, result.reason);
  };
  static_cast<void>(thread_.put(std::move(kept)));
}

GivenCommand PartnerStates::for_both(GivenCommand given) {
  given.turn = [this, identity = given.identity] {
    if (ticks_.standing() != PartnerStanding::kLeading) return CommandTurn::kOfPartner;
    return scenes_.is_done(identity) ? CommandTurn::kDone : CommandTurn::kDo;
  };
  given.answer = [this, identity = given.identity, is_dry = given.command.dry_run,
                  answer = std::move(given.answer)](const CommandResult& result) {
    if (!is_dry && result.status != CommandStatus::kBusy) scenes_.ended(identity, result);
    answer(of_both(result, is_dry));
  };
  return given;
}

// If the partner has taken the lead meanwhile, its cell is that of both: the change is lost, and a
// refusal may be one of what the partner has done already. A daemon that was held up may not have
// heard of that: it must hold the lease of the leader before a result counts that it alone has.
// Busy: the client sends the command again.
CommandResult PartnerStates::of_both(CommandResult result, bool is_dry) {
  const bool is_to_agree = result.done() && !is_dry;
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (!loop_ended_ && result.status != CommandStatus::kBusy) {
    const bool hears = is_to_agree && port_.hears_partner();
    if (hears && port_.partner_revision() == result.scene_revision) break;
    if (!hears && port_.leads()) break;
    const bool is_late = std::chrono::steady_clock::now() > end;
    if (ticks_.standing() != PartnerStanding::kLeading || (is_late && !hears)) {
      result.status = CommandStatus::kBusy;
      result.reason = fmt::format(
          "found that '{}' has taken the lead meanwhile, with its cell; expected that the same "
          "command is sent again",
          port_.partner());
      break;
    }
    if (is_late) {
      result.reason = fmt::format("the partner '{}' has another cell in force: its log says why",
                                  port_.partner());
      break;
    }
    std::this_thread::sleep_for(kPoll);
  }
  return result;
}

}  // namespace clearance
