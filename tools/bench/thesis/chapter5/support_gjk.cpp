#include "tools/bench/thesis/chapter5/support_gjk.hpp"

#include <Eigen/LU>
#include <array>

#include "core/convex_body.hpp"

namespace clearance::bench {
namespace {

struct Corner {
  Vec3 on_a, on_b;
  [[nodiscard]] Vec3 between() const { return on_b - on_a; }
};

// Some of a simplex's vertices, in their order, and the weights of a point between them.
struct Part {
  std::array<int, 4> corner{};
  std::array<double, 4> weight{};
  int size = 0;
};

class Simplex {
 public:
  [[nodiscard]] int size() const { return part_.size; }
  void add(const Corner& corner) { corners_[static_cast<std::size_t>(part_.size++)] = corner; }

  // Keeps the smallest simplex that holds the point nearest to the origin (Johnson's
  // sub-algorithm). Among all simplices with the newest vertex, it is the nearest one whose nearest
  // point is inside it. Keeps none if rounding leaves no such point.
  void reduce() {
    Part best;
    double nearest = kInfinity;
    const int newest = size() - 1;
    for (int others = 0; others < 1 << newest; ++others) {
      Part part;
      const auto take = [&](int i) { part.corner[static_cast<std::size_t>(part.size++)] = i; };
      for (int i = 0; i < newest; ++i) {
        if ((others >> i & 1) != 0) take(i);
      }
      take(newest);
      if (!weigh(part)) continue;
      const double away = mean(part, [](const Corner& c) { return c.between(); }).squaredNorm();
      if (away < nearest) {
        nearest = away;
        best = part;
      }
    }
    for (std::size_t k = 0; k < static_cast<std::size_t>(best.size); ++k) {
      corners_[k] = of(best, k);
      best.corner[k] = static_cast<int>(k);
    }
    part_ = best;
  }
  [[nodiscard]] Vec3 on_a() const {
    return mean(part_, [](const Corner& c) { return c.on_a; });
  }
  [[nodiscard]] Vec3 on_b() const {
    return mean(part_, [](const Corner& c) { return c.on_b; });
  }

 private:
  [[nodiscard]] const Corner& of(const Part& part, std::size_t k) const {
    return corners_[static_cast<std::size_t>(part.corner[k])];
  }
  // Finds the point nearest to the origin in the affine hull of the part's vertices, as weights of
  // the vertices. Returns false if a weight is not positive: the point is then not inside the part.
  [[nodiscard]] bool weigh(Part& part) const {
    const Vec3 first = of(part, 0).between();
    const auto side = [&](std::size_t k) { return Vec3(of(part, k).between() - first); };
    Vec3 rest = Vec3::Zero();
    if (part.size == 2) {
      const Vec3 along = side(1);
      rest[0] = -along.dot(first) / along.squaredNorm();
    } else if (part.size == 3) {
      Eigen::Matrix<double, 3, 2> sides;
      sides << side(1), side(2);
      const Eigen::Matrix2d gram = sides.transpose() * sides;
      rest.head<2>() = gram.inverse() * (-sides.transpose() * first);
    } else if (part.size == 4) {
      Mat3 sides;
      sides << side(1), side(2), side(3);
      rest = sides.inverse() * -first;
    }
    part.weight = {1.0 - rest.sum(), rest[0], rest[1], rest[2]};
    for (std::size_t k = 0; k < static_cast<std::size_t>(part.size); ++k) {
      if (!(part.weight[k] > 0.0)) return false;
    }
    return true;
  }
  template <class Member>
  [[nodiscard]] Vec3 mean(const Part& part, const Member& member) const {
    Vec3 sum = Vec3::Zero();
    for (std::size_t k = 0; k < static_cast<std::size_t>(part.size); ++k) {
      sum += part.weight[k] * member(of(part, k));
    }
    return sum;
  }

  std::array<Corner, 4> corners_;
  Part part_;
};

Vec3 support(const Vec3& axes, const Vec3& direction) {
  const Vec3 scaled = axes.cwiseProduct(direction);
  return axes.cwiseProduct(scaled) / scaled.norm();
}

}  // namespace

ClosestPoints support_gjk(const EllipsoidPair& pair, double tolerance, int most_rounds) {
  Simplex simplex;
  Vec3 v = pair.apart;
  ClosestPoints found{Vec3::Zero(), pair.apart, 0, false};
  while (found.rounds < most_rounds) {
    ++found.rounds;
    const Corner next{support(pair.axes_a, v), Vec3(pair.apart - support(pair.axes_b, v))};
    const double length2 = v.squaredNorm();
    if (simplex.size() > 0 && length2 - v.dot(next.between()) <= tolerance * length2) {
      found.converged = true;
      break;
    }
    simplex.add(next);
    simplex.reduce();
    if (simplex.size() == 0 || simplex.size() == 4) break;  // no weights to rounding; they overlap
    const Vec3 on_a = simplex.on_a(), on_b = simplex.on_b();
    if (found.rounds > 1 && !((on_b - on_a).squaredNorm() < length2)) break;
    v = on_b - on_a;
    found.on_a = on_a;
    found.on_b = on_b;
  }
  return found;
}

}  // namespace clearance::bench
