// The commands of a run of the cell of inputs that lie: they change its scene between two ticks, as
// those of clients do.
#pragma once

#include <cstdint>
#include <list>
#include <optional>
#include <vector>

#include "config/edit/cell_editor.hpp"
#include "monitor/loop/tick_loop.hpp"
#include "tests/monitor/adversary/lies.hpp"
#include "tests/monitor/adversary/true_motion.hpp"

namespace clearance::test::lies {

class LyingCommands {
 public:
  // All must outlive this.
  LyingCommands(const Cell& cell, const TrueMotion& truth, const std::vector<Fault>& faults);

  // Before a tick, at `t` ns since the start: offers the scene that is due to the loop, and lets it
  // catch up. `sink` gets its reports.
  void work(std::int64_t t, TickLoop& loop, ReportSink& sink);
  // The cell that the loop ticks.
  [[nodiscard]] const Cell& in_force() const noexcept;
  // A command is to change the scene from this time on, and has not yet; nothing: there is none.
  [[nodiscard]] std::optional<std::int64_t> waits_since(std::int64_t t) const noexcept;
  // The body that the command takes elsewhere; kBodies: none.
  [[nodiscard]] std::size_t moved_body() const noexcept;

 private:
  [[nodiscard]] std::int64_t due(std::size_t change) const noexcept;
  [[nodiscard]] CellChange change(bool is_first) const;
  [[nodiscard]] Cell changed();

  const Cell& first_;
  const TrueMotion& truth_;
  const Fault* fault_ = nullptr;  // null: the run has no commands
  std::optional<CellEditor> editor_;
  TickRecords records_;
  std::list<Cell> cells_;
  std::list<SceneOffer> offers_;  // as many as cells
};

}  // namespace clearance::test::lies
