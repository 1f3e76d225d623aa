#include "config/edit/cell_document.hpp"

#include <algorithm>
#include <utility>

#include "config/yaml/yaml_writer.hpp"

namespace clearance {
namespace {

// Lines with their ends.
std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::size_t length = end == std::string_view::npos ? text.size() : end + 1;
    lines.push_back(text.substr(0, length));
    text.remove_prefix(length);
  }
  return lines;
}

bool is_comment(std::string_view line) {
  const std::size_t first = line.find_first_not_of(' ');
  return first != std::string_view::npos && line[first] == '#';
}

// Comments directly above a line belong to it. Lines count from 0; none before `least` is taken.
std::size_t with_comments(const std::vector<std::string_view>& lines, std::size_t line,
                          std::size_t least) {
  while (line > least && is_comment(lines[line - 1])) --line;
  return line;
}

std::string joined(const std::vector<std::string_view>& lines, std::size_t begin, std::size_t end) {
  std::string text;
  for (std::size_t i = begin; i < end; ++i) text += lines[i];
  if (!text.empty() && text.back() != '\n') text += '\n';
  return text;
}

// Tells whether a text by itself is this entry of a map, or this only item of a sequence.
bool reads_as(const std::string& text, const YamlEntry& entry) {
  const auto read = parse_yaml(text);
  const auto* map = std::get_if<YamlNode>(&read);
  return map != nullptr && map->entries.size() == 1 &&
         same_content(map->entries.front().key, entry.key) &&
         same_content(map->entries.front().value, entry.value);
}
bool reads_as(const std::string& text, const YamlNode& item) {
  const auto read = parse_yaml(text);
  const auto* list = std::get_if<YamlNode>(&read);
  return list != nullptr && list->items.size() == 1 && same_content(list->items.front(), item);
}

// Conservative: the character may also stand in a text.
bool may_have_anchors(const std::string& text) { return text.find('&') != std::string::npos; }

YamlEntry empty_list(std::string_view key) {
  YamlEntry entry;
  entry.key.kind = YamlNode::Kind::kScalar;
  entry.key.text = key;
  entry.value.kind = YamlNode::Kind::kSequence;
  return entry;
}

}  // namespace

std::variant<CellDocument, YamlFault> CellDocument::parse(const std::string& text) {
  auto read = parse_yaml(text);
  if (const auto* fault = std::get_if<YamlFault>(&read)) return *fault;
  CellDocument document;
  document.tree_ = std::get<YamlNode>(std::move(read));
  if (document.tree_.kind != YamlNode::Kind::kMap)
    return YamlFault{document.tree_.line, document.tree_.column,
                     "found no map; expected a cell, with the keys of config/KEYS.md"};
  document.split(lines_of(text));
  const auto again = parse_yaml(document.joined_text());
  const auto* tree = std::get_if<YamlNode>(&again);
  if (tree == nullptr || !same_content(*tree, document.tree_)) document.write_anew();
  document.parsed_text_ = text;
  document.parsed_joined_ = document.joined_text();
  return document;
}

bool CellDocument::is_list(const YamlEntry& entry) {
  return std::ranges::find(kLists, entry.key.text) != kLists.end() &&
         entry.value.kind == YamlNode::Kind::kSequence && !entry.value.items.empty();
}

CellDocument::Section CellDocument::section_anew(const YamlEntry& entry) {
  Section section;
  section.is_list = is_list(entry);
  section.text =
      section.is_list ? line_of(entry.key) + ":\n" : map_entry(entry.key, entry.value, 0);
  section.canonical = section.text;
  if (!section.is_list) return section;
  for (const YamlNode& item : entry.value.items) {
    const std::string text = list_item(item, section.indent);
    section.items.push_back({.text = text, .written = text, .written_canonical = text});
  }
  return section;
}

void CellDocument::write_anew() {
  sections_.clear();
  for (const YamlEntry& entry : tree_.entries) sections_.push_back(section_anew(entry));
}

