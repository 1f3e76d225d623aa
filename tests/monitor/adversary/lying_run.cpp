#include "tests/monitor/adversary/lying_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "monitor/ask/asker.hpp"
#include "monitor/ask/completion.hpp"
#include "monitor/inputs/scene_ids.hpp"
#include "monitor/loop/tick_loop.hpp"
#include "monitor/sensors/sensors.hpp"
#include "monitor/tick/read_inputs.hpp"
#include "tests/monitor/adversary/detection.hpp"
#include "tests/monitor/adversary/lying_commands.hpp"
#include "tests/monitor/adversary/lying_partner.hpp"

namespace clearance::test::lies {
namespace {

constexpr std::int64_t kStartOfLies = 1'700'000'000 * kSecond;  // CLOCK_REALTIME
constexpr double kAsks = 0.005;                // the share of ticks after which is asked
constexpr std::int64_t kWaypoints = 40 * kMs;  // between two of them

// The ports of the loop, and what makes the frames of sensors. The time is that of its only clock.
class LyingWorld final : public Clock, public PoseSource, public ReportSink {
 public:
  LyingWorld(const Cell& cell, const LyingRun& run)
      : truth_(run.sending.seed, run.joints_went_far),
        sending_(run.sending),
        cell_(&cell),
        judged_(&cell),
        ids_(cell.scene),
        sensors_(std::make_unique<Sensors>(cell, SensorsOptions{}, ids_.sources())),
        frames_(cell.scene.sensors.size()),
        intake_(cell,
                {.admits_sources = true,
                 .most_samples = 4096,
                 .most_joints = 4096,
                 .use_sensor =
                     [this](const RawSensorMessage& message) {
                       sensors_->add(message, {kStartOfLies + now_, monotonic_ns()});
                     },
                 .time = time()},
                [this](PoseBatch& batch) {
                  batches_.push_back(batch);
                  note(batch);
                  return true;
                }),
        senders_(cell.scene, truth_, run.sending, kStartOfLies, intake_,
                 [this](std::vector<std::uint64_t> writers) {
                   std::ranges::sort(writers);
                   sensors_->keep(writers);
                 }),
        judge_(cell.scene, truth_, run.sending.faults),
        commands_(cell, truth_, run.sending.faults),
        asker_(std::make_unique<Asker>(cell.scene)),
        present_(room_for_inputs(cell.scene)),
        seen_(cell.scene.sensors.size()),
        random_(run.sending.seed + 3000) {
    for (const Fault& fault : run.sending.faults) {
      if (fault.lie == Lie::kAttached) truth_.carry(fault.from, fault.to);
      if (fault.lie == Lie::kRestored) partner_from_ = fault.from;
    }
    if (run.sending.faults.size() == 1) detection_.emplace(cell.scene, run.sending.faults.front());
  }

  std::int64_t realtime_ns() noexcept override { return kStartOfLies + machine_; }
  std::int64_t monotonic_ns() noexcept override { return kSecond + machine_; }
  std::int64_t steady_ns() noexcept override { return kSecond + machine_; }
  void sleep_until(std::int64_t monotonic_ns) noexcept override {
    follow();
    if (now_ >= 0 && !sending_.factor && random_.chance(kAsks)) ask();
    while (kSecond + machine_ < monotonic_ns) {
      machine_ += kMs;
      while (sending_.machine_time(now_ + kMs) <= machine_) senders_.send(now_ += kMs);
      has_built_ = false;
      build();
    }
    change();
  }
  const PoseBatch* next() noexcept override {
    if (batches_.empty()) return nullptr;
    given_ = std::move(batches_.front());
    batches_.pop_front();
    return &given_;
  }
  void input(const PoseBatch& batch) noexcept override {
    if (partner_) partner_->input(batch);
  }
  void statistics(const LoopStatistics&) noexcept override {}
  void report(const Report& report, std::span<const SourceUse>) noexcept override {
    if (&commands_.in_force() != judged_) {
      judged_ = &commands_.in_force();
      judge_.change(judged_->scene);
    }
    const auto waits = commands_.waits_since(now_);
    judge_.await_command(waits ? commands_.moved_body() : kBodies, waits.value_or(now_));
    const Report* const told = partner_ ? partner_->tick(report) : nullptr;
    if (told != nullptr && partner_->differs()) judge_.note_partner(report.cycle);
    const std::int64_t t = sending_.factor ? report.now_ns - kStartOfLies : now_;
    judge_.judge(told == nullptr ? report : *told, t);
    if (detection_) detection_->follow(loop_->state().monitor(), *sensors_, t);
  }
  [[nodiscard]] Verdict verdict() const {
    Verdict verdict = judge_.verdict();
    if (detection_) verdict.detected = detection_->told();
    return verdict;
  }
  [[nodiscard]] FrameExchange& frames() noexcept { return frames_; }
  [[nodiscard]] SimulatedTime* time() noexcept { return sending_.factor ? &time_ : nullptr; }
  // The loop must outlive this.
  void know(TickLoop& loop) noexcept { loop_ = &loop; }

