#include "config/edit/cell_editor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <utility>

#include "config/edit/cell_document.hpp"
#include "config/edit/change_document.hpp"
#include "config/edit/touched_entry.hpp"
#include "config/scene/pairs_between.hpp"
#include "config/yaml/yaml_writer.hpp"

namespace clearance {
namespace {

// The reader's message without its place, and that place.
struct PlacedMistake {
  int line = 0, column = 0;  // 0: none is stated
  std::string text;
};

PlacedMistake placed(const std::string& text, const std::string& file) {
  PlacedMistake mistake{.text = text};
  if (!text.starts_with(file + ':')) return mistake;
  const char* at = text.data() + file.size() + 1;
  const char* end = text.data() + text.size();
  const auto line = std::from_chars(at, end, mistake.line);
  if (line.ec != std::errc() || line.ptr == end) return mistake;
  const auto column = std::from_chars(line.ptr + 1, end, mistake.column);
  constexpr std::size_t kColonAndBlank = 2;
  if (column.ec == std::errc())
    mistake.text.erase(0, static_cast<std::size_t>(column.ptr - text.data()) + kColonAndBlank);
  return mistake;
}

// A path and the entry of a list that it leads through.
struct Field {
  std::string path;
  TouchedEntry entry;
};

bool is_at(const YamlNode& node, const PlacedMistake& mistake) {
  return node.line == mistake.line && node.column == mistake.column;
}

// Finds the outermost value, or key, that stands there.
std::optional<Field> field_at(const YamlNode& node, const PlacedMistake& mistake,
                              const Field& above) {
  if (is_at(node, mistake)) return above;
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    Field field = above;
    const std::string label = entry_label(node.items[i], i);
    field.path += fmt::format("[{}]", label);
    if (field.entry.name.empty()) field.entry = {above.path, label};
    if (auto found = field_at(node.items[i], mistake, field)) return found;
  }
  for (const YamlEntry& entry : node.entries) {
    Field field = above;
    field.path += (field.path.empty() ? "" : ".") + entry.key.text;
    if (is_at(entry.key, mistake)) return field;
    if (auto found = field_at(entry.value, mistake, field)) return found;
  }
  return std::nullopt;
}

// Returns nothing unless both are objects that the scene watches.
std::optional<ObjectPair> pair_of(const Scene& scene, const std::string& a, const std::string& b) {
  for (const ObjectPair& pair : scene.pairs) {
    const std::string &first = scene.objects[pair.first].name,
                      &second = scene.objects[pair.second].name;
    if ((first == a && second == b) || (first == b && second == a)) return pair;
  }
  return std::nullopt;
}

bool has_object(const Scene& scene, const std::string& name) {
  return std::ranges::find(scene.objects, name, &Object::name) != scene.objects.end();
}

// Tells whether a later change says something else of the same two names.
bool is_overruled(const SetPair& pair, std::span<const CellChange> later) {
  return std::ranges::any_of(later, [&](const CellChange& change) {
    const auto* other = std::get_if<SetPair>(&change);
    return std::holds_alternative<ReplaceCell>(change) ||
           (other != nullptr && std::minmax(other->a, other->b) == std::minmax(pair.a, pair.b));
  });
}

// A contact over no pair allows nothing. Later changes may leave one without pairs.
std::optional<EditRefusal> void_contact(const AllowContact& wanted, std::size_t place,
                                        const Scene& scene) {
  const auto found = std::ranges::find(scene.contacts, wanted.contact, &AllowedContact::name);
  if (found == scene.contacts.end() || !found->pairs.empty() ||
      !pairs_between(scene, wanted.a, wanted.b).empty())
    return std::nullopt;
  return EditRefusal{place, fmt::format("contacts[{}]", wanted.contact),
                     fmt::format("found a contact over no pair: none between '{}' and '{}' is "
                                 "watched; expected at least one",
                                 wanted.a, wanted.b)};
}

// A rule that other rules make void would be accepted and change nothing.
// `scene` has the pairs of the whole cell.
std::optional<EditRefusal> void_rule(std::span<const CellChange> changes, const Scene& scene) {
  for (std::size_t i = 0; i < changes.size(); ++i) {
    if (const auto* contact = std::get_if<AllowContact>(&changes[i])) {
      if (auto refused = void_contact(*contact, i, scene)) return refused;
    }
    const auto* wanted = std::get_if<SetPair>(&changes[i]);
    if (wanted == nullptr || is_overruled(*wanted, changes.subspan(i + 1))) continue;
    if (!has_object(scene, wanted->a) || !has_object(scene, wanted->b)) continue;
    const auto pair = pair_of(scene, wanted->a, wanted->b);
    const std::string sides = fmt::format("'{}' against '{}'", wanted->a, wanted->b);
    if (wanted->rule == SetPair::Rule::kWatch && pair && pair->publish) {
      return EditRefusal{i, fmt::format("pairs[{}, {}]", wanted->a, wanted->b),
                         fmt::format("found {} published by a rule with other names, or in a zone "
                                     "with separation; expected none",
                                     sides)};
    }
    const bool is_rule =
        wanted->rule == SetPair::Rule::kPublish || wanted->rule == SetPair::Rule::kWatch;
    if (is_rule && !pair) {
      return EditRefusal{i, fmt::format("pairs[{}, {}]", wanted->a, wanted->b),
                         fmt::format("found {} left out by an exception with other names or by a "
                                     "robot's description, or rigid; expected none of these",
                                     sides)};
    }
  }
  return std::nullopt;
}

}  // namespace

