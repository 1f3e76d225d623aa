#include "config/edit/touched_entry.hpp"

#include <fmt/format.h>

#include <variant>

#include "config/edit/change_document.hpp"
#include "config/edit/object_users.hpp"
#include "config/yaml/yaml_writer.hpp"

namespace clearance {
namespace {

struct Touched {
  static TouchedEntry entry_of(const std::string& yaml) {
    const auto read = object_entry(yaml);
    const auto* node = std::get_if<YamlNode>(&read);
    return node == nullptr ? TouchedEntry{} : TouchedEntry{"objects", name_of(*node)};
  }
  TouchedEntry operator()(const AddObject& change) const { return entry_of(change.yaml); }
  TouchedEntry operator()(const ReplaceObject& change) const { return entry_of(change.yaml); }
  TouchedEntry operator()(const SetPair& change) const {
    const bool is_exception =
        change.rule == SetPair::Rule::kLeaveOut || change.rule == SetPair::Rule::kNoException;
    return {is_exception ? "allowed_collisions" : "pairs",
            fmt::format("{}, {}", change.a, change.b)};
  }
  TouchedEntry operator()(const SetZoneThresholds& change) const { return {"zones", change.zone}; }
  TouchedEntry operator()(const AllowContact& change) const { return {"contacts", change.contact}; }
  TouchedEntry operator()(const WithdrawContact& of) const { return {"contacts", of.contact}; }
  TouchedEntry operator()(const ReplaceCell&) const { return {}; }
  TouchedEntry operator()(const ReadCellAgain&) const { return {}; }
  TouchedEntry operator()(const Note&) const { return {}; }
  TouchedEntry operator()(const AttachRobot& change) const { return {"robots", change.robot}; }
  TouchedEntry operator()(const DetachRobot& change) const { return {"robots", change.robot}; }
  template <class Change>
  TouchedEntry operator()(const Change& change) const {
    return {"objects", change.object};
  }
};

}  // namespace

TouchedEntry touched_by(const CellChange& change) { return std::visit(Touched{}, change); }

std::string entry_label(const YamlNode& entry, std::size_t place) {
  if (const std::string name = name_of(entry); !name.empty()) return name;
  const YamlNode* between = find(entry, "between");
  if (between != nullptr && between->items.size() == 2)
    return fmt::format("{}, {}", between->items[0].text, between->items[1].text);
  return std::to_string(place);
}

}  // namespace clearance
