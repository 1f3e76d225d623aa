#include "core/curved/max_min_programme.hpp"

#include <cmath>
#include <limits>

namespace clearance {
namespace {

// The step at which two or three functions are equal; for two functions, the one with the greatest
// value. The weights have sum 1. If one is negative, fewer functions are active at the optimum.
struct MeetingPoint {
  Vec2 step = Vec2::Zero();
  std::array<double, 3> weights{};
};

// The step is not computed as the sum of the weighted slopes, which may be long and cancel. Along
// the difference of the slopes, it leads to the place where the functions are equal. Across that
// difference, both slopes agree.
MeetingPoint meeting_of(const PlaneFunction& f, const PlaneFunction& g) noexcept {
  const Vec2 slope = g.slope - f.slope, across(-slope.y(), slope.x());
  const double square = slope.squaredNorm(), value = g.value - f.value;
  const double part = -(f.slope.dot(slope) + value) / square;
  return {(f.slope.dot(across) / square) * across - (value / square) * slope,
          {1.0 - part, part, 0.0}};
}

// The step where all three are equal, and its weights.
MeetingPoint meeting_of(const PlaneFunction& f, const PlaneFunction& g,
                        const PlaneFunction& h) noexcept {
  const Vec2 u = g.slope - f.slope, v = h.slope - f.slope;
  const double du = f.value - g.value, dv = f.value - h.value;
  const double area = u.x() * v.y() - u.y() * v.x();
  const Vec2 step = Vec2(du * v.y() - dv * u.y(), dv * u.x() - du * v.x()) / area;
  const Vec2 rest = step - f.slope;
  const double to_g = (rest.x() * v.y() - rest.y() * v.x()) / area;
  const double to_h = (u.x() * rest.y() - u.y() * rest.x()) / area;
  return {step, {1.0 - to_g - to_h, to_g, to_h}};
}

// The change of variables that makes Q the identity. With Q = L L^T and s = L^-T r, Q becomes the
// identity, and a slope becomes L^-1 slope.
struct Scaling {
  double xx, xy, yy;

  explicit Scaling(const PlaneMatrix& q) noexcept
      : xx(std::sqrt(q.xx)), xy(q.xy / xx), yy(std::sqrt(q.yy - xy * xy)) {}
  [[nodiscard]] PlaneFunction operator()(const PlaneFunction& f) const noexcept {
    const double x = f.slope.x() / xx;
    return {f.value, Vec2(x, (f.slope.y() - xy * x) / yy)};
  }
  [[nodiscard]] Vec2 back(const Vec2& step) const noexcept {
    const double y = step.y() / yy;
    return {(step.x() - xy * y) / xx, y};
  }
};

// After the change of variables that makes Q the identity, the dual problem (P. Wolfe, Q. Appl.
// Math. 19, 1961) is to minimise |sum w_i slope_i|^2 / 2 + sum w_i value_i over weights >= 0 of sum
// 1. All subsets of one to three functions are tried. Each bounds the dual from above, so the least
// one is the optimum, whatever rounding does to the others.
class Dual {
 public:
  Dual(const std::array<PlaneFunction, 5>& functions, std::size_t count) noexcept
      : f_(functions), count_(count) {}

  [[nodiscard]] PlaneStep solve() noexcept {
    if (count_ == 1) {
      one(0);
      return best_;
    }
    for (std::size_t i = 0; i < count_; ++i) {
      one(i);
      for (std::size_t j = 0; j < i; ++j) {
        two(i, j);
        for (std::size_t k = 0; k < j; ++k) three(i, j, k);
      }
    }
    return best_;
  }

 private:
  void one(std::size_t i) noexcept { take(f_[i].slope, f_[i].value, {i}, {1.0}); }

  void two(std::size_t i, std::size_t j) noexcept {
    const auto [step, weights] = meeting_of(f_[i], f_[j]);
    const double part = weights[1];
    if (!(part > 0.0 && part < 1.0)) return;
    take(step, f_[i].value + part * (f_[j].value - f_[i].value), {i, j}, {1.0 - part, part});
  }

  void three(std::size_t i, std::size_t j, std::size_t k) noexcept {
    const auto [step, weights] = meeting_of(f_[i], f_[j], f_[k]);
    const auto [of_i, of_j, of_k] = weights;
    if (!(of_j > 0.0 && of_k > 0.0 && of_j + of_k < 1.0)) return;
    const double value =
        f_[i].value + of_j * (f_[j].value - f_[i].value) + of_k * (f_[k].value - f_[i].value);
    take(step, value, {i, j, k}, {of_i, of_j, of_k});
  }

  template <std::size_t N>
  void take(const Vec2& step, double value, const std::size_t (&at)[N],
            const double (&weights)[N]) noexcept {
    const double dual = value + 0.5 * step.squaredNorm();
    if (!(dual < best_dual_)) return;
    best_dual_ = dual;
    best_ = {step, dual, {}};
    for (std::size_t n = 0; n < N; ++n) best_.weights[at[n]] = weights[n];
  }

  const std::array<PlaneFunction, 5>& f_;
  std::size_t count_;
  PlaneStep best_;
  double best_dual_ = std::numeric_limits<double>::infinity();
};

}  // namespace

PlaneStep max_min(const std::array<PlaneFunction, 5>& functions, std::size_t count,
                  const PlaneMatrix& q) noexcept {
  const Scaling scaling(q);
  std::array<PlaneFunction, 5> scaled{};
  for (std::size_t i = 0; i < count; ++i) scaled[i] = scaling(functions[i]);
  PlaneStep found = Dual(scaled, count).solve();
  found.step = scaling.back(found.step);
  return found;
}

}  // namespace clearance