// Each section and each entry of a list becomes a run of whole lines. What is written otherwise, as
// a list in brackets is, gets a new text.
void CellDocument::split(const std::vector<std::string_view>& lines) {
  const std::vector<YamlEntry>& entries = tree_.entries;
  std::vector<std::size_t> begins;
  for (const YamlEntry& entry : entries) {
    const std::size_t line = static_cast<std::size_t>(entry.key.line) - 1;
    const std::size_t least = begins.empty() ? 0 : begins.back() + 1;
    if (entry.key.column != 1 || line < least || line >= lines.size()) return write_anew();
    begins.push_back(begins.empty() ? 0 : with_comments(lines, line, least));
  }
  begins.push_back(lines.size());
  for (std::size_t i = 0; i < entries.size(); ++i) {
    Section section;
    if (is_list(entries[i])) {
      section = split_items(lines, {begins[i], begins[i + 1]}, entries[i])
                    .value_or(section_anew(entries[i]));
    } else {
      section.text = joined(lines, begins[i], begins[i + 1]);
      section.canonical = map_entry(entries[i].key, entries[i].value, 0);
      section.needs_anchors = !reads_as(section.text, entries[i]);
    }
    sections_.push_back(std::move(section));
  }
}

std::optional<CellDocument::Section> CellDocument::split_items(
    const std::vector<std::string_view>& lines, std::pair<std::size_t, std::size_t> range,
    const YamlEntry& entry) {
  Section section;
  section.is_list = true;
  std::vector<std::size_t> begins;
  for (const YamlNode& item : entry.value.items) {
    const std::size_t line = static_cast<std::size_t>(item.line) - 1;
    const std::size_t least =
        begins.empty() ? static_cast<std::size_t>(entry.key.line) : begins.back() + 1;
    if (line < least || line >= range.second) return std::nullopt;
    const std::size_t dash = lines[line].find_first_not_of(' ');
    if (lines[line][dash] != '-' || static_cast<std::size_t>(item.column) <= dash + 1)
      return std::nullopt;
    section.indent = dash;
    begins.push_back(with_comments(lines, line, least));
  }
  section.text = joined(lines, range.first, begins.front());
  section.canonical = line_of(entry.key) + ":\n";
  YamlEntry head{entry.key, {}};
  if (!reads_as(section.text, head)) return std::nullopt;
  begins.push_back(range.second);
  for (std::size_t i = 0; i < entry.value.items.size(); ++i) {
    const YamlNode& item = entry.value.items[i];
    const std::string text = joined(lines, begins[i], begins[i + 1]);
    section.items.push_back({.text = text,
                             .written = text,
                             .written_canonical = list_item(item, section.indent),
                             .needs_anchors = !reads_as(text, item)});
  }
  return section;
}

// Aliases stand for values that another entry marks, as long as that one keeps its text.
bool CellDocument::anchors_are_lost() const {
  return removed_anchors_ > 0 || std::ranges::any_of(sections_, [](const Section& section) {
           return std::ranges::any_of(section.items, [](const Item& item) {
             return item.is_touched() && may_have_anchors(item.written);
           });
         });
}

// An unchanged document is the file, whether its lines were taken over or not.
std::string CellDocument::text() const {
  std::string text = joined_text();
  return text == parsed_joined_ ? parsed_text_ : text;
}

std::string CellDocument::joined_text() const {
  const bool lost = anchors_are_lost();
  std::string text;
  for (const Section& section : sections_) {
    text += lost && section.needs_anchors ? section.canonical : section.text;
    for (const Item& item : section.items) {
      text += lost && item.needs_anchors && !item.is_touched() ? item.written_canonical : item.text;
    }
  }
  return text;
}

std::optional<std::size_t> CellDocument::section_of(std::string_view list) const {
  const auto found = std::ranges::find_if(
      tree_.entries, [&](const YamlEntry& entry) { return entry.key.text == list; });
  if (found == tree_.entries.end()) return std::nullopt;
  return static_cast<std::size_t>(found - tree_.entries.begin());
}

const std::vector<YamlNode>& CellDocument::items(std::string_view list) const {
  static const std::vector<YamlNode> kNone;
  const auto section = section_of(list);
  return section ? tree_.entries[*section].value.items : kNone;
}

// A new list follows those that precede it in kLists. The first text decides its place, so that two
// orders of changes give one text.
std::size_t CellDocument::add_section(std::string_view list) {
  std::size_t place = tree_.entries.size();
  for (const std::string_view* after = std::ranges::find(kLists, list); after != kLists.begin();) {
    if (const auto section = section_of(*--after)) {
      place = *section + 1;
      break;
    }
  }
  const auto at = static_cast<std::ptrdiff_t>(place);
  tree_.entries.insert(tree_.entries.begin() + at, empty_list(list));
  Section section;
  section.is_list = true;
  section.text = section.canonical = std::string(list) + ":\n";
  sections_.insert(sections_.begin() + at, std::move(section));
  undo_.push_back({Undo::Kind::kSectionAdded, place, 0, {}, {}});
  return place;
}

