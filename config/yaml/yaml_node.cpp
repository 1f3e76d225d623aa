// Reads YAML of any origin with yaml-cpp, whose exceptions end here.
#include "config/yaml/yaml_node.hpp"

#include <fmt/format.h>

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <map>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include "config/text/utf8.hpp"

namespace clearance {
namespace {

// Aliases of aliases can make a short file enormous, so this limits how many values they add in
// total.
constexpr std::size_t kMaxCopies = 1'000'000;

// Faults that the parser does not find.
constexpr const char* kAliasOfItself = "an alias inside of the value that it stands for";
constexpr const char* kTooManyCopies = "aliases that stand for more than a million values";

// The advice for one kind of mistake.
struct Remedy {
  std::string_view fault;  // the beginning of the parser's message
  const char* expected;
};

// The most frequent mistakes; the parser tells only where it failed.
const std::array<Remedy, 13> kRemedies{{
    {YAML::ErrorMsg::END_OF_MAP_FLOW, "',' or '}' after a value inside of '{'"},
    {YAML::ErrorMsg::END_OF_MAP, "another key as far to the right as the one before, or the end"},
    {YAML::ErrorMsg::END_OF_SEQ_FLOW, "',' or ']' after a value inside of '['"},
    {YAML::ErrorMsg::END_OF_SEQ, "another '- ' as far to the right as the one before, or the end"},
    {YAML::ErrorMsg::FLOW_END, "a '[' or '{' before it"},
    {YAML::ErrorMsg::TAB_IN_INDENTATION, "blanks: YAML takes no tabs there"},
    {YAML::ErrorMsg::EOF_IN_SCALAR, "a closing quote"},
    {YAML::ErrorMsg::MAP_VALUE,
     "one 'key: value' a line, no tabs before it, quotes around a text with ': '"},
    {YAML::ErrorMsg::MAP_KEY, "one 'key: value' a line"},
    {YAML::ErrorMsg::BLOCK_ENTRY, "'- ' at the start of a line, in a list of its own"},
    {YAML::ErrorMsg::UNKNOWN_ANCHOR, "an anchor (&name) of this name above"},
    {kAliasOfItself, "an alias (*name) after the value that its anchor marks"},
    {kTooManyCopies, "fewer"},
}};

// Returns the advice that belongs to the parser's message.
std::string remedy_for(const std::string& fault) {
  const auto remedy = std::ranges::find_if(
      kRemedies, [&](const Remedy& known) { return fault.starts_with(known.fault); });
  return remedy != kRemedies.end() ? remedy->expected
                                   : "valid YAML; see also the end of the line before";
}

// Counts the values in a tree, which each alias to it adds again.
std::size_t count_nodes(const YamlNode& node) {
  std::size_t count = 1;
  for (const YamlNode& item : node.items) count += count_nodes(item);
  for (const YamlEntry& entry : node.entries)
    count += count_nodes(entry.key) + count_nodes(entry.value);
  return count;
}

// Builds the tree from the parser's events.
class TreeBuilder : public YAML::EventHandler {
 public:
  YamlNode root;

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    finish(node_at(mark, YamlNode::Kind::kNull), anchor);
  }

  // An anchor is known once its value is finished, so an alias inside of its own value is found
  // here as well.
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto found = anchored_.find(anchor);
    if (found == anchored_.end()) {
      throw YAML::ParserException(mark, kAliasOfItself);
    }
    copies_ += count_nodes(found->second);
    if (copies_ > kMaxCopies) {
      throw YAML::ParserException(mark, kTooManyCopies);
    }
    finish(YamlNode(found->second), 0);
  }

