#include "monitor/requests/scene_task.hpp"

namespace clearance {
namespace {

std::size_t bytes_of(const GivenCommand& given) {
  constexpr std::size_t kOfAChange = sizeof(CellChange);
  const Command& command = given.command;
  std::size_t bytes = command.changes.size() * kOfAChange;
  for (const SentFile& file : command.files) bytes += file.bytes.size();
  for (const CellChange& change : command.changes) {
    if (const auto* added = std::get_if<AddObject>(&change)) bytes += added->yaml.size();
    if (const auto* whole = std::get_if<ReplaceCell>(&change)) bytes += whole->yaml.size();
  }
  return bytes;
}
std::size_t bytes_of(const MadeCommand& made) { return made.bytes; }
std::size_t bytes_of(const KeptFiles& files) { return files.bytes; }
std::size_t bytes_of(const OtherWork&) { return 0; }

}  // namespace

AnswerCommand* answer_of(SceneTask& task) noexcept {
  return std::visit(
      [](auto& each) -> AnswerCommand* {
        if constexpr (requires { each.answer; }) return &each.answer;
        return nullptr;
      },
      task);
}

std::string sender_of(const SceneTask& task) {
  if (const auto* given = std::get_if<GivenCommand>(&task))
    return given->is_own ? "own" : "client " + given->command.client;
  const auto* made = std::get_if<MadeCommand>(&task);
  return made == nullptr ? std::string() : made->sender;
}

std::size_t bytes_of(const SceneTask& task) {
  return std::visit([](const auto& each) { return bytes_of(each); }, task);
}

}  // namespace clearance