void CellDocument::append(std::string_view list, YamlNode item) {
  const auto known = section_of(list);
  const std::size_t at = known ? *known : add_section(list);
  Section& section = sections_[at];
  if (!section.is_list) {  // written as [], or no list at all: the reader has its say
    undo_.push_back({Undo::Kind::kSectionReplaced, at, 0, tree_.entries[at], section});
    tree_.entries[at].value = empty_list(list).value;
    section = section_anew(tree_.entries[at]);
    section.is_list = true;
    section.text = section.canonical = std::string(list) + ":\n";
  }
  section.items.push_back({.text = list_item(item, section.indent)});
  std::vector<YamlNode>& items = tree_.entries[at].value.items;
  items.push_back(std::move(item));
  undo_.push_back({Undo::Kind::kAppended, at, items.size() - 1, {}, {}});
}

void CellDocument::replace(std::string_view list, std::size_t index, YamlNode item) {
  const std::size_t at = *section_of(list);
  YamlNode& node = tree_.entries[at].value.items[index];
  Item& texts = sections_[at].items[index];
  Undo undo{Undo::Kind::kReplaced, at, index, {{}, std::move(node)}, {}};
  undo.texts.items.push_back(texts);
  undo_.push_back(std::move(undo));
  texts.text = list_item(item, sections_[at].indent);
  if (texts.text == texts.written_canonical) texts.text = texts.written;
  node = std::move(item);
}

void CellDocument::remove(std::string_view list, std::size_t index) {
  const std::size_t at = *section_of(list);
  std::vector<YamlNode>& nodes = tree_.entries[at].value.items;
  std::vector<Item>& items = sections_[at].items;
  const auto offset = static_cast<std::ptrdiff_t>(index);
  removed_anchors_ += may_have_anchors(items[index].written) ? 1 : 0;
  Undo undo{Undo::Kind::kRemoved, at, index, {{}, std::move(nodes[index])}, {}};
  undo.texts.items.push_back(std::move(items[index]));
  undo_.push_back(std::move(undo));
  nodes.erase(nodes.begin() + offset);
  items.erase(items.begin() + offset);
  if (!nodes.empty()) return;
  const auto section = static_cast<std::ptrdiff_t>(at);
  undo_.push_back(
      {Undo::Kind::kSectionRemoved, at, 0, std::move(tree_.entries[at]), std::move(sections_[at])});
  tree_.entries.erase(tree_.entries.begin() + section);
  sections_.erase(sections_.begin() + section);
}

void CellDocument::take_back() {
  for (; !undo_.empty(); undo_.pop_back()) {
    Undo& undo = undo_.back();
    const auto at = static_cast<std::ptrdiff_t>(undo.section);
    const auto index = static_cast<std::ptrdiff_t>(undo.index);
    switch (undo.kind) {
      case Undo::Kind::kAppended:
        tree_.entries[undo.section].value.items.pop_back();
        sections_[undo.section].items.pop_back();
        break;
      case Undo::Kind::kReplaced:
        tree_.entries[undo.section].value.items[undo.index] = std::move(undo.entry.value);
        sections_[undo.section].items[undo.index] = std::move(undo.texts.items.front());
        break;
      case Undo::Kind::kRemoved: {
        std::vector<YamlNode>& nodes = tree_.entries[undo.section].value.items;
        std::vector<Item>& items = sections_[undo.section].items;
        removed_anchors_ -= may_have_anchors(undo.texts.items.front().written) ? 1 : 0;
        nodes.insert(nodes.begin() + index, std::move(undo.entry.value));
        items.insert(items.begin() + index, std::move(undo.texts.items.front()));
        break;
      }
      case Undo::Kind::kSectionAdded:
        tree_.entries.erase(tree_.entries.begin() + at);
        sections_.erase(sections_.begin() + at);
        break;
      case Undo::Kind::kSectionReplaced:
        tree_.entries[undo.section] = std::move(undo.entry);
        sections_[undo.section] = std::move(undo.texts);
        break;
      case Undo::Kind::kSectionRemoved:
        tree_.entries.insert(tree_.entries.begin() + at, std::move(undo.entry));
        sections_.insert(sections_.begin() + at, std::move(undo.texts));
        break;
    }
  }
}

}  // namespace clearance
