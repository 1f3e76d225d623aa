#include "monitor/scene_changes/command_ledger.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace clearance {
namespace {

CommandResult refusal(const CommandLedger::Request& request, CommandStatus status,
                      std::string reason) {
  return {.client = request.client,
          .request = request.number,
          .status = status,
          .reason = std::move(reason)};
}

}  // namespace

CommandLedger::CommandLedger(const std::vector<std::string>& clients) {
  for (const std::string& name : clients) clients_.emplace(name, Client{});
}

std::optional<CommandResult> CommandLedger::refuse_sender(const Request& request,
                                                          std::uint64_t writer) {
  const std::lock_guard lock(mutex_);
  const auto client = clients_.find(request.client);
  if (client == clients_.end()) {
    return refusal(request, CommandStatus::kNotNamed,
                   fmt::format("found a command from '{}'; expected a client that the cell names "
                               "under 'commands: from', or --commands",
                               request.client));
  }
  std::vector<std::uint64_t>& writers = client->second.writers;
  if (std::ranges::find(writers, writer) == writers.end() && writers.size() < kWriters)
    writers.push_back(writer);
  if (writers.size() == 1) {
    if (client->second.writer != writer) client->second.last = 0;
    client->second.writer = writer;
    return std::nullopt;
  }
  return refusal(request, CommandStatus::kTwoWriters,
                 fmt::format("found {} programs that send as '{}'; expected one. A program that "
                             "was killed counts until its lease ends",
                             writers.size(), request.client));
}

CommandLedger::Verdict CommandLedger::admit(const Request& request) {
  const std::lock_guard lock(mutex_);
  Client& client = clients_[request.client];
  const auto known = std::ranges::find(client.known, request.number, &Known::number);
  if (known != client.known.end()) {
    if (known->content != request.content) {
      return {Next::kAnswer,
              refusal(request, CommandStatus::kOtherContent,
                      fmt::format("found request {} with another content than before; expected "
                                  "numbers from {}",
                                  request.number, client.last + 1))};
    }
    if (!known->result) return {Next::kWait};
    return {Next::kAnswer, *known->result};
  }
  if (request.number <= client.last) {
    return {Next::kAnswer,
            refusal(request, CommandStatus::kOutOfOrder,
                    fmt::format("found request {} after request {}; expected a later number",
                                request.number, client.last))};
  }
  client.known.push_back({request.number, request.content, client.last});
  client.last = request.number;
  if (client.known.size() > kKnown && client.known.front().result) client.known.pop_front();
  return {Next::kDo};
}

void CommandLedger::answer(const CommandResult& result) {
  const std::lock_guard lock(mutex_);
  Client& client = clients_[result.client];
  const auto known = std::ranges::find(client.known, result.request, &Known::number);
  if (known != client.known.end()) known->result = result;
}

void CommandLedger::withdraw(const Request& request) {
  const std::lock_guard lock(mutex_);
  Client& client = clients_[request.client];
  std::erase_if(client.known, [&](const Known& known) {
    if (known.number != request.number || known.result) return false;
    if (client.last == request.number) client.last = known.before;
    return true;
  });
}

void CommandLedger::keep_writers(std::span<const std::uint64_t> writers) {
  const std::lock_guard lock(mutex_);
  for (auto& [name, client] : clients_) {
    std::erase_if(client.writers, [&](std::uint64_t each) {
      return std::ranges::find(writers, each) == writers.end();
    });
  }
}

}  // namespace clearance
