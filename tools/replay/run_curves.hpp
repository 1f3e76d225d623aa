// --plot and --report: gathers the curves of a replay and writes picture and page.
#pragma once

#include <string>

#include "tools/replay/arguments.hpp"
#include "tools/replay/run_series.hpp"

namespace clearance {

class RunCurves {
 public:
  // Both arguments must outlive the object.
  RunCurves(const CheckArguments& arguments, const Cell& cell)
      : arguments_(arguments), cell_(cell), scene_(cell.scene), series_(cell.scene) {}

  void add(const ReplayedTick& tick) { series_.add(tick); }

  // Returns an empty text, or the file that could not be written and why.
  [[nodiscard]] std::string write(const OfflineReplay& replay) const;

 private:
  [[nodiscard]] std::string write_report(const OfflineReplay& replay) const;
  [[nodiscard]] std::string unknown_pair() const;

  const CheckArguments& arguments_;
  const Cell& cell_;
  const Scene& scene_;
  RunSeries series_;
};

}  // namespace clearance
