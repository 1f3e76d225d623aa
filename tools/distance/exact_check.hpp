// Answers held against the exact ones that a line of cases may carry, in exact rational arithmetic:
//   distance            text, "0.0625": right to 30 digits; of a motion `distances`, one a pose
//   penetration         text or null, the length of the shortest translation that parts the bodies;
//                       of a motion `penetrations`
//   scale               the length to measure errors with, m; else the bodies' reach
//   family              what kind of case it is, for the table
#pragma once

#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/distance/case.hpp"

namespace clearance {

class ExactCheck {
 public:
  // `tolerance`: of distance and witness points, over the larger of scale and distance; of depth,
  // over the scale. Bounds have none. `widest`: how far bounds may be apart, over the bodies' reach
  // and the distance of their origins, of which a converged answer promises 1e-14 (and kUnderflow).
  ExactCheck(double tolerance, double widest) : tolerance_(tolerance), widest_(widest) {}

  // What is wrong with the answer, a sentence each. Throws BadLine where the exact one cannot be
  // read.
  [[nodiscard]] std::vector<std::string> faults(const nlohmann::json& line,
                                                const DistanceCase& question,
                                                const nlohmann::ordered_json& answer);

  // To stderr: a table with a row a family.
  void print_summary() const;
  // Something was checked, and nothing was wrong.
  [[nodiscard]] bool good() const;

 private:
  // The largest of each, over what its tolerance is.
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
