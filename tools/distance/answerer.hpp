// Answers cases with every figure that the core gives, measures the time, and counts by which
// method the answers were found.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/distance.hpp"
#include "tools/cases/case.hpp"

namespace clearance {

struct DistanceAnswer {
  DistanceResult result;
  Vec3 own_point_on_b;  // the witness point in B's local frame, before the radius
};

// The number of answers of each method, by DistancePath. Also the number of touching or overlapping
// pairs among those that feature tracking did not answer.
struct PathCount {
  std::array<std::size_t, static_cast<std::size_t>(DistancePath::kDirection) + 1> by_path{};
  std::size_t met = 0;

  [[nodiscard]] std::size_t operator[](DistancePath path) const {
    return by_path[static_cast<std::size_t>(path)];
  }
  void add(const DistanceResult& result);
};

class Answerer {
 public:
  // `cold`: forget the state between the poses of a motion. `repeat`: evaluate each query this many
  // times, for the measurement of time.
  Answerer(bool cold, int repeat) : cold_(cold), repeat_(repeat) {}

  // An answer as --help describes it: one entry for each pose of a motion.
  [[nodiscard]] nlohmann::ordered_json answer(const DistanceCase& question);

  // Prints to stderr; the second line counts the answers of each method.
  void print_summary(std::size_t lines, std::size_t bad_lines) const;

 private:
  std::vector<DistanceAnswer> run(const DistanceCase& question);
  void print_paths() const;

  bool cold_;
  int repeat_;
  std::size_t queries_ = 0;
  std::size_t not_converged_ = 0;
  PathCount paths_;
  std::chrono::steady_clock::duration time_{};
};

}  // namespace clearance
