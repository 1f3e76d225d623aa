// Makes one change in the document of a cell.
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "config/edit/cell_change.hpp"
#include "config/edit/cell_document.hpp"

namespace clearance {

// Why a change cannot be made, before any reader sees the result.
struct ChangeFault {
  std::string path, reason;  // as of EditRefusal
};

// Reads one entry of `objects`, which may stand in a list of its own.
[[nodiscard]] std::variant<YamlNode, ChangeFault> object_entry(const std::string& yaml);

// Does nothing where it returns a fault. Every change but ReplaceCell.
[[nodiscard]] std::optional<ChangeFault> make_change(const CellChange& change,
                                                     CellDocument& document);

}  // namespace clearance
