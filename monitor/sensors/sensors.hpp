// Makes frames for the tick from messages of sensors: decodes, judges, places, leaves out the
// robot itself and sorts. It runs beside the tick, in one thread.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/clouds/seen_cloud.hpp"
#include "monitor/inputs/source_numbers.hpp"
#include "monitor/intake/camera_stream.hpp"
#include "monitor/intake/sensor_messages.hpp"
#include "monitor/sensors/mounts.hpp"
#include "monitor/sensors/organised_points.hpp"
#include "monitor/sensors/own_image.hpp"
#include "monitor/sensors/unknown_payloads.hpp"
#include "monitor/sensors/witness.hpp"
#include "monitor/tick/monitor.hpp"

namespace clearance {

struct FrameDecoder;

// A frame that was built, with all that a second build of it needs.
struct BuiltFrame {
  std::uint32_t sensor = 0;
  std::int64_t stamp_ns = 0;
  std::uint64_t scene_revision = 0;
  PastPose place;
  Carrier carrier;
  PlacedPostures postures;
  PinholeCamera camera;  // of depth images
  RawSensorMessage message;
};

struct SensorsOptions {
  bool is_log = false;  // see IntakeOptions::is_log
  // A frame waits for joints, poses and transforms up to its stamp for this long, ns of the
  // caller's time. Then it is built with what their largest speeds allow. Where a transform is
  // missing and the mount has no stated speed, a frame waits for up to half of the age limit, and
  // is refused.
  std::int64_t patience_ns = 20'000'000;
  // Receives each frame that is built, before anything else does. Empty: messages are not kept.
  std::function<void(BuiltFrame frame)> keep = {};
};

// The part of the robot's surroundings that a frame cannot show, because it is left out with the
// robot's own image.
struct OwnImageStatus {
  std::uint32_t object = 0;  // a link
  std::size_t elements = 0;  // of the last frame
  double thickness = 0.0;    // m: anything this close to the link may be left out with it
  double thickest = 0.0;     // the largest of all frames
  double shell = 0.0;        // m: the part of the thickness that the body's place and the cell make
  double unseen = -kInfinity;  // m: lower bound to the nearest unseen place, if asked for
};

// What a sensor that is a witness says of a robot.
struct RobotSeen {
  RaysOfRobot rays;  // of the last picture
  SeenCount count;
};

struct SensorStatus {
  std::uint64_t heard = 0;    // messages on its topic, but for CameraInfo
  std::uint64_t frames = 0;   // built
  std::uint64_t skipped = 0;  // good ones that a newer one overtook
  std::int64_t stamp_ns = 0;  // of the last frame that was built
  std::size_t elements = 0;   // of that frame
  std::size_t hidden = 0;     // elements of it that too few frames had (persist)
  std::size_t cropped = 0;    // elements of it beyond the links' reach
  double pose_error = 0.0;    // m, of that frame
  double largest_pose_error = 0.0;
  std::int64_t longest_build_ns = 0;
  // Messages that were used (kNoFault) or refused, by cause.
  std::array<std::uint64_t, kFrameFaults> counts{};
  std::vector<OwnImageStatus> own;
  std::vector<RobotSeen> robots;         // as Scene::robots; empty: the sensor is no witness
  std::vector<UnknownPayload> payloads;  // likewise, by link that may hold something
  // Why the last frame was refused as kRobotElsewhere, with frame and difference; empty: it was
  // not.
  std::string robot_elsewhere;
};

class Sensors {
 public:
  // Allocates the memory of all clouds. The cell must outlive this. `numbers` are those of the
  // samples' sources, with the sources that the cell names; without them, those of a first cell.
  Sensors(const Cell& cell, const SensorsOptions& options, const SourceNumbers& numbers);
  Sensors(const Cell& cell, const SensorsOptions& options);
  // For a changed cell: goes on with the transforms of `before` and the judged streams of sensors
  // that are the same, and with their last maps. Joints and poses are heard anew.
  Sensors(const Cell& cell, Sensors& before, const SourceNumbers& numbers);
  ~Sensors();

