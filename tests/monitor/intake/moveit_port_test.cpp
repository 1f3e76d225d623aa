// MoveIt's messages change the cell of a running loop.
#include "monitor/daemon/moveit_port.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <functional>
#include <future>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "monitor/requests/scene_thread.hpp"
#include "tests/monitor/intake/moveit_messages.hpp"
#include "tests/monitor/requests/commanded_cell.hpp"
#include "tests/shared/logged.hpp"

namespace clearance {
namespace {

moveit::RawScene raw(const moveit::CollisionObject& message) {
  return {moveit::RawScene::Type::kCollisionObject, "/collision_object", moveit::cdr_of(message)};
}
moveit::RawScene sphere(const std::string& id, const std::string& frame) {
  return raw(moveit::sphere_object(id, frame, {0.5, 0.0, 0.0}));
}
moveit::RawScene removal(const std::string& id) {
  return raw(moveit::operation(moveit::Operation::kRemove, id));
}

class MoveItPortTest : public test::CommandedCell {
 protected:
  MoveItPortTest()
      : port_([this](SceneTask task) {
          if (AnswerCommand* const asked = answer_of(task)) {
            *asked = [this, answer = std::move(*asked)](const CommandResult& result) {
              answer(result);
              if (auto waiting = std::exchange(result_, std::nullopt)) waiting->set_value(result);
            };
          }
          return thread_->put(std::move(task));
        }) {
    std::string text = test::kCommandedCell;
    text.insert(text.find("commands:"), "ros2: {collision_object: true}\n");
    text.insert(text.find("zones:"), "  - {between: [arm, moveit]}\n");
    start(text);
    thread_ = std::make_unique<SceneThread>(*changer, *loop, loop_ended, CommanderOptions{});
    thread_->start();
  }
  ~MoveItPortTest() override {
    port_.close();
    end_loop();
    EXPECT_TRUE(thread_->end());
  }
  CommandResult take(moveit::RawScene message) {
    auto result = result_.emplace().get_future();
    port_.take(std::move(message));
    return result.get();
  }
  [[nodiscard]] const Object* object(const std::string& name) const {
    const auto& objects = changer->cell().scene.objects;
    const auto found = std::ranges::find(objects, name, &Object::name);
    return found == objects.end() ? nullptr : &*found;
  }