struct CellEditor::State {
  State(std::filesystem::path of, CellOptions how, CellDocument parsed)
      : file(std::move(of)),
        options(std::move(how)),
        document(std::move(parsed)),
        readings(file, options) {}

  // The document and the readings before ReplaceCell.
  struct Before {
    CellDocument document;
    CellReadings readings;
  };
  std::optional<EditRefusal> replace(std::size_t index, const ReplaceCell& change);
  std::optional<EditRefusal> change_all(std::span<const CellChange> changes);
  void take_back();
  EditRefusal refusal(std::span<const CellChange> changes, const std::vector<CellError>& errors);
  std::size_t change_at_fault(std::span<const CellChange> changes, const TouchedEntry& entry);
  std::variant<Cell, EditRefusal> read(std::span<const CellChange> changes);

  std::filesystem::path file;
  CellOptions options;
  CellDocument document;
  CellReadings readings;
  std::optional<Before> before;
};

std::optional<EditRefusal> CellEditor::State::replace(std::size_t index,
                                                      const ReplaceCell& change) {
  auto parsed = CellDocument::parse(change.yaml);
  if (const auto* fault = std::get_if<YamlFault>(&parsed)) {
    return EditRefusal{index, "",
                       fmt::format("line {}:{}: {}", fault->line, fault->column, fault->reason)};
  }
  if (!before) before.emplace(Before{std::move(document), std::move(readings)});
  document = std::get<CellDocument>(std::move(parsed));
  readings = CellReadings(file, options);
  return std::nullopt;
}

std::optional<EditRefusal> CellEditor::State::change_all(std::span<const CellChange> changes) {
  for (std::size_t i = 0; i < changes.size(); ++i) {
    if (const auto* whole = std::get_if<ReplaceCell>(&changes[i])) {
      if (auto refused = replace(i, *whole)) return refused;
    } else if (auto fault = make_change(changes[i], document)) {
      return EditRefusal{i, std::move(fault->path), std::move(fault->reason)};
    }
  }
  return std::nullopt;
}

void CellEditor::State::take_back() {
  if (before) {
    document = std::move(before->document);
    readings = std::move(before->readings);
    before.reset();
  }
  document.take_back();
}

// The last change of the entry with the mistake; or else the first change after the longest
// beginning of the list that is accepted.
std::size_t CellEditor::State::change_at_fault(std::span<const CellChange> changes,
                                               const TouchedEntry& entry) {
  for (std::size_t i = changes.size(); i-- > 0;) {
    if (!entry.name.empty() && touched_by(changes[i]) == entry) return i;
  }
  constexpr std::size_t kMostReadings = 32;
  for (std::size_t count = changes.size(); count-- > 1;) {
    if (changes.size() - count > kMostReadings) break;
    take_back();
    if (change_all(changes.first(count))) continue;
    const auto result = readings.read(document.tree(), document.text());
    if (std::holds_alternative<Cell>(result)) return count;
  }
  return 0;
}

