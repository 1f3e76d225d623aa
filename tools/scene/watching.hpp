// The cost of certifying at every instant that two bodies are not near, with a coarse or a fine
// model. It shows where a finer model no longer pays.
//
// The monitor's broad phase queries a pair and certifies a distance. It then leaves the pair alone
// until both objects have moved by the allowance: the excess of the distance over the threshold
// that matters (§4.6; monitor/schedule/BROAD_PHASE.md). If the distance exceeds that threshold by
// D, a model of error e certifies at least D - e. Let V be the largest speed of both objects
// together that the cell states, m/s. Let u be the margin of the broad phase for urgent pairs. Then
// the pair is queried V / (D - e - u) times a second. A model of c ns per query therefore costs c V
// / (D - e
// - u). In a plot of c against e, draw the line from each model to the point (D - u, 0). The
// cheapest model is the one with the least slope.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace clearance {

// Time of one query, ns: from the state of the last query, and without.
struct QueryTimes {
  double tracked = 0.0, cold = 0.0;
};

// A model's error, m, and the time of a query against it, ns.
struct Level {
  double error = 0.0, query_ns = 0.0;
};

struct Watching {
  double distance = 0.0;  // m: the excess of the bodies' distance over a zone's threshold or the
                          // horizon
  double speed = 0.0;     // m/s: sum of the objects' speeds; > 0
};

struct WatchCost {
  double looks_per_s = 0.0, ns_per_s = 0.0;
};

// Nothing: with this model the pair is queried in every tick (1 kHz).
[[nodiscard]] std::optional<WatchCost> watch_cost(const Level& level, const Watching& watching);

// The error, m, at which a model with queries of `query_ns` costs `ns_per_s`.
[[nodiscard]] double error_of_equal_cost(double query_ns, double ns_per_s,
                                         const Watching& watching);

// The cheapest model; nothing if every model needs a query per tick.
[[nodiscard]] std::optional<std::size_t> cheapest(std::span<const Level> levels,
                                                  const Watching& watching);

// The cheapest model from this distance on, m, up to that of the next entry.
struct CheapestFrom {
  double distance = 0.0;
  std::size_t level = 0;
};
// By rising distance. Nearer than the first entry, every model needs a query per tick.
[[nodiscard]] std::vector<CheapestFrom> cheapest_by_distance(std::span<const Level> levels,
                                                             double speed);

}  // namespace clearance
