#include "config/yaml/yaml_node.hpp"

#include <gtest/gtest.h>

namespace clearance {
namespace {

YamlNode tree(const std::string& text) {
  auto result = parse_yaml(text);
  if (const auto* fault = std::get_if<YamlFault>(&result)) {
    ADD_FAILURE() << fault->line << ":" << fault->column << ": " << fault->reason;
    return {};
  }
  return std::get<YamlNode>(std::move(result));
}

YamlFault fault(const std::string& text) {
  const auto result = parse_yaml(text);
  if (const auto* found = std::get_if<YamlFault>(&result)) return *found;
  ADD_FAILURE() << "was accepted: " << text;
  return {};
}

TEST(YamlNode, KnowsLineAndColumnOfEveryKeyAndValue) {
  const YamlNode root = tree("# a comment\nname: cell\nlist:\n  - one\n  - {key: 2}\n");
  ASSERT_EQ(root.entries.size(), 2u);
  EXPECT_EQ(root.entries[0].key.line, 2);
  EXPECT_EQ(root.entries[0].value.column, 7);
  const YamlNode& list = root.entries[1].value;
  ASSERT_EQ(list.items.size(), 2u);
  EXPECT_EQ(list.items[0].line, 4);
  EXPECT_EQ(list.items[0].column, 5);
  EXPECT_EQ(list.items[1].entries[0].value.line, 5);
  EXPECT_EQ(list.items[1].entries[0].value.column, 11);
}

TEST(YamlNode, QuotedTextIsToldFromPlainScalars) {
  const YamlNode root = tree("[12, \"12\", '12', text]");
  ASSERT_EQ(root.items.size(), 4u);
  EXPECT_FALSE(root.items[0].quoted);
  EXPECT_TRUE(root.items[1].quoted);
  EXPECT_TRUE(root.items[2].quoted);
  EXPECT_FALSE(root.items[3].quoted);
}

TEST(YamlNode, RepeatedKeysAreBothKept) {
  const YamlNode root = tree("a: 1\na: 2\n");
  ASSERT_EQ(root.entries.size(), 2u);
  EXPECT_EQ(root.entries[1].value.text, "2");
}

TEST(YamlNode, AnAliasIsACopyOfItsAnchor) {
  const YamlNode root = tree("a: &here {x: [1, 2]}\nb: *here\n");
  ASSERT_EQ(root.entries.size(), 2u);
  ASSERT_EQ(root.entries[1].value.entries.size(), 1u);
  EXPECT_EQ(root.entries[1].value.entries[0].value.items.size(), 2u);
}

TEST(YamlNode, BrokenYamlIsLocated) {
  EXPECT_EQ(fault("a: 1\nb: [1, 2\n").line, 3);
  EXPECT_EQ(fault("a: 1\n\tb: 2\n").line, 2);
  EXPECT_EQ(fault("a: *nowhere\n").line, 1);
}

TEST(YamlNode, ASecondDocumentIsRefused) {
  const YamlFault found = fault("a: 1\n---\nb: 2\n");
  EXPECT_EQ(found.line, 3);
  EXPECT_NE(found.reason.find("second document"), std::string::npos);
}

TEST(YamlNode, WhatIsNotUtf8IsRefusedWhereItStands) {
  EXPECT_EQ(tree("name: \u00e9\u20ac\U0001F916\n").entries.size(), 1u);
  // Latin-1, a truncated character, an overlong one, a surrogate, and a value above Unicode's
  // range.
  for (const char* bytes : {"\xff", "\xe2\x82", "\xc0\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80"}) {
    const YamlFault found = fault("a: 1\nname: fl" + std::string(bytes) + "\n");
    EXPECT_EQ(found.line, 2);
    EXPECT_EQ(found.column, 9);
    EXPECT_NE(found.reason.find("expected the file in UTF-8"), std::string::npos);
  }
}

TEST(YamlNode, AliasesOfAliasesCannotExhaustMemory) {
  std::string text = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 12; ++i) {
    const std::string last = "*a" + std::to_string(i - 1);
    text += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + last;
    for (int k = 1; k < 10; ++k) text += ", " + last;
    text += "]\n";
  }
  EXPECT_NE(fault(text).reason.find("more than a million"), std::string::npos);
}

TEST(YamlNode, BottomlessNestingIsRefused) {
  EXPECT_FALSE(fault(std::string(100'000, '[')).reason.empty());
}

TEST(YamlNode, AnEmptyTextIsNothing) { EXPECT_EQ(tree("").kind, YamlNode::Kind::kNull); }

}  // namespace
}  // namespace clearance
