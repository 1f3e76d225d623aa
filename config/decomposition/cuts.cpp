// Cuts across one direction share their work. Points are sorted into slabs, and the outlines of the
// slabs before and after a cut give those of its two sides.
#include "config/decomposition/cuts.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "config/decomposition/in_parallel.hpp"
#include "config/decomposition/rough_hull.hpp"

namespace clearance {
namespace {

constexpr std::size_t kSlabs = 14;
constexpr std::size_t kMostFaceCuts = 48;
// Weights of an uneven cut and of a long one, as shares of the open space.
constexpr double kUneven = 0.1, kLong = 2.0;
constexpr double kGain = 0.85;  // a cut that leaves less of the open space is good as it is
constexpr double kAtCut = 1.5;  // points so near to a plane are cut by it; times the spacing
constexpr double kWithin = 0.8, kBeside = 0.6;  // of the tolerance
constexpr std::size_t kMostOpen = 1500;         // points of the open space that compare cuts

// Sums over the open space in hulls: all of it, and that of hulls that need another cut.
struct OpenSum {
  double all = 0.0, unfinished = 0.0;
};

struct Candidate {
  HalfSpace plane;  // one side: n.x <= d
  Outline sides[2];
  OpenSum open = {};
  double uneven = 0.0;  // of two cuts that leave as much open space the one with less is better
};

double weight(const OpenPoint& point, double tolerance) {
  const double share = point.distance / tolerance;
  return share * share;
}

void add_open(const Outline& outline, const std::vector<OpenPoint>& open, double tolerance,
              double spacing, OpenSum& sum) {
  const std::vector<HalfSpace> hull = rough_hull(outline.points());
  if (hull.empty()) return;
  double here = 0.0, farthest = 0.0;
  for (const OpenPoint& point : open) {
    if (!holds(hull, point.position, 0.5 * spacing)) continue;
    here += weight(point, tolerance);
    farthest = std::max(farthest, point.distance);
  }
  sum.all += here;
  if (farthest - 0.5 * spacing > kWithin * tolerance) sum.unfinished += here;
}

// Returns what speaks against a cut that is as good as others: uneven sides, and a long cut through
// the mesh. A ring is cut across its wall.
double unevenness(const Piece& piece, const HalfSpace& plane, double spacing) {
  double above = 0.0, at = 0.0;
  for (const Vec3& point : piece.points) {
    const double height = plane.normal.dot(point) - plane.offset;
    above += height > 0.0 ? 1.0 : 0.0;
    at += std::abs(height) < kAtCut * spacing ? 1.0 : 0.0;
  }
  const auto all = static_cast<double>(piece.points.size());
  return kUneven * std::abs(2.0 * above / all - 1.0) + kLong * at / all;
}

Mat3 principal_axes(const std::vector<Vec3>& points) {
  Vec3 mean = Vec3::Zero();
  for (const Vec3& point : points) mean += point / static_cast<double>(points.size());
  Mat3 spread = Mat3::Zero();
  for (const Vec3& point : points) spread += (point - mean) * (point - mean).transpose();
  return Eigen::SelfAdjointEigenSolver<Mat3>(spread).eigenvectors();
}

void add_slabs(const Piece& piece, const Vec3& normal, std::vector<Candidate>& candidates) {
  double low = normal.dot(piece.points[0]), high = low;
  for (const Vec3& point : piece.points) {
    low = std::min(low, normal.dot(point));
    high = std::max(high, normal.dot(point));
  }
  if (!(high > low)) return;
  std::array<Outline, kSlabs> slabs;
  for (const Vec3& point : piece.points) {
    const auto slab = static_cast<std::size_t>((normal.dot(point) - low) / (high - low) * kSlabs);
    slabs[std::min(slab, kSlabs - 1)].add(point);
  }
  const std::size_t first = candidates.size();
  Outline before;
  for (std::size_t i = 1; i < kSlabs; ++i) {
    before.add(slabs[i - 1]);
    const double at = low + (high - low) * static_cast<double>(i) / kSlabs;
    candidates.push_back({{normal, at}, {before, {}}});
  }
  Outline after;
  for (std::size_t i = kSlabs - 1; i > 0; --i) {
    after.add(slabs[i]);
    candidates[first + i - 1].sides[1] = after;
  }
}

// Adds planes along each face and on either side of it, so that a wall is cut off together with its
// surroundings.
void add_faces(const Piece& piece, const std::vector<HalfSpace>& faces, double tolerance,
               std::vector<Candidate>& candidates) {
  const double overlap = kOverlap * tolerance;
  std::vector<HalfSpace> planes;
  for (const HalfSpace& face : faces) {
    for (const double beside : {0.0, -kBeside, kBeside}) {
      planes.push_back({face.normal, face.offset + beside * tolerance});
    }
  }
  std::size_t count = 0;
  for (const HalfSpace& face : planes) {
    Candidate candidate{face, {}};
    std::array<std::size_t, 2> points{};
    for (const Vec3& point : piece.points) {
      ++points[face.normal.dot(point) > face.offset ? 1 : 0];
    }
    if (std::min(points[0], points[1]) * 20 < piece.points.size()) continue;
    for (const Vec3& point : piece.points) {
      const double above = face.normal.dot(point) - face.offset;
      if (above <= overlap) candidate.sides[0].add(point);
      if (above >= -overlap) candidate.sides[1].add(point);
    }
    candidates.push_back(std::move(candidate));
    if (++count == kMostFaceCuts) return;
  }
}

}  // namespace

std::optional<HalfSpace> best_cut(const Piece& piece, const std::vector<HalfSpace>& faces,
                                  CutChoice choice, double tolerance, double spacing) {
  std::vector<Candidate> candidates;
  for (Eigen::Index axis = 0; axis < 3; ++axis) add_slabs(piece, Vec3::Unit(axis), candidates);
  const Mat3 axes = principal_axes(piece.points);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    if (axes.col(axis).cwiseAbs().maxCoeff() < 0.9999) add_slabs(piece, axes.col(axis), candidates);
  }
  add_faces(piece, faces, tolerance, candidates);

  const std::size_t step = piece.open.size() / kMostOpen + 1;
  std::vector<OpenPoint> open;
  for (std::size_t i = 0; i < piece.open.size(); i += step) open.push_back(piece.open[i]);
  in_parallel(candidates.size(), [&](std::size_t i) {
    candidates[i].uneven = unevenness(piece, candidates[i].plane, spacing);
    for (const Outline& side : candidates[i].sides) {
      add_open(side, open, tolerance, spacing, candidates[i].open);
    }
  });
  OpenSum whole;
  add_open(piece.outline, open, tolerance, spacing, whole);
  // Both sums count. No cut through a box of sheets makes the hulls smaller, but a cut that
  // separates a finished side is a gain as well.
  const auto plain = [](const Candidate& candidate) {
    return candidate.open.all + candidate.open.unfinished;
  };
  const auto best = std::ranges::min_element(candidates, {}, plain);
  if (best == candidates.end()) return std::nullopt;
  const bool gains = plain(*best) < kGain * (whole.all + whole.unfinished);
  if (choice == CutChoice::kLeastOpen || gains) return best->plane;
  return std::ranges::min_element(candidates, {},
                                  [&](const Candidate& candidate) {
                                    return plain(candidate) * (1.0 + candidate.uneven);
                                  })
      ->plane;
}

}  // namespace clearance
