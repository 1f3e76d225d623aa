// The distance as the quadratic programme (3.2.5), solved by a general primal active-set method
// (§3.3.2, Fletcher) that knows nothing of geometry: six variables, N1 + N2 rows.
//
// Each body's point is kept in its own frame, minimise |x1 - R x2 - t|^2, so that the rows stay as
// they are when bodies move and a tracked start is feasible. The objective is used as the least
// squares that it is, which keeps the digits that forming H = J'J loses; the equality problem is
// solved in the null space of the active rows. Slacks are carried along, so alpha costs one product
// with the rows. It remembers x and the active set while tracked, and starts from the bodies'
// middles else.
#include <algorithm>

#include "tools/bench/intervals.hpp"
#include "tools/bench/measure.hpp"
#include "tools/bench/peers/null_space.hpp"
#include "tools/bench/peers/peers.hpp"

namespace clearance::bench {
namespace {

using Vec6 = NullSpace::Vec6;

struct Rows {
  Eigen::Matrix<double, Eigen::Dynamic, 3> normals;
  Eigen::VectorXd offsets;
  Vec3 middle;
};

class Qp {
 public:
  using Shape = Rows;
  static Shape shape(const ConvexPolyhedron& body) {
    const auto n = static_cast<Eigen::Index>(body.facets.size());
    Rows rows{{n, 3}, Eigen::VectorXd(n), body.interior};
    for (Eigen::Index i = 0; i < n; ++i) {
      rows.normals.row(i) = body.facets[static_cast<std::size_t>(i)].normal;
      rows.offsets[i] = body.facets[static_cast<std::size_t>(i)].offset;
    }
    return rows;
  }

  Qp(const Shape& a, const Shape& b)
      : a_(a), b_(b), slack_(a.offsets.size() + b.offsets.size()), speed_(slack_.size()) {
    forget();
  }

  void forget() {
    active_.clear();
    free_.resize(0);
    x_ << a_.middle, b_.middle;
  }

  Answer query(const Pose& world_from_a, const Pose& world_from_b) {
    const Mat3 to_a = world_from_a.orientation.toRotationMatrix().transpose();
    const Vec3 t = to_a * (world_from_b.position - world_from_a.position);
    jacobian_.leftCols<3>().setIdentity();
    jacobian_.rightCols<3>() = -to_a * world_from_b.orientation.toRotationMatrix();
    slack_ << a_.offsets, b_.offsets;
    product(x_);
    slack_ -= speed_;

    Answer answer{.distance = 0.0, .ok = false};
    int idle = 0;  // steps of no length since the last one
    while (answer.iterations < kIterations) {
      ++answer.iterations;
      const Vec3 residual = jacobian_ * x_ - t;
      answer.distance = residual.norm();
      const bool full = step(residual, idle);
      if (!full) continue;
      const Vec3 left = jacobian_ * x_ - t;
      answer.distance = left.norm();
      if (answer.distance < kContact || !release(left, idle > kIdle)) {
        answer.ok = true;
        break;
      }
    }
    return answer;
  }

 private:
  static constexpr int kIterations = 5000;
  // So many steps of no length may be cycling: from then on Bland's rule, the smallest index.
  static constexpr int kIdle = 20;
  static constexpr double kContact = 1e-13;  // m
  static constexpr double kRounding = 1e-14;

  [[nodiscard]] Vec6 row(Eigen::Index i) const {
    Vec6 r = Vec6::Zero();
    if (i < a_.offsets.size()) {
      r.head<3>() = a_.normals.row(i);
    } else {
      r.tail<3>() = b_.normals.row(i - a_.offsets.size());
    }
    return r;
  }

  // speed_ = rows * v
  void product(const Vec6& v) {
    speed_.head(a_.offsets.size()).noalias() = a_.normals * v.head<3>();
    speed_.tail(b_.offsets.size()).noalias() = b_.normals * v.tail<3>();
  }

  // Delta and alpha; true if nothing blocked.
  bool step(const Vec3& residual, int& idle) {
    const Vec6 move = free_.least_squares(jacobian_, residual);
    const double length = move.norm();
    if (length <= kRounding * (1.0 + x_.norm())) return true;
    product(move);
    for (const Eigen::Index i : active_) speed_[i] = 0.0;
    double alpha = 1.0;
    Eigen::Index blocking = -1;
    for (Eigen::Index i = 0; i < speed_.size(); ++i) {
      if (!(speed_[i] > kRounding * length) || slack_[i] >= alpha * speed_[i]) continue;
      alpha = std::max(0.0, slack_[i] / speed_[i]);
      blocking = i;
    }
    x_ += alpha * move;
    slack_ -= alpha * speed_;
    idle = alpha * length > kRounding ? 0 : idle + 1;
    if (blocking < 0) return true;
    active_.push_back(blocking);
    free_.add(row(blocking));
    return false;
  }

  // Lambda: lets go of the row with the most negative multiplier; false if there is none.
  bool release(const Vec3& residual, bool smallest_index) {
    if (active_.empty()) return false;
    const Vec6 gradient = jacobian_.transpose() * residual;
    const Vec6 lambda = free_.multipliers(-gradient);
    int leaving = -1;
    for (int k = 0; k < free_.size(); ++k) {
      if (lambda[k] >= -kRounding * gradient.norm()) continue;
      const bool better = leaving < 0 || (smallest_index ? active_[k] < active_[leaving]
                                                         : lambda[k] < lambda[leaving]);
      if (better) leaving = k;
    }
    if (leaving < 0) return false;
    active_.erase(active_.begin() + leaving);
    free_.resize(leaving);
    for (std::size_t k = leaving; k < active_.size(); ++k) free_.add(row(active_[k]));
    return true;
  }

  const Rows& a_;
  const Rows& b_;
  NullSpace::Wide jacobian_;
  Vec6 x_;  // of A in its frame, of B in its frame
  std::vector<Eigen::Index> active_;
  NullSpace free_;  // of the active rows, in their order
  Eigen::VectorXd slack_, speed_;
};

}  // namespace

void register_qp() {
  register_rows<Qp>("peer/qp/");
  register_intervals<Qp>("peer/qp/");
}

}  // namespace clearance::bench
