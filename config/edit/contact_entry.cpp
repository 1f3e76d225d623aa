#include "config/edit/contact_entry.hpp"

#include <string>
#include <utility>

#include "config/yaml/yaml_writer.hpp"

namespace clearance {
namespace {

// All digits: a double would round a time.
YamlNode integer_node(std::int64_t value) {
  YamlNode node;
  node.kind = YamlNode::Kind::kScalar;
  node.text = std::to_string(value);
  return node;
}

YamlNode contact_entry(const AllowContact& change,
                       const std::function<YamlNode(double metres)>& length) {
  YamlNode between;
  between.kind = YamlNode::Kind::kSequence;
  for (const std::string& side : {change.a, change.b}) between.items.push_back(text_node(side));
  YamlNode entry;
  set(entry, "name", text_node(change.contact));
  set(entry, "between", std::move(between));
  set(entry, "may_be_empty", flag_node(true));
  set(entry, "depth", length(change.depth));
  const ContactEnd& end = change.end;
  YamlNode until;
  if (end.distance < kInfinity) set(until, "distance", length(end.distance));
  if (end.duration_ns != ContactEnd::kNoTime)
    set(until, "duration_ms", number_node(static_cast<double>(end.duration_ns) / 1e6));
  if (end.time_ns != ContactEnd::kNoTime) set(until, "time_ns", integer_node(end.time_ns));
  if (end.last_cycle != ContactEnd::kNoCycle)
    set(until, "cycle", integer_node(static_cast<std::int64_t>(end.last_cycle)));
  if (!until.entries.empty()) set(entry, "until", std::move(until));
  set(entry, "by", text_node(change.by));
  set(entry, "reason", text_node(change.reason));
  return entry;
}

}  // namespace

// An entry that stands already keeps its place.
void allow_contact(const AllowContact& change, const std::function<YamlNode(double metres)>& length,
                   CellDocument& document) {
  YamlNode entry = contact_entry(change, length);
  const std::vector<YamlNode>& items = document.items("contacts");
  for (std::size_t i = 0; i < items.size(); ++i) {
    const YamlNode* name = find(items[i], "name");
    if (name == nullptr || name->text != change.contact) continue;
    document.replace("contacts", i, std::move(entry));
    return;
  }
  document.append("contacts", std::move(entry));
}

}  // namespace clearance
