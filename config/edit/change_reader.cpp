// One function for each kind of change. Kinds have the names of idl/commands.idl.
#include "config/edit/change_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include "config/cell/contact_reader.hpp"
#include "config/text/file_bytes.hpp"
#include "config/text/sentences.hpp"
#include "config/text/spelling.hpp"
#include "config/yaml/diagnostics.hpp"
#include "config/yaml/map_reader.hpp"
#include "config/yaml/quantities.hpp"
#include "config/yaml/scalar.hpp"
#include "config/yaml/yaml_writer.hpp"

namespace clearance {
namespace {

constexpr Range kTime{.least = 0.001, .most = 86'400'000.0};  // ms

class ChangeReader {
 public:
  ChangeReader(const Quantities& quantities, std::filesystem::path directory)
      : quantities_(quantities),
        diagnostics_(quantities.diagnostics()),
        directory_(std::move(directory)) {}

  std::optional<CellChange> read(const YamlNode& node);

 private:
  struct Kind {
    std::string_view name;
    std::optional<CellChange> (ChangeReader::*read)(const YamlNode&);
  };

  std::optional<CellChange> add_object(const YamlNode& node) {
    if (node.kind == YamlNode::Kind::kMap) return AddObject{line_of(node)};
    diagnostics_.add(node,
                     fmt::format("found {}; expected one entry of 'objects'", describe(node)));
    return std::nullopt;
  }
  std::optional<CellChange> replace_object(const YamlNode& node) {
    if (node.kind == YamlNode::Kind::kMap) return ReplaceObject{line_of(node)};
    diagnostics_.add(node,
                     fmt::format("found {}; expected one entry of 'objects'", describe(node)));
    return std::nullopt;
  }
  std::optional<CellChange> add_from_template(const YamlNode& node) {
    MapReader map(node, "a change 'add_from_template'", diagnostics_);
    AddFromTemplate change;
    name(map, "template", change.template_name);
    name(map, "object", change.object);
    names(map, "groups", change.groups);
    change.world_from_object = pose(map).value_or(Pose{});
    return finished(map, std::move(change));
  }
  std::optional<CellChange> remove_object(const YamlNode& node) {
    MapReader map(node, "a change 'remove_object'", diagnostics_);
    RemoveObject change;
    name(map, "object", change.object);
    return finished(map, std::move(change));
  }
  std::optional<CellChange> set_absent(const YamlNode& node) {
    MapReader map(node, "a change 'set_absent'", diagnostics_);
    SetAbsent change;
    name(map, "object", change.object);
    if (const YamlNode* absent = map.optional("absent"))
      change.absent = read_flag(*absent, diagnostics_).value_or(true);
    return finished(map, std::move(change));
  }
  std::optional<CellChange> attach(const YamlNode& node) {
    MapReader map(node, "a change 'attach'", diagnostics_);
    Attach change;
    name(map, "object", change.object);
    name(map, "to", change.to);
    change.carrier_from_object = pose(map);
    names(map, "touch", change.touch);
    if (const YamlNode* overlap = map.optional("overlap"))
      change.overlap = quantities_.length(*overlap, "the greatest overlap", kNotNegative);
    return finished(map, std::move(change));
  }
  std::optional<CellChange> detach(const YamlNode& node) {
    MapReader map(node, "a change 'detach'", diagnostics_);
    Detach change;
    name(map, "object", change.object);
    change.world_from_object = pose(map);
    return finished(map, std::move(change));
  }
  std::optional<CellChange> place(const YamlNode& node) {
    MapReader map(node, "a change 'place'", diagnostics_);
    Place change;
    name(map, "object", change.object);
    if (const YamlNode* value = map.required("pose"))
      change.world_from_object = quantities_.pose(*value).value_or(Pose{});
    return finished(map, std::move(change));
  }
  std::optional<CellChange> set_max_speed(const YamlNode& node) {
    MapReader map(node, "a change 'set_max_speed'", diagnostics_);
    SetMaxSpeed change;
    name(map, "object", change.object);
    if (const YamlNode* speed = map.optional("max_speed"))
      change.m_per_s = quantities_.speed(*speed, "the greatest speed");
    return finished(map, std::move(change));
  }
  std::optional<CellChange> set_margin(const YamlNode& node) {
    MapReader map(node, "a change 'set_margin'", diagnostics_);
    SetMargin change;
    name(map, "object", change.object);
    if (const YamlNode* margin = map.optional("margin"))
      change.m = quantities_.length(*margin, "the margin", kNotNegative);
    return finished(map, std::move(change));
  }
  std::optional<CellChange> set_age_limit(const YamlNode& node) {
    MapReader map(node, "a change 'set_age_limit'", diagnostics_);
    SetAgeLimit change;
    name(map, "object", change.object);
    if (const YamlNode* limit = map.optional("age_limit_ms"))
      change.ns = quantities_.milliseconds(*limit, "the age limit", kTime);
    return finished(map, std::move(change));
  }
  std::optional<CellChange> set_source(const YamlNode& node) {
    MapReader map(node, "a change 'set_source'", diagnostics_);
    SetSource change;
    name(map, "object", change.object);
    if (const YamlNode* source = map.optional("source"))
      change.source = read_text(*source, "the name of a source", diagnostics_);
    return finished(map, std::move(change));
  }
  std::optional<CellChange> set_pair(const YamlNode& node);
  std::optional<CellChange> set_zone_thresholds(const YamlNode& node) {
    MapReader map(node, "a change 'set_zone_thresholds'", diagnostics_);
    SetZoneThresholds change;
    name(map, "zone", change.zone);
    if (const YamlNode* enter = map.required("enter_below"))
      change.enter_below = quantities_.length(*enter, "the threshold").value_or(0.0);
    if (const YamlNode* leave = map.required("leave_above"))
      change.leave_above = quantities_.length(*leave, "the threshold").value_or(0.0);
    return finished(map, std::move(change));
  }
  std::optional<CellChange> allow_contact(const YamlNode& node);
  std::optional<CellChange> withdraw_contact(const YamlNode& node) {
    MapReader map(node, "a change 'withdraw_contact'", diagnostics_);
    WithdrawContact change;
    name(map, "contact", change.contact);
    return finished(map, std::move(change));
  }
  std::optional<CellChange> replace_cell(const YamlNode& node);
  std::optional<CellChange> read_cell_again(const YamlNode& node) {
    MapReader map(node, "a change 'read_cell_again'", diagnostics_);
    ReadCellAgain change;
    if (const YamlNode* file = map.optional("file")) {
      if (auto text = read_text(*file, "the path of a cell file", diagnostics_))
        change.file = *std::move(text);
    }
    return finished(map, std::move(change));
  }

