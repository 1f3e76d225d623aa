// Answers cases with curved bodies or bodies of several parts: the least distance of any two parts.
#pragma once

#include <chrono>
#include <cstddef>
#include <nlohmann/json.hpp>

#include "tools/distance/curved_case.hpp"

namespace clearance {

class CurvedAnswerer {
 public:
  // The arguments have the same meaning as in Answerer.
  CurvedAnswerer(bool cold, int repeat) : cold_(cold), repeat_(repeat) {}

  // The same as in Answerer, without the deepest points. Overlapping parts have no depth.
  [[nodiscard]] nlohmann::ordered_json answer(const CurvedCase& question);

  // Prints to stderr if there were any answers.
  void print_summary() const;

 private:
  bool cold_;
  int repeat_;
  std::size_t queries_ = 0, not_converged_ = 0;
  std::chrono::steady_clock::duration time_{};
};

}  // namespace clearance
