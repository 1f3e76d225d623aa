// Everything that is wrong with a cell file, each with its place.
#pragma once

#include <string>
#include <vector>

#include "config/cell_file.hpp"
#include "config/yaml_node.hpp"

namespace clearance {

// "nothing", "the number 12", "the text 'abc'", "a list of 3", "a map": what a message says was
// found.
[[nodiscard]] std::string describe(const YamlNode& node);

class Diagnostics {
 public:
  explicit Diagnostics(std::string file) : file_(std::move(file)) {}

  // `text` says what was found and what was expected.
  void add(const YamlNode& at, const std::string& text) { add(at.line, at.column, text); }
  void add(int line, int column, const std::string& text);

  [[nodiscard]] bool empty() const { return diagnostics_.empty(); }
  [[nodiscard]] std::size_t count() const { return diagnostics_.size(); }

  // In the order of the file.
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