  void name(MapReader& map, std::string_view key, std::string& out) {
    const YamlNode* node = map.required(key);
    if (node == nullptr) return;
    if (auto text = read_name(*node, "a name of the cell", diagnostics_)) out = *std::move(text);
  }
  void names(MapReader& map, std::string_view key, std::vector<std::string>& out) {
    const YamlNode* node = map.optional(key);
    if (node == nullptr) return;
    for (const YamlNode& item : read_list(*node, "names of the cell", diagnostics_)) {
      if (auto text = read_name(item, "a name of the cell", diagnostics_))
        out.push_back(*std::move(text));
    }
  }
  std::optional<Pose> pose(MapReader& map) {
    const YamlNode* node = map.optional("pose");
    return node == nullptr ? std::nullopt : quantities_.pose(*node);
  }
  static CellChange finished(MapReader& map, CellChange change) {
    map.refuse_unknown_keys();
    return change;
  }

  const Quantities& quantities_;
  Diagnostics& diagnostics_;
  std::filesystem::path directory_;
};

std::optional<CellChange> ChangeReader::set_pair(const YamlNode& node) {
  constexpr std::array<std::pair<std::string_view, SetPair::Rule>, 5> kRules = {{
      {"publish", SetPair::Rule::kPublish},
      {"watch", SetPair::Rule::kWatch},
      {"leave_out", SetPair::Rule::kLeaveOut},
      {"unstated", SetPair::Rule::kUnstated},
      {"no_exception", SetPair::Rule::kNoException},
  }};
  MapReader map(node, "a change 'set_pair'", diagnostics_);
  SetPair change;
  std::vector<std::string> sides;
  if (const YamlNode* between = map.required("between")) {
    names(map, "between", sides);
    if (sides.size() == 2) {
      change.a = sides[0];
      change.b = sides[1];
    } else {
      diagnostics_.add(*between, "found no two names; expected two objects or groups");
    }
  }
  if (const YamlNode* rule = map.required("rule")) {
    const auto text = read_text(*rule, "a rule", diagnostics_);
    const auto* found = std::ranges::find(kRules, std::string_view(text ? *text : ""),
                                          &std::pair<std::string_view, SetPair::Rule>::first);
    if (found != kRules.end()) {
      change.rule = found->second;
    } else if (text) {
      diagnostics_.add(*rule, fmt::format("found '{}'; expected publish, watch, leave_out, "
                                          "unstated or no_exception",
                                          *text));
    }
  }
  if (const YamlNode* reason = map.optional("reason")) {
    if (auto text = read_text(*reason, "a reason", diagnostics_)) change.reason = *std::move(text);
  }
  return finished(map, std::move(change));
}

std::optional<CellChange> ChangeReader::allow_contact(const YamlNode& node) {
  MapReader map(node, "a change 'allow_contact'", diagnostics_);
  AllowContact change;
  name(map, "contact", change.contact);
  if (const YamlNode* between = map.required("between")) {
    std::vector<std::string> sides;
    names(map, "between", sides);
    if (sides.size() != 2) {
      diagnostics_.add(*between, "found no two names; expected two objects or groups");
    } else {
      change.a = sides[0];
      change.b = sides[1];
    }
  }
  if (const YamlNode* depth = map.required("depth"))
    change.depth = quantities_.length(*depth, "the greatest depth", kPositive).value_or(0.0);
  if (const YamlNode* until = map.optional("until"))
    change.end = read_contact_end(*until, quantities_);
  for (const auto& [key, text] : {std::pair{"by", &change.by}, {"reason", &change.reason}}) {
    const YamlNode* value = map.optional(key);
    if (value == nullptr) continue;
    if (auto read = read_text(*value, "a text", diagnostics_)) *text = *std::move(read);
  }
  return finished(map, std::move(change));
}

std::optional<CellChange> ChangeReader::replace_cell(const YamlNode& node) {
  MapReader map(node, "a change 'replace_cell'", diagnostics_);
  ReplaceCell change;
  if (const YamlNode* file = map.required("file")) {
    const auto name = read_text(*file, "the path of a cell file", diagnostics_);
    if (name) {
      auto bytes = read_bytes((directory_ / *name).string());
      if (const auto* fault = std::get_if<FileFault>(&bytes)) {
        diagnostics_.add(*file, fmt::format("found {}; expected a cell file", fault->reason));
      } else {
        change.yaml = std::get<std::string>(std::move(bytes));
      }
    }
  }
  return finished(map, std::move(change));
}

std::optional<CellChange> ChangeReader::read(const YamlNode& node) {
  static constexpr std::array<Kind, 18> kKinds = {{
      {"add_object", &ChangeReader::add_object},
      {"replace_object", &ChangeReader::replace_object},
      {"add_from_template", &ChangeReader::add_from_template},
      {"remove_object", &ChangeReader::remove_object},
      {"set_absent", &ChangeReader::set_absent},
      {"attach", &ChangeReader::attach},
      {"detach", &ChangeReader::detach},
      {"place", &ChangeReader::place},
      {"set_max_speed", &ChangeReader::set_max_speed},
      {"set_margin", &ChangeReader::set_margin},
      {"set_age_limit", &ChangeReader::set_age_limit},
      {"set_source", &ChangeReader::set_source},
      {"set_pair", &ChangeReader::set_pair},
      {"set_zone_thresholds", &ChangeReader::set_zone_thresholds},
      {"allow_contact", &ChangeReader::allow_contact},
      {"withdraw_contact", &ChangeReader::withdraw_contact},
      {"replace_cell", &ChangeReader::replace_cell},
      {"read_cell_again", &ChangeReader::read_cell_again},
  }};
  static_assert(kKinds.size() == std::variant_size_v<CellChange>);
  if (node.kind != YamlNode::Kind::kMap || node.entries.size() != 1) {
    diagnostics_.add(
        node, fmt::format("found {}; expected one change, as 'attach: {{...}}'", describe(node)));
    return std::nullopt;
  }
  const auto& [key, value] = node.entries.front();
  std::vector<std::string> known;
  for (const Kind& kind : kKinds) {
    if (kind.name == key.text) return (this->*kind.read)(value);
    known.emplace_back(kind.name);
  }
  diagnostics_.add(key, fmt::format("found '{}'; expected {}{}", key.text, one_of(known),
                                    did_you_mean(key.text, known)));
  return std::nullopt;
}

}  // namespace

ChangesResult read_changes(const std::string& text, const std::filesystem::path& file) {
  Diagnostics diagnostics(file.string());
  auto parsed = parse_yaml(text);
  if (const auto* fault = std::get_if<YamlFault>(&parsed)) {
    diagnostics.add(fault->line, fault->column, fault->reason);
    return diagnostics.sorted();
  }
  const auto& root = std::get<YamlNode>(parsed);
  Units units;
  const YamlNode* list = &root;
  if (root.kind == YamlNode::Kind::kMap && find(root, "changes") != nullptr) {
    MapReader map(root, "a list of changes", diagnostics);
    list = map.required("changes");
    if (const YamlNode* stated = map.optional("units")) {
      MapReader unit(*stated, "the units", diagnostics);
      if (const YamlNode* length = unit.optional("length"))
        units.length = read_length_unit(*length, diagnostics).value_or(units.length);
      if (const YamlNode* angle = unit.optional("angle"))
        units.angle = read_angle_unit(*angle, diagnostics).value_or(units.angle);
      unit.refuse_unknown_keys();
    }
    map.refuse_unknown_keys();
  }
  const Quantities quantities(units, diagnostics);
  ChangeReader reader(quantities, file.parent_path());
  std::vector<CellChange> changes;
  // One change need not be a list.
  const bool is_one = list->kind == YamlNode::Kind::kMap;
  const std::vector<YamlNode> only =
      is_one ? std::vector<YamlNode>{*list} : std::vector<YamlNode>{};
  for (const YamlNode& item : is_one ? only : read_list(*list, "changes", diagnostics)) {
    if (auto change = reader.read(item)) changes.push_back(*std::move(change));
  }
  if (diagnostics.empty()) return changes;
  return diagnostics.sorted();
}

}  // namespace clearance
