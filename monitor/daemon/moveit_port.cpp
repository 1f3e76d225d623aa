// A message is translated in the scene thread when its turn comes: it then finds the cell in force.
#include "monitor/daemon/moveit_port.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "monitor/app/log_line.hpp"
#include "monitor/loop/ports.hpp"

namespace clearance {

void MoveItPort::take(moveit::RawScene message) {
  const Lock lock(mutex_);
  if (!put_) return;
  const auto shared = std::make_shared<const moveit::RawScene>(std::move(message));
  if (!sharing_) {
    if (!put_(command(shared, 0)))
      log_refusal(shared->topic, "", "too many commands wait, so that it is lost");
    return;
  }
  if (const std::size_t lost = turns_.add(shared, shared->identity()); lost > 0)
    log_refusal(shared->topic, "",
                fmt::format("too many messages wait, so that the first {} of them are lost", lost));
  if (leads()) {
    put_waiting();
  } else {
    keep_files();
  }
}

void MoveItPort::log_refusal(const std::string& topic, const std::string& path,
                             const std::string& reason) {
  if (refusal_lines_.admits(SystemClock().monotonic_ns()))
    log_line(lines::kMoveItRefused, topic, path, reason);
}

void MoveItPort::close() {
  const Lock lock(mutex_);
  put_ = nullptr;
}

// `identity`: 0 if the messages are not shared.
MadeCommand MoveItPort::command(const SceneTurns::Message& message, std::uint64_t identity) {
  MadeCommand queued;
  queued.sender = "moveit";
  queued.put_off = [this] {
    keeper_.take_back();
    current_ = 0;
  };
  queued.bytes = message->cdr.size();
  queued.make = [this, message, identity](const Cell& cell, const AskPose& pose) {
    if (identity != 0 && !begins(identity, cell.scene.revision)) return Command{};
    Command made = translated(*message, cell, pose);
    if (identity != 0 && made.changes.empty()) ended(identity, cell.scene.revision);
    return made;
  };
  queued.complete = [this](const Scene& changed) { return keeper_.complete(changed); };
  queued.answer = [this, message, identity](const CommandResult& result) {
    if (!result.done()) {
      keeper_.take_back();
      log_refusal(message->topic, result.path.empty() ? "" : result.path + ": ", result.reason);
    }
    if (identity != 0) ended(identity, sharing_->revision());
  };
  return queued;
}

Command MoveItPort::translated(const moveit::RawScene& message, const Cell& cell,
                               const AskPose& pose) {
  moveit::SceneKeeper::Work work = keeper_.take(message, cell, pose);
  for (const std::string& sentence : work.news) {
    if (left_out_lines_.admits(SystemClock().monotonic_ns()))
      log_line(lines::kMoveItLeftOut, sentence);
  }
  Command command;
  command.changes = std::move(work.changes);
  for (moveit::MeshFile& file : work.files)
    command.files.push_back({std::move(file.name), std::move(file.bytes)});
  return command;
}

void MoveItPort::coming(std::uint64_t revision, std::uint64_t command) {
  if (sharing_) note(command != 0 ? command : current_, revision);
}

// The partner may have been told of a command that is then refused: that entry is removed.
void MoveItPort::ended(std::uint64_t command, const CommandResult& result) {
  if (!sharing_) return;
  if (result.done()) return note(command, sharing_->revision());
  const auto is_told = [&](const DoneSceneChange& change) { return change.message == command; };
  if (std::erase_if(changes_, is_told) > 0) note(0, sharing_->revision());
}

bool MoveItPort::is_done(std::uint64_t command) {
  if (!sharing_) return false;
  const std::uint64_t revision = sharing_->revision();
  go_on_from_heard(revision);
  return has_message(changes_until(changes_, revision), command);
}

// Other changes that were done here are not in that cell. The cell may have another revision here,
// with other options.
void MoveItPort::took_over(std::uint64_t revision) {
  if (!sharing_) return;
  {
    const Lock lock(mutex_);
    const auto done = changes_until(heard_.changes, revision);
    changes_.assign(done.begin(), done.end());
    turns_.go_on_from(changes_);
  }
  add({0, sharing_->revision()});
}

void MoveItPort::hear(const clearance_msg_PartnerScene& scene) {
  const std::span changes(scene.changes._buffer, scene.changes._length);
  const auto bytes = std::as_bytes(std::span(scene.bytes._buffer, scene.bytes._length));
  const Lock lock(mutex_);
  heard_ = {{changes.begin(), changes.end()}, {bytes.begin(), bytes.end()}, true};
}

void MoveItPort::update_lead() {
  const Lock lock(mutex_);
  if (!sharing_ || !put_) return;
  const bool led = std::exchange(leads_, leads());
  if (!leads_) {
    turns_.drop_done(heard_.changes, sharing_->revision());
    return keep_files();
  }
  if (!led) {
    leads_ = put_(OtherWork{[this] {
      go_on_from_heard(sharing_->revision());
      note(0, sharing_->revision());
    }});
  }
  if (sharing_->both_have && sharing_->both_have()) turns_.forget_done();
  put_waiting();
}

void MoveItPort::put_waiting() {
  std::uint64_t identity = 0;
  while (const SceneTurns::Message message = turns_.to_queue(identity)) {
    if (put_(command(message, identity))) continue;
    return turns_.put_back(identity);
  }
}

// The leader names them in the changed cell. A daemon that never leads needs no more of a message.
void MoveItPort::keep_files() {
  if (keeps_ || !turns_.has_to_keep()) return;
  KeptFiles kept;
  kept.make = [this](const Cell& cell) {
    std::vector<SentFile> files;
    std::vector<SceneTurns::Message> messages;
    {
      const Lock lock(mutex_);
      messages = turns_.to_keep();
      if (!sharing_->leads) turns_ = {};
      keeps_ = false;
    }
    for (const SceneTurns::Message& message : messages) {
      for (moveit::MeshFile& file : keeper_.files_of(*message, cell))
        files.push_back({std::move(file.name), std::move(file.bytes)});
    }
    return files;
  };
  kept.answer = [](const CommandResult& result) {
    if (!result.done()) log_line(lines::kPartnerFileNotKept, result.reason);
  };
  keeps_ = put_(std::move(kept));
}

// By its turn the partner may lead, or have done the message before it fell silent.
bool MoveItPort::begins(std::uint64_t identity, std::uint64_t revision) {
  {
    const Lock lock(mutex_);
    turns_.drop_done(heard_.changes, revision);
    const bool does_it = leads();
    if (!does_it) turns_.put_back(identity);
    if (!does_it || !turns_.begins(identity)) return false;
  }
  go_on_from_heard(revision);
  current_ = identity;
  return true;
}

// The leader before told of its last change before that was in force. It counts only if it is in
// force here. If that leader never had the scene in force here, only this daemon knows what led to
// it, even if an earlier scene was the same.
void MoveItPort::go_on_from_heard(std::uint64_t revision) {
  const Lock lock(mutex_);
  if (!std::exchange(heard_.is_new, false)) return;
  if (!keeper_.restore(heard_.bytes))
    log_line(lines::kPartnerStateRefused, "what it kept of MoveIt does not fit");
  const auto done = changes_until(heard_.changes, revision);
  const auto own = changes_until(changes_, revision);
  const auto last = std::ranges::find_if(own.rbegin(), own.rend(),
                                         [](const auto& change) { return change.message != 0; });
  const bool goes_on = last == own.rend() ? !done.empty() : has_message(done, last->message);
  if (goes_on) changes_.assign(done.begin(), done.end());
}

void MoveItPort::ended(std::uint64_t identity, std::uint64_t revision) {
  current_ = 0;
  {
    const Lock lock(mutex_);
    turns_.end(identity, sharing_->both_have != nullptr);
  }
  note(identity, revision);
}

void MoveItPort::add(const DoneSceneChange& change) {
  const bool is_known = !changes_.empty() && changes_.back().message == change.message &&
                        changes_.back().scene_revision == change.scene_revision;
  if (!is_known) changes_.push_back(change);
  if (changes_.size() > kMostChanges) changes_.erase(changes_.begin());
}

void MoveItPort::note(std::uint64_t identity, std::uint64_t revision) {
  add({identity, revision});
  if (!sharing_->tell) return;
  std::vector<std::byte> bytes;
  keeper_.save(bytes);
  sharing_->tell(changes_, bytes);
}

}  // namespace clearance
