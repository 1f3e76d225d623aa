#include "monitor/sensors/organised_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "monitor/intake/measured_points.hpp"

namespace clearance {
namespace {

// The rounding of a radius, relative.
constexpr double kRounded = 0x1p-40;

}  // namespace

bool OrganisedPoints::on_one_surface(const Ray& a, const Ray& b, double chord2) noexcept {
  const double nearer = std::min(a.range, b.range);
  const double jump = std::abs(a.range - b.range) - a.error - b.error;
  if (jump <= 0.0) return true;
  return jump <= kWidestNeighbour * nearer &&
         jump * jump <= kSteepest * kSteepest * chord2 * nearer * nearer;
}

void OrganisedPoints::add_cell(const std::array<const Ray*, 4>& rays,
                               const std::array<Reach*, 4>& reaches) {
  std::array<Vec3, 4> sums;  // from a corner to those on one surface with it
  std::array<double, 4> counts{1.0, 1.0, 1.0, 1.0};
  sums.fill(Vec3::Zero());
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = i + 1; k < 4; ++k) {
      const Ray &a = *rays[i], &b = *rays[k];
      if (a.range == 0.0 || b.range == 0.0) continue;
      const double chord2 = (a.direction - b.direction).squaredNorm();
      const std::size_t side = i + k == 3 ? 2 : k - i - 1;
      widest2_[side] = std::max(widest2_[side], chord2);
      if (std::isnan(a.error) || std::isnan(b.error) || !on_one_surface(a, b, chord2)) continue;
      const Vec3 across = b.point - a.point;
      const double half2 = 0.25 * across.squaredNorm(), error = std::max(a.error, b.error);
      for (Reach* const reach : {reaches[i], reaches[k]}) {
        reach->squared = std::max(reach->squared, half2);
        reach->error = std::max(reach->error, error);
      }
      sums[i] += across;
      sums[k] -= across;
      ++counts[i];
      ++counts[k];
    }
  }
  for (std::size_t i = 0; i < 4; ++i) {
    reaches[i]->squared =
        std::max(reaches[i]->squared, sums[i].squaredNorm() / (counts[i] * counts[i]));
  }
}

FrameFault OrganisedPoints::widen(std::uint32_t width, std::uint32_t height,
                                  std::span<MeasuredPoint> points) {
  if (width < 2 || height < 2) return FrameFault::kNotOrganised;
  rows_.resize(2 * std::size_t{width});
  reaches_.assign(points.size(), {});
  widest2_.fill(0.0);
  bool is_empty = true;
  for (std::size_t row = 0; row < height; ++row) {
    Ray* const above = &rows_[(row + 1) % 2 * width];
    Ray* const here = &rows_[row % 2 * width];
    Reach* const reaches = &reaches_[row * width];
    for (std::size_t column = 0; column < width; ++column) {
      const MeasuredPoint& p = points[row * width + column];
      const Vec3 at(p.x, p.y, p.z);
      const double range = at.norm();
      here[column] =
          range > 0.0 && std::isfinite(range) ? Ray{at, at / range, range, p.radius} : Ray{};
      is_empty = is_empty && !(here[column].range > 0.0 && p.radius >= 0.0F);
      if (row == 0 || column == 0) continue;
      add_cell({&above[column - 1], &above[column], &here[column - 1], &here[column]},
               {&reaches[column - 1] - width, &reaches[column] - width, &reaches[column - 1],
                &reaches[column]});
    }
  }
  if (std::ranges::max(widest2_) > kWidestNeighbour * kWidestNeighbour)
    return FrameFault::kWideRays;
  if (!is_empty && (widest2_[0] == 0.0 || widest2_[1] == 0.0)) return FrameFault::kUnknownRays;
  const double pixel = kHalfDiagonal * std::sqrt(std::max(widest2_[0], widest2_[1]));
  for (std::size_t i = 0; i < points.size(); ++i) {
    MeasuredPoint& p = points[i];
    const double range = Vec3(p.x, p.y, p.z).norm();
    if (std::isnan(p.radius)) p.x = std::numeric_limits<float>::quiet_NaN();
    if (!(range > 0.0) || std::isnan(p.radius)) continue;
    const double reach = std::max(std::sqrt(reaches_[i].squared), pixel * range);
    const double radius = reach + std::max(reaches_[i].error, double{p.radius});
    p.radius = std::nextafter(static_cast<float>(radius * (1.0 + kRounded)),
                              std::numeric_limits<float>::infinity());
  }
  return FrameFault::kNoFault;
}

}  // namespace clearance
