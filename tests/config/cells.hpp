// Small cells for the tests of the reader.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <variant>

#include "config/cell/cell_file.hpp"

namespace clearance {

// Returns a whole cell, in which `sections` begins in line 4.
inline std::string cell_text(const std::string& sections) {
  return "name: test\nunits: {length: m, angle: deg}\nrate_hz: 500\n" + sections;
}

// Reads a text that must be a valid cell.
inline Cell read_good(const std::string& text, const std::filesystem::path& file = "cell.yaml") {
  CellResult result = parse_cell(text, file);
  if (const auto* errors = std::get_if<std::vector<CellError>>(&result)) {
    for (const CellError& error : *errors) ADD_FAILURE() << error.text;
    return {};
  }
  return std::get<Cell>(std::move(result));
}
inline Scene scene_of(const std::string& text, const std::filesystem::path& file = "cell.yaml") {
  return read_good(text, file).scene;
}

// Returns the errors of a text, one per line; empty if the text is valid.
inline std::string errors_of(const std::string& text,
                             const std::filesystem::path& file = "cell.yaml") {
  const CellResult result = parse_cell(text, file);
  std::string lines;
  if (const auto* errors = std::get_if<std::vector<CellError>>(&result)) {
    for (const CellError& error : *errors) lines += error.text + "\n";
  }
  return lines;
}

// Two moving boxes and a floor. Each test adds its own sections.
inline const std::string kBoxes =
    "objects:\n"
    "  - {name: left, groups: [arm], box: {size: [1, 1, 1]}}\n"
    "  - {name: right, groups: [arm], box: {size: [1, 1, 1]}}\n"
    "  - {name: floor, groups: [still], fixed: true, half_space: {normal: [0, 0, 1], offset: 0}}\n"
    "pairs:\n"
    "  - {between: [arm, still]}\n";

}  // namespace clearance
