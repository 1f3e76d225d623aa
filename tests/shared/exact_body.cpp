#include "tests/shared/exact_body.hpp"

#include <optional>
#include <stdexcept>
#include <utility>

namespace clearance::oracle {
namespace {

using Vector = std::vector<Rational>;
using Matrix = std::vector<Vector>;

std::vector<Integer> to_integers(const Vector& v) {
  Integer common = 1;
  for (const Rational& x : v) mpz_lcm(common.get_mpz_t(), common.get_mpz_t(), x.get_den_mpz_t());
  std::vector<Integer> out;
  Integer divisor = 0;
  for (const Rational& x : v) {
    out.emplace_back(x.get_num() * (common / x.get_den()));
    mpz_gcd(divisor.get_mpz_t(), divisor.get_mpz_t(), out.back().get_mpz_t());
  }
  if (divisor > 1) {
    for (Integer& x : out) mpz_divexact(x.get_mpz_t(), x.get_mpz_t(), divisor.get_mpz_t());
  }
  return out;
}

Integer row_product(const std::vector<Integer>& a, const std::vector<Integer>& b) {
  Integer sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
  return sum;
}

// Reduces `m` to row echelon form in place, with pivots of one. Returns the pivot columns.
std::vector<std::size_t> reduce(Matrix& m, std::size_t columns) {
  std::vector<std::size_t> pivots;
  for (std::size_t column = 0; column < columns && pivots.size() < m.size(); ++column) {
    const std::size_t top = pivots.size();
    std::size_t row = top;
    while (row < m.size() && m[row][column] == 0) ++row;
    if (row == m.size()) continue;
    std::swap(m[top], m[row]);
    const Rational pivot = m[top][column];
    for (Rational& x : m[top]) x /= pivot;
    for (std::size_t r = 0; r < m.size(); ++r) {
      if (r == top || m[r][column] == 0) continue;
      const Rational factor = m[r][column];
      for (std::size_t c = 0; c < m[r].size(); ++c) m[r][c] -= factor * m[top][c];
    }
    pivots.push_back(column);
  }
  return pivots;
}

// A basis of {x : m x = 0}.
Matrix null_space(Matrix m, std::size_t dimension) {
  const std::vector<std::size_t> pivots = reduce(m, dimension);
  Matrix out;
  for (std::size_t free = 0; free < dimension; ++free) {
    bool is_pivot = false;
    for (const std::size_t p : pivots) is_pivot = is_pivot || p == free;
    if (is_pivot) continue;
    Vector v(dimension, 0);
    v[free] = 1;
    for (std::size_t row = 0; row < pivots.size(); ++row) v[pivots[row]] = -m[row][free];
    out.push_back(std::move(v));
  }
  return out;
}

}  // namespace

Rational dot(const RationalVec& a, const RationalVec& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

RationalVec exact(const Vec3& v) { return {Rational(v.x()), Rational(v.y()), Rational(v.z())}; }

IntegerVec primitive(const RationalVec& v) {
  const std::vector<Integer> out = to_integers({v[0], v[1], v[2]});
  return {out[0], out[1], out[2]};
}

// Maximises objective.x subject to the rows, in any number of variables.
struct ExactBody::Program {
  const std::vector<Row>& rows;
  std::size_t dimension;

  struct Corner {
    Point point;
    Matrix inverse;  // inverse of the basis rows: column j is minus the edge that leaves row j
  };

  [[nodiscard]] Vector normal(int row) const {
    const std::vector<Integer>& n = rows[row].normal;
    return {n.begin(), n.end()};
  }

  [[nodiscard]] Corner corner(const std::vector<int>& basis) const {
    Matrix m;
    for (std::size_t k = 0; k < dimension; ++k) {
      Vector row = normal(basis[k]);
      row.resize(2 * dimension, 0);
      row[dimension + k] = 1;
      m.push_back(std::move(row));
    }
    if (reduce(m, dimension).size() != dimension)
      throw std::logic_error("basis rows are dependent");
    Corner out;
    Vector x(dimension, 0);
    for (std::size_t i = 0; i < dimension; ++i) {
      out.inverse.emplace_back(m[i].begin() + static_cast<std::ptrdiff_t>(dimension), m[i].end());
      for (std::size_t k = 0; k < dimension; ++k) {
        x[i] += out.inverse[i][k] * rows[basis[k]].offset;
      }
    }
    out.point = homogeneous(x);
    return out;
  }

  [[nodiscard]] static Point homogeneous(const Vector& x) {
    Integer w = 1;
    for (const Rational& v : x) mpz_lcm(w.get_mpz_t(), w.get_mpz_t(), v.get_den_mpz_t());
    Point out{{}, w};
    for (const Rational& v : x) out.x.emplace_back(v.get_num() * (w / v.get_den()));
    return out;
  }

  // The first row that is met from `from` along `edge`; among equal ones the one of lowest index
  // (Bland). Returns -1 if there is none.
  [[nodiscard]] int blocking_row(const Point& from, const std::vector<Integer>& edge) const {
    int best = -1;
    Integer best_slack, best_slope;
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const Integer slope = row_product(rows[r].normal, edge);
      if (slope <= 0) continue;
      const Integer slack = rows[r].offset * from.w - row_product(rows[r].normal, from.x);
      if (best < 0 || slack * best_slope < best_slack * slope) {
        best = static_cast<int>(r);
        best_slack = slack;
        best_slope = slope;
      }
    }
    return best;
  }

  // Moves from a feasible point to a vertex: along the directions that the active rows leave free,
  // until three (or four) rows determine it.
  [[nodiscard]] std::vector<int> corner_near(const Vector& start) const {
    std::vector<int> basis;
    Matrix held;
    const auto hold = [&](int row) {
      Matrix candidate = held;
      candidate.push_back(normal(row));
      Matrix reduced = candidate;
      if (reduce(reduced, dimension).size() != candidate.size()) return;
      held = std::move(candidate);
      basis.push_back(row);
    };
    Vector x = start;
    for (std::size_t r = 0; r < rows.size() && basis.size() < dimension; ++r) {
      const Point at = homogeneous(x);
      if (row_product(rows[r].normal, at.x) == rows[r].offset * at.w) hold(static_cast<int>(r));
    }
    while (basis.size() < dimension) {
      const Point at = homogeneous(x);
      std::vector<Integer> edge = to_integers(null_space(held, dimension).front());
      int row = blocking_row(at, edge);
      if (row < 0) {
        for (Integer& e : edge) e = -e;
        row = blocking_row(at, edge);
      }
      if (row < 0) throw std::logic_error("the body contains a line");
      const Rational step(rows[row].offset * at.w - row_product(rows[row].normal, at.x),
                          at.w * row_product(rows[row].normal, edge));
      for (std::size_t k = 0; k < dimension; ++k) x[k] += step * Rational(edge[k]);
      for (Rational& v : x) v.canonicalize();
      hold(row);
    }
    return basis;
  }

  // Moves `basis` to an optimal basis, or returns a ray along which the objective is unbounded.
  std::optional<std::vector<Integer>> maximise(const std::vector<Integer>& objective,
                                               std::vector<int>& basis, long& pivots) const {
    while (true) {
      const Corner at = corner(basis);
      std::size_t leaving = dimension;
      for (std::size_t j = 0; j < dimension; ++j) {
        Rational multiplier = 0;
        for (std::size_t i = 0; i < dimension; ++i) multiplier += at.inverse[i][j] * objective[i];
        if (multiplier < 0 && (leaving == dimension || basis[j] < basis[leaving])) leaving = j;
      }
      if (leaving == dimension) return std::nullopt;
      Vector edge(dimension);
      for (std::size_t i = 0; i < dimension; ++i) edge[i] = -at.inverse[i][leaving];
      const std::vector<Integer> direction = to_integers(edge);
      const int entering = blocking_row(at.point, direction);
      if (entering < 0) return direction;
      basis[leaving] = entering;
      ++pivots;
    }
  }
};

ExactBody::ExactBody(const Body& body) {
  if (body.rows.empty()) {
    if (body.points.empty()) throw std::invalid_argument("a body without rows and points");
    Vector flat;
    for (const Vec3& p : body.points) flat.insert(flat.end(), {p.x(), p.y(), p.z()});
    const Point all = Program::homogeneous(flat);
    points_scale_ = all.w;
    for (std::size_t k = 0; k < all.x.size(); k += 3) {
      points_.push_back({all.x[k], all.x[k + 1], all.x[k + 2]});
    }
    return;
  }
  for (const HalfSpace& row : body.rows) {
    const Vector doubles = {row.normal.x(), row.normal.y(), row.normal.z(), row.offset};
    std::vector<Integer> integers = to_integers(doubles);
    const Integer offset = integers.back();
    integers.pop_back();
    rows_.push_back({std::move(integers), offset});
  }
  given_rows_ = rows_.size();
  pin_lines();
  basis_ = Program{rows_, 3}.corner_near(feasible_point());
}

// A body that contains a line has no vertices. It is the sum of its lines and its section by the
// plane through the origin that is normal to them. The section has vertices.
void ExactBody::pin_lines() {
  Matrix normals;
  for (const Row& row : rows_) normals.emplace_back(row.normal.begin(), row.normal.end());
  for (const Vector& line : null_space(normals, 3)) {
    const std::vector<Integer> l = to_integers(line);
    lines_.push_back({l[0], l[1], l[2]});
    rows_.push_back({l, 0});
    rows_.push_back({{-l[0], -l[1], -l[2]}, 0});
  }
}

// Phase one of the simplex method: the least s >= 0 for which all n.x - s <= d have a solution must
// be zero.
std::vector<Rational> ExactBody::feasible_point() const {
  Integer s = 0;
  for (const Row& row : rows_) {
    if (-row.offset > s) s = -row.offset;
  }
  std::vector<Rational> x(3, 0);
  if (s == 0) return x;
  std::vector<Row> relaxed = rows_;
  for (std::size_t r = 0; r < relaxed.size(); ++r) {
    relaxed[r].normal.emplace_back(r < given_rows_ ? -1 : 0);
  }
  relaxed.push_back({{0, 0, 0, -1}, 0});
  const Program program{relaxed, 4};
  std::vector<int> basis = program.corner_near({0, 0, 0, s});
  long pivots = 0;
  (void)program.maximise({0, 0, 0, -1}, basis, pivots);
  const Point at = program.corner(basis).point;
  if (at.x[3] != 0) throw std::invalid_argument("the half-spaces have no common point");
  for (std::size_t k = 0; k < 3; ++k) {
    x[k] = Rational(at.x[k], at.w);
    x[k].canonicalize();
  }
  return x;
}

Support ExactBody::support_of_points(const IntegerVec& direction) const {
  std::size_t best = 0;
  Integer best_value;
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const IntegerVec& p = points_[k];
    const Integer value = p[0] * direction[0] + p[1] * direction[1] + p[2] * direction[2];
    if (k == 0 || value > best_value) {
      best = k;
      best_value = value;
    }
  }
  Support out;
  for (std::size_t k = 0; k < 3; ++k) {
    out.vector[k] = Rational(points_[best][k], points_scale_);
    out.vector[k].canonicalize();
  }
  return out;
}

