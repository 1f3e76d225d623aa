// Requests of clients over DDS, commands or questions: a thread of its own takes them, decides whom
// it answers at once, and passes the others on. Results go out as they come.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/app/line_limit.hpp"
#include "monitor/dds/name_limit.hpp"
#include "monitor/dds/request_ledger.hpp"
#include "monitor/interface/mutex.hpp"
#include "monitor/participant/cdr_sample.hpp"
#include "monitor/participant/command_message.hpp"
#include "monitor/participant/lapsed_writers.hpp"
#include "monitor/participant/participant.hpp"
#include "monitor/participant/question_message.hpp"
#include "monitor/requests/question_desk.hpp"
#include "monitor/requests/scene_task.hpp"
#include "monitor/wire/cdr.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance {

// The differences between commands and questions.
struct CommandTraffic {
  using Message = clearance_msg_Command;
  using Request = Command;
  using Result = CommandResult;
  using Queued = GivenCommand;
  static constexpr const char* kKey = "commands";  // of the cell, and the name of the thread
  static constexpr TopicKind kRequests = TopicKind::kCommands,
                             kResults = TopicKind::kCommandResults;
};
struct QuestionTraffic {
  using Message = clearance_msg_Question;
  using Request = MotionQuestion;
  using Result = QuestionResult;
  using Queued = QueuedQuestion;
  static constexpr const char* kKey = "questions";
  static constexpr TopicKind kRequests = TopicKind::kQuestions, kResults = TopicKind::kAnswers;
};

template <class Traffic>
class RequestPort {
 public:
  using Request = typename Traffic::Request;
  using Result = typename Traffic::Result;
  // Passes a request on, or returns false if too many wait. The answer may come from any thread.
  using Put = std::function<bool(typename Traffic::Queued)>;
  // The rules for requests that another daemon gets, too.
  struct Sharing {
    // False while the other one answers; requests that come meanwhile are not even refused. Empty:
    // there is no other one.
    std::function<bool()> takes;
    // Gets these requests of clients that are named. The other one may refuse them.
    std::function<void(Request)> overhear;
  };

  // Takes the requests of `clients`, on the topics of the cell. `daemon` is the id in the messages,
  // and `revision` returns that of the scene in force. The participant must outlive this. Throws
  // DdsError.
  RequestPort(const Cell& cell, const std::vector<std::string>& clients, Participant& participant,
              std::uint64_t daemon, Put put, std::function<std::uint64_t()> revision,
              Sharing sharing = {});
  ~RequestPort();
  RequestPort(const RequestPort&) = delete;
  RequestPort& operator=(const RequestPort&) = delete;

  // Starts the thread.
  void start();

 private:
  using Ledger = RequestLedger<Result>;
  void run();
  void take_all();
  void take(const CdrSample& sample);
  void pass_on(Request request, const typename Ledger::Request& known_as);
  void answer_at_once(Result result);
  void write(const Result& result);
  void log_refusal(const Result& result);

  const std::uint64_t daemon_;
  const Put put_;
  const std::function<std::uint64_t()> revision_;
  const Sharing sharing_;
  Ledger ledger_;
  NameLimit names_;
  std::set<std::string> strangers_;  // clients that are not named and were answered
  LineLimit refusal_lines_;
  LapsedWriters lapsed_;
  dds_entity_t reader_;
  Mutex mutex_;
  GUARDED_BY(mutex_) dds_entity_t results_;  // other threads write to it, too
  std::uint64_t address_;                    // of the results
  DataWait wait_;
  std::vector<CdrSample> taken_;
  std::vector<std::uint64_t> ended_;
  CdrDecoder decoder_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

extern template class RequestPort<CommandTraffic>;
extern template class RequestPort<QuestionTraffic>;

using CommandPort = RequestPort<CommandTraffic>;
using QuestionPort = RequestPort<QuestionTraffic>;

}  // namespace clearance
