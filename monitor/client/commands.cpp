#include "monitor/client/commands.hpp"

#include "monitor/wire/topics.hpp"

namespace clearance::client {
namespace {

auto maker(const std::vector<CellChange>& changes, const CommandOptions& options) {
  return [&](const std::string& client, std::uint64_t number) {
    return Command{client, number, options.scene_revision, options.dry_run, changes, options.files};
  };
}

}  // namespace

Commands::Commands(Connection& connection, std::string_view client)
    : Requests(connection, client, TopicKind::kCommands, TopicKind::kCommandResults) {}

std::uint64_t Commands::post(const std::vector<CellChange>& changes,
                             const CommandOptions& options) {
  return Requests::post(maker(changes, options));
}

std::optional<CommandResult> Commands::send(const std::vector<CellChange>& changes,
                                            const CommandOptions& options,
                                            std::chrono::nanoseconds timeout) {
  return Requests::send(maker(changes, options), options.stop, timeout);
}

}  // namespace clearance::client
