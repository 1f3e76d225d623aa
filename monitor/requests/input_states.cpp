#include "monitor/requests/input_states.hpp"
#include "monitor/tick/read_inputs.hpp"

#include <utility>

namespace clearance {
namespace {

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
    read_inputs(loop.monitor, state_);
  }

  const Scene& scene_;
  InputState state_;
  bool is_of_scene_ = false;
};

}  // namespace

// The time of asking is read before the loop is asked, so that its answer is not older.
std::shared_ptr<const InputState> InputStates::of(const std::shared_ptr<const Cell>& cell,
                                                  Time since) {
  const Lock lock(mutex_);
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
