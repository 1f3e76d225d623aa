#include "tests/shared/exact_depth.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/shared/exact_features.hpp"
#include "tests/shared/exact_placement.hpp"

namespace clearance::oracle {
namespace {

// Directions whose sine is above this limit are accurate to 1e-10 in doubles.
constexpr double kCrossing = 1e-5;

constexpr std::size_t kCornersAsked = 8;

Vec3 rounded(const RationalVec& v) {
  const IntegerVec p = primitive(v);
  long exponent = 0;
  for (const Integer& x : p) {
    exponent = std::max(exponent, static_cast<long>(mpz_sizeinbase(x.get_mpz_t(), 2)));
  }
  Vec3 out;
  for (int k = 0; k < 3; ++k) {
    long e = 0;
    const double mantissa = mpz_get_d_2exp(&e, p[static_cast<std::size_t>(k)].get_mpz_t());
    out[k] = std::ldexp(mantissa, static_cast<int>(e - exponent));
  }
  return out.normalized();
}

// Keeps each direction once, regardless of its length and sign.
void drop_parallels(std::vector<RationalVec>& edges) {
  std::set<IntegerVec> seen;
  std::erase_if(edges, [&](const RationalVec& edge) {
    IntegerVec p = primitive(edge);
    const Integer first = p[0] != 0 ? p[0] : p[1] != 0 ? p[1] : p[2];
    if (first < 0) p = {-p[0], -p[1], -p[2]};
    return !seen.insert(p).second;
  });
}

class Search {
 public:
  Search(const Body& a, const Pose& pose_a, const Body& b, const Pose& pose_b)
      : a_(a), b_(b), place_(pose_a, pose_b) {}

  // Computes exactly how far B must move along n (frame A, any length), and keeps the value if it
  // is the smallest so far.
  void look(const RationalVec& n) {
    if (is_zero(n) || a_corner_is_as_far(n)) return;
    const std::optional<RationalVec> corner = remember_corner(n);
    if (!corner) return;
    const Rational support_value = dot(n, *corner);
    const Rational squared =
        support_value <= 0 ? Rational(0) : Rational(support_value * support_value / dot(n, n));
    if (!best_ || squared < *best_) best_ = squared;
    root_ = std::sqrt(best_->get_d());
  }

  // Estimates the same value in doubles from the vertices known so far. Further vertices can only
  // increase it.
  [[nodiscard]] bool hopeless(const Vec3& n) {
    if (!best_) return false;
    double least = -1e300;
    for (const Vec3& corner : rounded_corners_) least = std::max(least, corner.dot(n));
    return least > root_ + 1e-9 * (root_ + size_);
  }
  // The vertex of {a - b} that is the support point along n, if there is one.
  std::optional<RationalVec> remember_corner(const RationalVec& n) {
    const Support on_a = a_.support(primitive(n));
    if (on_a.is_ray) return {};
    const Support on_b = b_.support(primitive(Rational(-1) * place_.b_direction(n)));
    if (on_b.is_ray) return {};
    corners_.push_back(on_a.vector -
                       (place_.a_from_b_rotation * on_b.vector + place_.a_from_b_translation));
    rounded_corners_.push_back(to_vec(corners_.back()));
    size_ = std::max(size_, rounded_corners_.back().norm());
    return corners_.back();
  }

  [[nodiscard]] const Placement& place() const { return place_; }
  [[nodiscard]] const std::optional<Rational>& best() const { return best_; }

 private:
  // For neighbouring directions, the support point is usually among the latest vertices.
  [[nodiscard]] bool a_corner_is_as_far(const RationalVec& n) const {
    if (!best_) return false;
    const Rational enough = *best_ * dot(n, n);
    const std::size_t count = std::min(corners_.size(), kCornersAsked);
    return std::any_of(corners_.end() - static_cast<std::ptrdiff_t>(count), corners_.end(),
                       [&](const RationalVec& corner) {
                         const Rational support_value = dot(n, corner);
                         return support_value >= 0 && support_value * support_value >= enough;
                       });
  }

  ExactBody a_, b_;
  Placement place_;
  std::vector<RationalVec> corners_;
  std::vector<Vec3> rounded_corners_;
  double size_ = 0.0, root_ = 0.0;
  std::optional<Rational> best_;
};

}  // namespace

std::optional<Rational> exact_squared_depth(const Body& a, const Pose& world_from_a, const Body& b,
                                            const Pose& world_from_b) {
  Search search(a, world_from_a, b, world_from_b);
  Features on_a = features_of(a), on_b = features_of(b);
  for (RationalVec& n : on_b.normals) {
    n = Rational(-1) * (search.place().a_from_b_rotation * n);
  }
  for (RationalVec& e : on_b.edges) e = search.place().a_from_b_rotation * e;
  drop_parallels(on_a.edges);
  drop_parallels(on_b.edges);

  for (int k = 0; k < 125; ++k) {
    const int x = k % 5 - 2, y = k / 5 % 5 - 2, z = k / 25 - 2;
    if (std::max({std::abs(x), std::abs(y), std::abs(z)}) == 2) search.remember_corner({x, y, z});
  }
  const auto try_unless_hopeless = [&](const RationalVec& n) {
    if (!is_zero(n) && !search.hopeless(rounded(n))) search.look(n);
  };
  for (const RationalVec& n : on_a.normals) try_unless_hopeless(n);
  for (const RationalVec& n : on_b.normals) try_unless_hopeless(n);
  std::vector<Vec3> rounded_b;
  for (const RationalVec& f : on_b.edges) rounded_b.push_back(rounded(f));
  for (const RationalVec& e : on_a.edges) {
    const Vec3 rounded_e = rounded(e);
    for (std::size_t k = 0; k < on_b.edges.size(); ++k) {
      const Vec3 across = rounded_e.cross(rounded_b[k]);
      const double sine = across.norm();
      const bool unsure = sine < kCrossing;
      if (unsure || !search.hopeless(across / sine)) search.look(cross(e, on_b.edges[k]));
      if (unsure || !search.hopeless(-across / sine)) {
        search.look(Rational(-1) * cross(e, on_b.edges[k]));
      }
    }
  }
  // Points and segments have no interior, and may have no normals or edges.
  const auto flat = [](const Body& body) { return body.rows.empty() && body.points.size() < 3; };
  if (flat(a) && flat(b)) return Rational(0);
  return search.best();
}

}  // namespace clearance::oracle
