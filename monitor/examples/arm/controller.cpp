#include "monitor/examples/arm/controller.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "monitor/examples/arm/quadratic_programme.hpp"

namespace clearance::avoid {
namespace {

constexpr double kFollow = 4.0;    // 1/s: rate at which an error of the end point is corrected
constexpr double kHoming = 0.5;    // 1/s: rate at which an error of the posture is corrected
constexpr double kDamping = 1e-3;  // weight of joint velocities, relative to (m/s)^2 of the task
constexpr double kNear = 0.4;      // m: pairs at a larger distance add no constraint
constexpr double kOwnKeep = 0.01;  // m: the minimum distance between links of the arm
constexpr double kFleeing = 0.5;   // m/s: the largest separating speed of a constraint
constexpr double kStopping = 0.1;  // s: the least time to a position limit
constexpr double kPrice = 1e3;     // price of violating an inequality by 1 m/s or rad/s

// Rows a . dq >= b, collected one by one.
class Rows {
 public:
  explicit Rows(std::size_t unknowns) : unknowns_(static_cast<Eigen::Index>(unknowns)) {}
  void add(const Eigen::VectorXd& a, double b) { rows_.emplace_back(a, b); }
  [[nodiscard]] Inequalities all() const {
    const auto count = static_cast<Eigen::Index>(rows_.size());
    Inequalities all{Eigen::MatrixXd(count, unknowns_), Eigen::VectorXd(count)};
    for (Eigen::Index i = 0; i < count; ++i) {
      all.a.row(i) = rows_[static_cast<std::size_t>(i)].first;
      all.b[i] = rows_[static_cast<std::size_t>(i)].second;
    }
    return all;
  }

 private:
  Eigen::Index unknowns_;
  std::vector<std::pair<Eigen::VectorXd, double>> rows_;
};

// The gradient with respect to the controller's own unknowns.
Eigen::VectorXd gradient_of(const clearance_msg_PairGradient& pair,
                            const std::vector<std::uint32_t>& variables) {
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(variables.size()));
  for (const auto& entry : std::span(pair.joints._buffer, pair.joints._length)) {
    const auto at = std::ranges::find(variables, entry.joint);
    if (at != variables.end()) gradient[at - variables.begin()] = entry.rate;
  }
  return gradient;
}

}  // namespace

Controller::Controller(const Scene& scene, const ArmModel& arm, std::vector<double> home,
                       const ControllerOptions& options)
    : scene_(scene), arm_(arm), home_(std::move(home)), options_(options) {}

std::vector<double> Controller::velocities(const std::vector<double>& positions,
                                           const Target& target,
                                           const clearance_msg_Gradients& gradients) const {
  const std::vector<std::uint32_t>& variables = arm_.variables();
  const std::size_t unknowns = variables.size();
  std::vector<double> velocities(positions.size(), 0.0);
  Rows rows(unknowns);
  for (const auto& pair : std::span(gradients.pairs._buffer, gradients.pairs._length)) {
    if (!options_.avoids || pair.lower > kNear) continue;
    const ObjectPair& objects = scene_.pairs[pair.pair];
    const double keep =
        arm_.has(objects.first) && arm_.has(objects.second) ? kOwnKeep : options_.keep_m;
    rows.add(gradient_of(pair, variables),
             std::min(kFleeing, -pair.drift - options_.rate_hz * (pair.lower - keep)));
  }
  Eigen::VectorXd homing(unknowns);
  for (std::size_t i = 0; i < unknowns; ++i) {
    const JointVariable& limits = scene_.variables[variables[i]];
    const double at = positions[variables[i]];
    const auto row = static_cast<Eigen::Index>(i);
    const Eigen::VectorXd one = Eigen::VectorXd::Unit(static_cast<Eigen::Index>(unknowns), row);
    rows.add(one, std::max(-limits.max_speed, (limits.lower - at) / kStopping));
    rows.add(-one, -std::min(limits.max_speed, (limits.upper - at) / kStopping));
    homing[row] = kHoming * (home_[variables[i]] - at);
  }
  const Eigen::Matrix3Xd jacobian = arm_.jacobian();
  const Vec3 wanted = target.velocity + kFollow * (target.position - arm_.end_point());
  Eigen::MatrixXd h = jacobian.transpose() * jacobian;
  h.diagonal().array() += kDamping;
  const Eigen::VectorXd f = jacobian.transpose() * wanted + kDamping * homing;
  const Eigen::VectorXd found = minimise(h, f, rows.all(), kPrice);
  for (std::size_t i = 0; i < unknowns; ++i) {
    velocities[variables[i]] = found[static_cast<Eigen::Index>(i)];
  }
  return velocities;
}

}  // namespace clearance::avoid
