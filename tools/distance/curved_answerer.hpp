// Answers cases with curved bodies or bodies of several parts: the least distance of any two parts.
#pragma once

#include <chrono>
#include <cstddef>
#include <nlohmann/json.hpp>

#include "tools/distance/curved_case.hpp"

namespace clearance {

class CurvedAnswerer {
 public:
  // The parameters are those of Answerer.
  CurvedAnswerer(bool cold, int repeat) : cold_(cold), repeat_(repeat) {}

  // Answers like Answerer, but without the deepest points, and without a depth for overlapping
  // parts.
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
