// The quadratic programme is solved by peers/active_set_qp.hpp, the same active-set method in
// orthonormal bases. DQP3 would need the adjacency of facets, which would have to be made in every
// cycle.
#include "tools/bench/thesis/chapter5/refinement.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "tools/bench/peers/active_set_qp.hpp"
#include "tools/bench/thesis/chapter5/safeguarded_newton.hpp"

namespace clearance::bench {
namespace {

// The largest number of facets per body: the first six, the active ones, and the newest.
constexpr std::size_t kPrism = 6, kKept = 20;

class Model {
 public:
  explicit Model(const Vec3& axes) : axes_(axes) {
    for (int i = 0; i < 3; ++i) {
      add(Vec3::Unit(i));
      add(-Vec3::Unit(i));
    }
  }

  [[nodiscard]] QpRows rows() const {
    const auto n = static_cast<Eigen::Index>(normals_.size());
    QpRows rows{{n, 3}, Eigen::VectorXd(n)};
    for (Eigen::Index i = 0; i < n; ++i) {
      const Vec3& normal = normals_[static_cast<std::size_t>(i)];
      rows.normals.row(i) = normal;
      rows.offsets[i] = axes_.cwiseProduct(normal).norm();
    }
    return rows;
  }

  // Keeps what is active, of the programme's rows from `first` on.
  void discard(const std::vector<Eigen::Index>& active, Eigen::Index first) {
    if (normals_.size() <= kKept) return;
    std::vector<bool> keep(normals_.size(), false);
    std::fill_n(keep.begin(), kPrism, true);
    std::size_t kept = kPrism;
    const auto use = [&](std::size_t i) {
      if (keep[i]) return;
      keep[i] = true;
      ++kept;
    };
    for (const Eigen::Index row : active) {
      const Eigen::Index i = row - first;
      if (i >= 0 && i < static_cast<Eigen::Index>(keep.size())) use(static_cast<std::size_t>(i));
    }
    for (std::size_t i = keep.size(); i-- > kPrism && kept < kKept;) use(i);
    std::size_t next = 0;
    for (std::size_t i = 0; i < keep.size(); ++i) {
      if (keep[i]) normals_[next++] = normals_[i];
    }
    normals_.resize(next);
  }

  // Around the normal n at the nearest point, with `along` the direction to the other body.
  void add_cluster(const Vec3& n, const Vec3& along, Cluster cluster) {
    const double sine = std::sqrt(0.75);  // of 60 and 120 degrees
    const Vec3 back = n - along, across = sine * n.cross(back);
    add(n);
    add(along);
    add(n + 0.5 * back + across);
    add(n + 0.5 * back - across);
    if (cluster == Cluster::kFour) return;
    add(n + 2.0 * back);
    add(n - back + 2.0 * across);
    add(n - back - 2.0 * across);
  }

 private:
  void add(const Vec3& direction) { normals_.push_back(direction.normalized()); }

  Vec3 axes_;
  std::vector<Vec3> normals_;
};

Vec3 normal_at(const Vec3& axes, const Vec3& point) {
  return point.cwiseQuotient(axes.cwiseProduct(axes)).normalized();
}

}  // namespace

ClosestPoints refine(const EllipsoidPair& pair, Cluster cluster, int most_cycles) {
  constexpr double kTouch = 1e-15;  // share of the semi-axes
  const double touch = kTouch * (pair.axes_a.maxCoeff() + pair.axes_b.maxCoeff());
  Model a(pair.axes_a), b(pair.axes_b);
  Vec3 on_a = Vec3::Zero(), on_b = Vec3::Zero();  // each in its own frame
  ClosestPoints found{on_a, pair.apart, 0, false};
  while (found.rounds < most_cycles) {
    ++found.rounds;
    const QpRows rows_a = a.rows(), rows_b = b.rows();
    ActiveSetQp programme(rows_a, rows_b);
    programme.start(on_a, on_b);
    if (!programme.solve(Mat3::Identity(), pair.apart).ok) return found;
    on_a = nearest_by_newton<3>(pair.axes_a, programme.on_a()).point;
    on_b = nearest_by_newton<3>(pair.axes_b, programme.on_b()).point;
    found.on_a = on_a;
    found.on_b = pair.apart + on_b;
    if ((programme.on_a() - on_a).norm() + (programme.on_b() - on_b).norm() <= touch) {
      found.converged = true;
      return found;
    }
    a.discard(programme.active(), 0);
    b.discard(programme.active(), rows_a.offsets.size());
    const Vec3 along = (found.on_b - found.on_a).normalized();
    a.add_cluster(normal_at(pair.axes_a, on_a), along, cluster);
    b.add_cluster(normal_at(pair.axes_b, on_b), -along, cluster);
  }
  return found;
}

}  // namespace clearance::bench
