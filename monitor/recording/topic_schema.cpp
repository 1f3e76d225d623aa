// Cuts from the text of clearance.idl the definitions that one type needs, backwards from the type.
// This is no IDL parser: it relies on how that file is written.
#include "monitor/recording/topic_schema.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <set>
#include <utility>
#include <vector>

namespace clearance {
namespace {

constexpr std::string_view kScope = "clearance::msg::";

// Comments would be found by the search for names.
std::string without_comments(std::string_view idl) {
  std::string text;
  for (std::size_t i = 0; i < idl.size(); ++i) {
    if (idl.substr(i, 2) == "//") i = std::min(idl.find('\n', i), idl.size());
    if (i < idl.size()) text += idl[i];
  }
  return text;
}

// Identifiers in a definition: the names of everything that it may use, and more.
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

// A constant or struct, from its keyword to its semicolon.
struct Definition {
  std::string name;
  std::string text;
};

// The end of a definition: the semicolon behind the brackets that open after `begin`.
std::size_t end_of_definition(std::string_view text, std::size_t begin) {
  int depth = 0;
  for (std::size_t i = begin; i < text.size(); ++i) {
    if (text[i] == '{') ++depth;
    if (text[i] == '}') --depth;
    if (text[i] == ';' && depth == 0) return i + 1;
  }
  return text.size();
}

// The word that follows the keyword.
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

// Readers of MCAP parse the schema alone, so it holds every type that the topic's type needs.
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
    text += fmt::format("{}\n", *definition);
  }
  return fmt::format("{}}};\n}};\n", text);
}

// This costs one comparison per topic, once for each channel.
std::optional<TopicKind> topic_kind(std::string_view type_name) noexcept {
  for (const Topic& topic : kRecordedTopics) {
    if (type_name == topic.type->m_typename) return topic.kind;
  }
  return std::nullopt;
}

std::string_view type_of(TopicKind kind) noexcept {
  return std::string_view(topic(kind).type->m_typename).substr(kScope.size());
}

const char* name(SideTopic topic) noexcept {
  return topic == SideTopic::kFrames ? "clearance/frames" : "clearance/states";
}

const McapSchema& side_schema(SideTopic topic) {
  static const McapSchema kFrames{"clearance::msg::SensorFrame", std::string(kIdlEncoding),
                                  self_contained_idl(kFramesIdlText, "SensorFrame")};
  static const McapSchema kStates{"clearance::msg::PartnerState", std::string(kIdlEncoding),
                                  self_contained_idl(kPartnersIdlText, "PartnerState")};
  return topic == SideTopic::kFrames ? kFrames : kStates;
}

// Made once, on first use; initialisation of statics is thread-safe.
const McapSchema& topic_schema(TopicKind kind) {
  static const std::array<McapSchema, kRecordedTopics.size()> kSchemas = [] {
    std::array<McapSchema, kRecordedTopics.size()> all;
    for (const Topic& each : kRecordedTopics) {
      all[index(each.kind)] = {each.type->m_typename, std::string(kIdlEncoding),
                               self_contained_idl(kIdlText, type_of(each.kind))};
    }
    return all;
  }();
  return kSchemas[index(kind)];
}

}  // namespace clearance
