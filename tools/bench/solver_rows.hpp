// Names and registers the rows of a solver, Clearance's own or a peer's, in clearance-bench and in
// clearance-thesis.
#pragma once

#include <fmt/format.h>

#include <initializer_list>
#include <string>
#include <string_view>

#include "tools/bench/measure.hpp"

namespace clearance::bench {

// The program that a row is for.
enum class RowSet { kBench, kThesis };

// Table 4.5: queries between two cold starts, and facet-balls of N1 + N2 = 12, 92, 576.
inline constexpr int kIntervals[] = {1, 5, 20, 50, 100};
inline constexpr const char* kIntervalLoads[] = {"f2", "f6", "f15"};

// PREFIXinterval/STEPS/LOAD.
template <class Solver>
void register_intervals(const std::string& prefix) {
  for (const char* load : kIntervalLoads) {
    for (const int steps : kIntervals) {
      register_row<Solver>(fmt::format("{}interval/{}/{}", prefix, steps, load), load, steps);
    }
  }
}

// PREFIXtracked/LOAD and PREFIXcold/LOAD of facet-balls and their duals.
template <class Solver>
void register_facet_balls(const std::string& prefix) {
  for (const int order : kOrders) {
    for (const char* kind : {"f", "v"}) {
      const std::string load = fmt::format("{}{}", kind, order);
      register_row<Solver>(fmt::format("{}tracked/{}", prefix, load), load, kTracked);
      register_row<Solver>(fmt::format("{}cold/{}", prefix, load), load, kCold);
    }
  }
}

// Registers the rows peer/WHO/... of a solver, in the program that `set` says. `lacking`: the kinds
// of bodies for which the solver has no shape.
template <class Solver>
void register_peer(RowSet set, const std::string& who,
                   std::initializer_list<std::string_view> lacking = {}) {
  const std::string prefix = fmt::format("peer/{}/", who);
  if (set == RowSet::kBench) {
    register_rows<Solver>(prefix);
    register_kind_rows<Solver>(prefix, lacking);
  } else {
    register_facet_balls<Solver>(prefix);
    register_intervals<Solver>(prefix);
    register_crossed_rows<Solver>(who);
  }
}

}  // namespace clearance::bench