Support ExactBody::support(const IntegerVec& direction) {
  if (!given_by_rows()) return support_of_points(direction);
  for (const IntegerVec& line : lines_) {
    const int side =
        sgn(Integer(line[0] * direction[0] + line[1] * direction[1] + line[2] * direction[2]));
    if (side == 0) continue;
    return {{Rational(side * line[0]), Rational(side * line[1]), Rational(side * line[2])}, true};
  }
  const Program program{rows_, 3};
  const auto ray = program.maximise({direction.begin(), direction.end()}, basis_, pivots_);
  if (ray) return {{Rational((*ray)[0]), Rational((*ray)[1]), Rational((*ray)[2])}, true};
  const Point at = program.corner(basis_).point;
  Support out;
  for (std::size_t k = 0; k < 3; ++k) {
    out.vector[k] = Rational(at.x[k], at.w);
    out.vector[k].canonicalize();
  }
  return out;
}

bool ExactBody::rows_hold_at(const RationalVec& x) const {
  const Point at = Program::homogeneous({x[0], x[1], x[2]});
  for (std::size_t r = 0; r < given_rows_; ++r) {
    if (row_product(rows_[r].normal, at.x) > rows_[r].offset * at.w) return false;
  }
  return true;
}

bool ExactBody::proves_bound(const RationalVec& direction, const Rational& value) const {
  if (!given_by_rows()) {
    for (const IntegerVec& p : points_) {
      Rational support_value = direction[0] * p[0] + direction[1] * p[1] + direction[2] * p[2];
      if (support_value > value * points_scale_) return false;
    }
    return true;
  }
  const Program::Corner at = Program{rows_, 3}.corner(basis_);
  RationalVec sum;
  Rational support_value = 0;
  for (std::size_t j = 0; j < 3; ++j) {
    Rational multiplier = 0;
    for (std::size_t i = 0; i < 3; ++i) multiplier += at.inverse[i][j] * direction[i];
    if (multiplier < 0) return false;
    const Row& row = rows_[basis_[j]];
    for (std::size_t k = 0; k < 3; ++k) sum[k] += multiplier * row.normal[k];
    support_value += multiplier * row.offset;
    // A row that only pins a line does not belong to the body, and proves nothing.
    if (static_cast<std::size_t>(basis_[j]) >= given_rows_ && multiplier != 0) return false;
  }
  return sum == direction && support_value <= value;
}

}  // namespace clearance::oracle
