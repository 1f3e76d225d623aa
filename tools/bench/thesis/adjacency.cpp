#include "tools/bench/thesis/adjacency.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <variant>
#include <vector>

#include "tools/bench/bodies.hpp"
#include "tools/bench/thesis/facet_walk.hpp"
#include "tools/bench/workload.hpp"

namespace clearance::bench {
namespace {

// Every row of a facet-ball is a facet, and the core keeps their order.
Neighbours exact_neighbours(std::span<const HalfSpace> rows) {
  const auto body = std::get<ConvexBody>(polyhedron_from_halfspaces(rows));
  Neighbours pairs;
  for (const Edge& e : body.edges) {
    pairs.emplace(std::min(e.facet[0], e.facet[1]), std::max(e.facet[0], e.facet[1]));
  }
  return pairs;
}

const Neighbours& truth(int order) {
  static std::map<int, Neighbours> known;
  if (const auto found = known.find(order); found != known.end()) return found->second;
  return known.emplace(order, exact_neighbours(ball_rows(order))).first->second;
}

void time_adjacency(benchmark::State& state, FindNeighbours find, int order) {
  const std::vector<HalfSpace> rows = ball_rows(order);
  Neighbours found;
  for (auto _ : state) found = find(rows);
  Neighbours wrong;
  std::set_symmetric_difference(found.begin(), found.end(), truth(order).begin(),
                                truth(order).end(), std::inserter(wrong, wrong.end()));
  state.counters["facets"] = static_cast<double>(rows.size());
  state.counters["wrong"] = static_cast<double>(wrong.size());
  state.counters["ns"] = benchmark::Counter(
      1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

}  // namespace

void register_adjacency(const std::string& who, FindNeighbours find) {
  for (const int order : kOrders) {
    const std::string name = fmt::format("adjacency/{}/f{}", who, order);
    benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
      time_adjacency(state, find, order);
    })->Unit(benchmark::kMicrosecond);
  }
}

void register_adjacency() {
  register_adjacency("walk", walk_facets);
  register_adjacency("core", exact_neighbours);
}

}  // namespace clearance::bench
