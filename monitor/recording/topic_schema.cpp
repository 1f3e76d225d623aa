#include "monitor/recording/topic_schema.hpp"

#include <algorithm>
#include <cctype>
#include <set>
#include <utility>
#include <vector>

namespace clearance {
namespace {

constexpr std::string_view kScope = "clearance::msg::";

std::string without_comments(std::string_view idl) {
  std::string text;
  for (std::size_t i = 0; i < idl.size(); ++i) {
    if (idl.substr(i, 2) == "//") i = std::min(idl.find('\n', i), idl.size());
    if (i < idl.size()) text += idl[i];
  }
  return text;
}

std::set<std::string> words(std::string_view text) {
  std::set<std::string> found;
  std::string word;
  for (const char c : text) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_') {
      word += c;
    } else if (!word.empty()) {
      found.insert(std::exchange(word, {}));
    }
  }
  return found;
}

struct Definition {
  std::string name;
  std::string text;
};

// From `begin` to where the brackets that follow are closed, and the semicolon.
std::size_t end_of_definition(std::string_view text, std::size_t begin) {
  int depth = 0;
  for (std::size_t i = begin; i < text.size(); ++i) {
    if (text[i] == '{') ++depth;
    if (text[i] == '}') --depth;
    if (text[i] == ';' && depth == 0) return i + 1;
  }
  return text.size();
}

std::string name_after(std::string_view text, std::string_view keyword) {
  const std::size_t begin = text.find(keyword) + keyword.size();
  const std::size_t end = std::min(text.find_first_of(" {\n", begin), text.size());
  return std::string(text.substr(begin, end - begin));
}

// Constants and structs in the order of the text.
std::vector<Definition> definitions(const std::string& text) {
  std::vector<Definition> found;
  std::size_t at = 0;
  for (;;) {
    at = std::min(text.find("const unsigned long ", at), text.find("@final struct ", at));
    if (at == std::string::npos) return found;
    const std::size_t end = end_of_definition(text, at);
    const std::string body = text.substr(at, end - at);
    const bool constant = body.starts_with("const");
    found.push_back({name_after(body, constant ? "const unsigned long " : "struct "), body});
    at = end;
  }
}

}  // namespace

std::string self_contained_idl(std::string_view idl, std::string_view type) {
  const std::vector<Definition> all = definitions(without_comments(idl));
  std::set<std::string> needed = {std::string(type)};
  std::vector<std::string> kept;
  // Backwards: whatever a definition uses stands before it.
  for (auto definition = all.rbegin(); definition != all.rend(); ++definition) {
    if (!needed.contains(definition->name)) continue;
    needed.merge(words(definition->text));
    kept.push_back(definition->text);
  }
  if (kept.empty()) return {};
  std::string text = "module clearance {\nmodule msg {\n";
  for (auto definition = kept.rbegin(); definition != kept.rend(); ++definition) {
    text += *definition + "\n";
  }
  return text + "};\n};\n";
}

const dds_topic_descriptor_t& descriptor(TopicKind kind) noexcept {
  switch (kind) {
    case TopicKind::kCatalogue:
      return clearance_msg_Catalogue_desc;
    case TopicKind::kPoses:
      return clearance_msg_PoseBatch_desc;
    case TopicKind::kDistances:
      return clearance_msg_Distances_desc;
    case TopicKind::kZones:
      return clearance_msg_ZoneState_desc;
    case TopicKind::kHealth:
      return clearance_msg_Health_desc;
  }
  __builtin_unreachable();
}

const std::string& topic_name(const Topics& topics, TopicKind kind) noexcept {
  switch (kind) {
    case TopicKind::kCatalogue:
      return topics.catalogue;
    case TopicKind::kPoses:
      return topics.poses;
    case TopicKind::kDistances:
      return topics.distances;
    case TopicKind::kZones:
      return topics.zones;
    case TopicKind::kHealth:
      return topics.health;
  }
  __builtin_unreachable();
}

std::optional<TopicKind> topic_kind(std::string_view type_name) noexcept {
  for (const TopicKind kind : kTopicKinds) {
    if (type_name == descriptor(kind).m_typename) return kind;
  }
  return std::nullopt;
}

const McapSchema& topic_schema(TopicKind kind) {
  static const std::array<McapSchema, kTopicKinds.size()> kSchemas = [] {
    std::array<McapSchema, kTopicKinds.size()> all;
    for (const TopicKind each : kTopicKinds) {
      const std::string name = descriptor(each).m_typename;
      all[static_cast<std::size_t>(each)] = {
          name, std::string(kIdlEncoding),
          self_contained_idl(kIdlText, name.substr(kScope.size()))};
    }
    return all;
  }();
  return kSchemas[static_cast<std::size_t>(kind)];
}

}  // namespace clearance
