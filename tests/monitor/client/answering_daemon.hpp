// A daemon that a test plays: it answers the commands of clients over real DDS.
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "config/cell/topics.hpp"
#include "monitor/participant/command_message.hpp"
#include "monitor/participant/participant.hpp"
#include "monitor/wire/dds_sample.hpp"
#include "tests/shared/sealed.hpp"

namespace clearance::test {

// Answers in a thread of its own, from its construction on.
class AnsweringDaemon {
 public:
  using Answer = std::function<std::vector<CommandResult>(const Command&)>;
  AnsweringDaemon(const DdsOptions& dds, Answer answer, const Topics& topics = {})
      : participant_(dds),
        commands_(participant_.reader(TopicKind::kCommands, topics.commands)),
        results_(participant_.writer(TopicKind::kCommandResults, topics.command_results)),
        answer_(std::move(answer)),
        thread_([this] { run(); }) {}
  ~AnsweringDaemon() {
    ends_ = true;
    thread_.join();
  }

 private:
  void run() {
    Sample<clearance_msg_Command> message;
    void* pointer = &*message;
    dds_sample_info_t info;
    while (!ends_) {
      if (dds_take(commands_, &pointer, &info, 1, 1) < 1 || !info.valid_data) {
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        continue;
      }
      const auto command = from_wire(*message);
      ASSERT_TRUE(std::holds_alternative<Command>(command));
      for (const CommandResult& result : answer_(std::get<Command>(command))) {
        auto answer = to_wire(result, 7);
        write_sealed(participant_, results_, *answer);
      }
    }
  }

  Participant participant_;
  dds_entity_t commands_, results_;
  Answer answer_;
  std::atomic<bool> ends_{false};
  std::thread thread_;
};

}  // namespace clearance::test
