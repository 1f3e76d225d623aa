// The tables of a body, one by one, for those who count or check all of its memory.
#pragma once

#include <cstddef>
#include <span>

#include "core/convex_body.hpp"

namespace clearance {

// Calls visit(name, table) for each table that the body holds outside of itself: a span of its
// elements. Empty tables are left out.
template <class Visit>
void each_table(const ConvexBody& body, Visit&& visit) {
  const auto show = [&](const char* name, const auto& table) {
    if (!table.empty()) visit(name, std::span(table));
  };
  const auto show_numbers = [&](const char* name, const double* first, std::size_t bytes) {
    show(name, std::span(first, bytes / sizeof(double)));
  };
  show("facets", body.facets);
  show("edges", body.edges);
  show("vertices", body.vertices);
  show("edges of facets", body.facet_edges);
  show("edges of vertices", body.vertex_edges);
  show("anchors", body.anchors);
  show("rays", body.rays);
  show("rays of the recession cone", body.recession_cone.rays);
  show("neighbours of vertices", body.neighbours);
  show("neighbours of facets", body.facets_beside);
  show_numbers("outgoing edges", body.outgoing.row(0), body.outgoing.bytes());
  show_numbers("limits of facets", body.facet_limits.row(0), body.facet_limits.bytes());
  show_numbers("planes", body.planes.data(), body.planes.bytes());
}

}  // namespace clearance
