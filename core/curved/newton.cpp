#include "core/curved/newton.hpp"

#include <algorithm>
#include <cmath>

#include "core/curved/direction_programme.hpp"
#include "core/curved/placed_body.hpp"

namespace clearance {
namespace {

constexpr int kSteps = 5;
// The witness points are along the direction to this, or to rounding.
constexpr double kAlong = 0x1p-34;
// A direction so near to the axis of a truncated cone is left to others.
constexpr double kLargestTurn = 0x1p30;

// One of the pairs of pieces that are active.
struct ActivePair {
  PlacedPiece a, b;
  Vec3 difference;  // from A's support point to B's
  double weight;
};

class Newton {
 public:
  Newton(CurvedPair& pair, const ActivePieces& active, Vec3& n) noexcept
      : pair_(pair),
        active_(active),
        n_(n),
        a_(*pair.a.body, kNotTurned, kOrigin),
        b_(*pair.b.body, pair.rotation(), pair.translation()) {
    const double equal = 1.0 / static_cast<double>(active.count);
    for (std::size_t i = 0; i < active.count; ++i) {
      const auto& [a, b] = active.pieces[i];
      pairs_[i] = {a_.piece(a), b_.piece(b), Vec3::Zero(), equal};
    }
  }

  NewtonEnd run() noexcept {
    double before = 0.0;
    for (end_.supports = 1; end_.supports <= kSteps; ++end_.supports) {
      look();
      const double gain = least_ - before;
      // Steps that lead nowhere are left to the search, which shortens them.
      if (!(least_ > 0.0) || !(gain > -pair_.gap_tolerance())) break;
      before = least_;
      const double trace = hessian_.trace();
      if (!(trace < kLargestTurn * pair_.size) || !find_step()) break;
      const double square = step_.squaredNorm();
      n_ = (n_ + step_).normalized();
      // The next step would be about the square of this one.
      if (square * trace > kAlong * least_) continue;
      ++end_.supports;
      certify();
      break;
    }
    return end_;
  }

 private:
  static inline const Mat3 kNotTurned = Mat3::Identity();
  static inline const Vec3 kOrigin = Vec3::Zero();

  // What there is to know at n_.
  void look() noexcept {
    const PlacedView a = a_.view(n_), b = b_.view(n_);
    least_ = kInfinity;
    double radii_a = 0.0, radii_b = 0.0;
    for (std::size_t i = 0; i < active_.count; ++i) {
      ActivePair& p = pairs_[i];
      p.difference = (p.b.middle - p.b.radius * b.out) - (p.a.middle + p.a.radius * a.out);
      least_ = std::min(least_, n_.dot(p.difference));
      radii_a += p.weight * p.a.radius;
      radii_b += p.weight * p.b.radius;
    }
    hessian_ = {least_, 0.0, 0.0, least_, 0.0, least_};
    hessian_.add(radii_a, a.turn);
    hessian_.add(radii_b, b.turn);
  }

  [[nodiscard]] bool find_step() noexcept {
    if (active_.count > 1) return meet();
    const Vec3& w = pairs_[0].difference;
    step_ = hessian_.solve(w - least_ * n_);
    return true;
  }

  // To the direction in which all functions are equal, and their weights there. False: one of them
  // has no weight, which means that fewer count.
  [[nodiscard]] bool meet() noexcept {
    const bool x = std::abs(n_.x()) < 0.6;
    const Vec3 along = x ? Vec3(0.0, n_.z(), -n_.y()) : Vec3(-n_.z(), 0.0, n_.x());
    const Vec3 u = along / along.norm(), v = n_.cross(u);
    const Vec3 of_u = hessian_ * u, of_v = hessian_ * v;
    std::array<PlaneFunction, 3> functions{};
    for (std::size_t i = 0; i < active_.count; ++i) {
      const Vec3& w = pairs_[i].difference;
      functions[i] = {n_.dot(w) - least_, Vec2(u.dot(w), v.dot(w))};
    }
    const MeetingPoint met =
        meeting_point(functions, active_.count, {u.dot(of_u), u.dot(of_v), v.dot(of_v)});
    step_ = met.step.x() * u + met.step.y() * v;
    for (std::size_t i = 0; i < active_.count; ++i) {
      pairs_[i].weight = met.weights[i];
      if (!(met.weights[i] >= 0.0)) return false;
    }
    return true;
  }

  // Bounds at n_, of all pieces, and in the bodies' own frames. Means of support points are points
  // of the bodies.
  void certify() noexcept {
    const SupportPair best = pair_.support(n_);
    PointPair mean = best.points;
    if (active_.count > 1) {
      mean = {};
      for (std::size_t i = 0; i < active_.count; ++i) {
        const PiecePair& pieces = active_.pieces[i];
        const PointPair points =
            pieces == best.pieces ? best.points : pair_.support_of(pieces, n_).points;
        mean.a += pairs_[i].weight * points.a;
        mean.own_b += pairs_[i].weight * points.own_b;
      }
      mean.b = pair_.point_to_a(mean.own_b);
    }
    const Vec3 difference = mean.difference();
    const double upper = difference.norm();
    const Vec3 across = difference - n_.dot(difference) * n_;
    const double limit = std::max(4.0 * kAlong * upper, 8.0 * pair_.gap_tolerance());
    if (!(across.squaredNorm() <= limit * limit)) return;
    pair_.bounds.upper = upper;
    pair_.bounds.points = mean;
    end_.tight = pair_.is_tight();
  }

  CurvedPair& pair_;
  const ActivePieces& active_;
  Vec3& n_;
  PlacedBody a_, b_;
  std::array<ActivePair, 3> pairs_;
  double least_ = 0.0;  // how far the active pieces are apart along n_, m
  SymmetricMatrix hessian_;
  Vec3 step_;
  NewtonEnd end_;
};

}  // namespace

NewtonEnd refine_direction(CurvedPair& pair, const ActivePieces& active, Vec3& n) noexcept {
  const bool bounded = pair.a.body->bounded() && pair.b.body->bounded();
  if (active.count == 0 || !bounded) return {};
  return Newton(pair, active, n).run();
}

}  // namespace clearance
