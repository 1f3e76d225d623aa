#include "core/model/farthest_vertices.hpp"

#include <algorithm>
#include <array>

#include "core/numerics/error_constants.hpp"

namespace clearance {
namespace {

// One that climbs from vertex to vertex in a direction m.
struct Climber {
  Vec3 m;
  std::int32_t at;
};

// Along the steepest edge, where one rises for certain, so that it ends: by how fast it rises, as
// ends a rounding apart are equally high. True: it has moved. Neither that nor which edge it is a
// branch could foresee.
bool climb(const ConvexPolyhedron& body, Climber& climber) noexcept {
  const Vertex& vertex = body.vertices[climber.at];
  const double* row = body.outgoing.row(vertex.first_edge);
  const std::int32_t n = vertex.edges;
  const double x = climber.m.x(), y = climber.m.y(), z = climber.m.z();
  double most = kDerivativeError;
  std::int32_t way = kNone;
  for (std::int32_t i = 0; i < n; ++i) {
    const double rate = (x * row[i] + y * row[n + i]) + z * row[2 * n + i];
    const std::int32_t steeper = rate > most;
    way ^= (way ^ i) & -steeper;
    most = std::max(most, rate);
  }
  const std::int32_t rises = way >= 0;
  const std::int32_t to = body.neighbours[vertex.first_edge + (way & -rises)];
  climber.at ^= (climber.at ^ to) & -rises;
  return rises != 0;
}

// Some of them at a time: one waits for memory while the others go on.
void climb_together(const ConvexPolyhedron& body, Climber* climbers, std::size_t count) noexcept {
  std::array<std::uint8_t, kLookedUpTogether> on_the_way;
  for (std::size_t i = 0; i < count; ++i) on_the_way[i] = static_cast<std::uint8_t>(i);
  while (count > 0) {
    std::size_t still = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint8_t which = on_the_way[i];
      on_the_way[still] = which;
      still += climb(body, climbers[which]);
    }
    count = still;
  }
}

}  // namespace

void look_up_farthest(const ConvexPolyhedron& body, const ConvexPolyhedron& other, const Mat3& turn,
                      std::span<const std::uint16_t> facets, std::uint16_t* corners) noexcept {
  std::array<Climber, kLookedUpTogether> climbers;
  for (std::size_t k = 0; k < facets.size(); ++k) {
    const Vec3 m = -(turn * body.facets[facets[k]].normal);
    climbers[k] = {m, other.start.at(m)};
  }
  climb_together(other, climbers.data(), facets.size());
  for (std::size_t k = 0; k < facets.size(); ++k) {
    corners[facets[k]] = static_cast<std::uint16_t>(climbers[k].at);
  }
}

}  // namespace clearance
