#include "tests/monitor/requests/block_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace clearance::test {
namespace {

constexpr long double kParallel = 1e-12L;  // of unit vectors: the sine between them

struct Block {
  LongVec centre = LongVec::Zero();
  std::vector<LongVec> generators = {};
  long double radius = 0;
  // A half-space has these instead: the outward normal, and the plane's distance from the origin.
  bool is_half_space = false;
  LongVec normal = LongVec::Zero();
  long double offset = 0;
};

bool are_parallel(const LongVec& a, const LongVec& b) {
  return a.cross(b).norm() <= kParallel * a.norm() * b.norm();
}

LongVec rotated(const Pose& pose, const LongVec& v) {
  return exactly({Vec3::Zero(), pose.orientation}, v);
}

std::optional<Block> block_of(const Part& part, const Pose& world_from_object) {
  const ConvexBody& shape = part.shape;
  const auto in_world = [&](const Vec3& point) {
    return exactly(world_from_object, exactly(part.object_from_part, point.cast<long double>()));
  };
  const auto along = [&](const Vec3& direction) {
    return rotated(world_from_object,
                   rotated(part.object_from_part, direction.cast<long double>()));
  };
  Block block;
  block.radius = shape.radius;
  if (shape.is_curved()) return std::nullopt;
  if (shape.is_half_space()) {
    block.is_half_space = true;
    block.normal = along(shape.facets[0].normal);
    block.offset = block.normal.dot(in_world(shape.point_of(shape.facets[0])));
    return block;
  }
  const bool is_box = shape.facets.size() == 6 && shape.vertices.size() == 8;
  if (!shape.is_thin() && !is_box) return std::nullopt;
  for (const Vec3& anchor : shape.anchors) block.centre += in_world(anchor);
  block.centre /= static_cast<long double>(shape.anchors.size());
  for (const Edge& edge : shape.edges) {
    const LongVec half = along(edge.direction) * static_cast<long double>(edge.end) / 2;
    const auto same = [&](const LongVec& g) { return are_parallel(g, half); };
    if (std::ranges::none_of(block.generators, same)) block.generators.push_back(half);
  }
  if (is_box && block.generators.size() != 3) return std::nullopt;
  return block;
}

// The half extent along a direction.
long double extent(const std::vector<LongVec>& generators, const LongVec& direction) {
  long double sum = 0;
  for (const LongVec& g : generators) sum += std::abs(direction.dot(g));
  return sum;
}

long double to_segment(const LongVec& centre, const LongVec& half) {
  return point_to_segment(LongVec::Zero(), {centre - half, centre + half});
}

// The distance from the origin to the parallelogram centre + [-1, 1] u + [-1, 1] v.
long double to_face(const LongVec& centre, const LongVec& u, const LongVec& v) {
  long double least = std::min({to_segment(centre + u, v), to_segment(centre - u, v),
                                to_segment(centre + v, u), to_segment(centre - v, u)});
  const LongVec n = u.cross(v).normalized();
  const long double height = n.dot(centre);
  const LongVec foot = height * n - centre;  // of the perpendicular, from the centre
  const LongVec across_u = n.cross(v), across_v = n.cross(u);
  const long double s = foot.dot(across_u) / u.dot(across_u);
  const long double t = foot.dot(across_v) / v.dot(across_v);
  if (std::abs(s) <= 1 && std::abs(t) <= 1) least = std::min(least, std::abs(height));
  return least;
}

// Adds generators that are parallel, so that each pair of them spans a plane.
std::vector<LongVec> merged(const std::vector<LongVec>& all) {
  std::vector<LongVec> merged;
  for (const LongVec& g : all) {
    const auto same =
        std::ranges::find_if(merged, [&](const LongVec& m) { return are_parallel(m, g); });
    if (same == merged.end()) {
      merged.push_back(g);
    } else {
      *same += same->dot(g) > 0 ? g : LongVec(-g);
    }
  }
  return merged;
}

// The signed distance from the origin to centre + sum of [-1, 1] g.
long double signed_distance(const LongVec& centre, const std::vector<LongVec>& g) {
  if (g.empty()) return centre.norm();
  if (g.size() == 1) return to_segment(centre, g[0]);
  if (g.size() == 2) return to_face(centre, g[0], g[1]);
  long double least = std::numeric_limits<long double>::infinity();
  long double depth = least;
  for (std::size_t i = 0; i < g.size(); ++i) {
    for (std::size_t j = i + 1; j < g.size(); ++j) {
      const LongVec n = g[i].cross(g[j]).normalized();
      depth = std::min(depth, extent(g, n) - std::abs(n.dot(centre)));
      // Where other generators lie in the plane of the face, that is tiled by parallelograms; each
      // choice of their signs gives one of them, or a part of the face.
      std::vector<LongVec> centres = {centre, centre};
      for (std::size_t k = 0; k < g.size(); ++k) {
        if (k == i || k == j) continue;
        const long double across = n.dot(g[k]);
        if (std::abs(across) > kParallel * g[k].norm()) {
          for (std::size_t c = 0; c < centres.size(); ++c)
            centres[c] += (c % 2 == 0) == (across > 0) ? g[k] : LongVec(-g[k]);
        } else {
          const std::vector<LongVec> before = centres;
          centres.clear();
          for (const LongVec& sign : {g[k], LongVec(-g[k])}) {
            for (const LongVec& each : before) centres.push_back(each + sign);
          }
        }
      }
      for (const LongVec& each : centres) least = std::min(least, to_face(each, g[i], g[j]));
    }
  }
  return depth >= 0 ? -depth : least;
}

std::optional<long double> distance(const Block& a, const Block& b) {
  if (a.is_half_space && b.is_half_space) return std::nullopt;
  if (a.is_half_space || b.is_half_space) {
    const Block &space = a.is_half_space ? a : b, &body = a.is_half_space ? b : a;
    return space.normal.dot(body.centre) - extent(body.generators, space.normal) - space.offset -
           a.radius - b.radius;
  }
  std::vector<LongVec> all = a.generators;
  all.insert(all.end(), b.generators.begin(), b.generators.end());
  return signed_distance(b.centre - a.centre, merged(all)) - a.radius - b.radius;
}

}  // namespace

std::optional<long double> block_distance(const Object& a, const Pose& world_from_a,
                                          const Object& b, const Pose& world_from_b) {
  long double least = std::numeric_limits<long double>::infinity();
  for (const Part& part_a : a.parts) {
    const auto block_a = block_of(part_a, world_from_a);
    for (const Part& part_b : b.parts) {
      const auto block_b = block_of(part_b, world_from_b);
      if (!block_a || !block_b) return std::nullopt;
      const auto found = distance(*block_a, *block_b);
      if (!found) return std::nullopt;
      least = std::min(least, *found);
    }
  }
  return least;
}

}  // namespace clearance::test
