// The parts of a daemon that other daemons of the same cell share: its partner, and those of other
// shares.
#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "monitor/daemon/daemon.hpp"

namespace clearance {

Daemon::Partnership::Partnership(const Cell& cell, Participant& participant, PoseReader& poses,
                                 Clock& clock, const DaemonIdentity& identity)
    : ticks(poses, clock,
            {.period_ns = std::llround(1e9 / cell.scene.rate_hz),
             .daemon = identity.id,
             .start_ns = identity.start_ns,
             .batch = {.samples = PoseReader::samples_a_batch(cell),
                       .joints = PoseReader::joints_a_batch(cell)},
             .frames = poses.frames()}),
      port(participant, cell.topics, identity, ticks),
      poses_(poses) {
  poses.share_frames(cell.topics, identity, ticks);
}

void Daemon::share_states() {
  partner_states_ = std::make_unique<PartnerStates>(
      partner_->port, partner_->ticks, *loop_, *changer_, *scene_thread_, moveit_, loop_ended_,
      recording_.get(), [this](SceneTask task) { return put(std::move(task)); },
      [this] { return revision_.load(); });
}

ClientPorts::Actions Daemon::client_actions() {
  ClientPorts::Actions actions{
      .put = [this](GivenCommand given) { return put(std::move(given)); },
      .revision = [this] { return revision_.load(); },
      .frames = [this](std::uint64_t of_scene) { return poses_.seen(of_scene); },
      .commands = {},
      .questions = {},
      .leads = leads()};
  if (!partner_) return actions;
  actions.put = [this](GivenCommand given) {
    return put(partner_states_->for_both(std::move(given)));
  };
  actions.commands.takes =
      actions.questions.takes = [this] { return partner_states_->takes_requests(); };
  actions.commands.overhear = [this](Command command) {
    partner_states_->keep_files(std::move(command));
  };
  return actions;
}

// Only the daemon that others follow reads the cell's file.
std::optional<std::string> Daemon::followed() const {
  const auto standing = partner_ ? partner_->ticks.standing() : PartnerStanding::kLeading;
  if (standing == PartnerStanding::kStarting) return std::nullopt;
  if (standing != PartnerStanding::kLeading) return "the leading partner";
  if (shares_ && !shares_->is_first()) return fmt::format("the share '{}'", shares_->first());
  return "";
}

// In a cell in shares, the daemon of the first share does MoveIt's messages.
void Daemon::share_scenes() {
  if (now_.cell->ros.moveit.any() && now_.cell->shares.is_one()) {
    shares_ = std::make_unique<ShareScenes>(
        *now_.cell, participant_,
        ShareScenes::Actions{.put = [this](SceneTask task) { return put(std::move(task)); },
                             .revision = [this] { return revision_.load(); },
                             .changes =
                                 [this] {
                                   return !partner_ ||
                                          partner_->ticks.standing() == PartnerStanding::kLeading;
                                 },
                             .update_lead = [this] { moveit_.update_lead(); }});
  }
  if (!partner_ && !shares_) return;
  MoveItPort::Sharing sharing{.leads = leads(), .revision = [this] { return revision_.load(); }};
  if (partner_) {
    // A leader whose lease has ended for a moment tells as well: its partner has to know what led
    // to its scene, and asks for no lease before it follows.
    sharing.tell = [partner = partner_.get()](auto changes, auto bytes) {
      if (partner->ticks.standing() == PartnerStanding::kLeading)
        partner->port.send_scene(changes, bytes);
    };
    sharing.both_have = [this] {
      return !partner_->port.hears_partner() || partner_->port.partner_revision() == revision_;
    };
  }
  if (shares_) {
    sharing.leads = [shares = shares_.get(), of_partners = sharing.leads] {
      return shares->does_messages() && (!of_partners || of_partners());
    };
    if (!shares_->is_first()) sharing.leads = nullptr;
  }
  moveit_.share(std::move(sharing));
}

PartnerPort::Actions Daemon::partner_actions() {
  PartnerPort::Actions actions = partner_states_->actions();
  actions.hear_scene = [this](const auto& scene) { moveit_.hear(scene); };
  actions.update_lead = [this] { moveit_.update_lead(); };
  return actions;
}

RosWrites::Leads Daemon::leads() {
  if (!partner_) return {};
  return [port = &partner_->port] { return port->leads(); };
}

void Daemon::stop_sharing() {
  if (partner_) partner_->port.stop();
  if (shares_) shares_->stop();
}

}  // namespace clearance
