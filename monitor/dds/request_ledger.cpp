#include "monitor/dds/request_ledger.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "config/text/sentences.hpp"

namespace clearance {
namespace {

template <class Result>
Result refusal(const typename RequestLedger<Result>::Request& request,
               decltype(Result::status) status, std::string reason) {
  return {.client = request.client,
          .request = request.number,
          .status = status,
          .reason = std::move(reason)};
}

}  // namespace

template <class Result>
RequestLedger<Result>::RequestLedger(const std::vector<std::string>& clients, std::string key)
    : key_(std::move(key)), expected_(one_of(clients)) {
  for (const std::string& name : clients) clients_.emplace(name, Client{});
}

template <class Result>
std::optional<Result> RequestLedger<Result>::refuse_sender(const Request& request,
                                                           std::uint64_t writer) {
  using Status = decltype(Result::status);
  const Lock lock(mutex_);
  const auto client = clients_.find(request.client);
  if (client == clients_.end()) {
    return refusal<Result>(request, Status::kNotNamed,
                           fmt::format("found a request of '{}'; expected {}. Send it under such "
                                       "a name, or name this client under '{}: from' in the "
                                       "cell or with --{}",
                                       request.client, expected_, key_, key_));
  }
  std::vector<std::uint64_t>& writers = client->second.writers;
  if (std::ranges::find(writers, writer) == writers.end() && writers.size() < kWriters)
    writers.push_back(writer);
  if (writers.size() == 1) {
    if (client->second.writer != writer) client->second.last = 0;
    client->second.writer = writer;
    return std::nullopt;
  }
  return refusal<Result>(
      request, Status::kTwoWriters,
      fmt::format("found {} programs that send as '{}'; expected one. One that was "
                  "killed counts until its lease ends, 2 s with Clearance's client and up to 10 s "
                  "with others",
                  writers.size(), request.client));
}

template <class Result>
typename RequestLedger<Result>::Verdict RequestLedger<Result>::admit(const Request& request) {
  using Status = decltype(Result::status);
  const Lock lock(mutex_);
  Client& client = clients_[request.client];
  const auto known = std::ranges::find(client.known, request.number, &Known::number);
  if (known != client.known.end()) {
    if (known->content != request.content) {
      return {
          Next::kAnswer,
          refusal<Result>(request, Status::kOtherContent,
                          fmt::format("found request {} with another content than before; expected "
                                      "numbers from {}",
                                      request.number, client.last + 1))};
    }
    if (!known->result) return {Next::kWait};
    return {Next::kAnswer, *known->result};
  }
  if (request.number <= client.last) {
    return {
        Next::kAnswer,
        refusal<Result>(request, Status::kOutOfOrder,
                        fmt::format("found request {} after request {}; expected a later number",
                                    request.number, client.last))};
  }
  client.known.push_back({request.number, request.content, client.last});
  client.last = request.number;
  if (client.known.size() > kKnown && client.known.front().result) client.known.pop_front();
  return {Next::kDo};
}

template <class Result>
void RequestLedger<Result>::answer(const Result& result) {
  const Lock lock(mutex_);
  Client& client = clients_[result.client];
  const auto known = std::ranges::find(client.known, result.request, &Known::number);
  if (known != client.known.end()) known->result = result;
}

template <class Result>
void RequestLedger<Result>::withdraw(const Request& request) {
  const Lock lock(mutex_);
  Client& client = clients_[request.client];
  std::erase_if(client.known, [&](const Known& known) {
    if (known.number != request.number || known.result) return false;
    if (client.last == request.number) client.last = known.before;
    return true;
  });
}

template <class Result>
void RequestLedger<Result>::keep_writers(std::span<const std::uint64_t> writers) {
  const Lock lock(mutex_);
  for (auto& [name, client] : clients_) {
    std::erase_if(client.writers, [&](std::uint64_t each) {
      return std::ranges::find(writers, each) == writers.end();
    });
  }
}

template class RequestLedger<CommandResult>;
template class RequestLedger<QuestionResult>;

}  // namespace clearance
