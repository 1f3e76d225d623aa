// All bodies of a scene at one instant of a motion. Parts are placed when they are first asked for.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/ask/chains.hpp"
#include "monitor/ask/trajectory.hpp"
#include "monitor/geometry/posed_part.hpp"
#include "monitor/kinematics/forward_kinematics.hpp"

namespace clearance {

class Posture {
 public:
  // The scene must outlive it. Allocates all memory that it ever needs.
  explicit Posture(const Scene& scene);

  // Takes a question's trajectory, held joints and poses, or returns what is wrong with them.
  [[nodiscard]] std::optional<std::string> take(const Question& question);

  [[nodiscard]] const Trajectory& trajectory() const noexcept { return trajectory_; }
  [[nodiscard]] Chains& chains() noexcept { return chains_; }
  [[nodiscard]] const std::vector<PosedPart>& parts() const noexcept { return parts_; }
  [[nodiscard]] std::span<const std::uint32_t> first_part() const noexcept { return first_part_; }
  [[nodiscard]] std::span<const VariableBounds> bounds() const noexcept { return bounds_; }
  // False for objects that the question leaves out because the scene says that they are absent.
  [[nodiscard]] bool is_present(std::uint32_t object) const noexcept {
    return present_[object] != 0;
  }
  // StatedPose::age; 0 for all other objects.
  [[nodiscard]] double age(std::uint32_t object) const noexcept { return age_[object]; }

  // Moves all joints to an instant of a stretch.
  void place(const Stretch& stretch, double at) noexcept;
  // The part at this instant.
  const PosedPart& part(std::uint32_t index) noexcept;
  // The velocity of the part's object, m/s and rad/s, and the origin that it refers to.
  [[nodiscard]] Twist twist(std::uint32_t object, Vec3& origin) const noexcept;

 private:
  [[nodiscard]] std::optional<std::string> take_joints(const Question& question);
  [[nodiscard]] std::optional<std::string> take_poses(const Question& question);
  [[nodiscard]] std::optional<std::string> slide_out_of_limits() const;
  void place_resting() noexcept;
  [[nodiscard]] const LinkState& link_state(std::uint32_t object) const noexcept;

  const Scene& scene_;
  std::vector<PosedPart> parts_;
  std::vector<std::uint32_t> first_part_;
  std::vector<std::uint64_t> placed_at_;  // by part: the number of the instant
  std::uint64_t instant_ = 0;
  Chains chains_;
  Trajectory trajectory_;
  std::vector<TrackedVariable> variables_;
  std::vector<VariableBounds> bounds_;
  ForwardKinematics kinematics_;
  std::vector<LinkState> bases_;
  std::vector<std::uint32_t> robot_of_object_, link_of_object_;  // kNoLink: not a link
  std::vector<Pose> pose_;                                       // of objects that are not links
  std::vector<std::uint8_t> present_;                            // by object
  std::vector<double> age_;                                      // by object
};

}  // namespace clearance
