// Kinds of changes have the names of idl/commands.idl.
#include "config/edit/change_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include "config/cell/contact_reader.hpp"
#include "config/cell/object_reader.hpp"
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

constexpr Range kPositions{.least = -1e6, .most = 1e6};       // rad or m
constexpr Range kTime{.least = 0.001, .most = 86'400'000.0};  // ms

// Reads the keys of one change. The overloads of read() list the keys of each kind.
class ChangeKeys {
 public:
  ChangeKeys(MapReader& map, const Quantities& quantities, const std::filesystem::path& directory)
      : map_(map),
        quantities_(quantities),
        diagnostics_(quantities.diagnostics()),
        directory_(directory) {}

  void read(AddFromTemplate& change) {
    name("template", change.template_name);
    name("object", change.object);
    names("groups", change.groups);
    if (auto stated = pose()) change.world_from_object = *stated;
  }
  void read(RemoveObject& change) { name("object", change.object); }
  void read(SetAbsent& change) {
    name("object", change.object);
    if (const YamlNode* absent = map_.optional("absent"))
      change.absent = read_flag(*absent, diagnostics_).value_or(true);
    if (const YamlNode* id = map_.optional("id")) change.id = read_text(*id, "an id", diagnostics_);
  }
  void read(Attach& change) {
    name("object", change.object);
    name("to", change.to);
    change.carrier_from_object = pose();
    names("touch", change.touch);
    fit(change);
    if (const double mass = read_mass(map_, diagnostics_); mass < kInfinity) change.mass = mass;
  }
  void read(Detach& change) {
    name("object", change.object);
    change.world_from_object = pose();
  }
  void read(AttachRobot& change) {
    name("robot", change.robot);
    name("to", change.to);
    change.carrier_from_root = pose();
    fit(change);
  }
  void read(DetachRobot& change) {
    name("robot", change.robot);
    change.world_from_root = pose();
    if (const YamlNode* joints = map_.optional("joints")) read_positions(*joints, change.joints);
    if (const YamlNode* powered = map_.optional("powered"))
      change.powered = read_flag(*powered, diagnostics_).value_or(false);
    if (const YamlNode* absent = map_.optional("absent"))
      change.absent = read_flag(*absent, diagnostics_).value_or(false);
  }
  void read(Place& change) {
    name("object", change.object);
    if (const YamlNode* value = map_.required("pose"))
      change.world_from_object = quantities_.pose(*value).value_or(Pose{});
  }
  void read(SetMaxSpeed& change) {
    name("object", change.object);
    if (const YamlNode* speed = map_.optional("max_speed"))
      change.m_per_s = quantities_.speed(*speed, "the greatest speed");
  }
  void read(SetMargin& change) {
    name("object", change.object);
    if (const YamlNode* margin = map_.optional("margin"))
      change.m = quantities_.length(*margin, "the margin", kNotNegative);
  }
  void read(SetAgeLimit& change) {
    name("object", change.object);
    if (const YamlNode* limit = map_.optional("age_limit_ms"))
      change.ns = quantities_.milliseconds(*limit, "the age limit", kTime);
  }
  void read(SetSource& change) {
    name("object", change.object);
    if (const YamlNode* source = map_.optional("source"))
      change.source = read_text(*source, "the name of a source", diagnostics_);
  }
  void read(SetPair& change) {
    sides(change.a, change.b);
    if (const YamlNode* rule = map_.required("rule")) read_rule(*rule, change.rule);
    text(map_.optional("reason"), change.reason);
  }
  void read(SetZoneThresholds& change) {
    name("zone", change.zone);
    if (const YamlNode* enter = map_.required("enter_below"))
      change.enter_below = quantities_.length(*enter, "the threshold").value_or(0.0);
    if (const YamlNode* leave = map_.required("leave_above"))
      change.leave_above = quantities_.length(*leave, "the threshold").value_or(0.0);
  }
  void read(AllowContact& change) {
    name("contact", change.contact);
    sides(change.a, change.b);
    if (const YamlNode* depth = map_.required("depth"))
      change.depth = quantities_.length(*depth, "the greatest depth", kPositive).value_or(0.0);
    if (const YamlNode* until = map_.optional("until"))
      change.end = read_contact_end(*until, quantities_);
    text(map_.required("by"), change.by);
    text(map_.required("reason"), change.reason);
  }
  void read(WithdrawContact& change) { name("contact", change.contact); }
  void read(ReplaceCell& change) {
    const YamlNode* file = map_.required("file");
    if (file == nullptr) return;
    const auto path = read_text(*file, "the path of a cell file", diagnostics_);
    if (!path) return;
    auto bytes = read_bytes((directory_ / *path).string());
    if (const auto* fault = std::get_if<FileFault>(&bytes)) {
      diagnostics_.add(*file, fmt::format("found {}; expected a cell file", fault->reason));
    } else {
      change.yaml = std::get<std::string>(std::move(bytes));
    }
  }
  void read(ReadCellAgain& change) { text(map_.optional("file"), change.file); }
  void read(Note& change) { text(map_.required("text"), change.text); }

