// Answers questions about motions: certified bounds of the least distance over all instants.
//
// The method is conservative advancement by bisection in time. README.md has it with its proof.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "config/scene/scene.hpp"
#include "monitor/ask/question.hpp"

namespace clearance {

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
  // room for the margins and the question is without fault.
  [[nodiscard]] std::optional<std::string> ask(const Question& question, Answer& answer);

 private:
  class Search;
  std::unique_ptr<Search> search_;
};

// The same for a single question.
[[nodiscard]] std::variant<Answer, std::string> ask(const Scene& scene, const Question& question);

}  // namespace clearance