 private:
  // As the daemon's thread of sensors does.
  void note(const PoseBatch& batch) {
    poses_.clear();
    joints_.clear();
    static_cast<void>(ids_.append(batch, poses_, joints_));
    sensors_->add(poses_, joints_, kStartOfLies + now_);
  }
  void build() {
    sensors_->settle(
        monotonic_ns(),
        [this](const SeenCloud* cloud) {
          return frames_.is_used(cloud) || (partner_ && partner_->is_used(cloud));
        },
        [this](std::uint32_t sensor, SensorFrame frame) {
          frame.content = ++contents_;
          frames_.put(sensor, frame, cell_->scene.revision);
          if (partner_) partner_->put(sensor, frame);
          seen_[sensor] = frame;
          has_built_ = true;
        });
  }
  // Changes the scene, or renews the monitor for a partner, which ends with its scene.
  void change() {
    if (now_ < 0) return;
    if (commands_.waits_since(now_) && !loop_->busy()) partner_.reset();
    commands_.work(now_, *loop_, *this);
    if (partner_) partner_->catch_up();
    if (partner_from_ < 0 || now_ < partner_from_ || has_built_ || loop_->busy()) return;
    partner_from_ = -1;
    partner_ = std::make_unique<LyingPartner>(*loop_, *this);
  }
  // All that belongs to one scene follows once the loop ticks another one, as in the daemon.
  void follow() {
    const Cell& now = commands_.in_force();
    if (&now == cell_) return;
    SceneMap map = scene_map(cell_->scene, now.scene);
    ids_.change(now.scene.revision, map);
    static_cast<void>(ids_.sources().add_named(named_sources(now.scene)));
    sensors_ = std::make_unique<Sensors>(now, *sensors_, ids_.sources());
    intake_.change(now);
    cell_ = &now;
    asker_ = std::make_unique<Asker>(now.scene);
    present_ = room_for_inputs(now.scene);
    seen_.assign(now.scene.sensors.size(), {});
  }
  // Asks between two ticks whether the robots may move as they are going to, while all others move
  // as the monitor knows them. A base on tf can only be held: the judge allows for its motion.
  void ask() {
    Question question;
    question.margins = {random_.uniform(0.0, 0.3)};
    question.tolerance = 0.02;
    question.work_limit = 1000;
    question.motion = true_motion();
    const Scene& scene = cell_->scene;
    const Monitor& monitor = loop_->state().monitor();
    present_.cycle = monitor.cycle();
    present_.now_ns = kStartOfLies + now_;
    read_inputs(monitor, present_);
    std::vector<SeenFrame> frames;
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      if (seen_[i].cloud == nullptr) continue;
      frames.push_back({.sensor = scene.sensors[i].name,
                        .cloud = {std::shared_ptr<void>(), seen_[i].cloud},
                        .world_from_sensor = seen_[i].world_from_sensor,
                        .pose_error = seen_[i].pose_error});
    }
    Answer answer;
    for (std::size_t i = 0; i < scene.variables.size(); ++i) {
      const PresentJoint& joint = present_.joints[i];
      const std::string& variable = scene.variables[i].name;
      if (variable.find('/') != std::string::npos && joint.state == PresentPose::State::kUsable)
        question.held.push_back({variable, joint.position});
    }
    auto refusal = complete(scene, present_, std::move(frames), question);
    if (!refusal) refusal = asker_->ask(question, answer);
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
  std::int64_t now_ = -kMs;      // ns since the start, as bodies move
  std::int64_t machine_ = -kMs;  // as the clocks of the machine say
  SimulatedTime time_;
  TrueMotion truth_;
  std::deque<PoseBatch> batches_;
  PoseBatch given_;
  const Sending& sending_;
  const Cell* cell_;    // that the loop ticks
  const Cell* judged_;  // of the reports
  SceneIds ids_;
  std::unique_ptr<Sensors> sensors_;
  std::vector<PoseSample> poses_;
  std::vector<JointSample> joints_;
  FrameExchange frames_;
  Intake intake_;
  LyingSenders senders_;
  TruthJudge judge_;
  std::optional<Detection> detection_;  // of a single fault
  LyingCommands commands_;
  std::unique_ptr<LyingPartner> partner_;
  std::int64_t partner_from_ = -1;  // it is to begin then
  std::uint64_t contents_ = 0;      // of frames
  bool has_built_ = false;          // a frame, for the coming tick
  std::unique_ptr<Asker> asker_;
  InputState present_;
  std::vector<SensorFrame> seen_;  // the newest ones, by sensor
  TickLoop* loop_ = nullptr;
  Random random_;
};

}  // namespace

Verdict judged(const Cell& cell, const LyingRun& run) {
  LyingWorld world(cell, run);
  TickLoop loop(
      cell.scene, world, {&world}, world,
      {.max_ticks = static_cast<std::uint64_t>(run.sending.machine_time(run.length) / kMs),
       .frames = &world.frames(),
       .time = world.time()});
  world.know(loop);
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
