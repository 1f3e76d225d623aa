// The rivals in turns on every case: the time and the error of each query.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "tools/bench/suite/cases.hpp"
#include "tools/bench/suite/rival.hpp"

namespace clearance::bench {

struct RaceOptions {
  int motions = 8;  // pairs of bodies for each class and separation
  int steps = 60;   // poses of each motion
  int passes = 7;   // over all cases, with every rival; the least time of a query counts
};

// All queries of one rival on the cases of a class, or on those of one separation. Times are of one
// query between two readings of the clock. The first query of a motion is no tracked one.
struct RaceRow {
  std::string kind;
  double separation;  // m; NaN: all separations
  std::size_t rival;  // index
  bool cold;
  double p50_ns, p90_ns;
  double streamed_ns;  // mean of the tracked queries of a motion, one after another; NaN when cold
  // m, of the queries without a reported failure. NaN: the rival has only said yes or no.
  double median_error, max_error;
  int failures;  // no answer, or wrong by more than kSuiteFailure of size plus distance
  int queries;
};

inline constexpr double kSuiteFailure = 1e-6;

// An answer that was judged.
struct Judged {
  double error;  // m; NaN: there is none
  bool failed;
};

// `exact` is the signed distance, m. Without depths, contact is any answer that is not positive.
[[nodiscard]] Judged judge(double answer, double exact, double size, bool has_depth);

// Rows for every class, rival and mode: first of all separations together, then of each. Cases that
// a rival does not offer are left out, and so are rows without cases. `progress` gets the share
// done and what is being measured.
[[nodiscard]] std::vector<RaceRow> race(
    std::span<const Rival> rivals, std::span<const std::string> kinds, const RaceOptions& options,
    const std::function<void(double share, const std::string& what)>& progress);

}  // namespace clearance::bench
