// Least squares under linear inequalities, for a handful of unknowns.
#pragma once

#include <Eigen/Core>

namespace clearance::avoid {

// a . x >= b, one per row.
struct Inequalities {
  Eigen::MatrixXd a;
  Eigen::VectorXd b;
};

// Minimises x' H x / 2 - f' x, H positive definite, under the inequalities. Each may be violated at
// `price` per unit of b. With a high price, only contradictory inequalities are violated.
// Hildreth's method solves the dual, one multiplier at a time.
[[nodiscard]] Eigen::VectorXd minimise(const Eigen::MatrixXd& h, const Eigen::VectorXd& f,
                                       const Inequalities& inequalities, double price);

}  // namespace clearance::avoid
