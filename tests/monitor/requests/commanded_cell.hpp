// A loop that ticks a small cell in a thread, and a commander that changes it. No DDS.
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "monitor/loop/tick_loop.hpp"
#include "monitor/requests/scene_commander.hpp"
#include "tests/config/cells.hpp"
#include "tests/shared/poses.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance::test {

inline const std::string kCommandedCell = R"(name: test
units: {length: m, angle: rad}
rate_hz: 500
commands: {from: [planner], folders: [allowed]}
capacity: {objects: 2, parts: 3, pairs: 20, bytes: 20000}
defaults: {age_limit_ms: 60000, may_jump: true}
templates:
  - {name: bin, groups: [things], box: {size: [0.1, 0.1, 0.1]}}
objects:
  - {name: hand, groups: [arm], box: {size: [0.2, 0.2, 0.2]}}
  - {name: finger, groups: [arm], box: {size: [0.02, 0.02, 0.02]}}
  - {name: part, groups: [things], fixed: true, pose: {xyz: [1, 0, 0]}, box: {size: [0.1, 0.1, 0.1]}}
  - {name: table, fixed: true, pose: {xyz: [0, 0, -1]}, box: {size: [1, 1, 0.1]}}
pairs:
  - {between: [arm, things]}
  - {between: [hand, table], publish: true}
zones:
  - {name: stop, between: [hand, table], enter_below: 0.1, leave_above: 0.2}
)";

// Sends one pose of the hand a tick.
class HandPoses final : public PoseSource {
 public:
  explicit HandPoses(std::uint64_t revision) {
    batch_.source = SourceName("robot");
    batch_.scene_revision = revision;
  }
  // Each batch repeats its sample so often.
  void repeat(std::size_t times) {
    const std::lock_guard lock(mutex_);
    times_ = times;
  }
  // The tick thread takes it from its next tick on.
  void put(const Pose& pose) {
    const std::lock_guard lock(mutex_);
    pose_ = pose;
    is_sent_ = true;
  }
  // Sends these positions, of the first joint variables, and no pose.
  void put_joints(std::vector<double> positions) {
    const std::lock_guard lock(mutex_);
    positions_ = std::move(positions);
    is_sent_ = true;
  }
  // Waits until two more batches were taken: the first one may have begun before.
  void settle() const {
    const std::uint64_t taken = taken_;
    while (taken_ < taken + 3) std::this_thread::yield();
  }
  const PoseBatch* next() noexcept override {
    is_turn_ = !is_turn_;
    if (is_turn_) return nullptr;
    ++taken_;
    const std::lock_guard lock(mutex_);
    if (!is_sent_) return nullptr;
    ++batch_.sequence_number;
    batch_.joints.resize(positions_.size());
    for (std::uint32_t i = 0; i < positions_.size(); ++i) {
      batch_.joints[i].variable = i;
      batch_.joints[i].position = positions_[i];
      batch_.joints[i].stamp_ns = SystemClock().realtime_ns();
    }
    batch_.samples.resize(positions_.empty() ? times_ : 0);
    for (PoseSample& sample : batch_.samples) {
      sample.stamp_ns = SystemClock().realtime_ns();
      sample.world_from_object = pose_;
    }
    return &batch_;
  }

 private:
  std::mutex mutex_;
  Pose pose_;
  std::vector<double> positions_;
  std::size_t times_ = 1;
  bool is_sent_ = false, is_turn_ = false;
  std::atomic<std::uint64_t> taken_{0};
  PoseBatch batch_;
};

class CommandedCell : public testing::Test, private CellParts {
 protected:
  ~CommandedCell() override { end_loop(); }

  void start(const std::string& text = kCommandedCell, CommanderOptions options = {},
             const TickRecords::Room& room = {}) {
    write_text(folder / "cell.yaml", text);
    cell = std::make_shared<const Cell>(std::get<Cell>(read_cell(folder / "cell.yaml")));
    options.began_with = cell->scene.revision;
    poses = std::make_unique<HandPoses>(cell->scene.revision);
    loop = std::make_unique<TickLoop>(cell->scene, *poses, std::vector<ReportSink*>{}, clock,
                                      TickLoopOptions{});
    changer = std::make_unique<SceneChanger>(*loop, cell, static_cast<CellParts&>(*this), room);
    commander = std::make_unique<SceneCommander>(*changer, *loop, loop_ended, std::move(options));
    ticking = std::thread([this] { loop->run(stop); });
  }
  void end_loop() {
    stop = true;
    if (ticking.joinable()) ticking.join();
    loop_ended = true;
  }

  CommandResult execute(Command command, bool is_own = false) {
    command.client = "planner";
    command.request = ++request;
    return commander->execute(command, is_own, [this] {
      ++changes;
      return may_change;
    });
  }
  CommandResult execute(std::vector<CellChange> list) {
    return execute(Command{.changes = std::move(list)});
  }
  // Expects that the command is refused so, and that nothing has changed.
  CommandResult expect_refused(Command command, CommandStatus status) {
    const std::uint64_t before = revision();
    const std::string text = changer->cell().yaml;
    CommandResult result = execute(std::move(command));
    EXPECT_EQ(result.status, status) << result.reason;
    EXPECT_NE(result.reason, "");
    EXPECT_EQ(result.scene_revision, before);
    EXPECT_EQ(revision(), before);
    EXPECT_EQ(changer->cell().yaml, text);
    return result;
  }
  CommandResult expect_refused(std::vector<CellChange> list, CommandStatus status) {
    return expect_refused(Command{.changes = std::move(list)}, status);
  }
  [[nodiscard]] std::uint64_t revision() const { return changer->cell().scene.revision; }
  [[nodiscard]] const Object& object(const std::string& name) const {
    const auto& objects = changer->cell().scene.objects;
    const auto found = std::ranges::find(objects, name, &Object::name);
    if (found != objects.end()) return *found;
    ADD_FAILURE() << "no object " << name;
    return objects.front();
  }

  ScratchFolder folder;
  SystemClock clock;
  std::shared_ptr<const Cell> cell;
  std::unique_ptr<HandPoses> poses;
  std::unique_ptr<TickLoop> loop;
  std::unique_ptr<SceneChanger> changer;
  std::unique_ptr<SceneCommander> commander;
  std::atomic<bool> stop{false}, loop_ended{false};
  std::thread ticking;
  std::uint64_t request = 0;
  int changes = 0;  // scenes that were about to change
  bool may_change = true;

 private:
  std::vector<ReportSink*> prepare(const std::shared_ptr<const Cell>&) override { return {}; }
  void follow(const SceneInForce&) noexcept override {}
  void abandon() override {}
};

}  // namespace clearance::test
