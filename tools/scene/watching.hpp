// What it costs to know at every instant that two bodies are not near, by a coarse model or a fine
// one; and so where a finer one stops paying.
//
// The monitor's broad phase looks at a pair, proves it to be so far apart, and leaves it alone
// until both objects have moved by what is left above the level that matters (§4.6; its allowance,
// see monitor/broad_phase/README.md). At distance D beyond that level a model of error e proves
// D - e at least. With objects that come V a second together, as fast as the cell states, the pair
// is looked at V / (D - e - u) times a second, u being what the broad phase takes off for what is
// urgent. So a level of c a query costs c V / (D - e - u): as seen from the point (D - u, 0) of a
// plot of c against e, the cheapest level is the one towards which the slope is least.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace clearance {

// Of one query, ns: from what the last one left, and without.
struct QueryTimes {
  double tracked = 0.0, cold = 0.0;
};

// Of a model: how far it reaches beyond the body, m, and what a look at it costs, ns.
struct Level {
  double error = 0.0, query_ns = 0.0;
};

struct Watching {
  double distance = 0.0;  // m: of the bodies, beyond a zone's threshold or the horizon
  double speed = 0.0;     // m/s: how far both objects come, added up; > 0
};

struct WatchCost {
  double looks_per_s = 0.0, ns_per_s = 0.0;
};

// Nothing: by this model the pair is not left alone, but looked at in every tick (of 1 kHz).
[[nodiscard]] std::optional<WatchCost> watch_cost(const Level& level, const Watching& watching);

// Levels of this error, m, cost as much as `ns_per_s` if a query of theirs takes `query_ns`.
[[nodiscard]] double error_of_equal_cost(double query_ns, double ns_per_s,
                                         const Watching& watching);

// Nothing: by no model.
[[nodiscard]] std::optional<std::size_t> cheapest(std::span<const Level> levels,
                                                  const Watching& watching);

// The cheapest of all from this distance on, m, up to that of the next one.
struct CheapestFrom {
  double distance = 0.0;
  std::size_t level = 0;
};
// By rising distance; nearer than the first one no model will do.
[[nodiscard]] std::vector<CheapestFrom> cheapest_by_distance(std::span<const Level> levels,
                                                             double speed);

}  // namespace clearance
