// Answers cases with every figure that the core gives, and keeps the time.
#pragma once

#include <chrono>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/distance.hpp"
#include "tools/distance/case.hpp"

namespace clearance {

struct DistanceAnswer {
  DistanceResult result;
  Vec3 own_point_on_b;  // the witness point in B's own frame, before the radius
};

class Answerer {
 public:
  // `cold`: forget the state between the poses of a motion. `repeat`: ask everything so often, for
  // the clock.
  Answerer(bool cold, int repeat) : cold_(cold), repeat_(repeat) {}

  // An answer as --help describes it: one entry a pose where it is a motion.
  [[nodiscard]] nlohmann::ordered_json answer(const DistanceCase& question);

  // To stderr.
  void print_summary(std::size_t lines, std::size_t bad_lines) const;

 private:
  std::vector<DistanceAnswer> run(const DistanceCase& question);

  bool cold_;
  int repeat_;
  std::size_t queries_ = 0;
  std::size_t not_converged_ = 0;
  std::chrono::steady_clock::duration time_{};
};

}  // namespace clearance
