#include "tests/shared/exact_depth.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/shared/exact_placement.hpp"

namespace clearance::oracle {
namespace {

// Directions whose sine is above this are good to 1e-10 in doubles.
constexpr double kCrossing = 1e-5;

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

// One body's facet normals and edge directions in frame A, with repetitions.
struct Features {
  std::vector<RationalVec> normals, edges;
};

// Does the line where rows i and j meet run along the body? Clips it by all other rows.
bool is_edge(const std::vector<HalfSpace>& rows, std::size_t i, std::size_t j) {
  const RationalVec n = exact(rows[i].normal), m = exact(rows[j].normal);
  const RationalVec along = cross(n, m);
  if (is_zero(along)) return false;
  const Rational length2 = dot(along, along);
  const RationalVec on_line = (Rational(rows[i].offset) / length2) * cross(m, along) +
                              (Rational(rows[j].offset) / length2) * cross(along, n);
  std::optional<Rational> begin, end;
  for (const HalfSpace& row : rows) {
    const RationalVec k = exact(row.normal);
    const Rational slope = dot(k, along), room = Rational(row.offset) - dot(k, on_line);
    if (slope == 0) {
      if (room < 0) return false;
      continue;
    }
    const Rational at = room / slope;
    std::optional<Rational>& limit = slope > 0 ? end : begin;
    if (!limit || (slope > 0 ? at < *limit : at > *limit)) limit = at;
  }
  return !begin || !end || *begin < *end;
}

Features features_of(const Body& body) {
  Features out;
  for (std::size_t i = 0; i < body.rows.size(); ++i) {
    out.normals.push_back(exact(body.rows[i].normal));
    for (std::size_t j = 0; j < i; ++j) {
      if (!is_edge(body.rows, i, j)) continue;
      out.edges.push_back(cross(exact(body.rows[i].normal), exact(body.rows[j].normal)));
    }
  }
  if (!body.rows.empty()) return out;
  for (std::size_t i = 0; i < body.points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      out.edges.push_back(exact(body.points[i]) - exact(body.points[j]));
      for (std::size_t k = 0; k < j; ++k) {
        const RationalVec other = exact(body.points[k]) - exact(body.points[j]);
        out.normals.push_back(cross(out.edges.back(), other));
        out.normals.push_back(Rational(-1) * out.normals.back());
      }
    }
  }
  return out;
}

// The same direction once, whatever its length and sign.
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

  // Along n (frame A, any length): the exact square of how far B must go; nothing if for ever.
  void look(const RationalVec& n) {
    if (is_zero(n)) return;
    const Support of_a = a_.support(primitive(n));
    if (of_a.is_ray) return;
    const RationalVec m = Rational(-1) * place_.b_direction(n);
    const Support of_b = b_.support(primitive(m));
    if (of_b.is_ray) return;
    const Rational reach =
        dot(n, of_a.vector) + dot(m, of_b.vector) - dot(n, place_.a_from_b_translation);
    if (reach <= 0) {
      best_ = 0;
      root_ = 0.0;
      return;
    }
    const Rational squared = reach * reach / dot(n, n);
    if (!best_ || squared < *best_) best_ = squared;
    root_ = std::sqrt(best_->get_d());
  }

  // Nearly the same in doubles, from any corners that are known; more of them only make it larger.
  [[nodiscard]] bool hopeless(const Vec3& n) {
    if (!best_) return false;
    double least = -1e300;
    for (const Vec3& corner : corners_) least = std::max(least, corner.dot(n));
    return least > root_ + 1e-9 * (root_ + size_);
  }
  void remember_corner(const RationalVec& n) {
    const Support of_a = a_.support(primitive(n));
    const Support of_b = b_.support(primitive(Rational(-1) * place_.b_direction(n)));
    if (of_a.is_ray || of_b.is_ray) return;
    const RationalVec c =
        of_a.vector - (place_.a_from_b_rotation * of_b.vector + place_.a_from_b_translation);
    corners_.emplace_back(c[0].get_d(), c[1].get_d(), c[2].get_d());
    size_ = std::max(size_, corners_.back().norm());
  }

  [[nodiscard]] const Placement& place() const { return place_; }
  [[nodiscard]] const std::optional<Rational>& best() const { return best_; }

 private:
  ExactBody a_, b_;
  Placement place_;
  std::vector<Vec3> corners_;
  double size_ = 0.0, root_ = 0.0;
  std::optional<Rational> best_;
};

}  // namespace

std::optional<Rational> exact_squared_depth(const Body& a, const Pose& world_from_a, const Body& b,
                                            const Pose& world_from_b) {
  Search search(a, world_from_a, b, world_from_b);
  Features of_a = features_of(a), of_b = features_of(b);
  for (RationalVec& n : of_b.normals) {
    n = Rational(-1) * (search.place().a_from_b_rotation * n);
  }
  for (RationalVec& e : of_b.edges) e = search.place().a_from_b_rotation * e;
  drop_parallels(of_a.edges);
  drop_parallels(of_b.edges);

  for (int k = 0; k < 125; ++k) {
    const int x = k % 5 - 2, y = k / 5 % 5 - 2, z = k / 25 - 2;
    if (std::max({std::abs(x), std::abs(y), std::abs(z)}) == 2) search.remember_corner({x, y, z});
  }
  const auto try_unless_hopeless = [&](const RationalVec& n) {
    if (!is_zero(n) && !search.hopeless(rounded(n))) search.look(n);
  };
  for (const RationalVec& n : of_a.normals) try_unless_hopeless(n);
  for (const RationalVec& n : of_b.normals) try_unless_hopeless(n);
  std::vector<Vec3> rounded_b;
  for (const RationalVec& f : of_b.edges) rounded_b.push_back(rounded(f));
  for (const RationalVec& e : of_a.edges) {
    const Vec3 rounded_e = rounded(e);
    for (std::size_t k = 0; k < of_b.edges.size(); ++k) {
      const Vec3 across = rounded_e.cross(rounded_b[k]);
      const double sine = across.norm();
      const bool unsure = sine < kCrossing;
      if (unsure || !search.hopeless(across / sine)) search.look(cross(e, of_b.edges[k]));
      if (unsure || !search.hopeless(-across / sine)) {
        search.look(Rational(-1) * cross(e, of_b.edges[k]));
      }
    }
  }
  // Points and segments have no inside, and may have no direction of their own.
  const auto flat = [](const Body& body) { return body.rows.empty() && body.points.size() < 3; };
  if (flat(a) && flat(b)) return Rational(0);
  return search.best();
}

}  // namespace clearance::oracle
