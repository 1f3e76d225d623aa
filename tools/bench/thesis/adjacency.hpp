// Table 4.8: which facets are neighbours, found from half-spaces. Benchmarks adjacency/walk/f2 ...
// (§3.6.2), adjacency/core/f2 ... (the core's exact hull and all that it makes of it), and
// adjacency/qhull/f2 ... where Qhull is installed. Counter wrong: pairs that are missing or not
// neighbours.
#pragma once

#include <benchmark/benchmark.h>

#include <set>
#include <span>
#include <string>
#include <utility>

#include "core/shapes.hpp"

namespace clearance::bench {

// Pairs of rows, the smaller index first, whose facets share an edge.
using Neighbours = std::set<std::pair<int, int>>;
using FindNeighbours = Neighbours (*)(std::span<const HalfSpace>);

// adjacency/WHO/fN for all orders.
void register_adjacency(const std::string& who, FindNeighbours find);

// walk and core.
void register_adjacency();
// bench/peers/qhull.cpp, compiled where Qhull is installed.
void register_qhull();

}  // namespace clearance::bench
