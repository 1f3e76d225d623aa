// Takes over the state and the cell of a daemon's partner, and gives it its own. All of this is
// work of the scene thread, so that none of it meets a change of the cell.
//
// The leader alone takes the commands of clients. Its partner gets the changed cell from it, so
// that both make the same changes in the same order.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "config/cell/cell.hpp"
#include "monitor/daemon/moveit_port.hpp"
#include "monitor/daemon/recording.hpp"
#include "monitor/dds/partner_port.hpp"
#include "monitor/loop/tick_loop.hpp"
#include "monitor/requests/scene_changer.hpp"
#include "monitor/requests/scene_thread.hpp"

namespace clearance {

// Everything given must outlive this. The actions are called in the threads of the port.
class PartnerStates {
 public:
  // `put`: the entry for changes of the cell. `revision` returns that of the scene in force.
  // `recording` gets the states that the loop goes on from; null: there is none.
  using Put = std::function<bool(SceneTask)>;
  PartnerStates(PartnerPort& port, TickPartner& ticks, TickLoop& loop, SceneChanger& changer,
                SceneThread& thread, MoveItPort& scenes, const std::atomic<bool>& loop_ended,
                Recording* recording, Put put_command, std::function<std::uint64_t()> revision)
      : port_(port),
        ticks_(ticks),
        loop_(loop),
        changer_(changer),
        thread_(thread),
        scenes_(scenes),
        loop_ended_(loop_ended),
        recording_(recording),
        put_command_(std::move(put_command)),
        revision_(std::move(revision)) {}

  [[nodiscard]] PartnerPort::Actions actions();

  // Returns whether this daemon takes commands and questions. If not, the partner takes them, or
  // neither daemon does while the lead changes. May wait for 100 ms, so the tick thread must not
  // call it.
  [[nodiscard]] bool takes_requests() const;
  // Keeps the files of a command that the partner takes.
  void keep_files(Command command);
  // The command of a client. It is done only if it was not done before, and answered only while
  // this daemon leads. If it has changed the cell, the answer waits until the partner has it, too.
  [[nodiscard]] GivenCommand for_both(GivenCommand given);

 private:
  void put(std::function<void()> task);
  void prepare();
  void send();
  void join(const PartnerStateView& state);
  void take_cell(std::string text, std::uint64_t revision);
  [[nodiscard]] CommandResult of_both(CommandResult result, bool is_dry);

  PartnerPort& port_;
  TickPartner& ticks_;
  TickLoop& loop_;
  SceneChanger& changer_;
  SceneThread& thread_;
  MoveItPort& scenes_;  // knows which commands led to the scene in force
  const std::atomic<bool>& loop_ended_;
  Recording* const recording_;
  const Put put_command_;
  const std::function<std::uint64_t()> revision_;
  std::uint64_t refused_ = 0;  // the last cell that was not taken over; for the scene thread
  // For the scene thread. The monitor of a prepared state refers to the scene of its cell.
  struct Prepared {
    std::shared_ptr<const Cell> cell;
    JoinedState state;
    Prepared(std::shared_ptr<const Cell> of, const Monitor& running)
        : cell(std::move(of)), state(cell->scene, &running) {}
  };
  std::unique_ptr<Prepared> prepared_;
};

}  // namespace clearance
