// All bodies of a scene at one instant of a motion. Parts of links are placed when they are first
// asked for.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "config/scene/absent_robots.hpp"
#include "config/scene/scene.hpp"
#include "monitor/ask/chains.hpp"
#include "monitor/ask/moving_objects.hpp"
#include "monitor/ask/planned_stops.hpp"
#include "monitor/ask/trajectory.hpp"
#include "monitor/bodies/forward_kinematics.hpp"
#include "monitor/bodies/posed_part.hpp"
#include "monitor/pairs/cloud_pairs.hpp"

namespace clearance {

// The motion of an object that is no link, in a stretch.
struct ObjectApproach {
  // By its stated motion, m: no point leaves its place at the middle by more, and by more than its
  // velocity says. The velocity is constant, m/s.
  double moved = 0.0, turned = 0.0;
  Vec3 velocity = Vec3::Zero();
  // By its assumed speed.
  Nearing nearing;
};

class Posture {
 public:
  // The scene must outlive it. Allocates all memory for questions that state no motions of objects.
  explicit Posture(const Scene& scene);

  // Takes a question's trajectories, held joints and poses, or returns what is wrong with them.
  [[nodiscard]] std::optional<std::string> take(const Question& question);

  [[nodiscard]] const Trajectory& trajectory() const noexcept { return trajectory_; }
  [[nodiscard]] Chains& chains() noexcept { return chains_; }
  [[nodiscard]] const Chains& chains() const noexcept { return chains_; }
  [[nodiscard]] const std::vector<PosedPart>& parts() const noexcept { return parts_; }
  [[nodiscard]] std::span<const std::uint32_t> first_part() const noexcept { return first_part_; }
  [[nodiscard]] std::span<const VariableBounds> bounds() const noexcept { return bounds_; }
  // By variable, as bounds(): by how much it may deviate by its assumed speed. All zero unless
  // any_free().
  [[nodiscard]] std::span<const Nearing> free_variables() const noexcept { return freedom_; }
  [[nodiscard]] bool any_free() const noexcept { return any_free_; }
  // False for links of robots that the question neither moves nor holds.
  [[nodiscard]] bool is_of_question(std::uint32_t object) const noexcept {
    return is_of_question_[object] != 0;
  }
  // The age of what places the object, at the first waypoint, s: its pose, or, of a link, the
  // oldest of the positions that the question states for joints of its robot and of what carries
  // that.
  [[nodiscard]] double age(std::uint32_t object) const noexcept;
  // True for the object of a sensor; content() is what it consists of in this question.
  [[nodiscard]] bool is_seen(std::uint32_t object) const noexcept {
    return scene_.objects[object].is_seen();
  }
  // True if the question says that nothing is known of this object, and no bound counts it.
  [[nodiscard]] bool is_left_out(std::uint32_t object) const noexcept {
    return left_out_[object] != 0;
  }
  [[nodiscard]] const CloudPairs::Content& content(std::uint32_t object) const noexcept {
    return contents_[scene_.objects[object].sensor];
  }
  // Something that no motion is stated for moves this link, or a stop does that leaves the path.
  [[nodiscard]] bool may_deviate(std::uint32_t object) const noexcept {
    return may_deviate_[object] != Deviates::kNot;
  }
  [[nodiscard]] bool may_deviate_by_assumption(std::uint32_t object) const noexcept {
    return may_deviate_[object] == Deviates::kByAssumption;
  }
  // The stops that a question with `stoppable` counts: after take(), those of the motion as timed.
  [[nodiscard]] PlannedStops& stops() noexcept { return stops_; }
  void count_stops(double factor) noexcept { stops_.count_scaled(factor, trajectory_); }
  // The latest instant, on the clock of the waypoints, at which bodies may be at places of a
  // stretch up to `instant`: after place(), the end of its stretch or the middle.
  [[nodiscard]] double latest(double instant, bool is_middle) const noexcept {
    if (!stops_.counts()) return instant;
    return is_middle ? stops_.clock().middle : stops_.clock().end;
  }
  // The rounding of the motion of a sphere at a link relative to the base, m, by stated motions of
  // what their robots stand on.
  [[nodiscard]] double carrier_rounding(const Sphere& sphere, std::uint32_t base) const noexcept;
  // False for objects that the question leaves out because the scene says that they are absent.
  [[nodiscard]] bool is_present(std::uint32_t object) const noexcept {
    return present_[object] != 0;
  }
  [[nodiscard]] bool all_present() const noexcept { return all_present_; }
  [[nodiscard]] bool is_link(std::uint32_t object) const noexcept {
    return robot_of_object_[object] != kNoLink;
  }

