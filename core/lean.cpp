#include "core/lean.hpp"

#include <algorithm>
#include <cmath>

namespace clearance {
namespace {

using Numbers = std::array<int, 4>;  // x, y, z, w

// The larger components of both quaternions together are brought to this power of two, so that
// neither their products with a ray nor the splitting of these overflow. Of one quaternion most of
// it, where its components differ by more.
constexpr int kScale = 950, kMost = 850;

// Products below this may have lost digits, no more than that.
constexpr double kLeastWhole = 0x1p-900;

// What has been lost may be no more than this part of a result.
constexpr double kLostPart = 0x1p-100;

int exponent_of_largest(const Eigen::Quaterniond& q) noexcept {
  return std::ilogb(q.coeffs().cwiseAbs().maxCoeff());
}

int exponents_within(const Eigen::Quaterniond& q) noexcept {
  int least = exponent_of_largest(q);
  for (const double x : q.coeffs()) {
    if (x != 0.0) least = std::min(least, std::ilogb(x));
  }
  return exponent_of_largest(q) - least;
}

// A product, into a sum; what may be lost of it, into `lost`.
void add_product(ExactSum& sum, double a, double b, double& lost) noexcept {
  if (a == 0.0 || b == 0.0) return;
  const DoubleDouble p = exact::product(a, b);
  if (!(std::abs(p.high) > kLeastWhole)) lost += 2.0 * kLeastWhole;
  sum.add(p);
}

// The same of two sums, one of them scaled down before.
void add_products(ExactSum& sum, const ExactSum& a, const ExactSum& b, double& lost) noexcept {
  for (const double part : a) {
    const double small = std::ldexp(part, -kScale);
    if (std::ldexp(small, kScale) != part) lost += kLeastWhole;
    for (const double by : b) add_product(sum, small, by, lost);
  }
}

// Puts into take(component, from_a, from_b, sign) what conj(a) b is made of.
template <class Take>
void for_terms_of_product(const Take& take) noexcept {
  constexpr std::size_t w = 3;
  for (std::size_t x = 0; x < 3; ++x) {
    const std::size_t y = (x + 1) % 3, z = (x + 2) % 3;
    take(x, w, x, 1.0);
    take(x, x, w, -1.0);
    take(x, z, y, 1.0);
    take(x, y, z, -1.0);
    take(w, x, x, 1.0);
  }
  take(w, w, w, 1.0);
}

// Of the rotations that lead axes to axes: by 90, 120 or 180 degrees, and by none.
constexpr std::size_t kTurns = 24;
constexpr std::array<Numbers, kTurns> all_turns() noexcept {
  std::array<Numbers, kTurns> out{};
  std::size_t size = 0;
  for (int code = 80; code > 40; --code) {  // of each two opposite ones the one that leads with 1
    const Numbers q = {code / 3 % 3 - 1, code / 9 % 3 - 1, code % 3 - 1, code / 27 - 1};
    const int square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    if (square != 3) out[size++] = q;
  }
  return out;
}
constexpr std::array<Numbers, kTurns> kAllTurns = all_turns();

Mat3 matrix(const Numbers& turn) noexcept {
  return rotation_matrix(Eigen::Quaterniond(turn[3], turn[0], turn[1], turn[2]));
}

int exponent_of(const ExactSum* first, std::size_t count) noexcept {
  double most = 0.0;
  for (std::size_t i = 0; i < count; ++i) most = std::max(most, std::abs(first[i].rounded()));
  return most > 0.0 ? std::ilogb(most) : 0;
}

}  // namespace

void ExactSum::add(double x) noexcept {
  if (size_ == parts_.size()) spread();
  std::size_t kept = 0;
  double high = x;
  for (std::size_t i = 0; i < size_; ++i) {
    const DoubleDouble s = exact::sum(high, parts_[i]);
    high = s.high;
    if (s.low != 0.0) parts_[kept++] = s.low;
  }
  if (high != 0.0) parts_[kept++] = high;
  size_ = kept;
}

// Compress, from the largest down: Shewchuk, Adaptive precision floating-point arithmetic, 1997,
// §2.8.
void ExactSum::spread() noexcept {
  if (size_ == 0) return;
  std::size_t first = size_ - 1;
  double high = parts_[first];
  for (std::size_t i = size_ - 1; i-- > 0;) {
    const DoubleDouble s = exact::sum(high, parts_[i]);
    if (s.low != 0.0) parts_[first--] = s.high;
    high = s.low != 0.0 ? s.low : s.high;
  }
  parts_[first] = high;
  std::copy(parts_.begin() + first, parts_.begin() + size_, parts_.begin());
  size_ -= first;
}

DoubleDouble ExactSum::scaled(int exponent) const noexcept {
  ExactSum all = *this;
  all.spread();
  DoubleDouble out;
  for (std::size_t i = all.size_ > 3 ? all.size_ - 3 : 0; i < all.size_; ++i) {
    out = out + DoubleDouble(std::ldexp(all.parts_[i], exponent));
  }
  return out;
}

Lean::Lean(const RelativePose& a_from_b) noexcept {
  const Eigen::Quaterniond &a = a_from_b.world_from_a, &b = a_from_b.world_from_b;
  const int up_b = exponents_within(b) > exponents_within(a) ? kMost : kScale - kMost;
  const auto scaled = [this](const Eigen::Quaterniond& q, int up) {
    const int by = up - exponent_of_largest(q);
    std::array<double, 4> out;
    for (std::size_t i = 0; i < 4; ++i) {
      const double given = q.coeffs()[static_cast<Eigen::Index>(i)];
      out[i] = std::ldexp(given, by);
      if (std::ldexp(out[i], -by) != given) lost_ += std::ldexp(0x1p-1074, kMost + 1);
    }
    return out;
  };
  const std::array<double, 4> of_a = scaled(a, kScale - up_b), of_b = scaled(b, up_b);
  for_terms_of_product([&](std::size_t to, std::size_t i, std::size_t j, double sign) {
    add_product(q_[to], sign * of_a[i], of_b[j], lost_);
  });
}

// What is left of the relative quaternion after a turn, conj(turn) q.
struct Lean::Turn {
  std::array<ExactSum, 4> q;

