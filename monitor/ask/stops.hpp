// Stage 'stop' of a tick: where robots that state how they stop may be until they stand, if they
// are told to stop now. The question is the same as that of a client about a motion, so that bounds
// and proofs are those of MotionSearch. STOPS.md says what is assumed.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/ask/chains.hpp"
#include "monitor/ask/stopping_joints.hpp"
#include "monitor/bodies/ingest.hpp"
#include "monitor/interface/question.hpp"
#include "monitor/interface/report.hpp"
#include "monitor/pairs/cloud_pairs.hpp"
#include "monitor/zones/contacts.hpp"

namespace clearance {

class MotionSearch;

class Stops {
 public:
  // The scene must outlive it. Allocates all memory; none if no robot states how it stops.
  explicit Stops(const Scene& scene);
  ~Stops();

  // Gives the report's list its size; nothing is known.
  void prepare(Report& report) const;

  // `report.pairs` are of this tick. `clouds`: null if the scene has no sensors.
  void write(const Inputs& inputs, const CloudPairs* clouds, const Contacts& contacts,
             Report& report) noexcept;

 private:
  struct WatchedPair {
    std::uint32_t pair = 0;       // index into Scene::pairs
    std::uint32_t published = 0;  // index into Report::pairs, or kNone
    double margin = 0.0;          // m: the largest that a zone states for it; 0: none
    // What brings its bodies nearer to each other: these levers, and the motion of `tracked`.
    std::uint32_t first_lever = 0, end_lever = 0;
    std::uint32_t tracked = 0;  // neither fixed nor a link; Scene::objects, or kNone
    double model_error = 0.0;   // m
    bool is_of_stops = false;   // only joints of robots that state stops move it
    bool is_absent = false;     // in this tick
  };
  struct StoppingRobot {
    StoppingRobot(const Scene& scene, std::uint32_t of);

    std::uint32_t robot;
    Question question;
    Answer answer;
    StoppingJoints joints;
    std::vector<std::uint32_t> links;  // that move with it; Scene::objects
    std::vector<WatchedPair> pairs;
    std::vector<bool> counts;       // by variable, as Lever: whether it moves an object of a pair
    std::vector<Lever> levers;      // of all pairs
    std::vector<double> margins;    // by Scene::pairs, in this tick
    std::vector<KnownBound> known;  // the same
  };
  static constexpr std::uint32_t kNone = ~0u;

  void add_pairs(StoppingRobot& robot) const;
  void add_others(StoppingRobot& robot) const;
  void make_room(StoppingRobot& robot);
  [[nodiscard]] bool stops(std::uint32_t variable) const noexcept;

  [[nodiscard]] static RobotStop unknown_stop(const StoppingRobot& robot) noexcept {
    return {.robot = robot.robot,
            .clearance = -kInfinity,
            .pair = robot.pairs.empty() ? 0 : robot.pairs.front().pair,
            .time = std::numeric_limits<double>::quiet_NaN()};
  }
  [[nodiscard]] static bool is_absent(const Inputs& inputs, const StoppingRobot& robot) noexcept;
  void state_others(const Inputs& inputs, const CloudPairs* clouds, double time,
                    StoppingRobot& robot) const noexcept;
  // Writes which pairs and margins count in this tick. Returns the first pair with an object that
  // may be anywhere.
  [[nodiscard]] std::optional<std::uint32_t> unknown_pair(const Inputs& inputs,
                                                          const Contacts& contacts,
                                                          StoppingRobot& robot) const noexcept;
  // Writes what is known of each pair without a search. Returns whether that is enough.
  [[nodiscard]] bool bound_by_levers(const Inputs& inputs, const Report& report,
                                     StoppingRobot& robot) noexcept;
  void note_changes(const Inputs& inputs, const StoppingRobot& robot) noexcept;
  // Each robot whose stop moves a pair has a bound for its own time. A pair that moves by stops
  // alone is bounded for as long as all of them take. Else the lowest bound counts.
  [[nodiscard]] bool holds_for_all(const WatchedPair& pair) const noexcept {
    return pair.is_of_stops && all_usable_;
  }
  void publish(const WatchedPair& pair, double lower, Report& report) const noexcept;
  // `bound`: by pair.
  template <class Bound>
  void write_bounds(const StoppingRobot& robot, const Bound& bound, Report& report,
                    RobotStop& out) const noexcept;
  [[nodiscard]] double largest_scaling(double clear_share, StoppingRobot& robot) noexcept;
  // Returns whether the stop is known.
  [[nodiscard]] bool write(const Inputs& inputs, const CloudPairs* clouds, StoppingRobot& robot,
                           Report& report, RobotStop& out) noexcept;

  const Scene& scene_;
  std::vector<StoppingRobot> robots_;
  std::vector<std::uint32_t> order_;              // of robots_, in this tick
  std::vector<std::uint32_t> stopping_of_robot_;  // by Scene::robots; kNone: states none
  std::vector<std::uint32_t> robot_of_object_;    // kNone: no link
  std::vector<std::uint32_t> tracked_;            // objects that are neither fixed nor links
  // Until the robot stands: by variable, rad or m; by object that is neither fixed nor a link, m.
  std::vector<double> changes_, approaches_;
  // By Scene::variables: where a joint is taken to be while it is not known.
  std::vector<double> neutral_;
  bool all_usable_ = false;  // in this tick: all robots that state stops and are there
  std::unique_ptr<MotionSearch> search_;
};

}  // namespace clearance
