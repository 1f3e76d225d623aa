// Passes commands on to the shares of a cell, one after another: all shares get each of them at the
// same time, and each change is made by all or, as far as a dry run can tell, by none.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/client/commands.hpp"
#include "monitor/client/shared_cell.hpp"
#include "monitor/dds/request_port.hpp"
#include "monitor/interface/mutex.hpp"

namespace clearance::merge {

class CommandRelay {
 public:
  // Takes the commands of the clients that the cell names. Without any, it does nothing. The
  // connection is that of the whole cell, and outlives this. Throws DdsError.
  CommandRelay(client::Connection& connection, const Cell& cell, std::uint64_t daemon);
  ~CommandRelay();
  CommandRelay(const CommandRelay&) = delete;
  CommandRelay& operator=(const CommandRelay&) = delete;

  // The revision in force and the last cycle, for the results.
  void note(const client::SharedCell& whole);

 private:
  struct ShareClient {
    std::string name;
    std::unique_ptr<client::Connection> connection;
    std::map<std::string, std::unique_ptr<client::Commands>> commands;  // by client
  };

  void run();
  [[nodiscard]] std::uint64_t in_force_from(std::uint64_t revision) const;
  [[nodiscard]] bool all_get(std::uint64_t revision) const;
  [[nodiscard]] CommandResult pass_on(const Command& command);
  [[nodiscard]] CommandResult send(ShareClient& share, const Command& command, bool dry_run);
  [[nodiscard]] std::vector<CommandResult> send_to_all(const Command& command, bool dry_run);

  client::Connection& connection_;
  std::vector<ShareClient> shares_;
  const bool follow_first_;  // the shares take over the scene of the first one
  std::atomic<std::uint64_t> revision_{0}, since_cycle_{0};
  std::atomic<std::uint64_t> whole_in_{0};  // the revision that all shares have; 0: not the same
  Mutex mutex_;
  std::condition_variable changed_;
  GUARDED_BY(mutex_) std::deque<GivenCommand> queue_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
  std::unique_ptr<CommandPort> port_;
};

}  // namespace clearance::merge
