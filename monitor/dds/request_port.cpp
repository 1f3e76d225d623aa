#include "monitor/dds/request_port.hpp"

#include <fmt/format.h>

#include <span>
#include <utility>
#include <variant>

#include "config/text/fnv1a.hpp"
#include "config/text/sentences.hpp"
#include "monitor/app/log_line.hpp"
#include "monitor/loop/ports.hpp"
#include "monitor/loop/realtime.hpp"
#include "monitor/wire/report_checksum.hpp"

namespace clearance {
namespace {

// Answers to clients that are not named: a name costs memory for as long as the daemon runs.
constexpr std::size_t kMostStrangers = 64;
constexpr std::int64_t kSecondNs = 1'000'000'000;

// The bytes of a request that is sent again are the same.
std::uint64_t hash_of(std::span<const std::byte> bytes) {
  Fnv1a hash;
  hash.add(bytes);
  return hash.value();
}

template <class Traffic>
dds_entity_t make_reader(const Cell& cell, Participant& participant, NameLimit& names,
                         const LapsedWriters& lapsed) {
  const dds_topic_filter filter = filter_of(names);
  return participant.reader(Traffic::kRequests, cell.topics.*topic(Traffic::kRequests).name, 0,
                            lapsed.listener(), &filter);
}

// The differences between commands and questions.
void begin_thread(const CommandTraffic&) { name_thread(CommandTraffic::kKey); }
void begin_thread(const QuestionTraffic&) {
  name_thread(QuestionTraffic::kKey);
  lower_priority();
}
CommandResult malformed(MalformedField fault, CommandResult of) {
  of.change = fault.change;
  of.path = std::move(fault.path);
  of.reason = std::move(fault.reason);
  return of;
}
QuestionResult malformed(MalformedField fault, QuestionResult of) {
  of.path = std::move(fault.path);
  of.reason = std::move(fault.reason);
  return of;
}
GivenCommand queued(Command command, AnswerCommand answer, std::uint64_t content) {
  return {std::move(command), false, std::move(answer), content};
}
QueuedQuestion queued(MotionQuestion question, std::function<void(const QuestionResult&)> answer,
                      std::uint64_t /*content*/) {
  return {std::move(question), std::move(answer)};
}
std::string too_many(const CommandTraffic&) {
  return fmt::format("found {} that wait; expected that the same command is sent again later",
                     counted(SceneQueue::kMost, "command"));
}
std::string too_many(const QuestionTraffic&) {
  return "found as many questions of this client that wait as `questions: queue` of the cell "
         "allows; expected that the same question is sent again later";
}
constexpr const auto& refusal_line(const CommandTraffic&) { return lines::kCommandRefused; }
constexpr const auto& refusal_line(const QuestionTraffic&) { return lines::kQuestionRefused; }
constexpr const auto& left_out_line(const CommandTraffic&) { return lines::kCommandsLeftOut; }
constexpr const auto& left_out_line(const QuestionTraffic&) { return lines::kQuestionsLeftOut; }

}  // namespace

template <class Traffic>
RequestPort<Traffic>::RequestPort(const Cell& cell, const std::vector<std::string>& clients,
                                  Participant& participant, std::uint64_t daemon, Put put,
                                  std::function<std::uint64_t()> revision, Sharing sharing)
    : daemon_(daemon),
      put_(std::move(put)),
      revision_(std::move(revision)),
      sharing_(std::move(sharing)),
      ledger_(clients, Traffic::kKey),
      refusal_lines_(left_out_line(Traffic{})),
      reader_(make_reader<Traffic>(cell, participant, names_, lapsed_)),
      results_(participant.writer(Traffic::kResults, cell.topics.*topic(Traffic::kResults).name)),
      address_(participant.address(cell.topics.*topic(Traffic::kResults).name)),
      wait_(participant, {reader_}) {}

template <class Traffic>
void RequestPort<Traffic>::start() {
  thread_ = std::thread([this] { run(); });
}

template <class Traffic>
RequestPort<Traffic>::~RequestPort() {
  stop_ = true;
  wait_.wake();
  if (thread_.joinable()) thread_.join();
  dds_delete(reader_);
  dds_delete(results_);
}

template <class Traffic>
void RequestPort<Traffic>::run() {
  begin_thread(Traffic{});
  while (!stop_) {
    wait_.wait(kSecondNs);
    if (stop_) return;
    try {
      take_all();
    } catch (const DdsError& error) {
      log_line(lines::kInputsFailed, error.what());
    }
  }
}

template <class Traffic>
void RequestPort<Traffic>::take_all() {
  while (take_cdr(reader_, taken_, &ended_) > 0 && !stop_) {
    for (const std::uint64_t name : std::exchange(ended_, {})) names_.forget_name(name);
    std::vector<std::uint64_t> writers = writers_of(reader_);
    names_.keep(writers);
    lapsed_.remove_from(writers);
    ledger_.keep_writers(writers);
    for (const CdrSample& sample : taken_) take(sample);
    taken_.clear();
  }
}

// Cyclone has refused what is no message at all: a truncated one never comes here. Each message is
// decoded into an empty sample. Cyclone takes what a union holds for what it shall hold, and would
// use a number of the last change as the pointer of a text.
template <class Traffic>
void RequestPort<Traffic>::take(const CdrSample& sample) {
  using Status = decltype(Result::status);
  const std::span<const std::byte> bytes = sample.bytes();
  Sample<typename Traffic::Message> message;
  if (!decoder_.decode(bytes, message, CdrBytes::kOfReader)) return;
  const bool is_taken = !sharing_.takes || sharing_.takes();
  if (!is_taken && !sharing_.overhear) return;
  const typename Ledger::Request request{message->client, message->request, hash_of(bytes)};
  auto refused = ledger_.refuse_sender(request, sample.writer());
  if (refused && is_taken) return answer_at_once(*std::move(refused));
  if (refused) return;
  auto read = from_wire(*message);
  if (!is_taken) {
    if (auto* overheard = std::get_if<Request>(&read)) sharing_.overhear(std::move(*overheard));
    return;
  }
  if (auto* fault = std::get_if<MalformedField>(&read)) {
    return answer_at_once(malformed(
        std::move(*fault),
        {.client = request.client, .request = request.number, .status = Status::kMalformed}));
  }
  auto verdict = ledger_.admit(request);
  switch (verdict.next) {
    case Ledger::Next::kDo:
      return pass_on(std::get<Request>(std::move(read)), request);
    case Ledger::Next::kWait:
      return;
    case Ledger::Next::kAnswer:
      if (verdict.result.scene_revision == 0) return answer_at_once(std::move(verdict.result));
      return write(verdict.result);
  }
}

template <class Traffic>
void RequestPort<Traffic>::pass_on(Request request, const typename Ledger::Request& known_as) {
  const auto answer = [this, known_as](const Result& result) {
    if (result.status == decltype(Result::status)::kBusy) {
      ledger_.withdraw(known_as);
    } else {
      ledger_.answer(result);
    }
    if (!result.done()) log_refusal(result);
    write(result);
  };
  if (put_(queued(std::move(request), answer, known_as.content))) return;
  ledger_.withdraw(known_as);
  answer_at_once({.client = known_as.client,
                  .request = known_as.number,
                  .status = decltype(Result::status)::kBusy,
                  .reason = too_many(Traffic{})});
}

// A refusal that no other thread has seen.
template <class Traffic>
void RequestPort<Traffic>::answer_at_once(Result result) {
  log_refusal(result);
  if (result.status == decltype(Result::status)::kNotNamed) {
    if (strangers_.size() >= kMostStrangers && !strangers_.contains(result.client)) return;
    strangers_.insert(result.client);
  }
  result.scene_revision = revision_();
  write(result);
}

template <class Traffic>
void RequestPort<Traffic>::write(const Result& result) {
  auto message = to_wire(result, daemon_);
  seal(*message, address_);
  const Lock lock(mutex_);
  dds_write(results_, &*message);
}

template <class Traffic>
void RequestPort<Traffic>::log_refusal(const Result& result) {
  if (!refusal_lines_.admits(SystemClock().monotonic_ns())) return;
  log_line(refusal_line(Traffic{}), result.client, result.request, name_of(result.status),
           result.path.empty() ? result.reason : fmt::format("{}: {}", result.path, result.reason));
}

template class RequestPort<CommandTraffic>;
template class RequestPort<QuestionTraffic>;

}  // namespace clearance
