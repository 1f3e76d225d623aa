// Counts zones that contradict the reports: the check that clearance-merge makes of itself.
#pragma once

#include <cstdint>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/client/shared_cell.hpp"

namespace clearance::merge {

class ZoneCheck {
 public:
  // `cell` is the whole cell, and outlives this.
  explicit ZoneCheck(const Cell& cell);

  // A zone is wrong if it is inactive in two reports that both have a pair of it nearer than it is
  // entered. The first of these may have come before the state of the zone. Reports of another
  // revision of the cell are left out.
  void check(const client::SharedCell& whole);
  [[nodiscard]] std::uint64_t wrong() const noexcept { return wrong_; }
  // Counts the times that a zone became active because a share was not heard.
  [[nodiscard]] std::uint64_t unheard() const noexcept { return unheard_; }

 private:
  const Cell& cell_;
  std::vector<bool> was_doubtful_, was_unheard_;  // by zone
  std::uint64_t wrong_ = 0, unheard_ = 0;
};

}  // namespace clearance::merge
