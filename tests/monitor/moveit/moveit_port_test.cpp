// MoveIt's messages change the cell of a running loop.
#include "monitor/daemon/moveit_port.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <future>
#include <string>
#include <utility>

#include "monitor/scene_changes/scene_thread.hpp"
#include "tests/monitor/moveit/moveit_messages.hpp"
#include "tests/monitor/scene_changes/commanded_cell.hpp"

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

}  // namespace
}  // namespace clearance
