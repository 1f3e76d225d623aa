#include "monitor/daemon/share_scenes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "config/cell/share_topics.hpp"
#include "monitor/app/log_line.hpp"
#include "monitor/intake/tracked_persons.hpp"
#include "monitor/loop/ports.hpp"
#include "monitor/loop/realtime.hpp"

namespace clearance {
namespace {

constexpr std::int64_t kPollNs = 10'000'000;
constexpr std::int64_t kAgainNs = 1'000'000'000;
// The first share waits so long before it takes a scene: it may come to have the same one itself.
constexpr std::int64_t kFirstWaitsNs = 200'000'000;
// The lists of bodies have no effect here for so long before people are unknown, beside the lease.
constexpr std::int64_t kAloneNs = 1'000'000'000;
constexpr std::int64_t kMeetingNs = 1'000'000'000, kMeetingAtMostNs = 3'000'000'000;

std::vector<std::string> names_of(const Shares& shares) {
  std::vector<std::string> names;
  for (const Share& share : shares.all) names.push_back(share.name);
  return names;
}

}  // namespace

std::optional<std::size_t> SceneToFollow::share_that_counts(std::uint64_t in_force,
                                                            bool has_changed) {
  if (own_ != 0) {
    const Told& first = told_.front();
    if (first.daemon == 0) return std::nullopt;
    const bool agrees = first.revision == in_force;
    const bool counts = agreed_.empty() || agreed_.contains(first.daemon);
    if (agrees) agreed_.insert(first.daemon);
    return counts && !agrees ? std::optional<std::size_t>(0) : std::nullopt;
  }
  std::optional<std::size_t> most;
  std::map<std::uint64_t, int> counts;
  for (const Told& told : told_) counts[told.revision] += told.has_changed ? 1 : 0;
  for (std::size_t i = 1; i < told_.size() && !has_changed; ++i) {
    const bool is_more = !most || counts[told_[i].revision] > counts[told_[*most].revision];
    if (told_[i].has_changed && told_[i].revision != in_force && is_more) most = i;
  }
  return most;
}

std::optional<std::size_t> SceneToFollow::find(std::uint64_t in_force, bool has_changed,
                                               std::int64_t now_ns) {
  const auto share = share_that_counts(in_force, has_changed);
  const std::int64_t age_ns = now_ns - start_ns_;
  const bool has_heard_all =
      std::ranges::count(told_, std::uint64_t{0}, &Told::daemon) == (own_ == 0 ? 1 : 0);
  is_settled_ = is_settled_ || age_ns > kMeetingAtMostNs ||
                (!share && (has_heard_all || age_ns > kMeetingNs));
  const std::uint64_t theirs = share ? told_[*share].revision : in_force;
  if (std::exchange(theirs_, theirs) != theirs) {
    due_ns_ = now_ns + (own_ == 0 ? kFirstWaitsNs : 0);
  } else if (ours_ != in_force) {
    due_ns_ = now_ns + kAgainNs;
  }
  ours_ = in_force;
  if (!share || now_ns < due_ns_) return std::nullopt;
  due_ns_ = now_ns + kAgainNs;
  return share;
}

// The first share hears all others, and these hear the first one.
ShareScenes::ShareScenes(const Cell& cell, Participant& participant, Actions actions)
    : own_(*cell.shares.own),
      names_(names_of(cell.shares)),
      follows_bodies_(!cell.ros.moveit.tracked_bodies.empty()),
      actions_(std::move(actions)),
      first_alive_ns_(SystemClock().monotonic_ns()),
      to_follow_(own_, names_.size(), first_alive_ns_) {
  std::vector<dds_entity_t> readers;
  for (std::size_t share = 0; share < names_.size(); ++share) {
    if ((share == 0) == (own_ == 0)) continue;
    const std::string topic =
        topic_of_other_share(cell.topics.catalogue, names_[own_], names_[share]);
    Heard& heard = heard_.emplace_back(
        Heard{share, client::CheckedReader(participant, TopicKind::kCatalogue, topic, true)});
    readers.push_back(heard.reader.entity());
  }
  wait_ = std::make_unique<DataWait>(participant, readers);
}

ShareScenes::~ShareScenes() {
  stop();
  wait_.reset();
  for (const Heard& heard : heard_) dds_delete(heard.reader.entity());
}

void ShareScenes::start() {
  thread_ = std::thread([this] { run(); });
}

void ShareScenes::stop() {
  stop_ = true;
  wait_->wake();
  if (thread_.joinable()) thread_.join();
}

void ShareScenes::run() {
  name_thread("shares");
  SystemClock clock;
  while (!stop_) {
    wait_->wait(kPollNs);
    hear();
    look_for_first(clock.monotonic_ns());
    const std::uint64_t in_force = actions_.revision();
    const auto share = to_follow_.find(in_force, has_changed_, clock.monotonic_ns());
    if (share) take_over(*std::ranges::find(heard_, *share, &Heard::share));
    does_messages_ = is_first() && to_follow_.is_settled();
    actions_.update_lead();
  }
}

void ShareScenes::hear() {
  for (Heard& heard : heard_) {
    while (heard.reader.take(*taken_)) {
      std::swap(*heard.last, *taken_);
      note_told(heard);
    }
    const client::RefusedMessages& refused = heard.reader.refused();
    if (refused.count < heard.next_told) continue;
    heard.next_told = 2 * refused.count;
    log_line(lines::kShareCatalogueRefused, names_[heard.share], client::text_of({refused}));
  }
}

// Only the first share applies the lists of bodies. What it said last means nothing without it.
void ShareScenes::look_for_first(std::int64_t now_ns) {
  if (is_first() || !follows_bodies_) return;
  const Heard& first = heard_.front();
  if (writers_alive(first.reader.entity()) > 0) {
    first_alive_ns_ = now_ns;
    if (is_alone_.exchange(false)) note_told(first);
    return;
  }
  if (now_ns - first_alive_ns_ < kAloneNs) return;
  to_follow_.hear(first.share, {});
  if (!is_alone_.exchange(true)) {
    log_line(lines::kShareAlone, names_[first.share]);
  } else if (now_ns - unknown_ns_ < kAgainNs) {
    return;
  }
  unknown_ns_ = now_ns;
  MadeCommand made{.sender = "shares"};
  made.make = [this](const Cell& cell, const AskPose&) {
    return is_alone_ && actions_.changes()
               ? Command{.changes = changes_by_bodies(std::nullopt, cell.scene)}
               : Command{};
  };
  made.answer = [](const CommandResult&) {};
  static_cast<void>(actions_.put(std::move(made)));
}

void ShareScenes::note_told(const Heard& heard) {
  to_follow_.hear(heard.share, {.daemon = heard.last->daemon,
                                .revision = heard.last->scene_revision,
                                .has_changed = heard.last->in_force_from != 0});
}

// One command waits at a time. It takes over the scene that was heard last.
void ShareScenes::take_over(const Heard& heard) {
  const Lock lock(mutex_);
  wanted_ = {heard.share, heard.last->scene_revision, heard.last->cell_yaml};
  if (!is_queued_) is_queued_ = actions_.put(command());
}

// By its turn this daemon may have the scene.
MadeCommand ShareScenes::command() {
  const auto doing = std::make_shared<Wanted>();
  MadeCommand made{.sender = "shares"};
  made.make = [this, doing](const Cell& cell, const AskPose&) {
    const Lock lock(mutex_);
    is_queued_ = false;
    *doing = wanted_;
    const bool has_it = cell.scene.revision == doing->revision;
    return has_it || !actions_.changes() ? Command{}
                                         : Command{.changes = {ReplaceCell{doing->text}}};
  };
  made.answer = [this, doing](const CommandResult& result) {
    const bool is_taken = result.done() && result.scene_revision == doing->revision;
    if (is_taken || std::exchange(refused_, doing->revision) == doing->revision) return;
    log_line(lines::kShareSceneRefused, names_[doing->share], doing->revision,
             result.done() ? "files or options differ" : result.reason);
  };
  return made;
}

}  // namespace clearance
