#include "monitor/scene_changes/command_queue.hpp"

#include <variant>

namespace clearance {

std::size_t bytes_of(const Command& command) {
  constexpr std::size_t kOfAChange = sizeof(CellChange);
  std::size_t bytes = command.changes.size() * kOfAChange;
  for (const SentFile& file : command.files) bytes += file.bytes.size();
  for (const CellChange& change : command.changes) {
    if (const auto* added = std::get_if<AddObject>(&change)) bytes += added->yaml.size();
    if (const auto* whole = std::get_if<ReplaceCell>(&change)) bytes += whole->yaml.size();
  }
  return bytes;
}

}  // namespace clearance
