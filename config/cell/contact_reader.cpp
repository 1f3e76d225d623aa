#include "config/cell/contact_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <string>

#include "config/scene/people.hpp"

namespace clearance {
namespace {

constexpr std::size_t kMaxContacts = 256;  // idl/clearance.idl
// The largest number that is no "never" (ContactEnd).
constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max() - 1;

class ContactReader {
 public:
  ContactReader(const ObjectList& objects, const std::vector<Robot>& robots,
                const std::vector<Zone>& zones, GroupIndex& group_index,
                const Quantities& quantities, PairList& pairs)
      : objects_(objects),
        robots_(robots),
        zones_(zones),
        group_index_(group_index),
        quantities_(quantities),
        diagnostics_(quantities.diagnostics()),
        pairs_(pairs) {}

  // A contact with a mistake stays in the list, so that later mistakes are found as well.
  AllowedContact read(const YamlNode& node);

 private:
  void read_name_of(const YamlNode& node, AllowedContact& contact);
  [[nodiscard]] std::string read_sentence(MapReader& map, const char* key,
                                          const std::string& what) const;
  void fill(const YamlNode& node, const Between& between, AllowedContact& contact);
  void refuse_people(const YamlNode& node, const AllowedContact& contact) const;
  [[nodiscard]] std::string names_of(std::uint32_t pair) const;

