// Stage 'differentiate' of a tick: the derivatives of the distances of published pairs by the
// positions of joints.
//
// A distance changes at the rate n . (v_b - v_a). The normal n points from A to B, and v is the
// velocity of a witness point that is fixed to its object. If the closest points are unique, their
// motion on the surfaces makes no difference (the envelope theorem). So
//
//   d distance / d q = n . (J_b - J_a),   J dq: how q moves the object at its witness point.
//
// The same holds for a penetration depth along its normal. The distance has no gradient where
// several pairs of points are closest (parallel faces, two parts at once). The result is then that
// of the points found, which is one of its generalised gradients. alternatives.hpp says so.
//
// Measured with two arms of seven joints (config/cells/seven_joint_arms.yaml, `clearance-bench
// --benchmark_filter=^robot/tick`): 22 us for 219 pairs with 1,430 entries, and 14 us more for
// their alternatives, beside a tick of 53 us. A scene that does not ask for gradients pays nothing.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/bodies/joint_screw.hpp"
#include "monitor/bodies/robot_inputs.hpp"
#include "monitor/interface/gradient_rows.hpp"
#include "monitor/pairs/tick_view.hpp"

namespace clearance {

class Differentiation {
 public:
  // Allocates all it will ever need. The scene must outlive this.
  explicit Differentiation(const Scene& scene);

  [[nodiscard]] const GradientRows& rows() const noexcept { return rows_; }

  // `pairs`: the published ones as of this tick, `view`; `inputs`: with links placed in this tick;
  // `gradients`: made by unknown_gradients() of the rows. Allocates, throws and locks nothing.
  void differentiate(std::span<const PairReport> pairs, const TickView& view,
                     const RobotInputs& inputs, Gradients& gradients) noexcept;

  // Calls visit(name, table) with each table that nothing changes after construction.
  template <class Visit>
  void each_constant(Visit&& visit) const {
    visit("rows of gradients", rows_.rows);
    visit("variables of gradients", rows_.variables);
    visit("joints of gradients", moving_);
    visit("terms of rows", terms_of_);
    visit("terms of gradients", terms_);
  }

 private:
  // A joint whose screws are computed.
  struct Moving {
    std::uint32_t robot, joint;
    std::uint32_t first_screw;
  };
  // The contribution of one position of a joint to an entry.
  struct Term {
    std::uint32_t screw, entry;
    bool moves_b;
  };
  struct Terms {  // of a row, the latter excluded
    std::uint32_t first, end;
  };

  [[nodiscard]] std::uint32_t first_screw_of(const MovingJoint& joint);
  void add_terms(const GradientRow& row, const ObjectPair& pair);
  void find_screws(const RobotInputs& inputs) noexcept;

  const Scene& scene_;
  GradientRows rows_;
  std::vector<Moving> moving_;
  std::vector<JointScrew> screws_;
  std::vector<Terms> terms_of_;  // by row
  std::vector<Term> terms_;
  std::vector<Vec3> turns_;  // of the row at hand
};

}  // namespace clearance