  // Moves all joints and objects to an instant of a stretch.
  void place(const Stretch& stretch, double at) noexcept;
  // The part at this instant.
  const PosedPart& part(std::uint32_t index) noexcept {
    if (placed_at_[index] < instant_) place_link_part(index);
    return parts_[index];
  }
  // Spheres around all places of a part over the stretch, by part of objects that are no links.
  [[nodiscard]] std::span<const Sphere> swept_spheres() const noexcept { return swept_; }
  // Zero for fixed objects and links.
  [[nodiscard]] const ObjectApproach& approach(std::uint32_t object) const noexcept {
    return approaches_[object];
  }
  // The velocity of the part's object, m/s and rad/s, and the origin that it refers to. Zero for
  // objects that are no links.
  [[nodiscard]] Twist twist(std::uint32_t object, Vec3& origin) const noexcept;
  // The same of the object that carries a link's robot.
  [[nodiscard]] Twist twist_of_carrier(std::uint32_t link_object, Vec3& origin) const noexcept;

 private:
  static constexpr std::uint32_t kNoLink = ~0u;

  [[nodiscard]] std::optional<std::string> take_joints(const Question& question);
  [[nodiscard]] std::optional<std::string> hold(const HeldJoint& held);
  [[nodiscard]] std::optional<std::string> set_deviations();
  [[nodiscard]] Instants elapsed(const Stretch& stretch, double at) const noexcept;
  [[nodiscard]] std::optional<std::string> set_free(const StatedJoint& stated, OthersMove others);
  [[nodiscard]] std::optional<std::string> set_variable(const std::string& name, double position,
                                                        std::uint32_t& variable);
  void free_carriers(const Question& question);
  void note_free();
  void leave_out_absent_robots() noexcept;
  [[nodiscard]] std::optional<std::string> open_joint() const;
  [[nodiscard]] std::optional<std::string> beyond_limits(const Question& question) const;
  [[nodiscard]] std::optional<std::string> take_poses(const Question& question);
  [[nodiscard]] std::optional<std::string> take_motions(const Question& question);
  [[nodiscard]] std::optional<std::string> open_object(const Question& question);
  // Finds an object whose pose the question may state.
  [[nodiscard]] std::optional<std::string> find_free(const std::string& name,
                                                     std::uint32_t& object) const;
  [[nodiscard]] std::optional<std::string> take_frame(const SeenFrame& frame);
  // Takes a pose of an object, or a frame of a sensor.
  [[nodiscard]] std::optional<std::string> take_pose(const std::string& name, std::uint32_t object,
                                                     const Pose& pose, double age);
  void place_resting(std::uint32_t object) noexcept;
  void sweep(std::uint32_t object) noexcept;
  void place_bases() noexcept;
  void note_moving() noexcept;
  void place_link_part(std::uint32_t index) noexcept;
  void place_free_objects(const Stretch& stretch, double at) noexcept;
  void place_carriers() noexcept;
  void note_freedom(const Stretch& stretch, double at) noexcept;
  [[nodiscard]] const LinkState& link_state(std::uint32_t object) const noexcept;

  const Scene& scene_;
  std::unordered_map<std::string_view, std::uint32_t> object_named_;
  std::vector<PosedPart> parts_;
  std::vector<Sphere> swept_;  // by part
  std::vector<std::uint32_t> first_part_;
  std::vector<std::uint64_t> placed_at_;  // by part: the number of the instant
  std::uint64_t instant_ = 0;
  Chains chains_;
  Trajectory trajectory_;
  PlannedStops stops_;
  std::vector<TrackedVariable> variables_;
  std::vector<VariableBounds> bounds_;
  ForwardKinematics kinematics_;
  std::vector<std::uint8_t> moves_;  // by robot
  bool is_placed_ = false;           // all robots are, in this question
  std::vector<LinkState> bases_;
  std::vector<std::uint32_t> robot_of_object_, link_of_object_;  // kNoLink: not a link
  std::vector<std::uint32_t> free_;               // objects that are neither fixed nor links
  std::vector<std::uint8_t> carries_;             // by object: a robot stands on it
  std::vector<double> radii_;                     // by object: about its origin, m
  std::vector<Pose> pose_;                        // of objects that are not links
  std::vector<std::uint8_t> present_, left_out_;  // by object
  AbsentRobots absent_robots_;
  bool all_present_ = true;
  std::vector<double> speed_, age_;  // by object: that are assumed, m/s; of a stated pose, s
  std::vector<double> turn_speed_;   // by object, rad/s
  std::vector<ObjectApproach> approaches_;
  MovingObjects moving_;
  std::vector<std::uint32_t> moving_objects_;

  // The assumed speed of a variable, as bounds_ counts them, that no motion is stated for.
  struct FreeVariable {
    std::uint32_t variable = 0;
    double speed = 0.0, age = 0.0;  // per second; s
    double most = kInfinity;        // its limits allow no larger deviation
  };
  std::vector<FreeVariable> free_variables_;
  std::vector<std::uint8_t> is_free_, is_stated_;  // by variable: while note_free() runs
  std::vector<Nearing> freedom_;
  bool any_free_ = false;
  enum class Deviates : std::uint8_t { kNot, kByStop, kByAssumption };
  std::vector<std::uint8_t> is_of_question_;   // by object
  std::vector<Deviates> may_deviate_;          // by object
  std::vector<CloudPairs::Content> contents_;  // by sensor
  double carrier_extent_ = 0.0;  // m: the sum of the largest positions of moving carriers
};

}  // namespace clearance
