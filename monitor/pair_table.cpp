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

Evaluation::Evaluation() noexcept
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
  for (std::uint32_t p = 0; p < scene.pairs.size(); ++p) {
    for (const std::uint32_t a : parts_by_object[scene.pairs[p].first]) {
      for (const std::uint32_t b : parts_by_object[scene.pairs[p].second]) {
        part_a.push_back(a);
        part_b.push_back(b);
        pair.push_back(p);
      }
    }
    first_row.push_back(static_cast<std::uint32_t>(pair.size()));
  }
  lower.assign(rows(), -kInfinity);
  upper.assign(rows(), kInfinity);
  tracking.resize(rows());
  evaluation.resize(rows());
}

void carry(const std::vector<ObjectState>& objects, const std::vector<PlacedPart>& parts,
           PairTable& table) noexcept {
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const PlacedPart& a = parts[table.part_a[row]];
    const PlacedPart& b = parts[table.part_b[row]];
    if (!objects[a.object].seen || !objects[b.object].seen) continue;
    carry_row(a, b, table.lower[row], table.upper[row]);
  }
}

void evaluate(const std::vector<PlacedPart>& parts, std::uint32_t row, std::uint64_t cycle,
              PairTable& table) noexcept {
  const PlacedPart& a = parts[table.part_a[row]];
  const PlacedPart& b = parts[table.part_b[row]];
  const DistanceResult found = distance(
      *a.shape, *b.shape, relative_pose(a.world_from_part, b.world_from_part), table.tracking[row]);

  const double error = placing_error(a, b);
  const double lower = error == 0.0 ? found.lower : rounded_down(found.lower - error);
  const double upper = error == 0.0 ? found.upper : rounded_up(found.upper + error);
  // The carried bounds are true as well, and a query that was cut short may know less.
  const bool cut_short = found.status == DistanceStatus::kIterationLimit;
  table.lower[row] = cut_short ? std::max(lower, table.lower[row]) : lower;
  table.upper[row] = cut_short ? std::min(upper, table.upper[row]) : upper;

  const Mat3& turn = a.world_from_part_rotation;
  Evaluation& evaluation = table.evaluation[row];
  evaluation.cycle = cycle;
  evaluation.status = found.status;
  evaluation.distance = found.distance;
  evaluation.witness_a = turn * found.point_on_a + a.world_from_part.position;
  evaluation.witness_b = turn * found.point_on_b + a.world_from_part.position;
  evaluation.normal = turn * found.normal;
}

}  // namespace clearance
