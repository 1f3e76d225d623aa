#include "monitor/daemon/client_ports.hpp"

#include <utility>

namespace clearance {

ClientPorts::ClientPorts(std::shared_ptr<const Cell> cell, Participant& participant,
                         std::uint64_t daemon, TickLoop& loop, const std::atomic<bool>& loop_ended,
                         const Actions& actions) {
  const auto& commanders = cell->commands.from;
  const auto& askers = cell->questions.from;
  const RosTrajectories& trajectories = cell->ros.trajectories;
  if (!commanders.empty()) {
    commands_ = std::make_unique<CommandPort>(*cell, commanders, participant, daemon, actions.put,
                                              actions.revision, actions.commands);
  }
  if (askers.empty() && trajectories.topics.empty()) return;
  desk_ = std::make_unique<QuestionDesk>(cell, loop, loop_ended, trajectories.topics.size(),
                                         actions.frames);
  const auto put = [desk = desk_.get()](QueuedQuestion question) {
    return desk->put(std::move(question));
  };
  if (!askers.empty()) {
    questions_ = std::make_unique<QuestionPort>(*cell, askers, participant, daemon, put,
                                                actions.revision, actions.questions);
  }
  if (!trajectories.topics.empty()) {
    trajectories_ = std::make_unique<TrajectoryPort>(cell->scene.name, trajectories, participant,
                                                     put, actions.leads);
  }
}

void ClientPorts::start() {
  if (commands_) commands_->start();
  if (desk_) desk_->start();
  if (questions_) questions_->start();
  if (trajectories_) trajectories_->start();
}

void ClientPorts::follow(const std::shared_ptr<const Cell>& cell) {
  if (desk_) desk_->follow(cell);
}

void ClientPorts::end_questions() {
  if (desk_) desk_->end();
  questions_.reset();
  trajectories_.reset();
}

}  // namespace clearance
