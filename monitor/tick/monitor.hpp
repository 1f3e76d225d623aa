// The tick: poses come in, a report goes out. It knows neither DDS nor a clock. The daemon, the
// offline replay and the tests all call this one function.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "config/scene/carrier.hpp"
#include "config/scene/scene.hpp"
#include "config/scene/scene_map.hpp"
#include "config/scene/stated_errors.hpp"
#include "monitor/inputs/joint_batch.hpp"
#include "monitor/inputs/pose_batch.hpp"
#include "monitor/inputs/refused_value.hpp"
#include "monitor/inputs/source_numbers.hpp"
#include "monitor/inputs/state_bytes.hpp"
#include "monitor/inputs/tick_time.hpp"
#include "monitor/interface/present_inputs.hpp"
#include "monitor/interface/report.hpp"
#include "monitor/interface/robots_seen.hpp"
#include "monitor/schedule/swept_bounds.hpp"

namespace clearance {

struct InputAge {
  // now - stamp, never negative; 0 for a fixed object; -1: no value is in use.
  std::int64_t age_ns = -1;
  bool stale = false;           // older than the object's limit, or contradicted
  bool contradicted = false;    // by later samples that the object or joint cannot have reached
  bool follows_joints = false;  // a link whose pose follows from joints: the age is theirs
  bool absent = false;          // see Monitor::set_absent
  // PoseSample::source of the owner, and of the last source that was refused because it is not the
  // owner.
  std::uint32_t source = kNoSource, other_source = kNoSource;
  // The number of times that another source took over, and the owner before the last of them.
  std::uint32_t takeovers = 0, former_source = kNoSource;
  bool velocities_contradict = false;  // of a joint: its sent velocities contradict its positions
};

class SeenCloud;  // monitor/clouds
class SelfTest;

// A frame of a sensor, as the tick takes it.
struct SensorFrame {
  const SeenCloud* cloud = nullptr;  // not empty
  std::int64_t stamp_ns = 0;         // of its content, CLOCK_REALTIME of the sender
  Pose world_from_sensor;            // at that time
  double pose_error = 0.0;           // m: no element is farther from its exact place in the world
  // Frames of the same content are the same to the bit. 0: not known.
  std::uint64_t content = 0;
  Carrier carrier = {};    // what has placed it: while that is unknown, so is what the frame shows
  RobotsSeen robots = {};  // by a sensor that is a witness
};

// The part of a pair's model error that one source has, m (config/scene/stated_errors.hpp).
struct ErrorShare {
  std::uint32_t source = 0;  // index into StatedErrors::sources()
  double metres = 0.0;
};

class Monitor {
 public:
  // Allocates all memory that it ever needs. The scene must outlive the monitor. `similar`, if not
  // null, is the monitor of a scene with partly the same bodies. What it knows of their shapes is
  // used again, if its self-test holds. It may tick in another thread meanwhile.
  explicit Monitor(const Scene& scene, const Monitor* similar = nullptr);
  ~Monitor();
  Monitor(const Monitor&) = delete;
  Monitor& operator=(const Monitor&) = delete;

  // For a changed scene, before the first tick and between two ticks of `before`: goes on with the
  // inputs and zones of that monitor. `map` is that of the two scenes. `numbers` has numbered the
  // sources of the samples that `before` got, and numbers those of both from now on. Returns false,
  // and changes nothing, if both scenes name too many sources (add_named()). The same ticks
  // then bring both monitors to the same inputs. No bound of a pair is taken over: the first ticks
  // find them afresh. If both have the same scene, the first tick takes the frames in use, whose
  // clouds both monitors then use; if not, the objects of sensors are unknown until their next
  // frames. Does not allocate, throw or lock. The time grows with the number of objects,
  // not with that of pairs.
  [[nodiscard]] bool take_over(const Monitor& before, const SceneMap& map,
                               SourceNumbers& numbers) noexcept;

  // The state that take_over() gives to a monitor before its first tick, as bytes for another
  // process of the same build.
  void save(StateWriter& out) const;
  // Before the first tick of a monitor of the same scene: goes on with that state, as take_over()
  // does. The same ticks then give both the same bits, if the frames that it awaits are shown
  // before. Returns false if the bytes are of another scene; this monitor must then not be used.
  [[nodiscard]] bool restore(StateReader& in) noexcept;
  // The content of the frame of this sensor that restore() has found to be in use; 0: none, or it
  // has been shown.
  [[nodiscard]] std::uint64_t awaited_frame(std::uint32_t sensor) const noexcept;

  // A checksum of where all objects are, and of one of kStateSlices slices of what else is known of
  // objects, parts and pairs: another slice in each tick. The same ticks give the same one.
  static constexpr std::uint32_t kStateSlices = 8;
  [[nodiscard]] std::uint64_t checksum() const noexcept;

  // The number of ticks so far, those of the monitors that it took over from included.
  [[nodiscard]] std::uint64_t cycle() const noexcept;

