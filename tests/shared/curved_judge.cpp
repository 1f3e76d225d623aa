#include "tests/shared/curved_judge.hpp"

#include <algorithm>
#include <cmath>

#include "tests/shared/random.hpp"

namespace clearance {
namespace {

using oracle::Real;

constexpr double kPromised = 1e-13;
constexpr double kTruthDigits = 1e-20;  // relative to the size
constexpr int kDirections = 40, kClimbs = 200;

double bounding_radius_of(const oracle::CurvedBody& body) {
  double radius = body.shape.semi_axes.maxCoeff();
  for (const Disc& disc : body.shape.discs) {
    radius = std::max(radius, std::hypot(disc.height, disc.radius));
  }
  for (const Vec3& p : body.points) radius = std::max(radius, p.norm());
  return radius + body.radius;
}

std::string text(const char* what, const Real& is, const Real& other) {
  return std::string(what) + ": " + is.str(25) + " beside " + other.str(25);
}

}  // namespace

CurvedJudge::CurvedJudge(const hard::CurvedCase& asked)
    : case_(asked),
      size_(bounding_radius_of(asked.a) + bounding_radius_of(asked.b) +
            2.0 * (asked.pose_a.position - asked.pose_b.position).norm()),
      truth_(oracle::curved_truth(case_.placed_a(), case_.placed_b(), kTruthDigits * size_)) {}

std::vector<std::string> CurvedJudge::faults(const DistanceResult& r) const {
  std::vector<std::string> faults;
  if (!(r.lower <= r.distance && r.distance <= r.upper)) faults.emplace_back("numbers in disorder");
  if (!std::isfinite(r.lower) || !std::isfinite(r.upper)) faults.emplace_back("infinite bounds");
  if (!faults.empty()) return faults;
  judge_bounds(r, faults);
  if (cores_meet()) {
    judge_depth(r, faults);
  } else {
    judge_points(r, faults);
  }
  return faults;
}

void CurvedJudge::judge_bounds(const DistanceResult& r, std::vector<std::string>& faults) const {
  if (Real(r.lower) > truth_.upper) {
    faults.push_back(text("lower bound above the truth", Real(r.lower), truth_.upper));
  }
  if (!cores_meet() && Real(r.upper) < truth_.lower) {
    faults.push_back(text("upper bound below the truth", Real(r.upper), truth_.lower));
  }
  if (r.status == DistanceStatus::kIterationLimit) return;
  const Real tolerance = kPromised * size_;
  if (Real(r.upper) - Real(r.lower) > tolerance) {
    faults.push_back(text("converged with wide bounds", Real(r.lower), Real(r.upper)));
  }
  if (!cores_meet() && abs(Real(r.distance) - truth_.lower) > tolerance) {
    faults.push_back(text("distance far from the truth", Real(r.distance), truth_.lower));
  }
}

void CurvedJudge::judge_depth(const DistanceResult& r, std::vector<std::string>& faults) const {
  const Vec3 n = case_.pose_a.orientation.normalized() * r.normal;
  const Real proved = oracle::apart_along(case_.placed_a(), case_.placed_b(), n);
  if (Real(r.lower) > proved + 1e-15 * size_) {
    faults.push_back(text("lower bound above what its normal proves", Real(r.lower), proved));
  }
  const Real apart = farthest_apart();
  if (Real(r.upper) < apart) {
    faults.push_back(text("upper bound below what a direction proves", Real(r.upper), apart));
  }
}

Real CurvedJudge::farthest_apart() const {
  Random random(1);
  const auto along = [&](const Vec3& n) {
    return oracle::apart_along(case_.placed_a(), case_.placed_b(), n);
  };
  Vec3 best = random.direction();
  Real most = along(best);
  for (int k = 0; k < kDirections + kClimbs; ++k) {
    const double off = std::exp2(-0.2 * (k - kDirections));
    const Vec3 n =
        k < kDirections ? random.direction() : Vec3((best + off * random.direction()).normalized());
    const Real apart = along(n);
    if (apart > most) {
      most = apart;
      best = n;
    }
  }
  return most;
}

void CurvedJudge::judge_points(const DistanceResult& r, std::vector<std::string>& faults) const {
  if (r.lower <= 0.0 || r.status == DistanceStatus::kIterationLimit) return;
  const double tolerance = kPromised * size_;
  if (std::abs((r.point_on_b - r.point_on_a).norm() - r.distance) > tolerance) {
    faults.emplace_back("witness points are not the distance apart");
  }
  const auto is_on = [&](const Vec3& in_a, const oracle::PlacedCurvedBody& placed) {
    oracle::CurvedBody at;
    at.points = {in_a};
    const auto off = oracle::curved_truth({&at, case_.pose_a}, placed, 0.1 * tolerance);
    return off.upper <= tolerance;
  };
  if (!is_on(r.point_on_a, case_.placed_a())) faults.emplace_back("a witness point is not on A");
  if (!is_on(r.point_on_b, case_.placed_b())) faults.emplace_back("a witness point is not on B");
}

}  // namespace clearance