 private:
  void name(std::string_view key, std::string& out) {
    const YamlNode* node = map_.required(key);
    if (node == nullptr) return;
    if (auto read = read_name(*node, "a name of the cell", diagnostics_)) out = *std::move(read);
  }
  void names(std::string_view key, std::vector<std::string>& out) {
    const YamlNode* node = map_.optional(key);
    if (node == nullptr) return;
    for (const YamlNode& item : read_list(*node, "names of the cell", diagnostics_)) {
      if (auto read = read_name(item, "a name of the cell", diagnostics_))
        out.push_back(*std::move(read));
    }
  }
  void sides(std::string& a, std::string& b) {
    const YamlNode* between = map_.required("between");
    if (between == nullptr) return;
    std::vector<std::string> both;
    names("between", both);
    if (both.size() != 2) {
      diagnostics_.add(*between, "found no two names; expected two objects or groups");
      return;
    }
    a = std::move(both[0]);
    b = std::move(both[1]);
  }
  // Null: the key is not there.
  void text(const YamlNode* node, std::string& out) {
    if (node == nullptr) return;
    if (auto read = read_text(*node, "a text", diagnostics_)) out = *std::move(read);
  }
  // Of what is attached.
  template <class Change>
  void fit(Change& change) {
    if (const YamlNode* overlap = map_.optional("overlap"))
      change.overlap = quantities_.length(*overlap, "the greatest overlap", kNotNegative);
    if (const YamlNode* far = map_.optional("far"))
      change.far = read_flag(*far, diagnostics_).value_or(false);
  }
  void read_positions(const YamlNode& node, std::vector<JointPosition>& out) {
    if (node.kind != YamlNode::Kind::kMap) {
      diagnostics_.add(
          node, fmt::format("found {}; expected joints and their positions in rad or m: {{NAME: "
                            "POSITION}}",
                            describe(node)));
    }
    for (const YamlEntry& entry : node.entries) {
      const auto joint = read_name(entry.key, "a joint's name in the URDF", diagnostics_);
      const auto at = read_number(entry.value, kPositions, "a position in rad or m", diagnostics_);
      if (joint && at) out.push_back({*joint, *at});
    }
  }
  std::optional<Pose> pose() {
    const YamlNode* node = map_.optional("pose");
    return node == nullptr ? std::nullopt : quantities_.pose(*node);
  }
  void read_rule(const YamlNode& node, SetPair::Rule& out) {
    // The names stand in the order of SetPair::Rule.
    static constexpr std::array<std::string_view, 5> kRules = {"publish", "watch", "leave_out",
                                                               "unstated", "no_exception"};
    const auto text = read_text(node, "a rule", diagnostics_);
    if (!text) return;
    const auto* const found = std::ranges::find(kRules, *text);
    if (found != kRules.end()) {
      out = static_cast<SetPair::Rule>(found - kRules.begin());
    } else {
      diagnostics_.add(node, fmt::format("found '{}'; expected publish, watch, leave_out, "
                                         "unstated or no_exception",
                                         *text));
    }
  }

  MapReader& map_;
  const Quantities& quantities_;
  Diagnostics& diagnostics_;
  const std::filesystem::path& directory_;
};

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
    std::optional<CellChange> (ChangeReader::*read)(std::string_view name, const YamlNode&);
  };

  // The value of AddObject and ReplaceObject is the entry itself.
  template <class Change>
  std::optional<CellChange> change(std::string_view name, const YamlNode& node) {
    if constexpr (std::is_same_v<Change, AddObject> || std::is_same_v<Change, ReplaceObject>) {
      if (node.kind == YamlNode::Kind::kMap) return Change{line_of(node)};
      diagnostics_.add(node,
                       fmt::format("found {}; expected one entry of 'objects'", describe(node)));
      return std::nullopt;
    } else {
      Change change;
      MapReader map(node, fmt::format("a change '{}'", name), diagnostics_);
      ChangeKeys(map, quantities_, directory_).read(change);
      map.refuse_unknown_keys();
      return change;
    }
  }
  template <std::size_t... kKind>
  static constexpr std::array<Kind, sizeof...(kKind)> kinds(std::index_sequence<kKind...>) {
    return {Kind{kChangeNames[kKind],
                 &ChangeReader::change<std::variant_alternative_t<kKind, CellChange>>}...};
  }

  const Quantities& quantities_;
  Diagnostics& diagnostics_;
  std::filesystem::path directory_;
};

std::optional<CellChange> ChangeReader::read(const YamlNode& node) {
  static constexpr auto kKinds = kinds(std::make_index_sequence<std::variant_size_v<CellChange>>());
  if (node.kind != YamlNode::Kind::kMap || node.entries.size() != 1) {
    diagnostics_.add(
        node, fmt::format("found {}; expected one change, as 'attach: {{...}}'", describe(node)));
    return std::nullopt;
  }
  const auto& [key, value] = node.entries.front();
  std::vector<std::string> known;
  for (const Kind& kind : kKinds) {
    if (kind.name == key.text) return (this->*kind.read)(kind.name, value);
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
