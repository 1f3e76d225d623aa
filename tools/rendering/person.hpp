// A person made of capsules, who walks in along a path, reaches out a hand, and walks out again.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/convex_body.hpp"
#include "core/pose.hpp"

namespace clearance {

// Points on the floor in the world, m; at least two different ones in a row.
using WalkingPath = std::vector<Vec3>;
// Reads "X,Y:X,Y" or "X,Y,Z:X,Y,Z", with Z the height of the floor; or returns what is wrong.
[[nodiscard]] std::variant<WalkingPath, std::string> read_walking_path(const std::string& text);

// The state is a function of time alone, and repeats: it walks to the last point, stands there and
// reaches out its right hand, turns round, walks back and turns round again.
class WalkingPerson {
 public:
  struct Limb {
    ConvexBody shape;
    Pose world_from_limb;
  };

  // `speed`: of walking, m/s, above 0.
  WalkingPerson(WalkingPath path, double speed);

  // Places all limbs at a time after the start, s.
  void place(double t_s);
  [[nodiscard]] const std::vector<Limb>& limbs() const noexcept { return limbs_; }
  // No point of it is faster, m/s.
  [[nodiscard]] double max_speed() const noexcept;
  [[nodiscard]] double period_s() const noexcept { return period_s_; }

 private:
  enum class Action { kWalk, kTurn, kReach };
  struct Stretch {
    Action action;
    double begin_s, length_s;
    Vec3 from, to;         // of the feet
    double heading, turn;  // rad about the vertical; the change within the stretch
  };
  void add(Action action, double length_s, const Vec3& from, const Vec3& to, double heading,
           double turn);
  void add_walk(const WalkingPath& path);

  double speed_, period_s_ = 0.0;
  std::vector<Stretch> stretches_;
  std::vector<Limb> limbs_;
};

}  // namespace clearance
