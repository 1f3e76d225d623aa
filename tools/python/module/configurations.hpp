// The distances of a cell's pairs in given configurations, each by itself: no time, no motion.
//
// A pair's bounds are those of its parts at the exact poses of forward kinematics, rounding
// included. Parts whose bounding spheres prove them farther than another part of the pair are not
// queried. With a limit, neither are those that are proven to be beyond it. README.md measures it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "config/scene/absent_robots.hpp"
#include "config/scene/scene.hpp"
#include "config/scene/stated_errors.hpp"
#include "core/distance.hpp"
#include "monitor/bodies/bounding_sphere.hpp"
#include "monitor/bodies/forward_kinematics.hpp"
#include "monitor/bodies/joint_screw.hpp"
#include "monitor/bodies/posed_part.hpp"
#include "monitor/interface/question.hpp"

namespace clearance::python {

// The places for the results of a configuration: `pairs` values each, three times as many of
// vectors, and pairs * variables of gradients. Null: not wanted.
struct ConfigurationResults {
  double *distance = nullptr, *lower = nullptr, *upper = nullptr;
  std::uint8_t* status = nullptr;                                        // PairStatus
  std::uint32_t *part_a = nullptr, *part_b = nullptr;                    // closest parts
  double *witness_a = nullptr, *witness_b = nullptr, *normal = nullptr;  // in the world
  double* gradient = nullptr;                                            // m/rad or m/m
};

class Configurations {
 public:
  // The scene must outlive this.
  explicit Configurations(const Scene& scene);

  // Places a moving object that is no link, for all configurations that follow.
  void place(std::uint32_t object, const Pose& world_from_object);

  // A new series of configurations: the same series gives the same bits. Poses of objects are
  // forgotten.
  void begin();
  // The same, with the poses as they are.
  void forget_tracking() noexcept;
  // The pairs that count from now on, as indices into Scene::pairs, in the order of the results.
  void choose(std::span<const std::uint32_t> pairs) { chosen_.assign(pairs.begin(), pairs.end()); }

  // A position that is not finite or not plausible: beyond the joint's limits and their tolerance,
  // or in a quaternion that has not length 1.
  struct Implausible {
    std::uint32_t variable;
    double length = 1.0;  // of the quaternion that begins there
  };
  // The first one. An absent robot may have no position at all: all of its joints are NaN.
  [[nodiscard]] std::optional<Implausible> implausible(std::span<const double> joints);

  // `joints`: plausible positions in the order of Scene::variables. Allocates nothing. Pairs of
  // absent objects that have no place are absent.
  void evaluate(std::span<const double> joints, const ConfigurationResults& to) noexcept;
  // Decides whether one of the chosen pairs is nearer than `limit`, m, and stops at the first one
  // that is. Results of pairs that it did not need have the bounds that it knows, and else those of
  // an unknown pair.
  [[nodiscard]] Verdict decide(std::span<const double> joints, double limit,
                               const ConfigurationResults& to) noexcept;

 private:
  // A joint position that moves one object of a pair relative to the other.
  struct Term {
    std::uint32_t robot, joint, first_variable, count;
    bool moves_b;
  };
  struct Pair {
    std::uint32_t a, b;         // objects
    std::uint32_t first_state;  // of its part pairs, part by part of A
    std::uint32_t closest = 0;  // the part pair that was closest in the last configuration
    std::uint32_t first_term = 0, end_term = 0;
  };
  // The closest parts of a pair.
  struct Closest {
    double lower = kInfinity, upper = kInfinity;
    std::uint32_t part_pair = 0;
    DistanceResult found;
  };

  void find_left_out(std::span<const double> joints) noexcept;
  void place(std::span<const double> joints) noexcept;
  void place_links() noexcept;
  void put(std::uint32_t object, const Pose& pose) noexcept;
  [[nodiscard]] bool is_known(const Pair& pair) const noexcept;
  // Of an absent object that no position or pose places.
  [[nodiscard]] bool is_absent(const Pair& pair) const noexcept;
  void write_unknown(std::size_t index, const ConfigurationResults& to) const noexcept;
  void query(const Pair& pair, std::uint32_t part_pair, Closest& closest) noexcept;
  // Parts that are proven to be at least `enough` apart, m, need no query.
  void evaluate(Pair& pair, std::size_t index, double enough,
                const ConfigurationResults& to) noexcept;
  void differentiate(const Pair& pair, const Vec3& on_a, const Vec3& on_b, const Vec3& normal,
                     double* rates) noexcept;

  const Scene& scene_;
  StatedErrors errors_;
  ForwardKinematics kinematics_;
  std::vector<TrackedVariable> variables_;
  AbsentRobots absent_robots_;
  std::vector<double> least_, largest_;        // plausible positions, by variable
  std::vector<LinkState> bases_;               // by robot
  std::vector<std::uint8_t> known_, is_link_;  // by object
  std::vector<PosedPart> parts_;
  std::vector<std::uint32_t> first_part_;  // by object
  std::vector<Pose> poses_;                // by object, if known
  std::vector<BoundingSphere> spheres_;    // likewise
  std::vector<TrackingState> states_;      // by part pair
  std::vector<Pair> pairs_;
  std::vector<std::uint32_t> chosen_;  // indices into pairs_
  std::size_t first_looked_at_ = 0;    // index into chosen_: the pair that decided the last time
  std::vector<Term> terms_;
};

}  // namespace clearance::python
