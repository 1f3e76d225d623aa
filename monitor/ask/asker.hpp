// Answers questions about motions: certified bounds of the least distance over all instants.
//
// The method is conservative advancement by bisection in time. README.md has it with its proof.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/interface/question.hpp"

namespace clearance {

class MotionSearch;

// The memory for questions about one scene. Several threads may each have one for the same scene.
class Asker {
 public:
  // The scene must outlive it. Allocates all memory for the search.
  explicit Asker(const Scene& scene);
  ~Asker();
  Asker(Asker&&) noexcept;
  Asker& operator=(Asker&&) noexcept;

  // Writes the answer, or returns why there is none: a sentence about the question. The same
  // question gets the same bits, whatever was asked before. Does not allocate if the answer has
  // room, the question has no more waypoints than an earlier one, no fault and no payloads.
  [[nodiscard]] std::optional<std::string> ask(const Question& question, Answer& answer);

 private:
  const Scene* scene_;
  std::unique_ptr<MotionSearch> search_;
};

// The same for a single question.
[[nodiscard]] std::variant<Answer, std::string> ask(const Scene& scene, const Question& question);

// Answers questions about one scene in `threads` threads, at least one, each with its own Asker.
// The answers and texts (empty: there is an answer) are in the order of the questions, and do not
// depend on the number of threads.
void ask_all(const Scene& scene, std::span<const Question> questions, std::span<Answer> answers,
             std::span<std::string> faults, unsigned threads);

// The name of an object in an answer, which may be a payload of the question.
[[nodiscard]] const std::string& object_name(const Scene& scene, const Question& question,
                                             std::uint32_t object) noexcept;

}  // namespace clearance
