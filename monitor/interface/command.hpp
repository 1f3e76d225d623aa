// A command: changes of the scene that a client asks for, and the result that it gets.
//
// Commands arrive over DDS (idl/commands.idl), by SIGHUP, or from a program that calls the queue of
// monitor/requests. idl/COMMANDS.md explains them to clients.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "config/edit/cell_change.hpp"

namespace clearance {

// A file that changes name as "sent:NAME".
struct SentFile {
  std::string name;
  std::string bytes;
};

// The changes are made wholly or not at all.
struct Command {
  std::string client = {};
  std::uint64_t request = 0;         // from 1; counts up
  std::uint64_t scene_revision = 0;  // of the scene that the client knows; 0: not checked
  bool dry_run = false;              // answer only, change nothing
  std::vector<CellChange> changes = {};
  std::vector<SentFile> files = {};
};

// The values are on the wire: new ones are added at the end. A value that a client does not know is
// a refusal.
enum class CommandStatus : std::uint8_t {
  kDone = 0,             // in force; of a dry run: would be accepted
  kMalformed = 1,        // a field of the message has no valid value
  kNotNamed = 2,         // the daemon takes no commands from this client
  kTwoWriters = 3,       // several programs send under the name of this client
  kOutOfOrder = 4,       // a later request came first, and the result of this one is not known
  kOtherContent = 5,     // a request with this number and another content came first
  kOtherRevision = 6,    // another scene than the client knows is in force
  kBusy = 7,             // too many commands wait; this one may be sent again
  kRefused = 8,          // the changed cell is not valid: `path` names the field
  kNeedsRestart = 9,     // the daemon cannot change this while it runs
  kBeyondCapacity = 10,  // `capacity` of the cell, or the pair table
  kNoPose = 11,          // a present pose is unknown, late or contradicted
  kOverlap = 12,         // an attached object overlaps its carrier deeper than allowed
  kFileRefused = 13,     // a file cannot be read, or is in no folder that the cell states
  kTooSlow = 14,         // the loop ticked faster than the changed scene could be prepared
  kEnding = 15,          // the daemon ends
  kFailed = 16,          // the system refused something, as a full disk does
};
inline constexpr std::size_t kCommandStatuses = 17;

struct CommandResult {
  std::string client = {};
  std::uint64_t request = 0;
  CommandStatus status = CommandStatus::kDone;
  std::uint32_t change = 0;  // of a refusal: index of the change that is at fault
  // The offending field of a refusal: "objects[part].attached.to", or, in a malformed message,
  // "changes[0].attach.to". Empty: the list as a whole.
  std::string path = {};
  std::string reason = {};           // of a refusal: a sentence
  std::uint64_t scene_revision = 0;  // in force afterwards; of a dry run, the one that would be
  // The first cycle of that revision. 0: the daemon began with it, or it is that of a dry run.
  std::uint64_t in_force_from = 0;

  [[nodiscard]] bool done() const noexcept { return status == CommandStatus::kDone; }
};

// Returns the name of a status for people and logs: "out-of-order".
[[nodiscard]] constexpr std::string_view name_of(CommandStatus status) noexcept {
  constexpr std::string_view kNames[kCommandStatuses] = {
      "done",         "malformed",     "not-named",       "two-writers",
      "out-of-order", "other-content", "other-revision",  "busy",
      "refused",      "needs-restart", "beyond-capacity", "no-pose",
      "overlap",      "file-refused",  "too-slow",        "ending",
      "failed"};
  const auto value = static_cast<std::size_t>(status);
  return value < kCommandStatuses ? kNames[value] : "unknown";
}

}  // namespace clearance