  std::optional<std::promise<CommandResult>> result_;  // that take() waits for
  MoveItPort port_;
  std::unique_ptr<SceneThread> thread_;
};

TEST_F(MoveItPortTest, AnObjectIsPlacedInAFrameThatMoves) {
  poses->put(test::at(2.0, 1.0, 0.0));
  poses->settle();
  EXPECT_TRUE(take(sphere("ball", "hand")).done());
  ASSERT_NE(object("ball"), nullptr);
  EXPECT_EQ(object("ball")->world_from_object.position, Vec3(2.5, 1.0, 0.0));
  EXPECT_TRUE(take(removal("ball")).done());
  EXPECT_EQ(object("ball"), nullptr);
}

TEST_F(MoveItPortTest, WhatTheCapacityDoesNotAllowIsRefusedAndTheNextMessageCounts) {
  for (const char* name : {"a", "b"}) EXPECT_TRUE(take(sphere(name, "world")).done());
  EXPECT_EQ(take(sphere("c", "world")).status, CommandStatus::kBeyondCapacity);
  EXPECT_TRUE(take(removal("a")).done());
  EXPECT_TRUE(take(sphere("c", "world")).done());
}

// Two programs send scenes that this cell refuses, as fast as they can.
TEST_F(MoveItPortTest, RefusedMessagesAtAnyRateGiveFiveLinesASecond) {
  const auto logged = std::make_shared<test::Logged>();
  const test::LoggedTo to(logged);
  for (const char* name : {"a", "b"}) EXPECT_TRUE(take(sphere(name, "world")).done());
  const auto began = std::chrono::steady_clock::now();
  for (int i = 0; i < 100; ++i) {
    for (const char* name : {"c", "d"}) EXPECT_FALSE(take(sphere(name, "world")).done());
  }
  const auto seconds =
      std::chrono::duration_cast<std::chrono::seconds>(std::chrono::steady_clock::now() - began);
  EXPECT_GE(logged->count("[moveit-refused]"), 5u);
  EXPECT_LE(logged->count("[moveit-refused]"),
            5u * (static_cast<std::size_t>(seconds.count()) + 2));
}

// Beside a partner, which the test plays.
class SharedMoveItPort : public MoveItPortTest {
 protected:
  SharedMoveItPort() {
    port_.share({.leads = [this] { return leads.load(); },
                 .revision = [this] { return in_force.load(); },
                 .tell =
                     [this](auto done, auto) {
                       const std::lock_guard lock(mutex_);
                       told_.assign(done.begin(), done.end());
                     },
                 .both_have = [this] { return both_have.load(); }});
    in_force = revision();
  }
  // The partner leads, and has done this message, after which that revision is in force.
  void hear(const moveit::RawScene& message, std::uint64_t revision) {
    hear(message.identity(), revision);
  }
  void hear(std::uint64_t message, std::uint64_t revision) {
    hear(std::vector<DoneSceneChange>{{message, revision}});
  }
  void hear(const std::vector<DoneSceneChange>& done) {
    Sample<clearance_msg_PartnerScene> sample;
    reserve_sequence(sample->changes, done.size());
    std::ranges::copy(done, sample->changes._buffer);
    sample->changes._length = static_cast<std::uint32_t>(done.size());
    std::vector<std::byte> bytes;
    moveit::SceneKeeper().save(bytes);
    reserve_sequence(sample->bytes, bytes.size());
    std::memcpy(sample->bytes._buffer, bytes.data(), bytes.size());
    sample->bytes._length = static_cast<std::uint32_t>(bytes.size());
    port_.hear(*sample);
    port_.update_lead();
  }
  void in_scene_thread(const std::function<void()>& work) {
    std::promise<void> done;
    ASSERT_TRUE(thread_->put(OtherWork{[&] {
      work();
      done.set_value();
    }}));
    done.get_future().get();
  }
  // This daemon puts a command in force, which leads to that revision.
  void make(std::uint64_t command, std::uint64_t revision) {
    in_scene_thread([&] {
      port_.coming(revision, command);
      in_force = revision;
      port_.ended(command, CommandResult{});
    });
  }
  // This daemon puts the leader's cell of that revision in force.
  void take_over(std::uint64_t revision) {
    in_scene_thread([&] {
      port_.coming(revision, 0);
      in_force = revision;
      port_.took_over(revision);
    });
  }
  void lead(bool is) {
    leads = is;
    finish();
  }
  // Until the scene thread has done what waits.
  void finish() {
    for (int i = 0; i < 3; ++i) {
      port_.update_lead();
      in_scene_thread([] {});
    }
  }
  bool is_done(std::uint64_t command) {
    bool done = false;
    in_scene_thread([&] { done = port_.is_done(command); });
    return done;
  }
  bool is_told(const moveit::RawScene& message) {
    const std::lock_guard lock(mutex_);
    return std::ranges::find(told_, message.identity(), &DoneSceneChange::message) != told_.end();
  }

  std::atomic<bool> leads{false}, both_have{false};
  std::atomic<std::uint64_t> in_force{0};

