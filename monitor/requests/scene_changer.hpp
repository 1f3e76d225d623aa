// Changes the cell of a running loop.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/interface/command.hpp"
#include "monitor/loop/scene_capacity.hpp"
#include "monitor/loop/tick_loop.hpp"
#include "monitor/requests/restart_needed.hpp"

namespace clearance {

// The readers, writers and queues of a program that belong to one cell. The preparing thread calls
// all of these.
class CellParts {
 public:
  virtual ~CellParts() = default;
  // Makes the sinks of the changed cell. They get no report yet.
  virtual std::vector<ReportSink*> prepare(const std::shared_ptr<const Cell>& cell) = 0;
  // The loop ticks the changed cell: its inputs and sinks are in use from now on, and those of the
  // cell before may go. Nothing takes this back, so whatever can fail belongs into prepare().
  virtual void follow(const SceneInForce& since) noexcept = 0;
  // Is called before follow(), with the final figures of the cell that the loop no longer ticks.
  virtual void end(const LoopStatistics&) noexcept {}
  // The changed cell is given up, and so is what prepare() made.
  virtual void abandon() = 0;
};

// To be used by one thread at a time, the preparing one.
class SceneChanger {
 public:
  // The loop ticks `cell`. Loop and parts must outlive this. `room`: the number of ticks by which a
  // changed cell may lag behind; one that needs more is refused as too slow.
  SceneChanger(TickLoop& loop, std::shared_ptr<const Cell> cell, CellParts& parts,
               const TickRecords::Room& room = TickRecords::Room())
      : loop_(loop),
        cell_(std::move(cell)),
        capacity_(capacity_for(*cell_)),
        records_(room),
        parts_(parts) {}

  struct Outcome {
    CommandStatus status = CommandStatus::kDone;
    std::string refusal = {};         // the end of a sentence that says why not; empty: changed
    std::uint64_t in_force_from = 0;  // the first cycle of the changed cell
  };
  // Returns why this cell cannot follow the present one in this loop, before anything is done.
  [[nodiscard]] Outcome check(const Cell& cell) const;
  // Returns when the loop ticks this cell, or when it is refused; then the cell before stays in
  // force. `loop_ended` is set once the thread of the loop has ended, and ends the wait for it.
  // Passes on the exceptions of prepare(); the cell before then stays in force.
  [[nodiscard]] Outcome change(std::shared_ptr<const Cell> cell,
                               const std::atomic<bool>& loop_ended);

  // Lets a new monitor of the same cell take over from the present one, as if the cell had changed:
  // no bound of a pair remains. `began` is called once it has taken over, before its first tick, in
  // the calling thread.
  using Began = std::function<void(const Successor&)>;
  [[nodiscard]] Outcome renew(const std::atomic<bool>& loop_ended, const Began& began);

  [[nodiscard]] const Cell& cell() const noexcept { return *cell_; }
  // Likewise, for a use that may last until after the next change.
  [[nodiscard]] std::shared_ptr<const Cell> shared_cell() const noexcept { return cell_; }

 private:
  [[nodiscard]] Outcome replace(std::shared_ptr<const Cell> cell,
                                const std::atomic<bool>& loop_ended, const Began& began);
  [[nodiscard]] Outcome succeed(std::shared_ptr<const Cell> cell,
                                const std::vector<ReportSink*>& sinks,
                                const std::atomic<bool>& loop_ended, const Began& began);
  [[nodiscard]] Successor::State run(SceneOffer& successor, const std::atomic<bool>& loop_ended,
                                     const Began& began);

  TickLoop& loop_;
  std::shared_ptr<const Cell> cell_;
  SceneCapacity capacity_;
  TickRecords records_;
  CellParts& parts_;
};

}  // namespace clearance
