// Doubles that keep a record of their roundings. They give the error of a result to first order, if
// all roundings are as bad as possible at the same time.
//
// Every operation is recorded with its partial derivatives. Going back from the result gives the
// effect of each rounding (reverse differentiation).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace clearance::test {

class Counted {
 public:
  Counted() : Counted(0.0) {}
  Counted(double exact) : value_(exact) {}  // NOLINT: constants have no roundings

  static void forget_all() { nodes().clear(); }
  [[nodiscard]] double value() const { return value_; }

  // The same number with its errors no longer counted.
  [[nodiscard]] Counted forgotten() const { return value_; }

  // The worst absolute error, in units of 2^-53.
  [[nodiscard]] double worst() const {
    if (node_ == kConstant) return 0.0;
    std::vector<double> weight(node_ + 1, 0.0);
    weight[node_] = 1.0;
    double sum = 0.0;
    for (std::size_t i = node_ + 1; i-- > 0;) {
      const Node& n = nodes()[i];
      if (weight[i] == 0.0) continue;
      sum += std::abs(weight[i]) * n.rounding;
      for (const Input& in : n.inputs) {
        if (in.node != kConstant) weight[in.node] += weight[i] * in.slope;
      }
    }
    return sum;
  }

  friend Counted operator+(const Counted& a, const Counted& b) {
    return {a.value_ + b.value_, {{{a.node_, 1.0}, {b.node_, 1.0}}}};
  }
  friend Counted operator-(const Counted& a, const Counted& b) {
    return {a.value_ - b.value_, {{{a.node_, 1.0}, {b.node_, -1.0}}}};
  }
  friend Counted operator*(const Counted& a, const Counted& b) {
    return {a.value_ * b.value_, {{{a.node_, b.value_}, {b.node_, a.value_}}}};
  }
  friend Counted operator/(const Counted& a, const Counted& b) {
    const double q = a.value_ / b.value_;
    return {q, {{{a.node_, 1.0 / b.value_}, {b.node_, -q / b.value_}}}};
  }
  friend Counted operator-(const Counted& a) {
    return {-a.value_, {{{a.node_, -1.0}, {kConstant, 0.0}}}, 0.0};
  }
  friend Counted sqrt(const Counted& a) {
    const double root = std::sqrt(a.value_);
    return {root, {{{a.node_, 0.5 / root}, {kConstant, 0.0}}}};
  }
  // A scaling that is exact.
  friend Counted plain_scaled(const Counted& a, double by) {
    return {by * a.value_, {{{a.node_, by}, {kConstant, 0.0}}}, 0.0};
  }
  friend Counted plain_sum(const Counted& a, const Counted& b) {
    return {a.value_ + b.value_, {{{a.node_, 1.0}, {b.node_, 1.0}}}, 0.0};
  }
  friend Counted doubled(const Counted& a) { return plain_scaled(a, 2.0); }

 private:
  static constexpr std::size_t kConstant = static_cast<std::size_t>(-1);
  struct Input {
    std::size_t node;
    double slope;
  };
  using Inputs = std::array<Input, 2>;
  struct Node {
    Inputs inputs;
    double rounding;
  };
  static std::vector<Node>& nodes() {
    static std::vector<Node> all;
    return all;
  }
  // The largest rounding error, half an ulp, in units of 2^-53. It is 2^k for a value from 2^k to
  // 2^(k+1).
  static double half_ulp(double value) {
    return value == 0.0 ? 0.0 : std::ldexp(1.0, std::ilogb(value));
  }
  Counted(double value, const Inputs& inputs) : Counted(value, inputs, half_ulp(value)) {}
  Counted(double value, const Inputs& inputs, double rounding)
      : value_(value), node_(nodes().size()) {
    nodes().push_back({inputs, rounding});
  }

  double value_;
  std::size_t node_ = kConstant;
};

}  // namespace clearance::test
