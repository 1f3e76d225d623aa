// The text of a cell together with its YAML tree. Entries of its lists are changed in both.
//
// Entries that no change touches keep their text, with comments and anchors. A touched entry is
// written in the form of config/yaml/yaml_writer.hpp. It gets its former text back when a later
// change restores its content. Hence the text depends only on the first text and on the present
// tree.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "config/yaml/yaml_node.hpp"

namespace clearance {

class CellDocument {
 public:
  // The lists of a cell that changes edit, in the order in which a new one is placed in the file.
  static constexpr std::array<std::string_view, 8> kLists = {
      "templates",          "objects", "robots",  "margins", "pairs",
      "allowed_collisions", "zones",   "contacts"};

  [[nodiscard]] static std::variant<CellDocument, YamlFault> parse(const std::string& text);

  [[nodiscard]] const YamlNode& tree() const noexcept { return tree_; }
  [[nodiscard]] std::string text() const;

  // The entries of a list; none if the cell does not have it.
  [[nodiscard]] const std::vector<YamlNode>& items(std::string_view list) const;

  // Each changes one entry of one of kLists. An entry is appended, to a new list if need be. A list
  // that loses its last entry is removed.
  void append(std::string_view list, YamlNode item);
  void replace(std::string_view list, std::size_t index, YamlNode item);
  void remove(std::string_view list, std::size_t index);

  // Takes back all changes since the last call of keep(), or since parse().
  void keep() noexcept { undo_.clear(); }
  void take_back();

 private:
  struct Item {
    std::string text = {};
    std::string written = {}, written_canonical = {};  // in the parsed file; empty: not in it
    bool needs_anchors = false;  // its written text has aliases of anchors in other entries
    [[nodiscard]] bool is_touched() const noexcept { return text != written; }
  };
  struct Section {
    std::string text;  // of a list: what precedes its entries
    std::string canonical;
    bool needs_anchors = false, is_list = false;
    std::size_t indent = 2;
    std::vector<Item> items;  // of a list
  };
  struct Undo {
    enum class Kind {
      kAppended,
      kReplaced,
      kRemoved,
      kSectionAdded,
      kSectionReplaced,
      kSectionRemoved
    };
    Kind kind;
    std::size_t section, index;
    YamlEntry entry;  // or an item, as its value
    Section texts;    // or of an item alone
  };

  [[nodiscard]] std::optional<std::size_t> section_of(std::string_view list) const;
  std::size_t add_section(std::string_view list);
  [[nodiscard]] bool anchors_are_lost() const;
  [[nodiscard]] std::string joined_text() const;
  [[nodiscard]] static bool is_list(const YamlEntry& entry);
  [[nodiscard]] static Section section_anew(const YamlEntry& entry);
  void split(const std::vector<std::string_view>& lines);
  // Returns nothing if the entries do not stand on lines of their own.
  [[nodiscard]] static std::optional<Section> split_items(
      const std::vector<std::string_view>& lines, std::pair<std::size_t, std::size_t> range,
      const YamlEntry& entry);
  void write_anew();

  std::string parsed_text_, parsed_joined_;  // the file, and text() of it if it was joined
  YamlNode tree_;
  std::vector<Section> sections_;  // in the order of tree_.entries
  std::vector<Undo> undo_;
  std::size_t removed_anchors_ = 0;  // entries with anchors that were removed
};

}  // namespace clearance
