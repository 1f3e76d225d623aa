// --plot and --report: gathers the curves of a replay and writes what is made of them.
#pragma once

#include <string>

#include "tools/replay/arguments.hpp"
#include "tools/replay/run_series.hpp"

namespace clearance {

class RunCurves {
 public:
  // Both must outlive it.
  RunCurves(const ReplayArguments& arguments, const Cell& cell)
      : arguments_(arguments), cell_(cell), scene_(cell.scene), series_(cell.scene) {}

  void add(const ReplayedTick& tick) { series_.add(tick); }

  // Empty, or what could not be written and why.
  [[nodiscard]] std::string write(const OfflineReplay& replay) const;

 private:
  [[nodiscard]] std::string write_report(const OfflineReplay& replay) const;
  [[nodiscard]] std::string unknown_pair() const;

  const ReplayArguments& arguments_;
  const Cell& cell_;
  const Scene& scene_;
  RunSeries series_;
};

}  // namespace clearance
