// Least squares under linear inequalities, for a handful of unknowns.
#pragma once

#include <Eigen/Core>

namespace clearance::avoid {

// a . x >= b, one a row.
struct Inequalities {
  Eigen::MatrixXd a;
  Eigen::VectorXd b;
};

// Minimises x' H x / 2 - f' x, H positive definite, under the inequalities, each of which may be
// violated at a price of `price` for each unit of b: with a great price only where they contradict
// each other. Hildreth's method: the dual, one multiplier at a time.
[[nodiscard]] Eigen::VectorXd minimise(const Eigen::MatrixXd& h, const Eigen::VectorXd& f,
                                       const Inequalities& inequalities, double price);

}  // namespace clearance::avoid
