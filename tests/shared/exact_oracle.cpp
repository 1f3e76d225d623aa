#include "tests/shared/exact_oracle.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "tests/shared/exact_placement.hpp"

namespace clearance::oracle {
namespace {

// A vertex or a ray of {b - a}, and the parts of each body that it consists of; all in frame A.
struct Generator {
  RationalVec difference, p_a, p_b;
  bool is_ray;
};

// Solves m x = r for a regular m by elimination.
std::vector<Rational> solve(std::vector<std::vector<Rational>> m, std::vector<Rational> r) {
  const std::size_t n = r.size();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t p = k;
    while (p < n && m[p][k] == 0) ++p;
    if (p == n) throw std::logic_error("dependent generators");
    std::swap(m[k], m[p]);
    std::swap(r[k], r[p]);
    for (std::size_t i = 0; i < n; ++i) {
      if (i == k || m[i][k] == 0) continue;
      const Rational factor = m[i][k] / m[k][k];
      for (std::size_t j = k; j < n; ++j) m[i][j] -= factor * m[k][j];
      r[i] -= factor * r[k];
    }
  }
  for (std::size_t k = 0; k < n; ++k) r[k] /= m[k][k];
  return r;
}

// The corral of Wolfe's method: affinely independent generators with non-negative weights, and the
// point of their hull that is nearest to the origin. The weights of the vertices add up to one.
class Corral {
 public:
  void add(Generator generator) {
    weights_.emplace_back(generators_.empty() ? 1 : 0);
    generators_.push_back(std::move(generator));
    while (true) {
      const std::vector<Rational> target = affine_minimum();
      Rational step = 1;
      for (std::size_t k = 0; k < target.size(); ++k) {
        if (target[k] >= 0) continue;
        const Rational limit = weights_[k] / (weights_[k] - target[k]);
        if (limit < step) step = limit;
      }
      for (std::size_t k = 0; k < target.size(); ++k) {
        weights_[k] += step * (target[k] - weights_[k]);
      }
      drop_unused();
      if (step == 1) return;
    }
  }

  [[nodiscard]] RationalVec sum(RationalVec Generator::*part) const {
    RationalVec out;
    for (std::size_t k = 0; k < weights_.size(); ++k) {
      out = out + weights_[k] * (generators_[k].*part);
    }
    return out;
  }

  [[nodiscard]] bool weights_are_convex() const {
    Rational total = 0;
    for (std::size_t k = 0; k < weights_.size(); ++k) {
      if (weights_[k] < 0) return false;
      if (!generators_[k].is_ray) total += weights_[k];
    }
    return total == 1;
  }

 private:
  // The weights of the point that is nearest to the origin in the affine hull.
  [[nodiscard]] std::vector<Rational> affine_minimum() const {
    const std::size_t n = generators_.size();
    std::vector<std::vector<Rational>> m(n + 1, std::vector<Rational>(n + 1, 0));
    std::vector<Rational> r(n + 1, 0);
    r[n] = 1;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        m[i][j] = dot(generators_[i].difference, generators_[j].difference);
      }
      if (!generators_[i].is_ray) m[i][n] = m[n][i] = 1;
    }
    std::vector<Rational> x = solve(std::move(m), std::move(r));
    x.pop_back();
    return x;
  }

  void drop_unused() {
    for (std::size_t k = weights_.size(); k-- > 0;) {
      if (weights_[k] != 0) continue;
      weights_.erase(weights_.begin() + static_cast<std::ptrdiff_t>(k));
      generators_.erase(generators_.begin() + static_cast<std::ptrdiff_t>(k));
    }
  }

  std::vector<Generator> generators_;
  std::vector<Rational> weights_;
};

// The next generator of {b - a}: its support point or ray in the direction from `nearest` to the
// origin.
Generator next_generator(ExactBody& a, ExactBody& b, const Placement& place,
                         const RationalVec& nearest) {
  const Rational minus_one = -1;
  const RationalVec zero;
  const Support on_a = a.support(primitive(nearest));
  if (on_a.is_ray) return {minus_one * on_a.vector, on_a.vector, zero, true};
  const Support on_b = b.support(primitive(minus_one * place.b_direction(nearest)));
  RationalVec p_b = place.a_from_b_rotation * on_b.vector;
  if (on_b.is_ray) return {p_b, zero, p_b, true};
  p_b = p_b + place.a_from_b_translation;
  return {p_b - on_a.vector, on_a.vector, p_b, false};
}

