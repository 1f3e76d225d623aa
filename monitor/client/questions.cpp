#include "monitor/client/questions.hpp"

#include <stdexcept>
#include <string>

#include "monitor/participant/question_message.hpp"
#include "monitor/wire/topics.hpp"

namespace clearance::client {
namespace {

auto maker(const Question& question, const QuestionOptions& options) {
  if (const std::string unsent = unsent_part(question); !unsent.empty())
    throw std::invalid_argument(unsent);
  return [&](const std::string& client, std::uint64_t number) {
    return MotionQuestion{client, number, options.scene_revision, question};
  };
}

}  // namespace

Questions::Questions(Connection& connection, std::string_view client)
    : Requests(connection, client, TopicKind::kQuestions, TopicKind::kAnswers) {}

std::optional<QuestionResult> Questions::ask(const Question& question,
                                             const QuestionOptions& options,
                                             std::chrono::nanoseconds timeout) {
  return send(maker(question, options), options.stop, timeout);
}

std::uint64_t Questions::post(const Question& question, const QuestionOptions& options) {
  return Requests::post(maker(question, options));
}

}  // namespace clearance::client