  const ObjectList& objects_;
  const std::vector<Robot>& robots_;
  const std::vector<Zone>& zones_;
  GroupIndex& group_index_;
  const Quantities& quantities_;
  Diagnostics& diagnostics_;
  PairList& pairs_;
  std::map<std::string, int> lines_;            // of the names
  std::map<std::uint32_t, std::string> taken_;  // pairs, and the names of their contacts
};

std::string ContactReader::names_of(std::uint32_t pair) const {
  const ObjectPair& of = pairs_.pairs[pair];
  return fmt::format("'{}' against '{}'", objects_.objects[of.first].name,
                     objects_.objects[of.second].name);
}

// Commands, reports and a changed scene refer to contacts by name.
void ContactReader::read_name_of(const YamlNode& node, AllowedContact& contact) {
  contact.name = read_name(node, "a contact's name", diagnostics_).value_or("");
  if (contact.name.empty()) return;
  if (const auto [same, is_new] = lines_.emplace(contact.name, node.line); !is_new) {
    diagnostics_.add(
        node, fmt::format("found the name '{}' of a contact again; expected it once (first in "
                          "line {})",
                          contact.name, same->second));
  }
}

std::string ContactReader::read_sentence(MapReader& map, const char* key,
                                         const std::string& what) const {
  const YamlNode* node = map.required(key);
  if (node == nullptr) return {};
  const auto text = read_text(*node, what, diagnostics_);
  if (text && text->find_first_not_of(" \t\n") == std::string::npos)
    diagnostics_.add(*node, fmt::format("found an empty text; expected {}", what));
  return text.value_or("");
}

void ContactReader::refuse_people(const YamlNode& node, const AllowedContact& contact) const {
  for (const std::uint32_t pair : contact.pairs) {
    const ObjectPair& of = pairs_.pairs[pair];
    const auto why =
        contact_with_people(objects_.objects, robots_, pairs_.pairs, zones_, of.first, of.second);
    if (why) return diagnostics_.add(node, *why);
  }
}

void ContactReader::fill(const YamlNode& node, const Between& between, AllowedContact& contact) {
  contact.group_a = between.names[0];
  contact.group_b = between.names[1];
  for (const PairKey key : group_index_.pairs(between)) {
    if (const auto index = pair_index(pairs_.pairs, key)) contact.pairs.push_back(*index);
  }
  if (contact.pairs.empty() && pairs_.complete && !between.may_be_empty) {
    diagnostics_.add(
        node, fmt::format("found a contact over no pair: none between '{}' and '{}' is watched; "
                          "expected at least one, or that the contact is withdrawn",
                          between.names[0], between.names[1]));
  }
  for (const std::uint32_t pair : contact.pairs) {
    pairs_.pairs[pair].publish = true;
    if (const auto [same, is_new] = taken_.emplace(pair, contact.name); !is_new) {
      diagnostics_.add(node, fmt::format("found {} in the contact '{}' as well; expected each pair "
                                         "in one contact: withdraw the former",
                                         names_of(pair), same->second));
      break;
    }
  }
  refuse_people(node, contact);
}

AllowedContact ContactReader::read(const YamlNode& node) {
  AllowedContact contact;
  MapReader map(node, "a contact", diagnostics_);
  if (const YamlNode* name = map.required("name")) read_name_of(*name, contact);
  const auto between = group_index_.read_between(map, GroupIndex::Attached::kDoNot);
  if (const YamlNode* depth = map.required("depth")) {
    contact.depth =
        quantities_.length(*depth, "the greatest depth of the contact", kPositive).value_or(0.0);
  }
  if (const YamlNode* until = map.optional("until"))
    contact.end = read_contact_end(*until, quantities_);
  contact.by = read_sentence(map, "by", "who allows the contact");
  contact.reason = read_sentence(map, "reason", "the reason why these may touch");
  map.refuse_unknown_keys();
  if (between) fill(node, *between, contact);
  return contact;
}

}  // namespace

// An empty end would read like an end and be none.
ContactEnd read_contact_end(const YamlNode& node, const Quantities& quantities) {
  Diagnostics& diagnostics = quantities.diagnostics();
  ContactEnd end;
  MapReader map(node, "the end of a contact", diagnostics);
  const YamlNode* distance = map.optional("distance");
  const YamlNode* duration = map.optional("duration_ms");
  const YamlNode* time = map.optional("time_ns");
  const YamlNode* cycle = map.optional("cycle");
  map.refuse_unknown_keys();
  if (distance != nullptr) {
    end.distance = quantities.length(*distance, "the distance that ends the contact", kPositive)
                       .value_or(end.distance);
  }
  if (duration != nullptr) {
    end.duration_ns =
        quantities.milliseconds(*duration, "how long the contact is allowed", kNotNegative)
            .value_or(end.duration_ns);
  }
  if (time != nullptr) {
    end.time_ns = read_integer(*time, 1, kMost, "the time of the end in ns", diagnostics)
                      .value_or(end.time_ns);
  }
  if (cycle != nullptr) {
    if (const auto last = read_integer(*cycle, 1, kMost, "the last cycle", diagnostics))
      end.last_cycle = static_cast<std::uint64_t>(*last);
  }
  const bool is_empty =
      distance == nullptr && duration == nullptr && time == nullptr && cycle == nullptr;
  if (map.is_map() && is_empty) {
    diagnostics.add(node,
                    "found an end without a condition; expected distance, duration_ms, time_ns or "
                    "cycle, or no 'until'");
  }
  return end;
}

std::vector<AllowedContact> read_contacts(const YamlNode& node, const ObjectList& objects,
                                          const std::vector<Robot>& robots,
                                          const std::vector<Zone>& zones, GroupIndex& group_index,
                                          const Quantities& quantities, PairList& pairs) {
  std::vector<AllowedContact> contacts;
  ContactReader reader(objects, robots, zones, group_index, quantities, pairs);
  for (const YamlNode& item : read_list(node, "contacts", quantities.diagnostics()))
    contacts.push_back(reader.read(item));
  if (contacts.size() > kMaxContacts) {
    quantities.diagnostics().add(
        node.items[kMaxContacts],
        fmt::format("found {} contacts; expected at most {}", contacts.size(), kMaxContacts));
  }
  const auto published =
      static_cast<std::size_t>(std::ranges::count(pairs.pairs, true, &ObjectPair::publish));
  if (!contacts.empty() && published > kMaxPublished) {
    quantities.diagnostics().add(
        node, fmt::format("found {} published pairs with those of contacts; expected at most {}: "
                          "name fewer objects on each side of the contacts",
                          published, kMaxPublished));
  }
  return contacts;
}

}  // namespace clearance
