// Collects messages in the order in which sections are read, and sorts them by place at the end. A
// person then corrects the file from top to bottom.
#include "config/yaml/diagnostics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

namespace clearance {

void Diagnostics::add(int line, int column, const std::string& text) {
  // The text that was found may hold line breaks; a message is one line.
  std::string one_line = text;
  std::replace_if(
      one_line.begin(), one_line.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; },
      ' ');
  diagnostics_.push_back({line, column, std::move(one_line)});
}

// Equal input gives equal output: messages of one place are ordered by their text.
std::vector<CellError> Diagnostics::sorted() const {
  std::vector<Diagnostic> ordered = diagnostics_;
  std::sort(ordered.begin(), ordered.end(), [](const Diagnostic& a, const Diagnostic& b) {
    return std::tie(a.line, a.column, a.text) < std::tie(b.line, b.column, b.text);
  });
  // A mistake inside an anchor (&x) is found once for every alias of it.
  const auto end =
      std::unique(ordered.begin(), ordered.end(), [](const Diagnostic& a, const Diagnostic& b) {
        return std::tie(a.line, a.column, a.text) == std::tie(b.line, b.column, b.text);
      });
  ordered.erase(end, ordered.end());
  std::vector<CellError> errors;
  for (const Diagnostic& diagnostic : ordered) {
    errors.push_back(
        {fmt::format("{}:{}:{}: {}", file_, diagnostic.line, diagnostic.column, diagnostic.text)});
  }
  return errors;
}

}  // namespace clearance