 private:
  std::mutex mutex_;
  std::vector<DoneSceneChange> told_;
};

TEST_F(SharedMoveItPort, MessagesWaitUntilThisDaemonLeadsAndAreDoneInOrder) {
  const auto added = sphere("ball", "world"), gone = removal("ball"), other = sphere("b", "world");
  for (const auto& message : {added, gone, other}) port_.take(message);
  finish();
  EXPECT_EQ(revision(), cell->scene.revision);
  leads = true;
  finish();
  EXPECT_EQ(object("ball"), nullptr);
  EXPECT_NE(object("b"), nullptr);
  for (const auto& message : {added, gone, other}) EXPECT_TRUE(is_told(message));
}

TEST_F(SharedMoveItPort, WhatTheOtherLeaderHasDoneIsNotDoneAgain) {
  const auto first = sphere("a", "world"), second = sphere("b", "world");
  port_.take(first);
  port_.take(second);
  hear(first, revision());
  leads = true;
  finish();
  EXPECT_EQ(object("a"), nullptr) << "it is in the scene that the test says is in force";
  EXPECT_NE(object("b"), nullptr);
  EXPECT_TRUE(is_told(first)) << "whoever follows has to know";
}

TEST_F(SharedMoveItPort, WhatTheOtherLeaderHadNotPutInForceIsDone) {
  const auto first = sphere("a", "world");
  port_.take(first);
  hear(first, revision() + 1);
  leads = true;
  finish();
  EXPECT_NE(object("a"), nullptr);
}

TEST_F(SharedMoveItPort, ACommandThatTheOtherLeaderHasPutInForceIsDone) {
  hear(7, revision());
  leads = true;
  EXPECT_TRUE(is_done(7));
  EXPECT_FALSE(is_done(8));
}

TEST_F(SharedMoveItPort, ACommandWhoseChangeIsLostWithTheOtherLeaderIsNotDone) {
  hear(7, revision() + 1);
  leads = true;
  EXPECT_FALSE(is_done(7));
}

TEST_F(SharedMoveItPort, ACommandThatWasRefusedAfterItWasToldOfIsNotDone) {
  leads = true;
  finish();
  in_scene_thread([this] { port_.coming(revision() + 1, 7); });
  EXPECT_FALSE(is_done(7)) << "it is not in force yet";
  in_scene_thread([this] { port_.ended(7, {.status = CommandStatus::kTooSlow}); });
  in_force = revision() + 1;
  EXPECT_FALSE(is_done(7)) << "another change led to the same scene";
}

// Lists of what was done, and the scenes to which it led, after which daemon led how.
TEST_F(SharedMoveItPort, ACommandThatIsInForceHereIsDoneThoughTheOtherOneLedWithoutIt) {
  const std::uint64_t first = revision();
  lead(true);
  make(7, first + 1);
  lead(false);
  hear({{6, first}, {0, first}});
  lead(true);
  EXPECT_TRUE(is_done(7)) << "its change is in the scene in force";
  lead(false);
  hear({{5, first + 1}, {6, first}, {0, first}});
  lead(true);
  EXPECT_TRUE(is_done(7)) << "an earlier scene was the same";
}

TEST_F(SharedMoveItPort, ACommandIsNotDoneOnceTheOtherOnesCellHasTakenItBack) {
  const std::uint64_t first = revision();
  lead(true);
  make(7, first + 1);
  lead(false);
  hear({{6, first}, {0, first}});
  lead(true);
  lead(false);
  take_over(first);
  lead(true);
  EXPECT_TRUE(is_done(6));
  EXPECT_FALSE(is_done(7));
}

TEST_F(SharedMoveItPort, ACommandIsDoneWithTheLeadersCellThoughThisOneLedForAMomentBefore) {
  const std::uint64_t first = revision();
  hear({{6, first}, {7, first + 1}});
  lead(true);
  EXPECT_FALSE(is_done(7));
  lead(false);
  take_over(first + 1);
  lead(true);
  EXPECT_TRUE(is_done(6));
  EXPECT_TRUE(is_done(7));
}

// A cell whose changes the leader did not tell of, and one that has another revision here, with
// other options.
TEST_F(SharedMoveItPort, OnlyWhatLedToTheCellThatWasTakenOverIsDone) {
  const std::uint64_t first = revision();
  lead(true);
  make(7, first + 1);
  lead(false);
  take_over(first + 2);
  lead(true);
  EXPECT_FALSE(is_done(7));
  lead(false);
  hear({{8, first + 3}, {9, first + 4}});
  in_scene_thread([&] {
    in_force = first + 5;
    port_.took_over(first + 3);
  });
  lead(true);
  EXPECT_TRUE(is_done(8));
  EXPECT_FALSE(is_done(9));
}

// This daemon did the message while it led, and then the other one led without it.
TEST_F(SharedMoveItPort, AMessageThatWasLostWithTheCellBeforeIsDoneAgain) {
  const std::uint64_t first = revision();
  lead(true);
  port_.take(sphere("a", "world"));
  finish();
  ASSERT_NE(object("a"), nullptr);
  const auto take_back = [&] {
    lead(false);
    hear({{0, first}});
    std::promise<CommandResult> undone;
    ASSERT_TRUE(thread_->put(MadeCommand{
        .sender = "partner",
        .make = [&](auto&, auto&) { return Command{.changes = {ReplaceCell{cell->yaml}}}; },
        .answer = [&](const CommandResult& result) { undone.set_value(result); }}));
    ASSERT_TRUE(undone.get_future().get().done());
    take_over(first);
    ASSERT_EQ(object("a"), nullptr);
    lead(true);
  };
  take_back();
  EXPECT_NE(object("a"), nullptr);
  both_have = true;
  finish();
  both_have = false;
  take_back();
  EXPECT_EQ(object("a"), nullptr) << "the other one had it, and has removed it since";
}

TEST_F(SharedMoveItPort, AMessageThatWasQueuedIsNotDoneOnceTheOtherOneLeads) {
  leads = true;
  finish();
  std::promise<void> begun, may_go_on;
  ASSERT_TRUE(thread_->put(OtherWork{[&] {
    begun.set_value();
    may_go_on.get_future().get();
  }}));
  begun.get_future().get();
  port_.take(sphere("a", "world"));
  leads = false;
  may_go_on.set_value();
  finish();
  EXPECT_EQ(object("a"), nullptr);
  leads = true;
  finish();
  EXPECT_NE(object("a"), nullptr);
}

}  // namespace
}  // namespace clearance
