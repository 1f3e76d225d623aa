// Questions of a client to a running daemon: how far is a motion from everything before it is made?
//
// idl/QUESTIONS.md explains what can be asked, and what each status means.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>

#include "monitor/client/requests.hpp"

namespace clearance::client {

struct QuestionOptions {
  std::uint64_t scene_revision = 0;  // of the scene that the client knows; 0: not checked
  // Asked about every 50 ms while ask() waits: true ends the wait as if its time were over.
  std::function<bool()> stop = {};
};

// Asks under the name of one client, which the daemon's cell names under `questions`, and which no
// other running program uses.
class Questions : public QuestionRequests {
 public:
  // Throws std::invalid_argument when the name has no bytes or more than 32.
  Questions(Connection& connection, std::string_view client);

  // Asks, and waits for the answer. The same request is sent again every second until the answer
  // comes: of two partners, the one that leads answers. `held` and `poses` have what shall count
  // instead of the present positions and poses. Returns nothing when none came in time: then
  // nothing is known of the motion. Throws std::invalid_argument when a part of the question cannot
  // be sent.
  [[nodiscard]] std::optional<QuestionResult> ask(
      const Question& question, const QuestionOptions& options = {},
      std::chrono::nanoseconds timeout = std::chrono::seconds(10));

  // Asks without waiting, and returns the number of the request, for result(). Nothing repeats it.
  // Returns 0 when DDS did not take the message. Throws as ask().
  std::uint64_t post(const Question& question, const QuestionOptions& options = {});
};

}  // namespace clearance::client
