#include "tests/shared/exact_features.hpp"

#include <algorithm>
#include <map>
#include <optional>

#include "tests/shared/exact_placement.hpp"

namespace clearance::oracle {
namespace {

const RationalVec kAlongZ = {0, 0, 1};

// Returns true if the intersection line of rows i and j contains an edge of the body. It clips the
// line by all other rows.
bool is_edge(const std::vector<HalfSpace>& rows, std::size_t i, std::size_t j) {
  const RationalVec n = exact(rows[i].normal), m = exact(rows[j].normal);
  const RationalVec along = cross(n, m);
  if (is_zero(along)) return false;
  const Rational length2 = dot(along, along);
  const RationalVec on_line = (Rational(rows[i].offset) / length2) * cross(m, along) +
                              (Rational(rows[j].offset) / length2) * cross(along, n);
  std::optional<Rational> begin, end;
  for (const HalfSpace& row : rows) {
    const RationalVec k = exact(row.normal);
    const Rational slope = dot(k, along), room = Rational(row.offset) - dot(k, on_line);
    if (slope == 0) {
      if (room < 0) return false;
      continue;
    }
    const Rational at = room / slope;
    std::optional<Rational>& limit = slope > 0 ? end : begin;
    if (!limit || (slope > 0 ? at < *limit : at > *limit)) limit = at;
  }
  return !begin || !end || *begin < *end;
}

void add_edges_of_rows(const std::vector<HalfSpace>& rows, Features& out) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (!is_edge(rows, i, j)) continue;
      out.edges.push_back(cross(exact(rows[i].normal), exact(rows[j].normal)));
    }
  }
}

void add_both_signs(const RationalVec& normal, Features& out) {
  out.normals.push_back(normal);
  out.normals.push_back(Rational(-1) * normal);
}

Features features_of_points(const std::vector<Vec3>& points) {
  Features out;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      out.edges.push_back(exact(points[i]) - exact(points[j]));
      for (std::size_t k = 0; k < j; ++k) {
        add_both_signs(cross(out.edges.back(), exact(points[k]) - exact(points[j])), out);
      }
    }
  }
  return out;
}

// Returns true if every row is a side or an end of a prism along z.
bool is_prism(const std::vector<HalfSpace>& rows) {
  return std::ranges::all_of(rows, [](const HalfSpace& row) {
    return row.normal.z() == 0.0 || (row.normal.x() == 0.0 && row.normal.y() == 0.0);
  });
}

// Two sides meet along z. A side and an end meet in a direction normal to z and to the side's
// normal.
void add_edges_of_prism(const std::vector<HalfSpace>& rows, Features& out) {
  out.edges.push_back(kAlongZ);
  for (const HalfSpace& row : rows) out.edges.push_back(cross(exact(row.normal), kAlongZ));
}

// The points of one height, ordered by x and y.
using Layer = std::vector<Vec3>;

std::vector<Layer> layers_of(const std::vector<Vec3>& points) {
  std::map<double, Layer> by_height;
  for (const Vec3& p : points) by_height[p.z()].push_back(p);
  std::vector<Layer> out;
  for (auto& [height, layer] : by_height) {
    std::ranges::sort(layer, {}, [](const Vec3& p) { return std::pair(p.x(), p.y()); });
    out.push_back(std::move(layer));
  }
  return out;
}

bool is_prism(const std::vector<Layer>& layers) {
  return layers.size() == 2 &&
         std::ranges::equal(
             layers[0], layers[1], {}, [](const Vec3& p) { return std::pair(p.x(), p.y()); },
             [](const Vec3& p) { return std::pair(p.x(), p.y()); });
}

bool is_lens(const std::vector<Layer>& layers) {
  return layers.size() == 3 && layers[0].size() == 1 && layers[1].size() > 2 &&
         layers[2].size() == 1;
}

// The vertices of a layer's outline, counter-clockwise (A. M. Andrew, "Another efficient algorithm
// for convex hulls in two dimensions", 1979). If the layer is not a polygon, its end points.
std::vector<RationalVec> outline(Layer layer) {
  std::vector<RationalVec> out;
  for (int half = 0; half < 2; ++half) {
    const std::size_t start = out.size();
    for (const Vec3& p : layer) {
      const RationalVec next = exact(p);
      while (out.size() >= start + 2 &&
             cross(out.back() - out.end()[-2], next - out.back())[2] <= 0) {
        out.pop_back();
      }
      out.push_back(next);
    }
    out.pop_back();
    std::ranges::reverse(layer);
  }
  return out;
}

Features features_of_prism(const std::vector<Layer>& layers) {
  Features out;
  out.edges.push_back(kAlongZ);
  add_both_signs(kAlongZ, out);
  const std::vector<RationalVec> corners = outline(layers[0]);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    out.edges.push_back(corners[(i + 1) % corners.size()] - corners[i]);
    add_both_signs(cross(out.edges.back(), kAlongZ), out);
  }
  return out;
}

// A facet contains a side of the polygon and a tip, or a vertex of it and both tips.
Features features_of_lens(const std::vector<Layer>& layers) {
  Features out;
  const RationalVec tips[] = {exact(layers[0][0]), exact(layers[2][0])};
  const RationalVec axis = tips[1] - tips[0];
  out.edges.push_back(axis);
  const std::vector<RationalVec> corners = outline(layers[1]);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const RationalVec side = corners[(i + 1) % corners.size()] - corners[i];
    out.edges.push_back(side);
    for (const RationalVec& tip : tips) {
      out.edges.push_back(tip - corners[i]);
      add_both_signs(cross(side, out.edges.back()), out);
    }
    add_both_signs(cross(axis, out.edges.back()), out);
  }
  return out;
}

}  // namespace

Features features_of(const Body& body) {
  if (body.rows.empty()) {
    const std::vector<Layer> layers = layers_of(body.points);
    if (is_prism(layers)) return features_of_prism(layers);
    return is_lens(layers) ? features_of_lens(layers) : features_of_points(body.points);
  }
  Features out;
  for (const HalfSpace& row : body.rows) out.normals.push_back(exact(row.normal));
  if (is_prism(body.rows)) {
    add_edges_of_prism(body.rows, out);
  } else {
    add_edges_of_rows(body.rows, out);
  }
  return out;
}

bool features_are_plain(const Body& body) {
  if (!body.rows.empty()) return is_prism(body.rows);
  const std::vector<Layer> layers = layers_of(body.points);
  return is_prism(layers) || is_lens(layers);
}

}  // namespace clearance::oracle
