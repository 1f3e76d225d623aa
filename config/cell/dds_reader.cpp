#include "config/cell/dds_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "config/yaml/map_reader.hpp"
#include "config/yaml/quantities.hpp"
#include "config/yaml/scalar.hpp"

namespace clearance {
namespace {

constexpr std::int64_t kMaxDomain = 232;  // the last whose ports fit into 16 bits
// Discovery announces names in bounded strings (DDSI-RTPS: string<256>).
constexpr std::size_t kMaxDdsName = 255;  // bytes
// A reader that joins late waits this long.
constexpr Range kFullReports{.least = 1e-3, .most = 60.0};  // s

// A DDS name has letters, digits, '_' and '/', and begins with no digit; two topics cannot share
// one.
void read_topics(const YamlNode& node, Topics& topics, Diagnostics& diagnostics) {
  MapReader map(node, "the topics", diagnostics);
  std::map<std::string, std::string_view> taken;
  for (const auto& [key, member] : kTopicKeys) {
    std::string* const topic = &(topics.*member);
    const YamlNode* name_node = map.optional(key);
    const auto name = name_node == nullptr ? std::optional(*topic)
                                           : read_text(*name_node, "a topic's name", diagnostics);
    if (!name) continue;
    // The characters that every DDS implementation accepts.
    const bool plain = std::all_of(name->begin(), name->end(), [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
             c == '_' || c == '/';
    });
    if (name->empty() || !plain || name->size() > kMaxDdsName ||
        (name->front() >= '0' && name->front() <= '9')) {
      diagnostics.add(
          *name_node,
          fmt::format(
              "found {}; expected a topic's name: letters, digits, '_' and '/', no digit first",
              describe(*name_node)));
    } else if (const auto [same, is_new] = taken.emplace(*name, key); !is_new) {
      diagnostics.add(
          name_node == nullptr ? node : *name_node,
          fmt::format(
              "found the topic '{}' for both '{}' and '{}'; expected a topic of its own for each",
              *name, same->second, key));
    }
    *topic = *name;
  }
  map.refuse_unknown_keys();
}

}  // namespace

void read_dds(const YamlNode& node, Cell& cell, Diagnostics& diagnostics) {
  MapReader map(node, "the dds settings", diagnostics);
  if (const YamlNode* domain = map.optional("domain")) {
    if (const auto id = read_integer(*domain, 0, kMaxDomain, "a DDS domain", diagnostics))
      cell.domain = static_cast<std::uint32_t>(*id);
  }
  if (const YamlNode* partition = map.optional("partition")) {
    cell.partition = read_text(*partition, "a DDS partition", diagnostics).value_or("");
    if (!is_partition(cell.partition)) {
      diagnostics.add(
          *partition,
          fmt::format(
              "found {}; expected a partition of at most {} bytes without wildcards (* ? [)",
              describe(*partition), kMaxDdsName));
    }
  }
  if (const YamlNode* interface = map.optional("interface")) {
    cell.interface =
        read_text(*interface, "lo, default, ros or the name of a network card", diagnostics)
            .value_or("");
  }
  if (const YamlNode* topics = map.optional("topics"))
    read_topics(*topics, cell.topics, diagnostics);
  const YamlNode* publish = map.optional("publish");
  const YamlNode* full = map.optional("full_every_s");
  const auto what = publish == nullptr ? std::optional<std::string>("all")
                                       : read_text(*publish, "'all' or 'changes'", diagnostics);
  if (what && *what != "all" && *what != "changes")
    diagnostics.add(*publish, fmt::format("found {}; expected 'all' or 'changes': the pairs that "
                                          "a report carries",
                                          describe(*publish)));
  if (what == "changes") cell.full_every_s = 1.0;
  if (full != nullptr) {
    const auto every =
        read_number(*full, kFullReports, "seconds between full reports", diagnostics);
    if (what == "all")
      diagnostics.add(*full, "found full_every_s without 'publish: changes'; expected both");
    if (what == "changes") cell.full_every_s = every.value_or(1.0);
  }
  map.refuse_unknown_keys();
}

}  // namespace clearance
