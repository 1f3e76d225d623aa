#include "monitor/scene_changes/command_queue.hpp"

#include <utility>
#include <variant>

namespace clearance {

std::size_t bytes_of(const Command& command) {
  constexpr std::size_t kOfAChange = sizeof(CellChange);
  std::size_t bytes = command.changes.size() * kOfAChange;
  for (const SentFile& file : command.files) bytes += file.bytes.size();
  for (const CellChange& change : command.changes) {
    if (const auto* added = std::get_if<AddObject>(&change)) bytes += added->yaml.size();
    if (const auto* whole = std::get_if<ReplaceCell>(&change)) bytes += whole->yaml.size();
  }
  return bytes;
}

bool CommandQueue::put(QueuedCommand command) {
  const std::size_t bytes = bytes_of(command.command) + command.bytes_to_make;
  {
    const std::lock_guard lock(mutex_);
    const bool is_full =
        !waiting_.empty() && (waiting_.size() >= kMost || bytes_ + bytes > kMostBytes);
    if (closed_ || is_full) return false;
    bytes_ += bytes;
    waiting_.push_back(std::move(command));
  }
  changed_.notify_one();
  return true;
}

std::optional<QueuedCommand> CommandQueue::next() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return closed_ || !waiting_.empty(); });
  if (closed_) return std::nullopt;
  QueuedCommand command = std::move(waiting_.front());
  waiting_.pop_front();
  bytes_ -= bytes_of(command.command) + command.bytes_to_make;
  return command;
}

void CommandQueue::close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    waiting_.clear();
    bytes_ = 0;
  }
  changed_.notify_all();
}

}  // namespace clearance
