#include "tests/monitor/adversary/lying_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <vector>

#include "monitor/ask/asker.hpp"
#include "monitor/ask/completion.hpp"
#include "monitor/inputs/scene_ids.hpp"
#include "monitor/loop/tick_loop.hpp"
#include "monitor/sensors/sensors.hpp"

namespace clearance::test::lies {
namespace {

constexpr std::int64_t kStartOfLies = 1'700'000'000 * kSecond;  // CLOCK_REALTIME
constexpr double kAsks = 0.005;                // the share of ticks after which is asked
constexpr std::int64_t kWaypoints = 40 * kMs;  // between two of them

// The ports of the loop, and what makes the camera's frames. The time is that of its only clock.
class LyingWorld final : public Clock, public PoseSource, public ReportSink {
 public:
  LyingWorld(const Cell& cell, const LyingRun& run)
      : truth_(run.sending.seed, run.joints_went_far),
        revision_(cell.scene.revision),
        ids_(cell.scene),
        sensors_(cell, {}, ids_.sources()),
        frames_(cell.scene.sensors.size()),
        intake_(cell,
                {.admits_sources = true,
                 .most_samples = 4096,
                 .most_joints = 4096,
                 .use_sensor =
                     [this](const RawSensorMessage& message) {
                       sensors_.add(message, {kStartOfLies + now_, kSecond + now_});
                     }},
                [this](PoseBatch& batch) {
                  batches_.push_back(batch);
                  note(batch);
                  return true;
                }),
        senders_(cell.scene, truth_, run.sending, kStartOfLies, intake_,
                 [this](std::vector<std::uint64_t> writers) {
                   std::ranges::sort(writers);
                   sensors_.keep(writers);
                 }),
        judge_(cell.scene, truth_, run.sending.faults),
        scene_(cell.scene),
        asker_(cell.scene),
        present_(room_for_inputs(cell.scene)),
        random_(run.sending.seed + 3000) {}

  std::int64_t realtime_ns() noexcept override { return kStartOfLies + now_; }
  std::int64_t monotonic_ns() noexcept override { return kSecond + now_; }
  std::int64_t steady_ns() noexcept override { return kSecond + now_; }
  void sleep_until(std::int64_t monotonic_ns) noexcept override {
    if (now_ >= 0 && random_.chance(kAsks)) ask();
    while (kSecond + now_ < monotonic_ns) {
      senders_.send(now_ += kMs);
      build();
    }
  }
  const PoseBatch* next() noexcept override {
    if (batches_.empty()) return nullptr;
    given_ = std::move(batches_.front());
    batches_.pop_front();
    return &given_;
  }
  void input(const PoseBatch&) noexcept override {}
  void statistics(const LoopStatistics&) noexcept override {}
  void report(const Report& report, std::span<const SourceUse>) noexcept override {
    judge_.judge(report, now_);
  }
  [[nodiscard]] Verdict verdict() const { return judge_.verdict(); }
  [[nodiscard]] FrameExchange& frames() noexcept { return frames_; }
  // The monitor of the loop, which must outlive this.
  void know(const Monitor& monitor) noexcept { monitor_ = &monitor; }

 private:
  // As the daemon's thread of sensors does.
  void note(const PoseBatch& batch) {
    poses_.clear();
    joints_.clear();
    static_cast<void>(ids_.append(batch, poses_, joints_));
    sensors_.add(poses_, joints_, kStartOfLies + now_);
  }
  void build() {
    sensors_.settle(
        kSecond + now_, [this](const SeenCloud* cloud) { return frames_.is_used(cloud); },
        [this](std::uint32_t sensor, const SensorFrame& frame) {
          frames_.put(sensor, frame, revision_);
          frame_ = frame;
        });
  }
  // Asks between two ticks whether the robots may move as they are going to, while all others move
  // as the monitor knows them. A base on tf can only be held: the judge allows for its motion.
  void ask() {
    Question question;
    question.margins = {random_.uniform(0.0, 0.3)};
    question.tolerance = 0.02;
    question.work_limit = 1000;
    question.motion = true_motion();
    present_.cycle = monitor_->cycle();
    present_.now_ns = kStartOfLies + now_;
    read_inputs(*monitor_, present_);
    std::vector<SeenFrame> frames;
    if (frame_.cloud != nullptr) {
      frames.push_back({.sensor = "eye",
                        .cloud = {std::shared_ptr<void>(), frame_.cloud},
                        .world_from_sensor = frame_.world_from_sensor,
                        .pose_error = frame_.pose_error});
    }
    Answer answer;
    for (std::size_t i = 0; i < scene_.variables.size(); ++i) {
      const PresentJoint& joint = present_.joints[i];
      const std::string& variable = scene_.variables[i].name;
      if (variable.find('/') != std::string::npos && joint.state == PresentPose::State::kUsable)
        question.held.push_back({variable, joint.position});
    }
    auto refusal = complete(scene_, present_, std::move(frames), question);
    if (!refusal) refusal = asker_.ask(question, answer);
    judge_.judge(answer, refusal, question.motion.times);
  }
  // Of all joints. The waypoints are so dense that cubic polynomials are the true
  // motion to within a micrometre.
  [[nodiscard]] JointTrajectory true_motion() {
    JointTrajectory motion;
    for (const Channel robot : {Channel::kArm, Channel::kPost}) {
      for (const char* const joint : kJointNames)
        motion.joints.push_back(std::string(name(robot)) + "_" + joint);
    }
    const int waypoints = random_.integer(2, 8);
    for (int i = 0; i < waypoints; ++i) {
      const std::int64_t t = now_ + i * kWaypoints;
      motion.times.push_back(1e-9 * static_cast<double>(t - now_));
      for (const Channel robot : {Channel::kArm, Channel::kPost}) {
        for (const TrueJoint& joint : truth_.joints(robot, t)) {
          motion.positions.push_back(static_cast<double>(joint.position));
          motion.velocities.push_back(static_cast<double>(joint.velocity));
        }
      }
    }
    return motion;
  }
  std::int64_t now_ = -kMs;  // ns since the start
  TrueMotion truth_;
  std::deque<PoseBatch> batches_;
  PoseBatch given_;
  std::uint64_t revision_;
  SceneIds ids_;
  Sensors sensors_;
  std::vector<PoseSample> poses_;
  std::vector<JointSample> joints_;
  FrameExchange frames_;
  Intake intake_;
  LyingSenders senders_;
  TruthJudge judge_;
  const Scene& scene_;
  Asker asker_;
  InputState present_;
  SensorFrame frame_;  // the newest one
  const Monitor* monitor_ = nullptr;
  Random random_;
};

}  // namespace

Verdict judged(const Cell& cell, const LyingRun& run) {
  LyingWorld world(cell, run);
  TickLoop loop(
      cell.scene, world, {&world}, world,
      {.max_ticks = static_cast<std::uint64_t>(run.length / kMs), .frames = &world.frames()});
  world.know(loop.state().monitor());
  const std::atomic<bool> stop = false;
  loop.run(stop);
  return world.verdict();
}

std::string explained(const Cell& cell, const LyingRun& run, const Verdict& verdict) {
  std::string text = fmt::format("seed {}\n{}", run.sending.seed, verdict.text());
  for (const Fault& fault : run.sending.faults) {
    text += "  fault: " + described(fault);
    if (run.sending.faults.size() > 1) {
      LyingRun alone = run;
      alone.sending.faults = {fault};
      const Verdict of_one = judged(cell, alone);
      text += of_one.is_true() ? " (true if alone)" : " (false if alone)";
    }
    text += "\n";
  }
  return text;
}

}  // namespace clearance::test::lies
