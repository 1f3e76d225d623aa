// Serves the clients that the cell names: accepts their commands, and answers questions about
// motions, also those on topics of trajectories.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>

#include "config/cell/cell.hpp"
#include "monitor/daemon/trajectory_port.hpp"
#include "monitor/dds/request_port.hpp"
#include "monitor/loop/tick_loop.hpp"
#include "monitor/participant/participant.hpp"
#include "monitor/publish/ros_writes.hpp"
#include "monitor/requests/question_desk.hpp"

namespace clearance {

class ClientPorts {
 public:
  struct Actions {
    CommandPort::Put put;                     // passes a command on
    std::function<std::uint64_t()> revision;  // of the scene in force
    QuestionDesk::Frames frames;
    // The partner's part in each; empty: there is none.
    CommandPort::Sharing commands;
    QuestionPort::Sharing questions;
    RosWrites::Leads leads;
  };
  // `daemon` is the id in the messages. Everything given outlives this. Throws DdsError.
  ClientPorts(std::shared_ptr<const Cell> cell, Participant& participant, std::uint64_t daemon,
              TickLoop& loop, const std::atomic<bool>& loop_ended, const Actions& actions);

  void start();
  // The thread that changes the scene: the loop ticks this cell from now on.
  void follow(const std::shared_ptr<const Cell>& cell);
  // Once `loop_ended` is set. The threads that answer do so through their port, so that it ends
  // last: commands are to be ended after the scene thread.
  void end_questions();
  void end_commands() { commands_.reset(); }

 private:
  std::unique_ptr<CommandPort> commands_;  // null: the cell names no client
  std::unique_ptr<QuestionDesk> desk_;     // likewise, here and below
  std::unique_ptr<QuestionPort> questions_;
  std::unique_ptr<TrajectoryPort> trajectories_;
};

}  // namespace clearance
