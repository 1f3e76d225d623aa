#include "monitor/pair_table.hpp"

#include <algorithm>
#include <limits>

#include "monitor/rounding.hpp"

namespace clearance {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

void carry_row(const PlacedPart& a, const PlacedPart& b, double& lower, double& upper) noexcept {
  const double moved = a.moved + b.moved;
  if (moved > 0.0) {
    lower = rounded_down(lower - rounded_up(moved));
    upper = rounded_up(upper + rounded_up(moved));
  }
  const Ball& ball_a = a.ball_in_world;
  const Ball& ball_b = b.ball_in_world;
  const double centres = (ball_a.centre - ball_b.centre).norm();
  const double radii = rounded_up(ball_a.radius + ball_b.radius);
  lower = std::max(lower, rounded_down(rounded_down(centres) - radii));
  upper = std::min(upper, rounded_up(rounded_up(centres) + radii));
}

}  // namespace

ClosestPoints::ClosestPoints() noexcept
    : distance(kNan),
      witness_a(Vec3::Constant(kNan)),
      witness_b(Vec3::Constant(kNan)),
      normal(Vec3::Constant(kNan)) {}

PairTable::PairTable(const Scene& scene, const std::vector<PlacedPart>& parts) {
  std::vector<std::vector<std::uint32_t>> parts_by_object(scene.objects.size());
  for (std::uint32_t part = 0; part < parts.size(); ++part) {
    parts_by_object[parts[part].object].push_back(part);
  }
  first_row.push_back(0);
  for (const ObjectPair& pair : scene.pairs) {
    object_a.push_back(pair.first);
    object_b.push_back(pair.second);
    for (const std::uint32_t a : parts_by_object[pair.first]) {
      for (const std::uint32_t b : parts_by_object[pair.second]) {
        part_a.push_back(a);
        part_b.push_back(b);
      }
    }
    first_row.push_back(rows());
  }
  least_lower.assign(pairs(), -kInfinity);
  evaluated_cycle.assign(pairs(), 0);
  lower.assign(rows(), -kInfinity);
  upper.assign(rows(), kInfinity);
  row_evaluated_cycle.assign(rows(), 0);
  status.assign(rows(), DistanceStatus::kIterationLimit);
  tracking.resize(rows());
  closest.resize(rows());
}

void carry(const std::vector<ObjectState>& objects, const std::vector<PlacedPart>& parts,
           PairTable& table) noexcept {
  for (std::uint32_t pair = 0; pair < table.pairs(); ++pair) {
    if (!objects[table.object_a[pair]].seen || !objects[table.object_b[pair]].seen) continue;
    double least = kInfinity;
    for (std::uint32_t row = table.first_row[pair]; row < table.first_row[pair + 1]; ++row) {
      carry_row(parts[table.part_a[row]], parts[table.part_b[row]], table.lower[row],
                table.upper[row]);
      least = std::min(least, table.lower[row]);
    }
    table.least_lower[pair] = least;
  }
}

}  // namespace clearance
