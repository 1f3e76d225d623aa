// Collects messages in the order in which sections are read, and sorts them by place at the end. A
// person then corrects the file from top to bottom.
#include "config/yaml/diagnostics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

namespace clearance {

void Diagnostics::add(int line, int column, const std::string& text) {
  add({line, column, 0, text});
}

void Diagnostics::add(const YamlNode& at, const std::string& what,
                      const NamedFileMistake& mistake) {
  add({at.line, at.column, mistake.line,
       is_of_urdf() ? mistake.text : fmt::format("{}: {}", what, mistake.text)});
}

// The text that was found may hold line breaks; a message is one line.
void Diagnostics::add(Diagnostic diagnostic) {
  std::ranges::replace_if(
      diagnostic.text, [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
  diagnostics_.push_back(std::move(diagnostic));
}

std::string Diagnostics::place_of(const Diagnostic& diagnostic) const {
  if (!is_of_urdf()) return fmt::format("{}:{}:{}: ", file_, diagnostic.line, diagnostic.column);
  return diagnostic.named_line > 0 ? "" : fmt::format("{}: ", file_);
}

// Equal input gives equal output: messages of one place are ordered by their text.
std::vector<CellError> Diagnostics::sorted() const {
  const auto key = [](const Diagnostic& each) {
    return std::tie(each.line, each.column, each.named_line, each.text);
  };
  std::vector<Diagnostic> ordered = diagnostics_;
  std::ranges::sort(ordered, {}, key);
  // A mistake inside an anchor (&x) is found once for every alias of it.
  const auto same = std::ranges::unique(ordered, {}, key);
  ordered.erase(same.begin(), same.end());
  std::vector<CellError> errors;
  for (const Diagnostic& diagnostic : ordered) {
    errors.push_back({place_of(diagnostic) + diagnostic.text});
  }
  return errors;
}

}  // namespace clearance
