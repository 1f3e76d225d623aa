#include "monitor/daemon/scene_turns.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace clearance {

SceneTurns::Turn* SceneTurns::find(std::uint64_t identity) noexcept {
  const auto turn = std::ranges::find(turns_, identity, &Turn::identity);
  return turn == turns_.end() ? nullptr : &*turn;
}

std::size_t SceneTurns::add(Message message, std::uint64_t identity) {
  bytes_ += message->cdr.size();
  turns_.push_back({std::move(message), identity});
  std::size_t gone = 0;
  for (; turns_.size() > 1 && (turns_.size() > kMost || bytes_ > kMostBytes); ++gone)
    end(turns_.front().identity);
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
  if (!turns_.empty() && turns_.front().identity == identity) return true;
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

void SceneTurns::end(std::uint64_t identity) {
  const auto turn = std::ranges::find(turns_, identity, &Turn::identity);
  if (turn == turns_.end()) return;
  bytes_ -= turn->message->cdr.size();
  turns_.erase(turn);
}

// Messages of two senders may come in another order here. One that came before a message that is
// done is either done soon or was not heard there.
void SceneTurns::drop_done(std::span<const DoneSceneChange> changes, std::uint64_t revision) {
  const auto last = std::ranges::find(changes.rbegin(), changes.rend(), revision,
                                      &DoneSceneChange::scene_revision);
  if (last == changes.rend()) return;
  const auto is_done = [&](const Turn& turn) {
    return std::ranges::find(changes.begin(), last.base(), turn.identity,
                             &DoneSceneChange::message) != last.base();
  };
  while (std::ranges::any_of(turns_, is_done)) end(turns_.front().identity);
}

}  // namespace clearance
