// The mistakes in a cell file, each with its place.
#pragma once

#include <string>
#include <vector>

#include "config/yaml/cell_error.hpp"
#include "config/yaml/yaml_node.hpp"

namespace clearance {

// A mistake in a line of a file that the cell names. `text` begins with FILE:LINE.
struct NamedFileMistake {
  int line;
  std::string text;
};

// The text of a cell: a file that a person wrote, or made of a URDF, whose places mean nothing to a
// person.
enum class CellText { kWritten, kOfUrdf };

// The list of mistakes that all readers of one file share. A reader adds to it and goes on, and
// callers compare count() before and after to learn whether a section was read without a mistake.
class Diagnostics {
 public:
  explicit Diagnostics(std::string file, CellText cell = CellText::kWritten)
      : file_(std::move(file)), cell_(cell) {}
  // Advice names keys of a cell, or else options of the command line.
  [[nodiscard]] bool is_of_urdf() const noexcept { return cell_ == CellText::kOfUrdf; }

  // `text` says what was found and what was expected.
  void add(const YamlNode& at, const std::string& text) { add(at.line, at.column, text); }
  // Line and column count from 1. Control characters in `text` become blanks, so that a message is
  // one line.
  void add(int line, int column, const std::string& text);
  // The cell names the file at `at`; `what` says what it names there.
  void add(const YamlNode& at, const std::string& what, const NamedFileMistake& mistake);

  [[nodiscard]] bool empty() const { return diagnostics_.empty(); }
  [[nodiscard]] std::size_t count() const { return diagnostics_.size(); }

  // Returns the mistakes in the order of the file.
  [[nodiscard]] std::vector<CellError> sorted() const;

 private:
  struct Diagnostic {
    int line, column;
    int named_line;  // in the file that the cell names there; 0: in the cell itself
    std::string text;
  };
  void add(Diagnostic diagnostic);
  [[nodiscard]] std::string place_of(const Diagnostic& diagnostic) const;

  std::string file_;
  CellText cell_;
  std::vector<Diagnostic> diagnostics_;
};

}  // namespace clearance
