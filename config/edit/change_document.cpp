// One overload for each type of change. Each finds the entry by its name.
#include "config/edit/change_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "config/edit/contact_entry.hpp"
#include "config/edit/object_users.hpp"
#include "config/edit/robot_entry.hpp"
#include "config/text/sentences.hpp"
#include "config/text/spelling.hpp"
#include "config/yaml/quantity_nodes.hpp"
#include "config/yaml/scalar.hpp"
#include "config/yaml/yaml_writer.hpp"

namespace clearance {
namespace {

using Fault = std::optional<ChangeFault>;

// Only a running monitor knows where objects are.
ChangeFault no_pose(std::string_view list, const std::string& name) {
  return {fmt::format("{}[{}]", list, name),
          fmt::format("found no pose for '{}'; expected one, since a cell does not say where its "
                      "{} are now",
                      name, list)};
}

class ChangeMaker {
 public:
  explicit ChangeMaker(CellDocument& document)
      : document_(document), unit_(length_unit_of(document.tree())) {}

  Fault operator()(const AddObject& change);
  Fault operator()(const ReplaceObject& change);
  Fault operator()(const AddFromTemplate& change);
  Fault operator()(const RemoveObject& change);
  Fault operator()(const SetAbsent& change);
  Fault operator()(const Attach& change);
  Fault operator()(const Detach& change);
  Fault operator()(const AttachRobot& change) {
    return edit_robot(change, change.carrier_from_root);
  }
  Fault operator()(const DetachRobot& change) { return edit_robot(change, change.world_from_root); }
  Fault operator()(const Place& change);
  Fault operator()(const SetMaxSpeed& change) {
    return set_length(change.object, "max_speed", change.m_per_s);
  }
  Fault operator()(const SetMargin& change);
  Fault operator()(const SetAgeLimit& change);
  Fault operator()(const SetSource& change);
  Fault operator()(const SetPair& change);
  Fault operator()(const SetZoneThresholds& change);
  Fault operator()(const AllowContact& change) {
    allow_contact(
        change, [this](double metres) { return length(metres); }, document_);
    return std::nullopt;
  }
  Fault operator()(const WithdrawContact& change);
  Fault operator()(const ReplaceCell&) { return std::nullopt; }
  Fault operator()(const ReadCellAgain&) {
    return ChangeFault{"", "found a cell file to be read; expected its text here"};
  }
  Fault operator()(const Note& change) {
    if (!change.text.empty()) return std::nullopt;
    return ChangeFault{"", "found a note without text; expected what is to be logged"};
  }

 private:
  // An entry of a list, and its place.
  struct Found {
    std::size_t index;
    YamlNode node;
  };
  [[nodiscard]] std::variant<Found, ChangeFault> named(std::string_view list,
                                                       const std::string& name) const;
  // Edits a copy of the entry, which then replaces it, unless `edit` returns a fault.
  template <class Edit>
  Fault edit_entry(std::string_view list, const std::string& name, const Edit& edit);
  template <class Edit>
  Fault edit_object(const std::string& name, const Edit& edit) {
    return edit_entry("objects", name, edit);
  }
  template <class Change>
  Fault edit_robot(const Change& change, const std::optional<Pose>& stated);
  Fault add_object(YamlNode node);
  Fault set_value(const std::string& name, const std::string& key, std::optional<YamlNode> value,
                  std::string_view list = "objects");
  Fault set_length(const std::string& object, const std::string& key,
                   const std::optional<double>& value);
  [[nodiscard]] YamlNode length(double metres) const { return length_node(metres, unit_); }
  [[nodiscard]] YamlNode pose(const Pose& pose) const { return pose_node(pose, unit_); }
  void erase_pair(std::string_view list, const std::pair<std::string, std::string>& sides);

