#include "monitor/dds/command_port.hpp"

#include <fmt/format.h>

#include <span>
#include <utility>
#include <variant>

#include "config/text/sentences.hpp"
#include "monitor/app/log_lines.hpp"
#include "monitor/commands/command_message.hpp"
#include "monitor/loop/ports.hpp"
#include "monitor/loop/realtime.hpp"

namespace clearance {
namespace {

// Answers to clients that are not named: a name costs memory for as long as the daemon runs.
constexpr std::size_t kMostStrangers = 64;
// Lines about refusals in a second.
constexpr std::uint64_t kMostLines = 5;
constexpr std::int64_t kSecondNs = 1'000'000'000;

// FNV-1a. The bytes of a command that is sent again are the same.
std::uint64_t hash_of(std::span<const std::byte> bytes) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const std::byte byte : bytes)
    hash = (hash ^ static_cast<std::uint64_t>(byte)) * 0x100000001b3;
  return hash;
}

// Cyclone asks before it stores a sample.
bool admits(const dds_sample_info_t* info, void* names) {
  return static_cast<NameLimit*>(names)->admits(info->publication_handle, info->instance_handle,
                                                SystemClock().monotonic_ns());
}

dds_entity_t make_reader(const Cell& cell, Participant& participant, NameLimit& names) {
  const dds_topic_filter filter{
      .mode = DDS_TOPIC_FILTER_SAMPLEINFO_ARG, .f = {.sampleinfo_arg = admits}, .arg = &names};
  return participant.reader(TopicKind::kCommands, cell.topics.commands, 0, nullptr, &filter);
}

}  // namespace

CommandPort::CommandPort(const Cell& cell, Participant& participant, std::uint64_t daemon, Put put,
                         std::function<std::uint64_t()> revision)
    : daemon_(daemon),
      put_(std::move(put)),
      revision_(std::move(revision)),
      ledger_(cell.commands.from),
      reader_(make_reader(cell, participant, names_)),
      results_(participant.writer(TopicKind::kCommandResults, cell.topics.command_results)),
      wait_(participant, {reader_}) {}

void CommandPort::start() {
  thread_ = std::thread([this] { run(); });
}

CommandPort::~CommandPort() {
  stop_ = true;
  wait_.wake();
  if (thread_.joinable()) thread_.join();
  dds_delete(reader_);
  dds_delete(results_);
}

void CommandPort::run() {
  name_thread("commands");
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

void CommandPort::take_all() {
  while (take_cdr(reader_, taken_, &ended_) > 0 && !stop_) {
    for (const std::uint64_t name : std::exchange(ended_, {})) names_.forget_name(name);
    const std::vector<std::uint64_t> writers = writers_of(reader_);
    names_.keep(writers);
    ledger_.keep_writers(writers);
    for (const CdrSample& sample : taken_) take(sample);
    taken_.clear();
  }
}

// Cyclone has refused what is no message at all: a truncated one never comes here. Each message is
// decoded into an empty sample. Cyclone takes what a union holds for what it shall hold, and would
// use a number of the last change as the pointer of a text.
void CommandPort::take(const CdrSample& sample) {
  const std::span<const std::byte> bytes = sample.bytes();
  Sample<clearance_msg_Command> message;
  if (!decoder_.decode(bytes, message, CdrBytes::kOfReader)) return;
  const CommandLedger::Request request{message->client, message->request, hash_of(bytes)};
  if (auto refused = ledger_.refuse_sender(request, sample.writer()))
    return answer_at_once(*std::move(refused));
  auto read = from_wire(*message);
  if (auto* fault = std::get_if<MalformedField>(&read)) {
    return answer_at_once({.client = request.client,
                           .request = request.number,
                           .status = CommandStatus::kMalformed,
                           .change = fault->change,
                           .path = std::move(fault->path),
                           .reason = std::move(fault->reason)});
  }
  CommandLedger::Verdict verdict = ledger_.admit(request);
  switch (verdict.next) {
    case CommandLedger::Next::kDo:
      return pass_on(std::get<Command>(std::move(read)), request);
    case CommandLedger::Next::kWait:
      return;
    case CommandLedger::Next::kAnswer:
      if (verdict.result.scene_revision == 0) return answer_at_once(std::move(verdict.result));
      return write(verdict.result);
  }
}

void CommandPort::pass_on(Command command, const CommandLedger::Request& request) {
  const auto answer = [this](const CommandResult& result) {
    ledger_.answer(result);
    if (!result.done()) log_refusal(result);
    write(result);
  };
  if (put_({std::move(command), false, answer})) return;
  ledger_.withdraw(request);
  answer_at_once({.client = request.client,
                  .request = request.number,
                  .status = CommandStatus::kBusy,
                  .reason = fmt::format("found {} that wait; expected that the same command is "
                                        "sent again later",
                                        counted(CommandQueue::kMost, "command"))});
}

// A refusal that no scene thread has seen.
void CommandPort::answer_at_once(CommandResult result) {
  log_refusal(result);
  if (result.status == CommandStatus::kNotNamed) {
    if (strangers_.size() >= kMostStrangers && !strangers_.contains(result.client)) return;
    strangers_.insert(result.client);
  }
  result.scene_revision = revision_();
  write(result);
}

void CommandPort::write(const CommandResult& result) {
  const auto message = to_wire(result, daemon_);
  const std::lock_guard lock(mutex_);
  dds_write(results_, &*message);
}

// Many refusals must not fill the log.
void CommandPort::log_refusal(const CommandResult& result) {
  const std::int64_t second = SystemClock().monotonic_ns() / kSecondNs;
  const std::lock_guard lock(mutex_);
  if (second != log_second_) {
    if (left_out_ > 0) log_line(lines::kCommandsLeftOut, counted(left_out_, "line"));
    log_second_ = second;
    logged_ = left_out_ = 0;
  }
  if (++logged_ > kMostLines) {
    ++left_out_;
    return;
  }
  log_line(lines::kCommandRefused, result.client, result.request, name_of(result.status),
           result.path.empty() ? result.reason : fmt::format("{}: {}", result.path, result.reason));
}

}  // namespace clearance
