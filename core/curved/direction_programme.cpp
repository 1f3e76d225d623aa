#include "core/curved/direction_programme.hpp"

#include <cmath>
#include <limits>

namespace clearance {
namespace {

// In the plane's coordinates after the change of variables that makes Q the identity: the dual
// problem is the least of |sum w_i slope_i|^2 / 2 + sum w_i value_i over weights >= 0 of sum 1. It
// is tried on all subsets of one to three functions. Each is a bound of the dual from above, so the
// least is the optimum, whatever rounding does to the others.
class Dual {
 public:
  Dual(const std::array<PlaneFunction, 5>& functions, std::size_t count) noexcept
      : f_(functions), count_(count) {}

  [[nodiscard]] PlaneStep solve() noexcept {
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

  // The step is not summed up from the weighted slopes, which may be long and cancel: along the
  // difference of both it is where they are equal, and across they agree.
  void two(std::size_t i, std::size_t j) noexcept {
    const Vec2 slope = f_[j].slope - f_[i].slope, across(-slope.y(), slope.x());
    const double square = slope.squaredNorm(), value = f_[j].value - f_[i].value;
    const double part = -(f_[i].slope.dot(slope) + value) / square;
    if (!(part > 0.0 && part < 1.0)) return;
    const Vec2 step = (f_[i].slope.dot(across) / square) * across - (value / square) * slope;
    take(step, f_[i].value + part * value, {i, j}, {1.0 - part, part});
  }

  // The step where all three are equal, and its weights.
  void three(std::size_t i, std::size_t j, std::size_t k) noexcept {
    const Vec2 u = f_[j].slope - f_[i].slope, v = f_[k].slope - f_[i].slope;
    const double du = f_[i].value - f_[j].value, dv = f_[i].value - f_[k].value;
    const double area = u.x() * v.y() - u.y() * v.x();
    const Vec2 step = Vec2(du * v.y() - dv * u.y(), dv * u.x() - du * v.x()) / area;
    const Vec2 rest = step - f_[i].slope;
    const double to_j = (rest.x() * v.y() - rest.y() * v.x()) / area;
    const double to_k = (u.x() * rest.y() - u.y() * rest.x()) / area;
    if (!(to_j > 0.0 && to_k > 0.0 && to_j + to_k < 1.0)) return;
    take(step, f_[i].value - to_j * du - to_k * dv, {i, j, k}, {1.0 - to_j - to_k, to_j, to_k});
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

PlaneStep highest_least(const std::array<PlaneFunction, 5>& functions, std::size_t count,
                        const PlaneMatrix& q) noexcept {
  // Q = L L^T; with s = L^-T r, Q becomes the identity and a slope L^-1 slope.
  const double xx = std::sqrt(q.xx), xy = q.xy / xx, yy = std::sqrt(q.yy - xy * xy);
  std::array<PlaneFunction, 5> scaled{};
  for (std::size_t i = 0; i < count; ++i) {
    const Vec2& slope = functions[i].slope;
    const double x = slope.x() / xx;
    scaled[i] = {functions[i].value, Vec2(x, (slope.y() - xy * x) / yy)};
  }
  PlaneStep found = Dual(scaled, count).solve();
  const double y = found.step.y() / yy;
  found.step = Vec2((found.step.x() - xy * y) / xx, y);
  return found;
}

}  // namespace clearance
