#include "monitor/daemon/scene_turns.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace clearance {

std::span<const DoneSceneChange> changes_until(std::span<const DoneSceneChange> changes,
                                               std::uint64_t revision) {
  const auto last = std::ranges::find(changes.rbegin(), changes.rend(), revision,
                                      &DoneSceneChange::scene_revision);
  return {changes.begin(), last.base()};
}

bool has_message(std::span<const DoneSceneChange> changes, std::uint64_t message) {
  return std::ranges::find(changes, message, &DoneSceneChange::message) != changes.end();
}

SceneTurns::Turn* SceneTurns::find(std::uint64_t identity) noexcept {
  const auto turn = std::ranges::find_if(
      turns_, [identity](const Turn& each) { return each.identity == identity && !each.is_done; });
  return turn == turns_.end() ? nullptr : &*turn;
}

std::size_t SceneTurns::add(Message message, std::uint64_t identity) {
  bytes_ += message->cdr.size();
  turns_.push_back({std::move(message), identity});
  std::size_t gone = 0;
  while (turns_.size() > 1 && (turns_.size() > kMost || bytes_ > kMostBytes)) {
    gone += static_cast<std::size_t>(!turns_.front().is_done);
    drop_first();
  }
  return gone;
}

SceneTurns::Message SceneTurns::to_queue(std::uint64_t& identity) {
  const auto turn = std::ranges::find(turns_, false, &Turn::is_queued);
  if (turn == turns_.end()) return nullptr;
  turn->is_queued = true;
  identity = turn->identity;
  return turn->message;
}

bool SceneTurns::begins(std::uint64_t identity) {
  const auto first = std::ranges::find(turns_, false, &Turn::is_done);
  if (first != turns_.end() && first->identity == identity) return true;
  put_back(identity);
  return false;
}

void SceneTurns::put_back(std::uint64_t identity) {
  if (Turn* const turn = find(identity)) turn->is_queued = false;
}

std::vector<SceneTurns::Message> SceneTurns::to_keep() {
  std::vector<Message> messages;
  for (Turn& turn : turns_) {
    if (!std::exchange(turn.is_kept, true)) messages.push_back(turn.message);
  }
  return messages;
}

bool SceneTurns::has_to_keep() const noexcept {
  return std::ranges::find(turns_, false, &Turn::is_kept) != turns_.end();
}

void SceneTurns::end(std::uint64_t identity, bool may_be_wanted) {
  Turn* const turn = find(identity);
  if (turn == nullptr) return;
  turn->is_done = true;
  if (!may_be_wanted) forget_done();
}

void SceneTurns::drop_first() {
  bytes_ -= turns_.front().message->cdr.size();
  turns_.pop_front();
}

template <class Of>
void SceneTurns::erase_if(const Of& of) {
  std::erase_if(turns_, [&](const Turn& turn) {
    const bool is = of(turn);
    if (is) bytes_ -= turn.message->cdr.size();
    return is;
  });
}

void SceneTurns::go_on_from(std::span<const DoneSceneChange> changes) {
  erase_if([&](const Turn& turn) { return turn.is_done && has_message(changes, turn.identity); });
  for (Turn& turn : turns_) {
    if (std::exchange(turn.is_done, false)) turn.is_queued = false;
  }
}

void SceneTurns::forget_done() {
  erase_if([](const Turn& turn) { return turn.is_done; });
}

std::size_t SceneTurns::waiting() const noexcept {
  return static_cast<std::size_t>(std::ranges::count(turns_, false, &Turn::is_done));
}

// Messages of two senders may come in another order here. One that came before a message that is
// done is either done soon or was not heard there.
void SceneTurns::drop_done(std::span<const DoneSceneChange> changes, std::uint64_t revision) {
  const auto done = changes_until(changes, revision);
  const auto is_done = [&](const Turn& turn) { return has_message(done, turn.identity); };
  while (std::ranges::any_of(turns_, is_done)) drop_first();
}

}  // namespace clearance
