#include "tools/merge/command_relay.hpp"

#include <fmt/format.h>

#include <chrono>
#include <future>
#include <optional>
#include <utility>
#include <variant>

#include "config/cell/share_topics.hpp"
#include "monitor/loop/realtime.hpp"
#include "monitor/participant/participant.hpp"

namespace clearance::merge {
namespace {

constexpr std::chrono::seconds kPatience{10};                 // for the result of one share
constexpr std::chrono::nanoseconds kReported{2'000'000'000};  // for the first report after it

CommandResult refusal(const Command& command, CommandStatus status, std::string reason) {
  return {.client = command.client,
          .request = command.request,
          .status = status,
          .reason = std::move(reason)};
}

// The answer of a share, in the name of the client. Its cycles are not those of the whole cell.
CommandResult answer_to(const Command& asked, CommandResult of_share) {
  of_share.client = asked.client;
  of_share.request = asked.request;
  of_share.in_force_from = 0;
  return of_share;
}

// Each share would find another pose or position, or none: the scenes would differ.
std::optional<std::uint32_t> needs_a_pose(const Command& command) {
  for (std::uint32_t i = 0; i < command.changes.size(); ++i) {
    const auto* const attach = std::get_if<Attach>(&command.changes[i]);
    const auto* const detach = std::get_if<Detach>(&command.changes[i]);
    const auto* const attach_robot = std::get_if<AttachRobot>(&command.changes[i]);
    const auto* const detach_robot = std::get_if<DetachRobot>(&command.changes[i]);
    if ((attach != nullptr && !attach->carrier_from_object) ||
        (detach != nullptr && !detach->world_from_object) ||
        (attach_robot != nullptr && !attach_robot->carrier_from_root) ||
        (detach_robot != nullptr && (!detach_robot->world_from_root ||
                                     (!detach_robot->powered && detach_robot->joints.empty()))))
      return i;
  }
  return std::nullopt;
}

// Each share counts the cycles of its own daemon.
std::optional<std::uint32_t> ends_by_cycle(const Command& command) {
  for (std::uint32_t i = 0; i < command.changes.size(); ++i) {
    const auto* const allow = std::get_if<AllowContact>(&command.changes[i]);
    if (allow != nullptr && allow->end.last_cycle != ContactEnd::kNoCycle) return i;
  }
  return std::nullopt;
}

}  // namespace

CommandRelay::CommandRelay(client::Connection& connection, const Cell& cell, std::uint64_t daemon)
    : connection_(connection), follow_first_(cell.ros.moveit.any()) {
  if (cell.commands.from.empty()) return;
  for (const Share& share : cell.shares.all) {
    ShareClient& of = shares_.emplace_back();
    of.name = share.name;
    of.connection = std::make_unique<client::Connection>(connection.participant().handle(),
                                                         connection.participant().partition(),
                                                         topics_of_share(cell.topics, share.name));
    for (const std::string& name : cell.commands.from)
      of.commands[name] = std::make_unique<client::Commands>(*of.connection, name);
  }
  port_ = std::make_unique<CommandPort>(
      cell, cell.commands.from, connection_.participant(), daemon,
      [this](GivenCommand command) {
        const Lock lock(mutex_);
        if (stop_ || queue_.size() >= SceneQueue::kMost) return false;
        queue_.push_back(std::move(command));
        changed_.notify_one();
        return true;
      },
      [this] { return revision_.load(); });
  port_->start();
  thread_ = std::thread([this] { run(); });
}

// The port ends last: results go through it.
CommandRelay::~CommandRelay() {
  if (!thread_.joinable()) return;
  {
    const Lock lock(mutex_);
    stop_ = true;
  }
  changed_.notify_one();
  thread_.join();
  port_.reset();
}

void CommandRelay::note(const client::SharedCell& whole) {
  whole_in_ = whole.is_whole() ? whole->scene_revision : 0;
  if (revision_ == whole->scene_revision) return;
  since_cycle_ = whole->cycle;
  revision_ = whole->scene_revision;
}

void CommandRelay::run() {
  name_thread("commands");
  for (;;) {
    GivenCommand next;
    {
      Lock lock(mutex_);
      changed_.wait(lock, [this]() REQUIRES(mutex_) { return stop_ || !queue_.empty(); });
      if (stop_) return;
      next = std::move(queue_.front());
      queue_.pop_front();
    }
    const CommandResult result = pass_on(next.command);
    if (next.answer) next.answer(result);
  }
}

CommandResult CommandRelay::send(ShareClient& share, const Command& command, bool dry_run) {
  client::Commands& commands = *share.commands.at(command.client);
  const auto result = commands.send(command.changes,
                                    {.scene_revision = command.scene_revision,
                                     .dry_run = dry_run,
                                     .files = command.files,
                                     .stop = [this] { return stop_.load(); }},
                                    kPatience);
  if (!result) return refusal(command, CommandStatus::kFailed, "it did not answer");
  return *result;
}

// All at once, so that they change within a short time of each other.
std::vector<CommandResult> CommandRelay::send_to_all(const Command& command, bool dry_run) {
  std::vector<std::future<CommandResult>> sent;
  for (ShareClient& share : shares_) {
    sent.push_back(std::async(std::launch::async, [&] { return send(share, command, dry_run); }));
  }
  std::vector<CommandResult> results;
  for (auto& each : sent) results.push_back(each.get());
  return results;
}

// The first report of that scene; 0: it has not come in time.
std::uint64_t CommandRelay::in_force_from(std::uint64_t revision) const {
  const std::int64_t end_ns = client::monotonic_ns() + kReported.count();
  while (revision_ != revision && !stop_ && client::monotonic_ns() < end_ns)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return revision_ == revision ? since_cycle_.load() : 0;
}

// A share may have taken over the scene of the first one before the command came to it.
bool CommandRelay::all_get(std::uint64_t revision) const {
  const std::int64_t end_ns = client::monotonic_ns() + kReported.count();
  while (whole_in_ != revision && !stop_ && client::monotonic_ns() < end_ns)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return whole_in_ == revision;
}

// All shares are asked first whether they can make the change. A share that then refuses it all the
// same is of another revision, so that the cell is not whole until it agrees.
CommandResult CommandRelay::pass_on(const Command& asked) {
  const std::uint64_t revision = revision_;
  if (asked.scene_revision != 0 && asked.scene_revision != revision)
    return refusal(asked, CommandStatus::kOtherRevision,
                   fmt::format("the scene in force has the revision {:016x}", revision));
  if (const auto change = needs_a_pose(asked)) {
    CommandResult result = refusal(asked, CommandStatus::kNoPose,
                                   "the shares of a cell do not read the same poses: state the "
                                   "pose");
    result.change = *change;
    return result;
  }
  if (const auto change = ends_by_cycle(asked)) {
    CommandResult result = refusal(asked, CommandStatus::kRefused,
                                   "the shares of a cell count other cycles than its clients see: "
                                   "end the contact by time_ns or duration");
    result.change = *change;
    return result;
  }
  Command command = asked;
  command.scene_revision = revision;
  std::vector<CommandResult> results = send_to_all(command, true);
  for (std::size_t i = 0; i < shares_.size(); ++i) {
    if (results[i].done()) continue;
    results[i].reason = fmt::format("the share '{}' refuses it, and no share has changed: {}",
                                    shares_[i].name, results[i].reason);
    return answer_to(asked, std::move(results[i]));
  }
  const std::uint64_t expected = results.front().scene_revision;
  for (std::size_t i = 0; i < shares_.size(); ++i) {
    if (results[i].scene_revision == expected) continue;
    return refusal(asked, CommandStatus::kFailed,
                   fmt::format("the shares '{}' and '{}' would have different scenes, and no share "
                               "has changed",
                               shares_.front().name, shares_[i].name));
  }
  if (asked.dry_run) return answer_to(asked, std::move(results.back()));
  results = send_to_all(command, false);
  std::string made, not_made;
  std::size_t last_made = 0;
  for (std::size_t i = 0; i < shares_.size(); ++i) {
    const bool is_same = results[i].scene_revision == expected;
    if (results[i].done() && is_same) {
      last_made = i;
      made += fmt::format("{}'{}'", made.empty() ? "" : ", ", shares_[i].name);
    } else {
      not_made += fmt::format("{}'{}': {}", not_made.empty() ? "" : ", ", shares_[i].name,
                              results[i].done() ? "its scene is another one" : results[i].reason);
    }
  }
  const bool may_come = follow_first_ && !made.empty();
  if (!not_made.empty() && !(may_come && all_get(expected))) {
    return refusal(asked, CommandStatus::kFailed,
                   fmt::format("not every share made it ({}){}; the cell is not whole until all "
                               "have the same scene",
                               not_made, made.empty() ? "" : fmt::format(", and {} did", made)));
  }
  CommandResult last = answer_to(asked, std::move(results[last_made]));
  last.in_force_from = in_force_from(last.scene_revision);
  return last;
}

}  // namespace clearance::merge
