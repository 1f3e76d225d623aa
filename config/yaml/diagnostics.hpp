// The mistakes in a cell file, each with its place.
#pragma once

#include <string>
#include <vector>

#include "config/yaml/cell_error.hpp"
#include "config/yaml/yaml_node.hpp"

namespace clearance {

// The list of mistakes that all readers of one file share. A reader adds to it and goes on, and
// callers compare count() before and after to learn whether a section was read without a mistake.
class Diagnostics {
 public:
  explicit Diagnostics(std::string file) : file_(std::move(file)) {}

  // `text` says what was found and what was expected.
  void add(const YamlNode& at, const std::string& text) { add(at.line, at.column, text); }
  // Line and column count from 1. Control characters in `text` become blanks, so that a message is
  // one line.
  void add(int line, int column, const std::string& text);

  [[nodiscard]] bool empty() const { return diagnostics_.empty(); }
  [[nodiscard]] std::size_t count() const { return diagnostics_.size(); }

  // Returns the mistakes in the order of the file.
  [[nodiscard]] std::vector<CellError> sorted() const;

 private:
  struct Diagnostic {
    int line, column;
    std::string text;
  };
  std::string file_;
  std::vector<Diagnostic> diagnostics_;
};

}  // namespace clearance
