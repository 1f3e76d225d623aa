// A Markdown table.
#pragma once

#include <sstream>
#include <string>
#include <vector>

namespace clearance::bench {

using Cells = std::vector<std::string>;

class Table {
 public:
  explicit Table(const Cells& head) {
    row(head);
    row(Cells(head.size(), "---:"));
  }
  void row(const Cells& cells) {
    for (const std::string& cell : cells) text_ << "| " << cell << ' ';
    text_ << "|\n";
  }
  [[nodiscard]] std::string text() const { return text_.str() + "\n"; }

 private:
  std::ostringstream text_;
};

}  // namespace clearance::bench
