// Commands of a client: changes of the scene of a running daemon, and their results.
//
// idl/COMMANDS.md explains what can be changed, and what each status means.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "monitor/client/requests.hpp"

namespace clearance::client {

struct CommandOptions {
  std::uint64_t scene_revision = 0;  // of the scene that the client knows; 0: not checked
  bool dry_run = false;              // answer only, change nothing
  std::vector<SentFile> files = {};  // that changes name as "sent:NAME"
  // Asked about every 50 ms while send() waits: true ends the wait as if its time were over.
  std::function<bool()> stop = {};
};

// Sends commands under the name of one client, which the daemon's cell names under `commands`, and
// which no other running program uses.
class Commands : public CommandRequests {
 public:
  // Throws std::invalid_argument when the name has no bytes or more than 32.
  Commands(Connection& connection, std::string_view client);

  // Sends changes that are made wholly or not at all, and waits for their result. The same request
  // is sent again every second until the result comes. Returns nothing when none came in time: the
  // changes may be made or not, and result() may tell later. While a former run of this program,
  // which was killed, counts as a second one, it is sent again, too (COMMANDS.md: up to 3 s).
  [[nodiscard]] std::optional<CommandResult> send(
      const std::vector<CellChange>& changes, const CommandOptions& options = {},
      std::chrono::nanoseconds timeout = std::chrono::seconds(10));

  // Sends changes without waiting, and returns the number of the request. Nothing repeats it.
  // Returns 0 when DDS did not take the message.
  std::uint64_t post(const std::vector<CellChange>& changes, const CommandOptions& options = {});
};

}  // namespace clearance::client
