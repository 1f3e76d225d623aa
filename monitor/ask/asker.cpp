#include "monitor/ask/asker.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>

#include "monitor/ask/motion_search.hpp"
#include "monitor/ask/payloads.hpp"

namespace clearance {

Asker::Asker(const Scene& scene) : scene_(&scene), search_(std::make_unique<MotionSearch>(scene)) {}
Asker::~Asker() = default;
Asker::Asker(Asker&&) noexcept = default;
Asker& Asker::operator=(Asker&&) noexcept = default;

std::optional<std::string> Asker::ask(const Question& question, Answer& answer) {
  if (question.payloads.empty()) return search_->ask(question, answer);
  const std::variant<Scene, std::string> loaded = scene_with(*scene_, question.payloads);
  if (const auto* text = std::get_if<std::string>(&loaded)) return *text;
  return MotionSearch(std::get<Scene>(loaded)).ask(question, answer);
}

std::variant<Answer, std::string> ask(const Scene& scene, const Question& question) {
  Answer answer;
  Asker asker(scene);
  if (std::optional<std::string> text = asker.ask(question, answer)) return *text;
  return answer;
}

void ask_all(const Scene& scene, std::span<const Question> questions, std::span<Answer> answers,
             std::span<std::string> faults, unsigned threads) {
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    Asker asker(scene);
    for (std::size_t i = next++; i < questions.size(); i = next++) {
      faults[i] = asker.ask(questions[i], answers[i]).value_or("");
    }
  };
  std::vector<std::jthread> others;
  const std::size_t wanted = std::min<std::size_t>(std::max(1u, threads), questions.size());
  for (std::size_t i = 1; i < wanted; ++i) others.emplace_back(work);
  work();
}

const std::string& object_name(const Scene& scene, const Question& question,
                               std::uint32_t object) noexcept {
  if (object < scene.objects.size()) return scene.objects[object].name;
  std::uint32_t added = static_cast<std::uint32_t>(scene.objects.size());
  for (const Payload& payload : question.payloads) {
    if (payload.shape && added++ == object) return payload.name;
  }
  static const std::string unknown;
  return unknown;
}

}  // namespace clearance
