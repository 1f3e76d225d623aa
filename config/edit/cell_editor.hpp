// Changes a cell while programs run: the one entry point of this room.
//
// A change is an edit of the cell's text, and the ordinary reader reads the result. Nothing is
// accepted that a cell file could not say.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "config/cell/cell_file.hpp"
#include "config/edit/cell_change.hpp"

namespace clearance {

// Why a list of changes was not done.
struct EditRefusal {
  std::size_t change = 0;  // index of the change that is at fault
  // The offending field: "objects[part].attached.to". Entries of lists have their names, or their
  // place from 0. Empty: the list as a whole.
  std::string path;
  std::string reason;  // one sentence: what was found; what was expected
};

// Returns changes that have to follow others in the same list, in the scene to which those lead.
using CompleteChanges = std::function<std::vector<CellChange>(const Scene& changed)>;

class CellEditor {
 public:
  // Begins with the text of a cell; `file` and `options` as for parse_cell(). The result has every
  // mistake of a text that is no valid cell.
  using Opened = std::variant<CellEditor, std::vector<CellError>>;
  [[nodiscard]] static Opened open(const std::string& yaml, const std::filesystem::path& file,
                                   const CellOptions& options = {});

  CellEditor(CellEditor&&) noexcept;
  CellEditor& operator=(CellEditor&&) noexcept;
  ~CellEditor();

  // Makes all changes, in this order, or none. Cell::yaml is the changed text: read from a file, it
  // gives the same cell. No changes give the present cell.
  [[nodiscard]] std::variant<Cell, EditRefusal> edit(std::span<const CellChange> changes);

  // The same, but nothing stays changed: the next edit begins where this one did.
  [[nodiscard]] std::variant<Cell, EditRefusal> dry_run(std::span<const CellChange> changes);

  // The same in two steps: propose() makes the changes like edit(), and one of the other two must
  // follow a cell that it returned. After a refusal nothing is changed and none must follow.
  [[nodiscard]] std::variant<Cell, EditRefusal> propose(std::span<const CellChange> changes);
  void keep();
  void take_back();
  // The same for `changes` and those that follow, which are appended. `complete` may be empty.
  [[nodiscard]] std::variant<Cell, EditRefusal> propose(std::vector<CellChange>& changes,
                                                        const CompleteChanges& complete);

  // The present text.
  [[nodiscard]] std::string text() const;

 private:
  struct State;
  explicit CellEditor(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace clearance
