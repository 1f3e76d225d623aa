#include "monitor/client/requests.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "monitor/participant/command_message.hpp"
#include "monitor/participant/participant.hpp"
#include "monitor/participant/question_message.hpp"
#include "monitor/wire/topics.hpp"

namespace clearance::client {
namespace {

constexpr std::size_t kKeptResults = 64;
constexpr std::int64_t kAgainNs = 1'000'000'000;  // until a request is sent again
constexpr std::int64_t kPollNs = 5'000'000;       // between two polls for a daemon
constexpr std::int64_t kLeaseNs = 2'000'000'000;  // a killed program's name is free after this time
constexpr std::int64_t kAskNs = 50'000'000;       // until the caller is asked again
constexpr std::int64_t kMeetNs = 20'000'000;      // between two polls for another daemon

// The daemons' readers of requests, and their writers of results, that this client has met.
struct Met {
  std::uint32_t readers = 0, writers = 0;
  [[nodiscard]] bool more(const Met& before) const noexcept {
    return readers > before.readers || writers > before.writers;
  }
};
Met met(dds_entity_t writer, dds_entity_t reader) {
  dds_publication_matched_status_t readers{};
  dds_subscription_matched_status_t writers{};
  if (dds_get_publication_matched_status(writer, &readers) != DDS_RETCODE_OK ||
      dds_get_subscription_matched_status(reader, &writers) != DDS_RETCODE_OK)
    return {};
  return {readers.current_count, writers.current_count};
}

}  // namespace

// Asks the caller whether to end a wait, not more often than every kAskNs.
template <class Request, class Result, class Message>
class Requests<Request, Result, Message>::Stop {
 public:
  explicit Stop(std::function<bool()> ask) : ask_(std::move(ask)) {}
  [[nodiscard]] bool operator()() {
    if (stopped_ || !ask_ || monotonic_ns() < next_ns_) return stopped_;
    next_ns_ = monotonic_ns() + kAskNs;
    return stopped_ = ask_();
  }
  // The time until a wait has to end so that the caller can be asked.
  [[nodiscard]] std::int64_t slice(std::int64_t left_ns) const noexcept {
    return ask_ ? std::min(left_ns, kAskNs) : left_ns;
  }

 private:
  std::function<bool()> ask_;
  std::int64_t next_ns_ = 0;
  bool stopped_ = false;
};

template <class Request, class Result, class Message>
Requests<Request, Result, Message>::Requests(Connection& connection, std::string_view client,
                                             TopicKind requests, TopicKind results)
    : client_(client),
      reader_(connection.participant(), results, connection.topics().*topic(results).name) {
  if (client.empty() || client.size() > 32) {
    throw std::invalid_argument(fmt::format(
        "the client '{}' has {} bytes; expected a name of 1 to 32", client, client.size()));
  }
  Participant& participant = connection.participant();
  const Topics& topics = connection.topics();
  writer_ =
      participant.writer(requests, topics.*topic(requests).name, {.process_lease_ns = kLeaseNs});
  wait_ = std::make_unique<DataWait>(participant, std::vector{reader_.entity()});
}

template <class Request, class Result, class Message>
Requests<Request, Result, Message>::~Requests() {
  wait_.reset();
  dds_delete(writer_);
  dds_delete(reader_.entity());
}

template <class Request, class Result, class Message>
bool Requests<Request, Result, Message>::is_heard() const {
  const Met now = met(writer_, reader_.entity());
  return now.readers > 0 && now.writers > 0;
}

template <class Request, class Result, class Message>
bool Requests<Request, Result, Message>::write(const Request& request) {
  const auto message = to_wire(request);
  return dds_write(writer_, &*message) == DDS_RETCODE_OK;
}

template <class Request, class Result, class Message>
Request Requests<Request, Result, Message>::next(const Make& make) {
  request_ = std::max(request_ + 1, static_cast<std::uint64_t>(now_ns()));
  return make(client_, request_);
}

template <class Request, class Result, class Message>
std::uint64_t Requests<Request, Result, Message>::post(const Make& make) {
  return write(next(make)) ? request_ : 0;
}

// The topic is volatile, so a request that is written before a daemon is met does not arrive. Only
// one of two partners answers, and it may be the one that is met later.
template <class Request, class Result, class Message>
std::optional<Result> Requests<Request, Result, Message>::send(const Make& make,
                                                               std::function<bool()> ask,
                                                               std::chrono::nanoseconds timeout) {
  const std::int64_t end_ns = monotonic_ns() + timeout.count();
  Stop stop(std::move(ask));
  while (!is_heard() && monotonic_ns() < end_ns && !stop()) dds_sleepfor(kPollNs);
  if (!is_heard() || stop()) return std::nullopt;
  const Request request = next(make);
  const std::int64_t alone_ns = monotonic_ns() + kLeaseNs + kAgainNs / 2;
  do {
    const Met before = met(writer_, reader_.entity());
    (void)write(request);
    const std::int64_t again_ns = std::min(end_ns, monotonic_ns() + kAgainNs);
    std::optional<Result> result;
    do {
      result = wait_for(request_, std::min(again_ns, monotonic_ns() + kMeetNs), stop);
    } while (!result && monotonic_ns() < again_ns && !stop() &&
             !met(writer_, reader_.entity()).more(before));
    if (result) {
      // In these cases the daemon has not taken the request.
      using Status = decltype(Result::status);
      const bool is_to_repeat =
          result->status == Status::kBusy ||
          (result->status == Status::kTwoWriters && monotonic_ns() < alone_ns);
      if (!is_to_repeat) return result;
      if (monotonic_ns() + kAgainNs >= end_ns) return result;
      results_.erase(request_);
      const std::int64_t pause_ns = monotonic_ns() + kAgainNs;
      while (monotonic_ns() < pause_ns && !stop())
        dds_sleepfor(stop.slice(pause_ns - monotonic_ns()));
    }
  } while (monotonic_ns() < end_ns && !stop());
  return std::nullopt;
}

template <class Request, class Result, class Message>
std::optional<Result> Requests<Request, Result, Message>::result(std::uint64_t request,
                                                                 std::chrono::nanoseconds timeout) {
  Stop never({});
  return wait_for(request, monotonic_ns() + timeout.count(), never);
}

template <class Request, class Result, class Message>
void Requests<Request, Result, Message>::take_results() {
  while (reader_.take(*message_)) {
    if (client_ != message_->client) continue;
    Result result = from_wire(*message_);
    results_[result.request] = std::move(result);
    if (results_.size() > kKeptResults) results_.erase(results_.begin());
  }
}

template <class Request, class Result, class Message>
std::optional<Result> Requests<Request, Result, Message>::wait_for(std::uint64_t request,
                                                                   std::int64_t end_ns,
                                                                   Stop& stop) {
  while (true) {
    take_results();
    if (const auto found = results_.find(request); found != results_.end()) return found->second;
    const std::int64_t left_ns = end_ns - monotonic_ns();
    if (left_ns <= 0 || stop()) return std::nullopt;
    wait_->wait(stop.slice(left_ns));
  }
}

template class Requests<Command, CommandResult, clearance_msg_CommandResult>;
template class Requests<MotionQuestion, QuestionResult, clearance_msg_Answer>;

}  // namespace clearance::client
