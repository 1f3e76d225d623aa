#include <fcl/narrowphase/detail/gjk_solver_indep.h>
#include <fcl/narrowphase/detail/gjk_solver_libccd.h>

#include <variant>

#include "tools/bench/peers/fcl_bodies.hpp"
#include "tools/bench/peers/peers.hpp"
#include "tools/bench/solver_rows.hpp"
#include "tools/bench/suite/rivals.hpp"
#include "tools/bench/suite/solver_rival.hpp"

namespace clearance::bench {
namespace {

// FCL's solvers are functions of the shapes' types. Selects the one for a pair of types.
template <class Use>
void with_types(const FclShape& a, const FclShape& b, const Use& use) {
  std::visit(
      [&](const auto& shape_a) {
        std::visit([&](const auto& shape_b) { use(*shape_a, *shape_b); }, b);
      },
      a);
}

class Pair {
 public:
  using Shape = FclShape;
  static Shape shape(const ConvexBody& body) { return fcl_shape(body); }
  Pair(Shape a, Shape b) : a_(std::move(a)), b_(std::move(b)) {}

 protected:
  template <class Gjk>
  Answer ask(const Gjk& gjk, const Pose& world_from_a, const Pose& world_from_b) {
    double apart = 0.0;
    fcl::Vector3d on_a, on_b;
    with_types(a_, b_, [&](const auto& a, const auto& b) {
      gjk.shapeDistance(a, fcl_transform(world_from_a), b, fcl_transform(world_from_b), &apart,
                        &on_a, &on_b);
    });
    return {.distance = apart};
  }
  Shape a_, b_;
};

template <int kDigits>
class WithLibccd : public Pair {
 public:
  WithLibccd(Shape a, Shape b) : Pair(std::move(a), std::move(b)) {
    gjk_.distance_tolerance = std::pow(10.0, -kDigits);
  }
  void forget() {}
  Answer query(const Pose& a, const Pose& b) { return ask(gjk_, a, b); }

 private:
  fcl::detail::GJKSolver_libccd<double> gjk_;
};

// FCL starts from minus its guess and returns its last ray with the original sign. So an unchanged
// guess would point away from the other body. Its sign is reversed here, for FCL's best speed.
class WithOwnGjk : public Pair {
 public:
  WithOwnGjk(Shape a, Shape b) : Pair(std::move(a), std::move(b)) { gjk_.gjk_tolerance = 1e-12; }
  void forget() { gjk_.enableCachedGuess(false); }
  Answer query(const Pose& a, const Pose& b) {
    const bool tracked = gjk_.enable_cached_guess;
    gjk_.enableCachedGuess(true);
    if (tracked) {
      gjk_.setCachedGuess(-gjk_.getCachedGuess());
    } else {  // the line of centres, better than FCL's own first guess, the x axis
      gjk_.setCachedGuess(a.orientation.conjugate() * (b.position - a.position));
    }
    return ask(gjk_, a, b);
  }

 private:
  fcl::detail::GJKSolver_indep<double> gjk_;
};

}  // namespace

// Without depths: an assertion in FCL's EPA, which Debian's library contains, ends the program on
// some pairs that touch.
std::vector<Rival> fcl_rivals() {
  return {
      solver_rival<WithLibccd<6>>(
          "FCL", "0.7, its default: libccd, 1e-6; no warm start; depths abort the program", false),
      solver_rival<WithOwnGjk>("FCL, own GJK", "0.7, 1e-12, cached guess; no depths", false)};
}

void register_fcl(RowSet set) {
  const std::initializer_list<std::string_view> lacking = {"truncated_cone", "rounded_box"};
  register_peer<WithLibccd<6>>(set, "fcl", lacking);
  register_peer<WithLibccd<12>>(set, "fcl-tight", lacking);
  register_peer<WithOwnGjk>(set, "fcl-gjk", lacking);
}

}  // namespace clearance::bench
