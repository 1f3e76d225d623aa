// MoveIt's messages change the cell of a running loop.
#include "monitor/daemon/moveit_port.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <future>
#include <string>
#include <utility>

#include "monitor/scene_changes/scene_thread.hpp"
#include "tests/monitor/bags/ros_bags.hpp"
#include "tests/monitor/scene_changes/commanded_cell.hpp"

namespace clearance {
namespace {

using test::RosCdr;

// A sphere of 0.1 m, 0.5 m along x of the frame.
moveit::RawScene sphere(const std::string& id, const std::string& frame, std::uint8_t operation) {
  constexpr std::uint32_t kNone = 0;
  RosCdr cdr;
  cdr.header(0, frame);
  for (const double each : {0.5, 0., 0., 0., 0., 0., 1.}) cdr.number(each);
  cdr.text(id).text("").text("");
  cdr.number(std::uint32_t{1}).number(std::uint8_t{2}).numbers({0.1}).number(kNone);
  for (int i = 0; i < 7; ++i) cdr.number(kNone);
  cdr.number(operation);
  return {moveit::RawScene::Type::kCollisionObject, "/collision_object", cdr.bytes()};
}

class MoveItPortTest : public test::CommandedCell {
 protected:
  MoveItPortTest()
      : port_([this](QueuedCommand command) {
          command.answer = [this, answer = std::move(command.answer)](const CommandResult& result) {
            answer(result);
            results_.set_value(result);
          };
          return thread_->put(std::move(command));
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
    end();
    EXPECT_TRUE(thread_->end());
  }
  CommandResult take(moveit::RawScene message) {
    results_ = {};
    port_.take(std::move(message));
    return results_.get_future().get();
  }
  [[nodiscard]] const Object* object(const std::string& name) const {
    const auto& objects = changer->cell().scene.objects;
    const auto found = std::ranges::find(objects, name, &Object::name);
    return found == objects.end() ? nullptr : &*found;
  }

  std::promise<CommandResult> results_;
  MoveItPort port_;
  std::unique_ptr<SceneThread> thread_;
};

TEST_F(MoveItPortTest, AnObjectIsPlacedInAFrameThatMoves) {
  poses->put(test::at(2.0, 1.0, 0.0));
  poses->settle();
  EXPECT_TRUE(take(sphere("ball", "hand", 0)).done());
  ASSERT_NE(object("ball"), nullptr);
  EXPECT_EQ(object("ball")->world_from_object.position, Vec3(2.5, 1.0, 0.0));
  EXPECT_TRUE(take(sphere("ball", "hand", 1)).done());
  EXPECT_EQ(object("ball"), nullptr);
}

TEST_F(MoveItPortTest, WhatTheCapacityDoesNotAllowIsRefusedAndTheNextMessageCounts) {
  for (const char* name : {"a", "b"}) EXPECT_TRUE(take(sphere(name, "world", 0)).done());
  EXPECT_EQ(take(sphere("c", "world", 0)).status, CommandStatus::kBeyondCapacity);
  EXPECT_TRUE(take(sphere("a", "world", 1)).done());
  EXPECT_TRUE(take(sphere("c", "world", 0)).done());
}

}  // namespace
}  // namespace clearance