  // yaml-cpp tells quoted scalars from plain ones by their tag alone.
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    YamlNode node = node_at(mark, YamlNode::Kind::kScalar);
    node.text = value;
    node.quoted = tag == "!";  // the parser's tag for quoted and block scalars; "?" is a plain one
    finish(std::move(node), anchor);
  }

  // Tags and styles of collections mean nothing here.
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open_.push_back({node_at(mark, YamlNode::Kind::kSequence), anchor, {}, false});
  }

  void OnSequenceEnd() override { close(); }

  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open_.push_back({node_at(mark, YamlNode::Kind::kMap), anchor, {}, false});
  }

  void OnMapEnd() override { close(); }

 private:
  // A sequence or map whose end has not come yet.
  struct Open {
    YamlNode node;
    YAML::anchor_t anchor;
    YamlNode key;
    bool has_key;
  };

  // Marks of yaml-cpp count from 0, those of editors from 1.
  static YamlNode node_at(const YAML::Mark& mark, YamlNode::Kind kind) {
    YamlNode node;
    node.kind = kind;
    node.line = mark.line + 1;
    node.column = mark.column + 1;
    return node;
  }

  // The innermost sequence or map is finished.
  void close() {
    Open done = std::move(open_.back());
    open_.pop_back();
    finish(std::move(done.node), done.anchor);
  }

  // A finished value belongs to the innermost open one, or is the document.
  void finish(YamlNode node, YAML::anchor_t anchor) {
    if (anchor != 0) anchored_[anchor] = node;
    if (open_.empty()) {
      root = std::move(node);
    } else if (Open& parent = open_.back(); parent.node.kind == YamlNode::Kind::kSequence) {
      parent.node.items.push_back(std::move(node));
    } else if (parent.has_key) {
      parent.node.entries.push_back({std::move(parent.key), std::move(node)});
      parent.has_key = false;
    } else {
      parent.key = std::move(node);
      parent.has_key = true;
    }
  }

  std::vector<Open> open_;
  std::map<YAML::anchor_t, YamlNode> anchored_;
  std::size_t copies_ = 0;
};

// yaml-cpp takes bytes that are not UTF-8 and passes them on, to logs and to the wire.
std::optional<YamlFault> fault_of_encoding(const std::string& text) {
  const std::size_t end = end_of_utf8(text);
  if (end == text.size()) return std::nullopt;
  const std::string before = text.substr(0, end);
  const auto line = 1 + std::ranges::count(before, '\n');
  const std::size_t column = end - (before.rfind('\n') + 1) + 1;  // npos + 1 is 0
  return YamlFault{static_cast<int>(line), static_cast<int>(column),
                   "found a byte that is not UTF-8; expected the file in UTF-8"};
}

}  // namespace

// Lengths precede texts, and counts precede lists.
void add_content(const YamlNode& node, std::string& bytes) {
  const auto add_number = [&](std::size_t number) {
    std::array<char, 24> text;
    const auto end = std::to_chars(text.data(), text.data() + text.size(), number);
    bytes.append(text.data(), end.ptr);
  };
  switch (node.kind) {
    case YamlNode::Kind::kNull:
      bytes += '~';
      return;
    case YamlNode::Kind::kScalar:
      bytes += node.quoted ? '"' : '\'';
      add_number(node.text.size());
      bytes += ' ';
      bytes += node.text;
      return;
    case YamlNode::Kind::kSequence:
      bytes += '[';
      add_number(node.items.size());
      for (const YamlNode& item : node.items) add_content(item, bytes);
      return;
    case YamlNode::Kind::kMap:
      bytes += '{';
      add_number(node.entries.size());
      for (const YamlEntry& entry : node.entries) {
        add_content(entry.key, bytes);
        add_content(entry.value, bytes);
      }
      return;
  }
}

// Exceptions of the parser end here.
std::variant<YamlNode, YamlFault> parse_yaml(const std::string& text) {
  if (const auto fault = fault_of_encoding(text)) return *fault;
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    TreeBuilder tree;
    if (!parser.HandleNextDocument(tree)) return YamlNode{};
    TreeBuilder second;
    if (parser.HandleNextDocument(second)) {
      return YamlFault{second.root.line, second.root.column,
                       "found a second document; expected one a file"};
    }
    return std::move(tree.root);
  } catch (const YAML::Exception& fault) {
    return YamlFault{std::max(fault.mark.line, 0) + 1, std::max(fault.mark.column, 0) + 1,
                     fmt::format("found what is not valid YAML ({}); expected {}", fault.msg,
                                 remedy_for(fault.msg))};
  }
}

}  // namespace clearance
