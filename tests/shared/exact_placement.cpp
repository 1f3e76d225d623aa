#include "tests/shared/exact_placement.hpp"

#include <stdexcept>

namespace clearance::oracle {
namespace {

RationalMat rotation(const Pose& pose) {
  const Rational w(pose.orientation.w()), x(pose.orientation.x()), y(pose.orientation.y()),
      z(pose.orientation.z());
  const Rational n = w * w + x * x + y * y + z * z;
  if (n == 0) throw std::invalid_argument("a quaternion of length zero");
  return {
      {{(w * w + x * x - y * y - z * z) / n, 2 * (x * y - w * z) / n, 2 * (x * z + w * y) / n},
       {2 * (x * y + w * z) / n, (w * w - x * x + y * y - z * z) / n, 2 * (y * z - w * x) / n},
       {2 * (x * z - w * y) / n, 2 * (y * z + w * x) / n, (w * w - x * x - y * y + z * z) / n}}};
}

}  // namespace

RationalVec operator+(const RationalVec& a, const RationalVec& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

RationalVec operator-(const RationalVec& a, const RationalVec& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

RationalVec operator*(const Rational& s, const RationalVec& a) {
  return {s * a[0], s * a[1], s * a[2]};
}

RationalVec operator*(const RationalMat& m, const RationalVec& v) {
  return {dot(m[0], v), dot(m[1], v), dot(m[2], v)};
}

RationalVec cross(const RationalVec& a, const RationalVec& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

RationalMat transposed(const RationalMat& m) {
  RationalMat out;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) out[i][j] = m[j][i];
  }
  return out;
}

bool is_zero(const RationalVec& v) { return v[0] == 0 && v[1] == 0 && v[2] == 0; }

Vec3 to_vec(const RationalVec& v) { return {v[0].get_d(), v[1].get_d(), v[2].get_d()}; }

Placement::Placement(const Pose& a, const Pose& b) : world_a(rotation(a)) {
  const RationalMat a_world = transposed(world_a), world_b = transposed(rotation(b));
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) a_from_b_rotation[i][j] = dot(a_world[i], world_b[j]);
  }
  a_from_b_translation = a_world * (exact(b.position) - exact(a.position));
}

RationalVec Placement::b_direction(const RationalVec& in_a) const {
  return transposed(a_from_b_rotation) * in_a;
}

}  // namespace clearance::oracle