  Turn(const Numbers& first, const std::array<ExactSum, 4>& all) noexcept {
    for_terms_of_product([&](std::size_t to, std::size_t i, std::size_t j, double sign) {
      if (first[i] != 0) q[to].add(all[j], sign * first[i]);
    });
  }
};

// By which way f is moved; of about unit length, or zero.
WideVec Lean::moved(const Turn& turn, const Vec3& f, bool& known) const noexcept {
  std::array<ExactSum, 3> across;  // v cross f
  double lost = 32.0 * lost_;
  for (std::size_t x = 0; x < 3; ++x) {
    const std::size_t y = (x + 1) % 3, z = (x + 2) % 3;
    for (const double part : turn.q[y])
      add_product(across[x], part, f[static_cast<Eigen::Index>(z)], lost);
    for (const double part : turn.q[z])
      add_product(across[x], part, -f[static_cast<Eigen::Index>(y)], lost);
  }
  const int up = -exponent_of(across.data(), 3), up_q = -exponent_of(turn.q.data(), 4);
  const WideVec g{across[0].scaled(up), across[1].scaled(up), across[2].scaled(up)};
  const double length = narrow(g).norm();
  known = length > 0.0 ? lost <= kLostPart * std::ldexp(1.0, -up) : lost == 0.0;
  if (!known || length == 0.0) return {};
  const auto& q = turn.q;
  const WideVec v{q[0].scaled(up_q), q[1].scaled(up_q), q[2].scaled(up_q)};
  const WideVec way = q[3].scaled(up_q) * g + cross(v, g);
  return DoubleDouble(1.0 / narrow(way).norm()) * way;
}

std::optional<int> Lean::sign(const Vec3& m, const Vec3& f) const noexcept {
  for (const Numbers& turn : kAllTurns) {
    const Vec3 own = matrix(turn).transpose() * m;
    ExactSum level;
    double lost = 0.0;
    for (Eigen::Index i = 0; i < 3; ++i) add_product(level, own[i], f[i], lost);
    if (level.sign() != 0 || lost != 0.0) continue;
    if (const auto sign = sign_of_rise(Turn(turn, q_), own, f)) return sign;
  }
  return {};
}

// Of w m.(v cross f) + m.v v.f.
std::optional<int> Lean::sign_of_rise(const Turn& turn, const Vec3& m,
                                      const Vec3& f) const noexcept {
  double lost = lost_;
  const auto dot = [&](const Vec3& by) {
    ExactSum out;
    for (std::size_t i = 0; i < 3; ++i) {
      for (const double part : turn.q[i]) {
        add_product(out, part, by[static_cast<Eigen::Index>(i)], lost);
      }
    }
    return out;
  };
  ExactSum across;
  for (std::size_t x = 0; x < 3; ++x) {
    const auto y = static_cast<Eigen::Index>((x + 1) % 3),
               z = static_cast<Eigen::Index>((x + 2) % 3);
    ExactSum component;
    add_product(component, f[y], m[z], lost);
    add_product(component, -f[z], m[y], lost);
    for (const double by : component) {
      for (const double part : turn.q[x]) add_product(across, part, by, lost);
    }
  }
  const ExactSum& w = turn.q[3];
  const ExactSum of_m = dot(m), of_f = dot(f);
  if (lost != 0.0) return {};
  const int first = w.sign() * across.sign(), second = of_m.sign() * of_f.sign();
  if (first * second >= 0) return first != 0 ? first : second;
  ExactSum rise;
  add_products(rise, w, across, lost);
  add_products(rise, of_f, of_m, lost);
  if (lost != 0.0) return {};
  return rise.sign();
}

Lean::Apart Lean::apart(const Vec3& e, const Vec3& f) const noexcept {
  Apart out;
  const auto rounded = [this](std::size_t i) { return q_[i].scaled(-exponent_of(q_.data(), 4)); };
  const Eigen::Quaterniond q(rounded(3).high, rounded(0).high, rounded(1).high, rounded(2).high);
  out.sign = (rotation_matrix(q) * f).dot(e) < 0.0 ? -1.0 : 1.0;
  for (const Numbers& turn : kAllTurns) {
    const Mat3 axes = matrix(turn);
    if (axes * f != out.sign * e) continue;
    const WideVec way = moved(Turn(turn, q_), f, out.known);
    const WideVec rows[] = {wide(axes.row(0)), wide(axes.row(1)), wide(axes.row(2))};
    out.way = {dot(rows[0], way), dot(rows[1], way), dot(rows[2], way)};
    return out;
  }
  return out;
}

}  // namespace clearance
