// Commands over DDS: a thread of its own takes them, decides whom it answers at once, and passes
// the others on. Results go out as they come.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/dds/name_limit.hpp"
#include "monitor/participant/cdr_sample.hpp"
#include "monitor/participant/participant.hpp"
#include "monitor/scene_changes/command_ledger.hpp"
#include "monitor/scene_changes/command_queue.hpp"
#include "monitor/wire/cdr.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance {

class CommandPort {
 public:
  // Passes a command on, or returns false if too many wait.
  using Put = std::function<bool(QueuedCommand)>;

  // Takes the commands of the clients that the cell names. `daemon` is the id in the messages, and
  // `revision` returns that of the scene in force. The participant must outlive this. Throws
  // DdsError.
  CommandPort(const Cell& cell, Participant& participant, std::uint64_t daemon, Put put,
              std::function<std::uint64_t()> revision);
  ~CommandPort();
  CommandPort(const CommandPort&) = delete;
  CommandPort& operator=(const CommandPort&) = delete;

  // Starts the thread.
  void start();

 private:
  void run();
  void take_all();
  void take(const CdrSample& sample);
  void pass_on(Command command, const CommandLedger::Request& request);
  void answer_at_once(CommandResult result);
  void write(const CommandResult& result);
  void log_refusal(const CommandResult& result);

  const std::uint64_t daemon_;
  const Put put_;
  const std::function<std::uint64_t()> revision_;
  CommandLedger ledger_;
  NameLimit names_;
  std::set<std::string> strangers_;  // clients that are not named and were answered
  std::mutex mutex_;                 // guards what follows: results also come from other threads
  std::int64_t log_second_ = 0;
  std::uint64_t logged_ = 0, left_out_ = 0;  // refusals in that second
  dds_entity_t reader_, results_;
  DataWait wait_;
  std::vector<CdrSample> taken_;
  std::vector<std::uint64_t> ended_;
  CdrDecoder decoder_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace clearance
