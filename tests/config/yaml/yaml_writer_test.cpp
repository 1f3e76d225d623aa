#include "config/yaml/yaml_writer.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <variant>

namespace clearance {
namespace {

YamlNode tree_of(const std::string& text) {
  auto parsed = parse_yaml(text);
  if (const auto* fault = std::get_if<YamlFault>(&parsed)) ADD_FAILURE() << fault->reason;
  return std::holds_alternative<YamlNode>(parsed) ? std::get<YamlNode>(std::move(parsed))
                                                  : YamlNode{};
}

TEST(YamlWriter, ContentDecidesTheLineAndNotHowItWasWritten) {
  const std::string line =
      "{name: a, groups: [b, c d], fixed: true, size: [1, 0.25, -300], margin: 0}";
  EXPECT_EQ(line_of(tree_of(line)), line);
  EXPECT_EQ(line_of(tree_of("margin: 0.00\nsize: [1.0, 0.25, -3e2]\nfixed: True\n'name': \"a\"\n"
                            "groups:\n- b\n- 'c d'\n")),
            line);
}

TEST(YamlWriter, TextIsQuotedWhereItWouldReadAsSomethingElse) {
  for (const std::string text : {"12",   "true", "null", "",         " a",  "a ",  "a: b", "[a",
                                 "a#b",  "&a",   "*a",   "-a",       "~",   "a,b", "\"",   "\\",
                                 "a\nb", "a\tb", "\x7f", "\xc3\xa4", "1e3", ".5",  ".inf", "No"}) {
    YamlNode list;
    list.kind = YamlNode::Kind::kSequence;
    list.items = {text_node(text), text_node("end")};
    const YamlNode read = tree_of(line_of(list));
    ASSERT_EQ(read.items.size(), 2u) << line_of(list);
    EXPECT_EQ(read.items[0].text, text);
    EXPECT_EQ(line_of(read), line_of(list));
    EXPECT_TRUE(same_content(tree_of(list_item(list, 3)).items.at(0), read));
  }
}

TEST(YamlWriter, NumbersReadBackAsTheSameDouble) {
  for (const double value : {0.1, 1.0 / 3.0, 1e-300, 5e-324, 1.7976931348623157e308, -2.5, 1e21}) {
    EXPECT_EQ(std::strtod(line_of(number_node(value)).c_str(), nullptr), value);
    EXPECT_EQ(line_of(tree_of(line_of(number_node(value)))), line_of(number_node(value)));
  }
  EXPECT_EQ(line_of(number_node(-0.0)), "0");
  EXPECT_EQ(line_of(tree_of("-0")), "-0") << "a cell that says so keeps its bits";
}

TEST(YamlWriter, LongValuesBecomeBlocks) {
  const std::string name(60, 'n');
  const YamlNode item = tree_of("{name: " + name + ", groups: [" + name + ", " + name +
                                "], parts: [{box: {size: [1, 2, 3]}, name: " + name +
                                "}, {name: " + name + ", sphere: {radius: 1}}]}");
  EXPECT_EQ(list_item(item, 2), "  - name: " + name + "\n    groups: [" + name + ", " + name +
                                    "]\n    parts:\n      - {name: " + name +
                                    ", box: {size: [1, 2, 3]}}\n      - {name: " + name +
                                    ", sphere: {radius: 1}}\n");
  EXPECT_EQ(line_of(tree_of(list_item(item, 2)).items.at(0)), line_of(item));
}

TEST(YamlWriter, AMapIsEditedByItsKeys) {
  YamlNode map = tree_of("{a: 1, b: 2}");
  set(map, "b", number_node(3.0));
  set(map, "c", flag_node(false));
  erase(map, "a");
  EXPECT_EQ(line_of(map), "{b: 3, c: false}");
  EXPECT_EQ(find(map, "a"), nullptr);
  EXPECT_TRUE(same_content(map, tree_of("b: 3\nc: false\n")));
  EXPECT_FALSE(same_content(map, tree_of("c: false\nb: 3\n")));
}

}  // namespace
}  // namespace clearance
