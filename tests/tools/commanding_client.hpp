// A client that sends commands to a daemon and waits for their results, as idl/COMMANDS.md says.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "monitor/participant/command_message.hpp"
#include "tests/shared/loopback.hpp"
#include "tests/shared/take_next.hpp"

namespace clearance::test {

class CommandingClient {
 public:
  CommandingClient(Participant& participant, std::string name)
      : name_(std::move(name)),
        writer_(participant.writer(TopicKind::kCommands, Topics{}.commands)),
        reader_(participant.reader(TopicKind::kCommandResults, Topics{}.command_results)) {}
  ~CommandingClient() { leave(); }
  CommandingClient(const CommandingClient&) = delete;
  CommandingClient& operator=(const CommandingClient&) = delete;

  // Waits until the daemon hears this client and vice versa.
  void meet() {
    EXPECT_TRUE(eventually([&] { return matched_readers(writer_) > 0; }));
    EXPECT_TRUE(eventually([&] { return matched_writers(reader_) > 0; }));
  }
  void leave() {
    if (writer_ != 0) dds_delete(std::exchange(writer_, 0));
    if (reader_ != 0) dds_delete(std::exchange(reader_, 0));
  }

  // Sends it once.
  void send(const Command& command) {
    const auto message = to_wire(command);
    EXPECT_EQ(dds_write(writer_, &*message), DDS_RETCODE_OK);
  }
  [[nodiscard]] Command command(std::vector<CellChange> changes) {
    return {.client = name_, .request = ++request_, .changes = std::move(changes)};
  }
  // Sends it until its result comes. A daemon that is busy, or no longer leads, does nothing with a
  // command, and expects that it is sent again.
  CommandResult result_of(const Command& command) {
    for (int i = 0; i < 60; ++i) {
      send(command);
      const bool came =
          eventually([&] { return find(command.request) != nullptr; }, std::chrono::seconds(1));
      if (!came) continue;
      const CommandResult result = *find(command.request);
      if (result.status != CommandStatus::kBusy) return result;
      last_.erase(command.request);
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    ADD_FAILURE() << "no result of request " << command.request;
    return {.status = CommandStatus::kFailed};
  }
  CommandResult result_of(std::vector<CellChange> changes) {
    return result_of(command(std::move(changes)));
  }

  // The last result of this request, or null.
  const CommandResult* find(std::uint64_t request) {
    take();
    const auto found = last_.find(request);
    return found == last_.end() ? nullptr : &found->second;
  }
  // All results of this client, in order.
  const std::vector<CommandResult>& all() {
    take();
    return all_;
  }
  void forget() {
    take();
    last_.clear();
    all_.clear();
  }

 private:
  void take() {
    for (Sample<clearance_msg_CommandResult> message; take_next(reader_, message);) {
      const CommandResult result = from_wire(*message);
      if (result.client != name_) continue;
      last_[result.request] = result;
      all_.push_back(result);
    }
  }

  std::string name_;
  dds_entity_t writer_, reader_;
  std::uint64_t request_ = 0;
  std::map<std::uint64_t, CommandResult> last_;
  std::vector<CommandResult> all_;
};

}  // namespace clearance::test
