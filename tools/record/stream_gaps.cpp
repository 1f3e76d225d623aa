#include "tools/record/stream_gaps.hpp"

#include <fmt/format.h>

namespace clearance {

void StreamGaps::note(const std::string& kind, const std::string& stream, std::uint64_t number) {
  if (number == 0) return;
  const auto [entry, is_new] = streams_.try_emplace(stream, Stream{kind, number, number, 0});
  Stream& known = entry->second;
  if (!is_new && number > known.last) known.missing += number - known.last - 1;
  known.last = number;
}

std::vector<std::string> StreamGaps::notes() const {
  std::vector<std::string> notes;
  for (const auto& [name, stream] : streams_) {
    const std::string what = fmt::format("{} {}", stream.kind, name);
    if (stream.first > 1) {
      notes.push_back(
          fmt::format("the first of the {} here is number {}: those before it were sent before "
                      "this recorder was known",
                      what, stream.first));
    }
    if (stream.missing > 0) {
      notes.push_back(fmt::format("missing in between: {} of the {}", stream.missing, what));
    }
  }
  return notes;
}

}  // namespace clearance
