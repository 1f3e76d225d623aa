// Compares answers with the exact ones that a line of cases may carry, in exact rational
// arithmetic:
//   distance            text, "0.0625": right to 30 digits; for a motion `distances`, one per pose
//   penetration         text or null, the length of the shortest translation that separates them;
//                       for a motion `penetrations`
//   scale               the length to measure errors with, m; otherwise the bodies' bounding radii
//   family              the kind of case, for the table
#pragma once

#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/cases/case.hpp"

namespace clearance {

class ExactCheck {
 public:
  // `tolerance` is relative: for distance and witness points to the larger of scale and distance,
  // for depth to the scale. Bounds have no tolerance. `widest` is the largest accepted gap between
  // the bounds, relative to the bounding radii plus the distance of the origins. A converged answer
  // promises 1e-14 (and kUnderflow). Two unbounded bodies only have true bounds.
  ExactCheck(double tolerance, double widest) : tolerance_(tolerance), widest_(widest) {}

  // One sentence for each thing that is wrong with the answer. Throws BadLine when the exact answer
  // cannot be read.
  [[nodiscard]] std::vector<std::string> faults(const nlohmann::json& line,
                                                const DistanceCase& question,
                                                const nlohmann::ordered_json& answer);

  // Prints a table to stderr, with one row for each family.
  void print_summary() const;
  // True when something was checked and nothing was wrong.
  [[nodiscard]] bool good() const;

 private:
  // The largest error of each kind, relative to the length that its tolerance is relative to.
  struct Figures {
    std::size_t answers = 0, wrong = 0;
    double error = 0.0, gap = 0.0, witness = 0.0, depth = 0.0;
    void add(const Figures& other);
  };

  struct Question;
  class Judge;

  static void print_row(const std::string& name, const Figures& figures);
  [[nodiscard]] Figures total() const;

  double tolerance_, widest_;
  std::map<std::string, Figures> families_;
  std::size_t without_ = 0;  // lines that carry no exact answer
};

}  // namespace clearance