// The lines of a changed tree mean nothing, so its text is parsed and read for the place.
EditRefusal CellEditor::State::refusal(std::span<const CellChange> changes,
                                       const std::vector<CellError>& errors) {
  const std::string text = document.text();
  const auto parsed = parse_yaml(text);
  const auto* tree = std::get_if<YamlNode>(&parsed);
  EditRefusal refused{0, "", placed(errors.front().text, file.string()).text};
  TouchedEntry entry;
  if (tree != nullptr) {
    const auto result = readings.read(*tree, text);
    if (const auto* again = std::get_if<std::vector<CellError>>(&result)) {
      bool is_first = true;
      for (const CellError& error : *again) {
        const PlacedMistake mistake = placed(error.text, file.string());
        const Field field = field_at(*tree, mistake, {}).value_or(Field{});
        const bool is_touched =
            !field.entry.name.empty() && std::ranges::any_of(changes, [&](const CellChange& each) {
              return touched_by(each) == field.entry;
            });
        if (!std::exchange(is_first, false) && !is_touched) continue;
        refused.reason = mistake.text;
        refused.path = field.path;
        entry = field.entry;
        if (is_touched) break;
      }
    }
  }
  refused.change = change_at_fault(changes, entry);
  return refused;
}

std::variant<Cell, EditRefusal> CellEditor::State::read(std::span<const CellChange> changes) {
  if (auto refused = change_all(changes)) return *std::move(refused);
  auto result = readings.read(document.tree(), document.text());
  if (const auto* errors = std::get_if<std::vector<CellError>>(&result))
    return refusal(changes, *errors);
  const Cell& cell = std::get<Cell>(result);
  std::optional<Scene> whole;  // if the cell is a share
  if (cell.shares.is_one()) whole.emplace(cell.scene).pairs = cell.shares.pairs;
  if (auto refused = void_rule(changes, whole ? *whole : cell.scene)) return *std::move(refused);
  return std::get<Cell>(std::move(result));
}

CellEditor::CellEditor(std::unique_ptr<State> state) : state_(std::move(state)) {}
CellEditor::CellEditor(CellEditor&&) noexcept = default;
CellEditor& CellEditor::operator=(CellEditor&&) noexcept = default;
CellEditor::~CellEditor() = default;

CellEditor::Opened CellEditor::open(const std::string& yaml, const std::filesystem::path& file,
                                    const CellOptions& options) {
  auto document = CellDocument::parse(yaml);
  if (std::holds_alternative<YamlFault>(document)) {
    auto mistakes = parse_cell(yaml, file, options);
    return std::get<std::vector<CellError>>(std::move(mistakes));
  }
  auto state = std::make_unique<State>(file, options, std::get<CellDocument>(std::move(document)));
  auto result = state->readings.read(state->document.tree(), yaml);
  if (auto* errors = std::get_if<std::vector<CellError>>(&result)) return std::move(*errors);
  return CellEditor(std::move(state));
}

std::variant<Cell, EditRefusal> CellEditor::propose(std::span<const CellChange> changes) {
  auto result = state_->read(changes);
  if (std::holds_alternative<EditRefusal>(result)) take_back();
  return result;
}

std::variant<Cell, EditRefusal> CellEditor::propose(std::vector<CellChange>& changes,
                                                    const CompleteChanges& complete) {
  auto proposed = propose(changes);
  const auto* cell = std::get_if<Cell>(&proposed);
  if (cell == nullptr || !complete) return proposed;
  const std::vector<CellChange> more = complete(cell->scene);
  if (more.empty()) return proposed;
  take_back();
  changes.insert(changes.end(), more.begin(), more.end());
  return propose(changes);
}

void CellEditor::keep() {
  state_->before.reset();
  state_->document.keep();
}

void CellEditor::take_back() { state_->take_back(); }

std::variant<Cell, EditRefusal> CellEditor::edit(std::span<const CellChange> changes) {
  auto result = propose(changes);
  if (std::holds_alternative<Cell>(result)) keep();
  return result;
}

std::variant<Cell, EditRefusal> CellEditor::dry_run(std::span<const CellChange> changes) {
  auto result = propose(changes);
  if (std::holds_alternative<Cell>(result)) take_back();
  return result;
}

std::string CellEditor::text() const { return state_->document.text(); }

}  // namespace clearance
