// openGJK, the scalar version in doubles. It has no warm start, and hulls only.
extern "C" {
#include <openGJK/openGJK.h>
}

#include <memory>

#include "tools/bench/suite/rivals.hpp"

namespace clearance::bench {
namespace {

// Points in the body's frame and in the world, as openGJK reads them.
class Points {
 public:
  explicit Points(const std::vector<Numbers3>& points) : local_(points), world_(points) {
    for (Numbers3& p : world_) rows_.push_back(p.data());
    polytope_.numpoints = static_cast<int>(rows_.size());
    polytope_.coord = rows_.data();
  }
  Points(const Points&) = delete;
  Points& operator=(const Points&) = delete;

  const gkPolytope& at(const PlainPose& pose) {
    const auto rotation = rotation_of(pose);
    for (std::size_t i = 0; i < local_.size(); ++i) {
      const Numbers3& p = local_[i];
      for (std::size_t k = 0; k < 3; ++k) {
        const Numbers3& row = rotation[k];
        world_[i][k] = row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + pose.position[k];
      }
    }
    for (std::size_t k = 0; k < 3; ++k) polytope_.s[k] = world_[0][k];
    polytope_.s_idx = 0;
    return polytope_;
  }

 private:
  std::vector<Numbers3> local_, world_;
  std::vector<double*> rows_;
  gkPolytope polytope_{};
};

class OpenGjkPair final : public RivalPair {
 public:
  OpenGjkPair(const PlainBody& a, const PlainBody& b) : a_(a.points), b_(b.points) {}
  void forget() override {}
  double distance(const PlainPose& world_from_a, const PlainPose& world_from_b) override {
    gkSimplex simplex{};
    return compute_minimum_distance(a_.at(world_from_a), b_.at(world_from_b), &simplex);
  }

 private:
  Points a_, b_;
};

}  // namespace

std::vector<Rival> opengjk_rivals() {
  return {{"openGJK", "3, scalar, doubles; no warm start; it takes points in the world", false,
           [](const PlainBody& a, const PlainBody& b) -> std::unique_ptr<RivalPair> {
             if (a.points.empty() || b.points.empty()) return nullptr;
             return std::make_unique<OpenGjkPair>(a, b);
           }}};
}

}  // namespace clearance::bench
