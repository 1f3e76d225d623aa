// Requests that a client sends under its name until their results come: the part that commands and
// questions have in common.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "monitor/client/client.hpp"
#include "monitor/interface/command.hpp"
#include "monitor/interface/motion_question.hpp"

namespace clearance {

enum class TopicKind : std::uint8_t;

namespace client {

// `Message` is the message of a result. Its two kinds are those of commands and questions.
template <class Request, class Result, class Message>
class Requests {
 public:
  Requests(const Requests&) = delete;
  Requests& operator=(const Requests&) = delete;

  // Waits up to `timeout` for the result of a request. Among results without a waiting caller, the
  // last 64 are kept.
  [[nodiscard]] std::optional<Result> result(std::uint64_t request,
                                             std::chrono::nanoseconds timeout = {});
  // True when a daemon takes such requests on this topic. Whether it takes them from this client,
  // the first result says.
  [[nodiscard]] bool is_heard() const;
  // Results that are not as the daemon wrote them: the request is sent again.
  [[nodiscard]] const RefusedMessages& refused() const noexcept { return reader_.refused(); }

 protected:
  // Throws std::invalid_argument when the name has no bytes or more than 32.
  Requests(Connection& connection, std::string_view client, TopicKind requests, TopicKind results);
  ~Requests();

  // Makes a request with a new number: the time at which it is made, so that a program that starts
  // again counts on from its former requests.
  using Make = std::function<Request(const std::string& client, std::uint64_t number)>;
  // Sends a request again every second until its result comes.
  [[nodiscard]] std::optional<Result> send(const Make& make, std::function<bool()> stop,
                                           std::chrono::nanoseconds timeout);
  // Sends it once and returns its number; 0 when DDS did not take the message.
  std::uint64_t post(const Make& make);

 private:
  class Stop;

  [[nodiscard]] Request next(const Make& make);
  bool write(const Request& request);
  void take_results();
  std::optional<Result> wait_for(std::uint64_t request, std::int64_t end_ns, Stop& stop);

  std::string client_;
  std::uint64_t request_ = 0;  // the last one
  dds_entity_t writer_;
  CheckedReader reader_;
  std::unique_ptr<DataWait> wait_;
  Sample<Message> message_;
  std::map<std::uint64_t, Result> results_;  // by request
};

using CommandRequests = Requests<Command, CommandResult, clearance_msg_CommandResult>;
using QuestionRequests = Requests<MotionQuestion, QuestionResult, clearance_msg_Answer>;
extern template class Requests<Command, CommandResult, clearance_msg_CommandResult>;
extern template class Requests<MotionQuestion, QuestionResult, clearance_msg_Answer>;

}  // namespace client
}  // namespace clearance
