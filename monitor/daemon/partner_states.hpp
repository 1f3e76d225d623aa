// Takes over the state of a daemon's partner, and gives it its own. Both are work of the
// scene thread, so that neither meets a change of the cell.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <utility>

#include "config/cell/cell.hpp"
#include "monitor/dds/partner_port.hpp"
#include "monitor/loop/tick_loop.hpp"
#include "monitor/scene_changes/scene_changer.hpp"
#include "monitor/scene_changes/scene_thread.hpp"

namespace clearance {

// Everything given must outlive this. The actions are called in the threads of the port.
class PartnerStates {
 public:
  PartnerStates(PartnerPort& port, TickPartner& ticks, TickLoop& loop, SceneChanger& changer,
                SceneThread& thread, const std::atomic<bool>& loop_ended)
      : port_(port),
        ticks_(ticks),
        loop_(loop),
        changer_(changer),
        thread_(thread),
        loop_ended_(loop_ended) {}

  [[nodiscard]] PartnerPort::Actions actions();

 private:
  void put(std::function<void()> task);
  void prepare();
  void send();
  void join(const PartnerStateView& state);

  PartnerPort& port_;
  TickPartner& ticks_;
  TickLoop& loop_;
  SceneChanger& changer_;
  SceneThread& thread_;
  const std::atomic<bool>& loop_ended_;
  // For the scene thread. The monitor of a prepared state refers to the scene of its cell.
  struct Prepared {
    std::shared_ptr<const Cell> cell;
    JoinedState state;
    explicit Prepared(std::shared_ptr<const Cell> of) : cell(std::move(of)), state(cell->scene) {}
  };
  std::unique_ptr<Prepared> prepared_;
};

}  // namespace clearance
