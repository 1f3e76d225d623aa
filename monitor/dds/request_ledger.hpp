// Decides which requests of clients are done: by whom they are sent, in which order, and what was
// answered before. It neither knows DDS nor looks into a request.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "monitor/interface/command.hpp"
#include "monitor/interface/motion_question.hpp"
#include "monitor/interface/mutex.hpp"

namespace clearance {

// Any thread but that of the tick. `Result` is CommandResult or QuestionResult.
template <class Result>
class RequestLedger {
 public:
  // The number of a client's last requests whose results are known, and of the programs that may
  // send under its name before more are not told apart.
  static constexpr std::size_t kKnown = 64, kWriters = 8;

  // `clients`: those whose requests are taken. `key` is that of the cell which names them.
  RequestLedger(const std::vector<std::string>& clients, std::string key);

  struct Request {
    std::string client;
    std::uint64_t number = 0;
    std::uint64_t content = 0;  // a hash of the whole message
  };
  enum class Next : std::uint8_t {
    kDo,     // it is new, and pending from now on
    kWait,   // it is pending: its result follows
    kAnswer  // with this result
  };
  struct Verdict {
    Next next = Next::kDo;
    Result result = {};
  };

  // Tells whether this client may send requests, and whether this writer is the only one under its
  // name. Returns the refusal. The numbers of a new writer need not be above those of the one
  // before: a clock that was stepped back between two runs bars no client. To be called for every
  // message, also for one that is malformed.
  [[nodiscard]] std::optional<Result> refuse_sender(const Request& request, std::uint64_t writer);
  // Judges a request that refuse_sender() lets pass. kDo must be followed by answer() or
  // withdraw().
  [[nodiscard]] Verdict admit(const Request& request);
  // The result of a pending request, which is known from now on.
  void answer(const Result& result);
  // The pending request was not begun, and counts as not sent.
  void withdraw(const Request& request);
  // Forgets all writers except these, whose programs still run.
  void keep_writers(std::span<const std::uint64_t> writers);

 private:
  struct Known {
    std::uint64_t number = 0, content = 0;
    std::uint64_t before = 0;           // the last number then
    std::optional<Result> result = {};  // none: pending
  };
  struct Client {
    std::vector<std::uint64_t> writers = {};
    std::deque<Known> known = {};  // the last requests, in the order in which they came
    std::uint64_t writer = 0;      // the last that sent alone: a program that runs
    std::uint64_t last = 0;        // the largest number of this writer
  };
  const std::string key_, expected_;  // expected: "'planner' or 'operator'"
  Mutex mutex_;
  GUARDED_BY(mutex_) std::map<std::string, Client> clients_;
};

extern template class RequestLedger<CommandResult>;
extern template class RequestLedger<QuestionResult>;

}  // namespace clearance