  CellDocument& document_;
  LengthUnit unit_;
};

std::variant<ChangeMaker::Found, ChangeFault> ChangeMaker::named(std::string_view list,
                                                                 const std::string& name) const {
  const std::vector<YamlNode>& items = document_.items(list);
  std::vector<std::string> names;
  for (std::size_t i = 0; i < items.size(); ++i) {
    names.push_back(name_of(items[i]));
    if (names.back() == name) return Found{i, items[i]};
  }
  return ChangeFault{
      std::string(list),
      fmt::format("found the name '{}', which no entry of '{}' has; expected one of "
                  "these{}{}",
                  name, list,
                  list == "objects" ? ", and no link of a robot or object of a planning scene" : "",
                  did_you_mean(name, names))};
}

template <class Edit>
Fault ChangeMaker::edit_entry(std::string_view list, const std::string& name, const Edit& edit) {
  auto found = named(list, name);
  if (auto* fault = std::get_if<ChangeFault>(&found)) return std::move(*fault);
  auto& [index, node] = std::get<Found>(found);
  if (Fault fault = edit(node)) return fault;
  document_.replace(list, index, std::move(node));
  return std::nullopt;
}

Fault ChangeMaker::set_value(const std::string& name, const std::string& key,
                             std::optional<YamlNode> value, std::string_view list) {
  return edit_entry(list, name, [&](YamlNode& node) -> Fault {
    erase(node, key);
    if (value) set(node, key, *std::move(value));
    return std::nullopt;
  });
}

Fault ChangeMaker::set_length(const std::string& object, const std::string& key,
                              const std::optional<double>& value) {
  return set_value(object, key, value ? std::optional(length(*value)) : std::nullopt);
}

// A later change of the list could not say which of two objects it names.
Fault ChangeMaker::add_object(YamlNode node) {
  const std::string name = name_of(node);
  if (std::ranges::find(document_.items("objects"), name, name_of) !=
      document_.items("objects").end()) {
    return ChangeFault{fmt::format("objects[{}]", name),
                       fmt::format("found '{}', which the cell has; expected another name, or "
                                   "replace_object",
                                   name)};
  }
  document_.append("objects", std::move(node));
  return std::nullopt;
}

Fault ChangeMaker::operator()(const AddObject& change) {
  auto read = object_entry(change.yaml);
  if (auto* fault = std::get_if<ChangeFault>(&read)) return std::move(*fault);
  return add_object(std::get<YamlNode>(std::move(read)));
}

Fault ChangeMaker::operator()(const ReplaceObject& change) {
  auto read = object_entry(change.yaml);
  if (auto* fault = std::get_if<ChangeFault>(&read)) return std::move(*fault);
  auto& node = std::get<YamlNode>(read);
  const auto found = named("objects", name_of(node));
  if (const auto* fault = std::get_if<ChangeFault>(&found)) return *fault;
  document_.replace("objects", std::get<Found>(found).index, std::move(node));
  return std::nullopt;
}

Fault ChangeMaker::operator()(const AddFromTemplate& change) {
  YamlNode node;
  set(node, "name", text_node(change.object));
  set(node, "template", text_node(change.template_name));
  if (!change.groups.empty()) set(node, "groups", texts_node(change.groups));
  set(node, "fixed", flag_node(true));
  set(node, "pose", pose(change.world_from_object));
  return add_object(std::move(node));
}

Fault ChangeMaker::operator()(const RemoveObject& change) {
  const auto found = named("objects", change.object);
  if (const auto* fault = std::get_if<ChangeFault>(&found)) return *fault;
  const std::vector<std::string> users = users_of(change.object, document_);
  if (!users.empty()) {
    constexpr std::size_t kNamed = 5;
    return ChangeFault{
        fmt::format("objects[{}]", change.object),
        fmt::format("found '{}' named by {}; expected that only groups lose it: change these first",
                    change.object, listed(users, kNamed))};
  }
  document_.remove("objects", std::get<Found>(found).index);
  return std::nullopt;
}

Fault ChangeMaker::operator()(const SetAbsent& change) {
  const bool is_robot = std::holds_alternative<Found>(named("robots", change.object));
  const char* const list = is_robot ? "robots" : "objects";
  const auto set_id = [&](YamlNode& node) { return set_body(*change.id, change.object, node); };
  Fault fault = change.id ? edit_entry(list, change.object, set_id) : std::nullopt;
  if (fault) return fault;
  return set_value(change.object, "absent",
                   change.absent ? std::optional(flag_node(true)) : std::nullopt, list);
}

// Erases the keys that say where an object is, and which poses count.
void forget_place(YamlNode& node) {
  for (const char* key : {"fixed", "pose", "attached", "max_speed", "age_limit_ms",
                          "frozen_limit_ms", "may_jump", "source", "frame"}) {
    erase(node, key);
  }
}

Fault ChangeMaker::operator()(const Attach& change) {
  if (!change.carrier_from_object) return no_pose("objects", change.object);
  return edit_object(change.object, [&](YamlNode& node) -> Fault {
    forget_place(node);
    YamlNode attached;
    set(attached, "to", text_node(change.to));
    set(attached, "pose", pose(*change.carrier_from_object));
    if (!change.touch.empty()) set(attached, "touch", texts_node(change.touch));
    set(node, "attached", std::move(attached));
    if (change.mass) set(node, "mass", number_node(*change.mass));
    return std::nullopt;
  });
}

Fault ChangeMaker::operator()(const Detach& change) {
  if (!change.world_from_object) return no_pose("objects", change.object);
  return edit_object(change.object, [&](YamlNode& node) -> Fault {
    if (find(node, "attached") == nullptr) {
      return ChangeFault{fmt::format("objects[{}]", change.object),
                         fmt::format("found '{}', which is not attached; expected an attached "
                                     "object",
                                     change.object)};
    }
    forget_place(node);
    set(node, "fixed", flag_node(true));
    set(node, "pose", pose(*change.world_from_object));
    return std::nullopt;
  });
}

// An unknown robot is named before a pose is missed.
template <class Change>
Fault ChangeMaker::edit_robot(const Change& change, const std::optional<Pose>& stated) {
  return edit_entry("robots", change.robot, [&](YamlNode& node) -> Fault {
    return stated ? move_robot(change, pose(*stated), node) : no_pose("robots", change.robot);
  });
}

Fault ChangeMaker::operator()(const Place& change) {
  return edit_object(change.object, [&](YamlNode& node) -> Fault {
    if (line_of(flag_node(true)) != text_of(find(node, "fixed"))) {
      return ChangeFault{fmt::format("objects[{}]", change.object),
                         fmt::format("found '{}', which is not fixed; expected fixed: true, since "
                                     "the poses of others arrive or follow from a carrier",
                                     change.object)};
    }
    set(node, "pose", pose(change.world_from_object));
    return std::nullopt;
  });
}

// A name without an object may be a link of a robot, which only the reader knows.
Fault ChangeMaker::operator()(const SetMargin& change) {
  const auto object = named("objects", change.object);
  if (std::holds_alternative<Found>(object) || find(document_.tree(), "robots") == nullptr)
    return set_length(change.object, "margin", change.m);
  YamlNode margin;
  set(margin, "name", text_node(change.object));
  if (change.m) set(margin, "margin", length(*change.m));
  const auto stated = named("margins", change.object);
  if (const auto* found = std::get_if<Found>(&stated)) {
    if (change.m) {
      document_.replace("margins", found->index, std::move(margin));
    } else {
      document_.remove("margins", found->index);
    }
  } else if (change.m) {
    document_.append("margins", std::move(margin));
  }
  return std::nullopt;
}

Fault ChangeMaker::operator()(const SetAgeLimit& change) {
  std::optional<YamlNode> value;
  if (change.ns) value = number_node(static_cast<double>(*change.ns) / 1e6);
  return set_value(change.object, "age_limit_ms", std::move(value));
}

Fault ChangeMaker::operator()(const SetSource& change) {
  return set_value(change.object, "source",
                   change.source ? std::optional(text_node(*change.source)) : std::nullopt);
}

void ChangeMaker::erase_pair(std::string_view list,
                             const std::pair<std::string, std::string>& sides) {
  for (std::size_t i = document_.items(list).size(); i-- > 0;) {
    if (sides_of(document_.items(list)[i]) == sides) document_.remove(list, i);
  }
}

// A rule that stands already keeps its place.
Fault ChangeMaker::operator()(const SetPair& change) {
  const std::pair<std::string, std::string> sides = std::minmax(change.a, change.b);
  const bool is_rule =
      change.rule == SetPair::Rule::kPublish || change.rule == SetPair::Rule::kWatch;
  const bool is_exception = change.rule == SetPair::Rule::kLeaveOut;
  if (change.rule == SetPair::Rule::kUnstated) erase_pair("pairs", sides);
  if (!is_exception) erase_pair("allowed_collisions", sides);
  if (!is_rule && !is_exception) return std::nullopt;
  const std::string_view list = is_rule ? "pairs" : "allowed_collisions";
  const std::vector<YamlNode>& items = document_.items(list);
  std::size_t place = 0;
  while (place < items.size() && sides_of(items[place]) != sides) ++place;
  YamlNode node;
  if (place < items.size()) {
    node = items[place];
  } else {
    set(node, "between", texts_node({change.a, change.b}));
  }
  // Later changes may leave it nothing to cover: an attached object has its carrier's pairs.
  set(node, "may_be_empty", flag_node(true));
  if (is_exception) {
    set(node, "reason", text_node(change.reason));
  } else {
    erase(node, "publish");
    if (change.rule == SetPair::Rule::kWatch) set(node, "publish", flag_node(false));
  }
  if (place < items.size()) {
    document_.replace(list, place, std::move(node));
  } else {
    document_.append(list, std::move(node));
  }
  return std::nullopt;
}

Fault ChangeMaker::operator()(const SetZoneThresholds& change) {
  auto found = named("zones", change.zone);
  if (auto* fault = std::get_if<ChangeFault>(&found)) return std::move(*fault);
  auto& [index, node] = std::get<Found>(found);
  set(node, "enter_below", length(change.enter_below));
  set(node, "leave_above", length(change.leave_above));
  document_.replace("zones", index, std::move(node));
  return std::nullopt;
}

Fault ChangeMaker::operator()(const WithdrawContact& change) {
  auto found = named("contacts", change.contact);
  if (auto* fault = std::get_if<ChangeFault>(&found)) return std::move(*fault);
  document_.remove("contacts", std::get<Found>(found).index);
  return std::nullopt;
}

}  // namespace

std::variant<YamlNode, ChangeFault> object_entry(const std::string& yaml) {
  auto read = parse_yaml(yaml);
  if (const auto* fault = std::get_if<YamlFault>(&read))
    return ChangeFault{"objects", fault->reason};
  auto& node = std::get<YamlNode>(read);
  if (node.kind == YamlNode::Kind::kSequence && node.items.size() == 1) {
    YamlNode only = std::move(node.items.front());
    node = std::move(only);
  }
  if (node.kind != YamlNode::Kind::kMap || name_of(node).empty()) {
    return ChangeFault{"objects", fmt::format("found {}; expected one entry of 'objects', a map "
                                              "with a name",
                                              describe(node))};
  }
  return std::move(node);
}

std::optional<ChangeFault> make_change(const CellChange& change, CellDocument& document) {
  return std::visit(ChangeMaker(document), change);
}

}  // namespace clearance
