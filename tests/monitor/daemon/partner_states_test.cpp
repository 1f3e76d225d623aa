// States of a partner that come after the cell has changed. The test is the leader: it tells of its
// ticks and makes the bytes of its state.
//
// Freed memory is overwritten here, so that a use of it does not go unnoticed.
#include "monitor/daemon/partner_states.hpp"

#include <gtest/gtest.h>
#include <malloc.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "config/cell/cell_file.hpp"
#include "monitor/tick/saved_state.hpp"
#include "tests/monitor/requests/commanded_cell.hpp"
#include "tests/shared/loopback.hpp"

namespace clearance {
namespace {

constexpr std::uint64_t kLeader = 7, kLineage = 1234;

class OverwritesFreedMemory {
 public:
  OverwritesFreedMemory() { mallopt(M_PERTURB, 0xa5); }
  ~OverwritesFreedMemory() { mallopt(M_PERTURB, 0); }
};

class PartnerStatesTest : public testing::Test, private CellParts {
 protected:
  PartnerStatesTest() {
    ticking = std::thread([this] { loop.run(stop); });
    thread.start();
  }
  ~PartnerStatesTest() override {
    stop = true;
    ticking.join();
    loop_ended = true;
    EXPECT_TRUE(thread.end());
  }
  static std::shared_ptr<const Cell> read(const std::filesystem::path& file) {
    test::write_text(file, test::kCommandedCell);
    return std::make_shared<const Cell>(std::get<Cell>(read_cell(file)));
  }
  // The leader has ticked the first cycle of a scene of this revision.
  void hear_leader(std::uint64_t revision) {
    TickNotice notice;
    notice.daemon = kLeader;
    notice.revision = revision;
    notice.lineage = kLineage;
    notice.cycle = 1;
    notice.due_ns = clock.monotonic_ns();
    ASSERT_TRUE(ticks.hear(notice));
  }
  // Waits until this daemon wants a state, and prepares for it.
  void prepare() {
    ASSERT_TRUE(test::eventually([&] { return ticks.wants_state(); }));
    states.actions().wants_state();
    finish();
  }
  // The state before that cycle.
  void take_state(const Scene& scene) {
    while (ticks.tags().front() != nullptr) ticks.tags().pop();
    std::vector<std::byte> bytes;
    save_state(SourceNumbers(scene), SceneIds(scene), Monitor(scene), bytes);
    states.actions().take_state({scene.revision, kLineage, 0, bytes});
    finish();
  }
  // Waits until the scene thread has done what it was given.
  void finish() {
    std::atomic<bool> done{false};
    ASSERT_TRUE(thread.put(OtherWork{[&] { done = true; }}));
    ASSERT_TRUE(test::eventually([&] { return done.load(); }));
  }
  std::uint64_t change(std::vector<CellChange> changes) {
    CommandResult result;
    EXPECT_TRUE(
        thread.put(GivenCommand{.command = {.client = "planner", .changes = std::move(changes)},
                                .answer = [&](const CommandResult& of) { result = of; }}));
    finish();
    EXPECT_TRUE(result.done()) << result.reason;
    return result.scene_revision;
  }
  // Since take_state() a tick has followed the leader's.
  bool joins() {
    for (int seen = 0; seen < 100;) {
      const TickTag* const tag = ticks.tags().front();
      if (tag == nullptr) {
        std::this_thread::yield();
        continue;
      }
      if (tag->lineage == kLineage) return true;
      ticks.tags().pop();
      ++seen;
    }
    return false;
  }

  OverwritesFreedMemory overwrites;
  test::ScratchFolder folder;
  SystemClock clock;
  std::shared_ptr<const Cell> first = read(folder / "cell.yaml");
  const Scene copy = first->scene;  // as the leader has it
  DaemonIdentity identity = make_identity("right");
  Participant participant{test::own_dds()};
  test::HandPoses poses{first->scene.revision};
  TickPartner ticks{poses,
                    clock,
                    {.period_ns = 2'000'000,
                     .daemon = identity.id,
                     .start_ns = identity.start_ns,
                     .batch = {.samples = 16},
                     .alone_after_ns = 3600'000'000'000,
                     .lost_after_ns = 3600'000'000'000}};
  PartnerPort port{participant, first->topics, identity, ticks};
  TickLoop loop{first->scene, ticks, {}, clock, {.pace = &ticks}};
  std::atomic<bool> stop{false}, loop_ended{false};
  SceneChanger changer{loop, std::exchange(first, nullptr), static_cast<CellParts&>(*this)};
  SceneThread thread{changer, loop, loop_ended, {}};
  MoveItPort scenes{[this](SceneTask task) { return thread.put(std::move(task)); }};
  PartnerStates states{port,
                       ticks,
                       loop,
                       changer,
                       thread,
                       scenes,
                       loop_ended,
                       nullptr,
                       [this](SceneTask task) { return thread.put(std::move(task)); },
                       [this] { return changer.cell().scene.revision; }};
  std::thread ticking;

 private:
  std::vector<ReportSink*> prepare(const std::shared_ptr<const Cell>&) override { return {}; }
  void follow(const SceneInForce&) noexcept override {}
  void abandon() override {}
};

TEST_F(PartnerStatesTest, AStateOfTheCellThatWasPreparedIsTakenOver) {
  hear_leader(copy.revision);
  prepare();
  take_state(copy);
  EXPECT_TRUE(joins());
}

// The leader sent its state, and then both changed the cell.
TEST_F(PartnerStatesTest, AStateThatComesAfterAChangeOfTheCellIsRefused) {
  hear_leader(copy.revision);
  prepare();
  hear_leader(change({SetMargin{"table", 0.01}}));
  ASSERT_TRUE(test::eventually([&] { return ticks.wants_state(); }));
  take_state(copy);
  EXPECT_FALSE(joins());
}

// The revisions are the same, but the former cell has gone.
TEST_F(PartnerStatesTest, AStateThatComesAfterTheCellHasChangedAndBackIsRefusedAndTheNextOneIsNot) {
  hear_leader(copy.revision);
  prepare();
  change({SetMargin{"table", 0.01}});
  ASSERT_EQ(change({SetMargin{"table", std::nullopt}}), copy.revision);
  ASSERT_TRUE(test::eventually([&] { return ticks.wants_state(); }));
  take_state(copy);
  EXPECT_FALSE(joins());
  prepare();
  take_state(copy);
  EXPECT_TRUE(joins());
}

// A command was taken while this daemon led, and its turn comes now. It may be one that the leader
// has done already, so a refusal by this daemon's cell means nothing.
TEST_F(PartnerStatesTest, ACommandWhoseTurnComesWhileTheOtherOneLeadsIsSentBackAndNotDone) {
  hear_leader(copy.revision);
  ASSERT_TRUE(test::eventually([&] { return ticks.wants_state(); }));
  const std::vector<CellChange> lists[] = {{SetMargin{"table", 0.01}}, {Detach{"table"}}};
  for (const auto& list : lists) {
    for (const bool is_dry : {false, true}) {
      CommandResult result;
      ASSERT_TRUE(thread.put(states.for_both(
          {.command = {.client = "planner", .request = 5, .dry_run = is_dry, .changes = list},
           .answer = [&](const CommandResult& of) { result = of; }})));
      finish();
      EXPECT_EQ(result.status, CommandStatus::kBusy) << result.reason;
      EXPECT_EQ(result.client, "planner");
      EXPECT_EQ(result.request, 5u);
      EXPECT_EQ(changer.cell().scene.revision, copy.revision);
    }
  }
}

}  // namespace
}  // namespace clearance
