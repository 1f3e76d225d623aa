#include "monitor/questions/input_state.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace clearance {
namespace {

constexpr double kSecond = 1e-9;  // s in a ns

class StateQuestion final : public LoopQuestion {
 public:
  explicit StateQuestion(const Scene& scene) : scene_(scene), state_(room_for_inputs(scene)) {}

  // Once it is answered: false if the loop ticks another scene, whose indices differ.
  [[nodiscard]] bool is_of_scene() const noexcept { return is_of_scene_; }
  [[nodiscard]] InputState& state() noexcept { return state_; }

 private:
  void copy(const LoopState& loop) noexcept override {
    is_of_scene_ = &loop.scene == &scene_;
    if (!is_of_scene_) return;
    state_.cycle = loop.statistics.cycle;
    state_.now_ns = loop.statistics.now_ns;
    const auto seconds = [](std::int64_t age_ns) {
      return kSecond * static_cast<double>(std::max<std::int64_t>(age_ns, 0));
    };
    for (std::uint32_t i = 0; i < state_.joints.size(); ++i) {
      state_.joints[i] = loop.monitor.present_joint(i);
      state_.joint_ages[i] = seconds(loop.monitor.joint_age(i).age_ns);
    }
    for (PresentObject& object : state_.objects) {
      object.pose = loop.monitor.present_pose(object.object);
      object.age = seconds(loop.monitor.input_age(object.object).age_ns);
    }
    std::ranges::copy(loop.monitor.contacts(), state_.contacts.begin());
  }

  const Scene& scene_;
  InputState state_;
  bool is_of_scene_ = false;
};

}  // namespace

InputState room_for_inputs(const Scene& scene) {
  std::vector<bool> is_link(scene.objects.size(), false);
  for (const Robot& robot : scene.robots) {
    for (const RobotLink& link : robot.links) {
      if (link.object != RobotLink::kNoObject) is_link[link.object] = true;
    }
  }
  InputState state{.joints = std::vector<PresentJoint>(scene.variables.size()),
                   .joint_ages = std::vector<double>(scene.variables.size(), 0.0),
                   .contacts = std::vector<ContactReport>(contact_pairs(scene).size())};
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    if (!scene.objects[i].fixed && !is_link[i]) state.objects.push_back({.object = i});
  }
  return state;
}

// The time of asking is read before the loop is asked, so that its answer is not older.
std::shared_ptr<const InputState> InputStates::of(const std::shared_ptr<const Cell>& cell,
                                                  Time since) {
  const std::lock_guard lock(mutex_);
  if (last_ != nullptr && cell_ == cell && asked_ >= since) return last_;
  StateQuestion question(cell->scene);
  const Time now = std::chrono::steady_clock::now();
  if (!loop_.ask(question, loop_ended_) || !question.is_of_scene()) return nullptr;
  cell_ = cell;
  last_ = std::make_shared<const InputState>(std::move(question.state()));
  asked_ = now;
  return last_;
}

}  // namespace clearance
