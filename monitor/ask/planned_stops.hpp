// The robots that a question moves may be told to stop at any instant of its motion: where they may
// be until they stand, and when. PLANNED_STOPS.md has the region with its proof.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/ask/chains.hpp"
#include "monitor/ask/trajectory.hpp"
#include "monitor/bodies/tracked_variable.hpp"
#include "monitor/interface/question.hpp"

namespace clearance {

// Times of what the question does not move, s: at the end of a stretch, its middle and its begin.
struct Instants {
  double end = 0.0, middle = 0.0, begin = 0.0;
};

class PlannedStops {
 public:
  // Allocates for robots of this scene. The scene must outlive it.
  explicit PlannedStops(const Scene& scene);

  // Reads a question whose trajectory is known, or returns why nothing is known of its stops.
  // The trajectory gets a further segment if the robot still moves at its end.
  [[nodiscard]] std::optional<std::string> take(const Question& question, Trajectory& trajectory);

  // Counts stops of the motion as it is timed.
  void count(Trajectory& trajectory) noexcept { count(1.0, false, trajectory); }
  // Counts those of the motion with its speeds times `factor`, in (0, 1]. Others are where the
  // question states them at the instant at which the robot is told to stop.
  void count_scaled(double factor, Trajectory& trajectory) noexcept {
    count(factor, true, trajectory);
  }
  // Leaves the robots where the motion has it, until the next count().
  void count_none() noexcept { counts_ = false; }
  [[nodiscard]] bool counts() const noexcept { return counts_; }
  // A joint may leave the path in a stop.
  [[nodiscard]] bool may_deviate() const noexcept { return may_deviate_; }

  // After Trajectory::place(): moves the joints to the middle of where they may be.
  void place(const Stretch& stretch, double at, std::span<TrackedVariable> variables) noexcept;
  // After place(): adds by how much the joints deviate from there.
  void add_deviations(std::span<Nearing> freedom) const noexcept;
  // After place(): for how long the others have moved when the robot is at places of the stretch.
  // With count() it is since the first waypoint, with count_scaled() since the robot was told to
  // stop.
  [[nodiscard]] const Instants& elapsed() const noexcept { return elapsed_; }
  // The same on the clock of the waypoints.
  [[nodiscard]] const Instants& clock() const noexcept { return clock_; }

 private:
  struct Joint {
    std::uint32_t variable = 0;
    std::uint32_t robot = 0;  // into robots_
    const JointStop* stop = nullptr;
    bool slides = false;
    Nearing deviation = {};  // from the middle of where it may be
  };
  // A part of a segment, in which the largest speeds count for all stops.
  struct Piece {
    Stretch stretch;
    double reach = 0.0;    // s: a stop that begins here goes on for no more of the path
    double braking = 0.0;  // s: until all stand
    // The latest instant at which a stop that begins in an earlier piece and reaches this one is
    // over, s since the first waypoint. With since_told_: the longest braking, s.
    double earlier = -kInfinity;
  };
  // The places of a joint beside the path, in a stop that begins in a piece.
  struct Box {
    double low = 0.0, high = 0.0;
  };

  void count(double factor, bool since_told, Trajectory& trajectory) noexcept;
  [[nodiscard]] std::optional<std::string> take_joints(const Question& question,
                                                       const Trajectory& trajectory);
  void add_pieces(const Trajectory& trajectory, const Stretch& stretch, double longest);
  void bound(std::size_t piece) noexcept;
  void bound_together() noexcept;
  // How far the motion takes a joint back and forth within a time, s of the motion, from anywhere
  // in a piece.
  [[nodiscard]] Box path_within(std::size_t piece, std::size_t joint, double time) const noexcept;
  // Returns the piece after all those in which a stop, told in `piece`, may begin within `time`.
  [[nodiscard]] std::size_t past_window(std::size_t piece, double time) const noexcept;
  [[nodiscard]] double time_past_the_end() const noexcept;
  void note_earlier() noexcept;
  // What elapsed() says for one instant.
  [[nodiscard]] double elapsed_at(double t, double braking, double earlier) const noexcept;
  void find_pieces(const Stretch& stretch, double at) noexcept;

  const Scene& scene_;
  std::vector<const RobotStops*> robots_;
  double reaction_ = 0.0;  // s: the longest of these
  bool counts_ = false, may_deviate_ = false;
  bool together_ = false;  // several robots stop; pieces are those in which they are told
  bool goes_on_ = false, since_told_ = false;
  double factor_ = 1.0;
  double begin_ = 0.0, end_ = 0.0;  // s: the first waypoint and the last one
  std::vector<Joint> joints_;
  std::vector<double> onward_;              // by joint: its velocity past the last waypoint
  std::vector<Piece> pieces_;               // in the order of time
  std::vector<std::uint32_t> first_piece_;  // by segment, and the end
  std::vector<VelocityRange> velocities_;   // by piece and joint, as the motion is timed
  std::vector<Box> boxes_;                  // by piece and joint
  std::vector<double> reaches_;             // by piece and robot: as Piece::reach
  std::size_t from_ = 0, to_ = 0, at_ = 0;  // pieces of the last place(): the first, the last, and
                                            // that of its middle
  Instants elapsed_, clock_;
};

}  // namespace clearance