  // Samples as the tick gets them, and transforms. Those stamped farther ahead of the time at which
  // they came than the scene's future_limit_ns place nothing. `came_ns` is this machine's
  // CLOCK_REALTIME, ns; in a log, the time of recording.
  void add(std::span<const PoseSample> poses, std::span<const JointSample> joints,
           std::int64_t came_ns);
  // `now`: when it came. The monotonic time is the caller's.
  void add(const RawSensorMessage& message, const Now& now);

  // The publishers that still exist; sorted. Names of frames become free that others had.
  void keep(std::span<const std::uint64_t> writers) { frames_.keep(writers); }

  // The receiver of a frame. Its cloud stays as it is while `is_used` says so.
  using Use = std::function<void(std::uint32_t sensor, const SensorFrame& frame)>;
  using IsUsed = std::function<bool(const SeenCloud* cloud)>;
  // Builds the newest frame of each sensor whose time has come. If all clouds of a sensor are in
  // use, its frame waits.
  void settle(std::int64_t now_ns, const IsUsed& is_used, const Use& use);

  // Builds a frame again, whatever was judged of its message and wherever the joints are. False: it
  // is of another cell, or cannot be built.
  [[nodiscard]] bool rebuild(const BuiltFrame& frame, const IsUsed& is_used, const Use& use);
  // True if rebuild() finds a cloud that is not in use.
  [[nodiscard]] bool has_room(std::uint32_t sensor, const IsUsed& is_used) const;
  // Sets SensorsOptions::keep. Call this before the first message.
  void keep(std::function<void(BuiltFrame frame)> keep) { options_.keep = std::move(keep); }

  // Stamps begin anew: none before says anything about those that follow.
  void begin_anew();
  // Frames that wait are not built, since others are (rebuild()).
  void drop_waiting() noexcept;
  // True if a frame waits.
  [[nodiscard]] bool any_waiting() const noexcept;
  [[nodiscard]] SensorStatus status(std::uint32_t sensor) const;

 private:
  // One is in use, one is shown for the next tick, and one is built.
  static constexpr std::size_t kClouds = 3;
  static constexpr std::size_t kMostWaiting = 4;
  struct Waiting;
  struct State;

  void note_time(std::int64_t came_ns);
  void forget_past();
  void keep_map(State& before, State& state);
  [[nodiscard]] bool is_ahead(std::int64_t stamp_ns, std::int64_t came_ns) const noexcept;
  void add_transforms(const RawSensorMessage& message);
  void add_frame(const RawSensorMessage& message, const FrameDecoder& decoder, State& state,
                 std::int64_t now_ns);
  void take_info(const sensor_msgs_msg_dds__CameraInfo_& info, State& state, std::int64_t now_ns);
  [[nodiscard]] bool is_ready(const State& state, const Waiting& frame, std::int64_t now_ns) const;
  void build(State& state, const Waiting& frame, SeenCloud& cloud, const Use& use);
  [[nodiscard]] FrameFault build_at(State& state, const Waiting& frame, const PastPose& place,
                                    const Carrier& carrier, SeenCloud& cloud, const Use& use,
                                    bool again);
  [[nodiscard]] FrameFault fill(State& state, const Waiting& frame, const PastPose& place,
                                SeenCloud& cloud, bool again);
  [[nodiscard]] static bool has_left_its_image(State& state, const Waiting& frame,
                                               const SeenCloud& cloud);
  // `seen` elements of the frame have depth within the range. What is built again is not judged.
  [[nodiscard]] static FrameFault judge_share(State& state, const Waiting& frame, std::size_t seen,
                                              bool again);
  void leave_out(State& state, const Waiting& frame, const PastPose& place, SeenCloud& cloud);
  void narrow(const MessageCloud& frame, PointCloud& points);

  const Cell& cell_;
  SensorsOptions options_;
  TfFrames frames_{Mounts::kKeptTransforms};
  PostureHistory postures_;
  Mounts mounts_;
  OwnImage own_image_;
  Witness witness_;
  std::vector<std::unique_ptr<State>> states_;  // by sensor
  CdrDecoder decoder_;
  SlabBody body_;
  std::vector<MeasuredPoint> points_, narrow_;
  OrganisedPoints organised_;
  Now now_;  // of the last message; the time of samples, too
};

}  // namespace clearance
