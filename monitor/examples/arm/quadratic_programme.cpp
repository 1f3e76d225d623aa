#include "monitor/examples/arm/quadratic_programme.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace clearance::avoid {
namespace {

// A round updates every multiplier once. It converges when they change by less than this share of
// the largest one.
constexpr int kRounds = 500;
constexpr double kSettled = 1e-9;

}  // namespace

Eigen::VectorXd minimise(const Eigen::MatrixXd& h, const Eigen::VectorXd& f,
                         const Inequalities& inequalities, double price) {
  const Eigen::MatrixXd& a = inequalities.a;
  const Eigen::LLT<Eigen::MatrixXd> factor(h);
  Eigen::VectorXd x = factor.solve(f);
  const Eigen::MatrixXd towards = factor.solve(a.transpose());  // a column per inequality
  Eigen::VectorXd multipliers = Eigen::VectorXd::Zero(a.rows());
  for (int round = 0; round < kRounds; ++round) {
    double change = 0.0;
    for (Eigen::Index i = 0; i < a.rows(); ++i) {
      const double curvature = a.row(i).dot(towards.col(i));
      if (!(curvature > 0.0)) continue;  // no motion changes it
      const double missing = inequalities.b[i] - a.row(i).dot(x);
      const double wanted = std::clamp(multipliers[i] + missing / curvature, 0.0, price);
      x += (wanted - multipliers[i]) * towards.col(i);
      change = std::max(change, std::abs(wanted - multipliers[i]));
      multipliers[i] = wanted;
    }
    if (change <= kSettled * (1.0 + multipliers.maxCoeff())) break;
  }
  return x;
}

}  // namespace clearance::avoid