  // Runs one cycle: takes in the samples in the given order, those of joints first. Refused samples
  // are counted and never used. Then it moves the objects, carries bounds forward, evaluates pairs
  // within the budget, and updates the zones. The report is valid until the next tick. Does not
  // allocate, throw or lock. The same inputs give the same bits.
  const Report& tick(std::span<const PoseSample> samples, std::span<const JointSample> joints,
                     const TickTime& time) noexcept;
  // For a cell without robots.
  const Report& tick(std::span<const PoseSample> samples, const TickTime& time) noexcept {
    return tick(samples, {}, time);
  }

  // Counts a sample that was refused before the tick (in a batch made for another scene). Reports
  // include it from the next tick on. If the scene has no such object, only the totals count it.
  void refuse(std::uint32_t object, Reject cause) noexcept;

  // To be called between ticks: from the next tick on, a moving object is known not to be there, or
  // is there again. An absent object has no pose, and its samples are refused like those of an
  // unknown object. Its pairs are kAbsent: they depend on no input, make no zone active, and are
  // left out of the minimum. When the object is present again, nothing from before its absence is
  // trusted: its pairs are unknown until its next pose. Returns false if the scene has no such
  // object, or if it is fixed. The time grows with the number of its pairs.
  bool set_absent(std::uint32_t object, bool absent) noexcept;

  // To be called between ticks: the next tick takes this frame into use, in the place of the
  // sensor's former one, unless its stamp is in the future or before that one. The cloud must not
  // change while uses() says so. Returns
  // false, and changes nothing, if the scene has no such sensor or the cloud is empty: that an
  // empty frame is clear is never certain.
  bool show(std::uint32_t sensor, const SensorFrame& frame) noexcept;
  // True if the cloud is that of a frame in use, or of one that the next tick takes.
  [[nodiscard]] bool uses(const SeenCloud* cloud) const noexcept;
  // The frame of a sensor that the last tick used; its cloud is null: none.
  [[nodiscard]] SensorFrame frame_in_use(std::uint32_t sensor) const noexcept;

  // What each tick checks of the memory that no tick changes. Once it has failed, no report is to
  // be believed.
  [[nodiscard]] const SelfTest& self_test() const noexcept;

  // What the pair's model error at its last evaluation consists of, by source, the largest first;
  // of first order. Empty: nothing is stated for it, or it was never evaluated. Allocates.
  [[nodiscard]] std::vector<ErrorShare> error_shares(std::uint32_t pair) const;
  [[nodiscard]] const StatedErrors& stated_errors() const noexcept;

  // Any pair at the last tick, whether it is published or not. All are unknown before the first
  // tick.
  [[nodiscard]] PairReport pair(std::uint32_t pair) const noexcept;

  // The same. If the lower bound is below `level`, m, queries without a budget decide whether the
  // distance is. Changes nothing.
  [[nodiscard]] PairReport pair_at_least(std::uint32_t pair, double level) const noexcept;

  // Bounds of a pair's distance between the last two ticks: PairReport::swept_lower. If that is
  // below `level`, m, a closer search runs until it has decided, without a budget. Changes nothing.
  [[nodiscard]] SweptBounds sweep(std::uint32_t pair, double level) const noexcept;

  // True if an input of the last tick was within its age limit, but not within
  // Scene::response_limit_ns, as far as reports were measured.
  [[nodiscard]] bool response_is_late() const noexcept;

  // The age of an object's pose at the last tick.
  [[nodiscard]] InputAge input_age(std::uint32_t object) const noexcept;

  // The age of a joint variable's position at the last tick.
  [[nodiscard]] InputAge joint_age(std::uint32_t variable) const noexcept;

  // Refused samples of one variable, by cause.
  [[nodiscard]] const std::array<std::uint64_t, kRejects>& rejected_joints(
      std::uint32_t variable) const noexcept;

  // Refused samples of one object, by cause (for the health topic).
  [[nodiscard]] const std::array<std::uint64_t, kRejects>& rejected(
      std::uint32_t object) const noexcept;

  // The samples that were refused last, by object and by joint variable.
  [[nodiscard]] std::span<const RefusedValue> refused_poses() const noexcept;
  [[nodiscard]] std::span<const RefusedValue> refused_positions() const noexcept;

  // World from object: the pose in use. It is meaningless if no pose is in use (input_age() is -1).
  [[nodiscard]] const Pose& pose(std::uint32_t object) const noexcept;

  // The pose of an object, or of a link of a robot, at the last tick, and how far it can be
  // trusted.
  [[nodiscard]] PresentPose present_pose(std::uint32_t object) const noexcept;
  [[nodiscard]] PresentPose present_link(std::uint32_t robot, std::uint32_t link) const noexcept;
  [[nodiscard]] PresentJoint present_joint(std::uint32_t variable) const noexcept;

  // The allowed contacts at the last tick, as Report::contacts.
  [[nodiscard]] std::span<const ContactReport> contacts() const noexcept;

  // Stamp of the pose in use; 0 if the object is fixed or no pose is in use.
  [[nodiscard]] std::int64_t stamp_ns(std::uint32_t object) const noexcept;

 private:
  friend class MonitorMemory;  // of tests
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace clearance
