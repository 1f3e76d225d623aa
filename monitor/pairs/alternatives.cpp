// The directions in which a body extends from its witness point form its tangent cone there. A
// tangent is a direction at right angles to the normal. The closest points are unique exactly if no
// tangent lies in both cones. If one does, then an extreme direction of a cone does. So the extreme
// directions decide.
#include "monitor/pairs/alternatives.hpp"

#include <algorithm>
#include <cmath>

#include "monitor/bodies/fixed_order.hpp"
#include "monitor/pairs/contact_cone.hpp"

namespace clearance {
namespace {

// Closest points that differ by no more than this are the same, and distances are equal, m. It is
// far above all rounding, and far below what a sensor sees.
constexpr double kSame = 1e-9;
constexpr double kParallel = 1e-6;  // the sine of an angle

bool are_near(const Vec3& p, const Vec3& q) noexcept {
  const Vec3 between = p - q;
  return dot(between, between) <= kSame * kSame;
}

// Two parts of one object that share a face may both contain its witness point.
bool are_same_points(const ClosestPoints& p, const ClosestPoints& q) noexcept {
  return are_near(p.witness_a, q.witness_a) && are_near(p.witness_b, q.witness_b);
}

// GradientAlternative::farther.
double farther_of(std::uint32_t pair, std::uint32_t closest, const TickView& view) noexcept {
  const PairTable& table = view.pairs;
  double lower = kInfinity;
  const std::uint32_t end = table.end_part_pair(pair);
  for (std::uint32_t other = table.first_part_pair(pair); other < end; ++other) {
    if (other == closest || table.lower[other] >= lower) continue;
    const bool evaluated = table.evaluations.cycle(other) == view.cycle;
    if (evaluated &&
        are_same_points(table.evaluations[other].closest, table.evaluations[closest].closest))
      continue;
    lower = table.lower[other];
  }
  return std::max(0.0, lower - table.upper[closest]);
}

// The part pair that a report names.
std::uint32_t part_pair_of(const PairReport& pair, const TickView& view) noexcept {
  const PairTable& table = view.pairs;
  const std::uint32_t first = table.first_part_pair(pair.pair);
  const std::uint32_t end = table.end_part_pair(pair.pair);
  std::uint32_t parts_of_b = 1;
  while (first + parts_of_b < end && table.part_a(first + parts_of_b) == table.part_a(first))
    ++parts_of_b;
  return first + pair.part_a * parts_of_b + pair.part_b;
}

// Another point along the tangent has another rate by one of the joints.
bool matters(const Vec3& tangent, const Vec3& normal, std::span<const Vec3> turns) noexcept {
  const Vec3 axis = cross(tangent, normal);
  return std::ranges::any_of(
      turns, [&axis](const Vec3& turn) { return std::abs(dot(turn, axis)) > kSame; });
}

// Goes through the edges of one cone. Returns the least sine so far.
double least_sine(const ContactCone& cone, const ContactCone& other, const Vec3& normal,
                  std::span<const Vec3> turns, double least) noexcept {
  for (int i = 0; i < cone.edges(); ++i) {
    const Vec3 edge = cone.edge(i);
    const Vec3 across = edge - dot(edge, normal) * normal;
    const double length = std::sqrt(dot(across, across));
    if (!(length > kParallel)) continue;  // along the normal
    const Vec3 tangent = across / length;
    const double sine = cone.leaves(tangent);
    if (!(sine < least)) continue;
    const double both = std::max(sine, other.leaves(tangent));
    if (both < least && matters(tangent, normal, turns)) least = both;
  }
  return least;
}

// Two faces are parallel along every tangent.
double of_faces(const Vec3& normal, std::span<const Vec3> turns) noexcept {
  const Vec3 x =
      unit_along(cross(normal, std::abs(normal.x()) < 0.5 ? Vec3::UnitX() : Vec3::UnitY()));
  return matters(x, normal, turns) || matters(cross(normal, x), normal, turns) ? 0.0 : 1.0;
}

}  // namespace

GradientAlternative unknown_alternative() noexcept {
  return {.status = GradientStatus::kUnknown, .farther = kNan, .tilt = kNan};
}

double tilt_of(const PosedPart& a, const PosedPart& b, const Contact& contact,
               std::span<const Vec3> turns) noexcept {
  const Vec3& normal = contact.normal;
  const ContactCone cone_a(a, contact.witness_a, normal), cone_b(b, contact.witness_b, -normal);
  if (!cone_a.known() || !cone_b.known()) return kNan;
  if (cone_a.is_point() || cone_b.is_point()) return 1.0;
  if (cone_a.is_plane() && cone_b.is_plane()) return of_faces(normal, turns);
  const double least = least_sine(cone_a, cone_b, normal, turns, 1.0);
  return least_sine(cone_b, cone_a, normal, turns, least);
}

GradientAlternative alternative_of(const PairReport& pair, std::span<const Vec3> turns,
                                   const TickView& view) noexcept {
  const std::uint32_t part_pair = part_pair_of(pair, view);
  const PairTable& table = view.pairs;
  GradientAlternative found{.status = GradientStatus::kPartsCompared,
                            .farther = farther_of(pair.pair, part_pair, view),
                            .tilt = kNan};
  // A cloud has many elements: whether another one is as near is not known.
  if (pair.status == PairStatus::kConverged && !is_of_cloud(part_pair, view)) {
    found.tilt = tilt_of(view.parts[table.part_a(part_pair)], view.parts[table.part_b(part_pair)],
                         {pair.witness_a, pair.witness_b, pair.normal}, turns);
    if (found.tilt >= 0.0) found.status = GradientStatus::kUnique;
  }
  if (found.farther <= kSame || found.tilt <= kParallel)
    found.status = GradientStatus::kOneOfSeveral;
  return found;
}

}  // namespace clearance