// Proves that (p, q) is a closest pair. Both points must lie in their bodies. The planes through
// them, normal to the line between them, must have all of A on one side and all of B on the other.
void prove_optimal(const ExactBody& a, const ExactBody& b, const Placement& place,
                   const Corral& corral, const RationalVec& p, const RationalVec& q) {
  const RationalVec gap = q - p;
  const RationalVec q_in_b = place.b_direction(q - place.a_from_b_translation);
  if (!corral.weights_are_convex()) throw std::logic_error("weights are not convex");
  if (a.given_by_rows() && !a.rows_hold_at(p)) throw std::logic_error("point outside A");
  if (b.given_by_rows() && !b.rows_hold_at(q_in_b)) throw std::logic_error("point outside B");
  if (is_zero(gap)) return;
  if (!a.proves_bound(gap, dot(gap, p))) throw std::logic_error("A reaches further");
  const RationalVec back = Rational(-1) * place.b_direction(gap);
  if (!b.proves_bound(back, dot(back, q_in_b))) throw std::logic_error("B reaches further");
}

void enclose(ExactDistance& out) {
  constexpr int kBits = 1024;
  mpf_class root(out.squared, kBits);
  root = sqrt(root) - sqrt(mpf_class(out.squared_depth, kBits)) - mpf_class(out.radii, kBits);
  constexpr double kUp = std::numeric_limits<double>::infinity();
  double value = root.get_d();
  while (out.compare(value) < 0) value = std::nextafter(value, -kUp);
  while (out.compare(std::nextafter(value, kUp)) >= 0) value = std::nextafter(value, kUp);
  out.lower = value;
  out.upper = out.compare(value) == 0 ? value : std::nextafter(value, kUp);
}

}  // namespace

int ExactDistance::compare(const Rational& value) const {
  const Rational core = value + radii;
  if (squared_depth != 0) return core >= 0 ? -1 : cmp(Rational(core * core), squared_depth);
  if (core < 0) return 1;
  return cmp(squared, Rational(core * core));
}

int ExactDistance::compare(double value) const {
  if (std::isnan(value)) throw std::invalid_argument("comparing with a NaN");
  if (std::isinf(value)) return value > 0 ? -1 : 1;
  return compare(Rational(value));
}

void ExactDistance::add_radii(double p_a, double p_b) {
  radii += Rational(p_a) + Rational(p_b);
  enclose(*this);
}

void ExactDistance::set_squared_depth(const Rational& value) {
  squared_depth = value;
  enclose(*this);
}

ExactDistance exact_distance(ExactBody& a, const Pose& world_from_a, ExactBody& b,
                             const Pose& world_from_b) {
  const Placement place(world_from_a, world_from_b);
  ExactDistance out;
  Corral corral;
  RationalVec start_a = a.support({0, 0, 0}).vector;
  RationalVec start_b = place.a_from_b_rotation * b.support({0, 0, 0}).vector;
  start_b = start_b + place.a_from_b_translation;
  corral.add({start_b - start_a, start_a, start_b, false});
  while (true) {
    const RationalVec nearest = corral.sum(&Generator::difference);
    out.squared = dot(nearest, nearest);
    ++out.steps;
    if (out.squared == 0) break;
    Generator next = next_generator(a, b, place, nearest);
    const Rational support_value = dot(nearest, next.difference);
    if (!next.is_ray && support_value >= out.squared) break;
    corral.add(std::move(next));
  }
  const RationalVec p = corral.sum(&Generator::p_a), q = corral.sum(&Generator::p_b);
  prove_optimal(a, b, place, corral, p, q);
  out.point_on_a = exact(world_from_a.position) + place.world_a * p;
  out.point_on_b = exact(world_from_a.position) + place.world_a * q;
  enclose(out);
  return out;
}

ExactDistance exact_distance(const Body& a, const Pose& world_from_a, const Body& b,
                             const Pose& world_from_b) {
  ExactBody exact_a(a), exact_b(b);
  ExactDistance out = exact_distance(exact_a, world_from_a, exact_b, world_from_b);
  out.add_radii(a.radius, b.radius);
  return out;
}

}  // namespace clearance::oracle
