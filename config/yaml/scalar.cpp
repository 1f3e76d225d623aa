// Classifies a scalar by the core schema of YAML 1.2 (section 10.3.2), in decimals only, and
// converts it with std::from_chars. A hint at the probable meaning goes with a value of the wrong
// type.
#include "config/yaml/scalar.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <system_error>

#include "config/yaml/diagnostics.hpp"

namespace clearance {
namespace {

// The longest name that the wire carries (idl/clearance.idl, ZoneState::name).
constexpr std::size_t kMaxName = 64;

constexpr std::size_t kShown = 60;  // bytes of a text that a message repeats

// A text from the file may be a whole document by mistake; its beginning identifies it.
std::string shortened(const std::string& text) {
  return text.size() <= kShown ? text : fmt::format("{}...", text.substr(0, kShown));
}

// The number that a text may be.
struct Parsed {
  double value = 0.0;
  bool number = false;    // the whole text is one
  bool in_range = false;  // it fits into a double
};

// The three spellings that YAML 1.2 allows for its special values.
bool is_special(const std::string& text, const std::string& lower, const std::string& title,
                const std::string& upper) {
  return text == lower || text == title || text == upper;
}

// Parses YAML's numbers in decimals. std::from_chars depends on no locale and rounds correctly.
Parsed parse_number(const std::string& text) {
  std::string unsigned_text = text;
  if (!text.empty() && (text[0] == '+' || text[0] == '-')) unsigned_text.erase(0, 1);
  if (is_special(unsigned_text, ".inf", ".Inf", ".INF")) {
    return {text[0] == '-' ? -HUGE_VAL : HUGE_VAL, true, true};
  }
  if (is_special(text, ".nan", ".NaN", ".NAN")) return {std::nan(""), true, true};
  // from_chars would also take "inf", "nan" and a second sign; a YAML number begins with a digit or
  // a dot.
  if (unsigned_text.empty() ||
      !(std::isdigit(static_cast<unsigned char>(unsigned_text[0])) || unsigned_text[0] == '.')) {
    return {};
  }
  double value = 0.0;
  const char* end = unsigned_text.data() + unsigned_text.size();
  const auto result = std::from_chars(unsigned_text.data(), end, value);
  if (result.ec == std::errc::invalid_argument || result.ptr != end) return {};
  return {text[0] == '-' ? -value : value, true, result.ec == std::errc()};
}

// Writes a number as a person would: 0.001, 10000, 1e+12.
std::string shown(double value) {
  std::array<char, 64> text;
  const auto format = std::fabs(value) < 1e9 && std::fabs(value) >= 1e-4
                          ? std::chars_format::fixed
                          : std::chars_format::general;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value, format);
  return {text.data(), end.ptr};
}

// Names every limit of the range.
std::string expectation(const std::string& what, const Range& range) {
  const bool limited = std::isfinite(range.most);
  if (!std::isfinite(range.least))
    return what + (limited ? fmt::format(", at most {}", shown(range.most)) : "");
  if (range.above_least) {
    return fmt::format("{}, more than {}{}", what, shown(range.least),
                       limited ? fmt::format(" and at most {}", shown(range.most)) : "");
  }
  return what + (limited ? fmt::format(", from {} to {}", shown(range.least), shown(range.most))
                         : fmt::format(", at least {}", shown(range.least)));
}

// "12 mm" begins with a number: the hint says how to write it.
std::string number_hint(const YamlNode& node) {
  if (node.kind != YamlNode::Kind::kScalar) return "";
  if (node.quoted && parse_number(node.text).number) return " (without the quotes)";
  double value = 0.0;
  const char* end = node.text.data() + node.text.size();
  const auto result = std::from_chars(node.text.data(), end, value);
  if (result.ec == std::errc() && result.ptr != end &&
      !std::isalpha(static_cast<unsigned char>(node.text[0]))) {
    return " (a bare number: units are stated once, under 'units')";
  }
  return "";
}

}  // namespace

// Numbers in hexadecimal or octal are text here: no cell needs them, and 0x10 is more often a name.
ScalarType scalar_type(const YamlNode& scalar) {
  if (scalar.quoted) return ScalarType::kText;
  if (is_special(scalar.text, "true", "True", "TRUE") ||
      is_special(scalar.text, "false", "False", "FALSE")) {
    return ScalarType::kFlag;
  }
  return parse_number(scalar.text).number ? ScalarType::kNumber : ScalarType::kText;
}

std::string describe(const YamlNode& node) {
  switch (node.kind) {
    case YamlNode::Kind::kNull:
      return "nothing";
    case YamlNode::Kind::kSequence:
      return node.items.empty() ? "an empty list" : fmt::format("a list of {}", node.items.size());
    case YamlNode::Kind::kMap:
      return "a map";
    case YamlNode::Kind::kScalar:
      break;
  }
  switch (scalar_type(node)) {
    case ScalarType::kNumber:
      return fmt::format("the number {}", shortened(node.text));
    case ScalarType::kFlag:
      return node.text;
    case ScalarType::kText:
      break;
  }
  return node.text.empty() ? "an empty text" : fmt::format("the text '{}'", shortened(node.text));
}

// There are three messages: for no number, for one that is not finite, and for one out of range.
std::optional<double> read_number(const YamlNode& node, const Range& range, const std::string& what,
                                  Diagnostics& diagnostics) {
  const auto expected = [&] { return fmt::format("; expected {}", expectation(what, range)); };
  if (node.kind != YamlNode::Kind::kScalar || scalar_type(node) != ScalarType::kNumber) {
    diagnostics.add(node,
                    fmt::format("found {}{}{}", describe(node), expected(), number_hint(node)));
    return std::nullopt;
  }
  const Parsed parsed = parse_number(node.text);
  if (!std::isfinite(parsed.value) || !parsed.in_range) {
    diagnostics.add(
        node, fmt::format("found {}, which is not a finite number{}", describe(node), expected()));
    return std::nullopt;
  }
  const bool too_small =
      range.above_least ? parsed.value <= range.least : parsed.value < range.least;
  if (too_small || parsed.value > range.most) {
    diagnostics.add(node, fmt::format("found {}{}", describe(node), expected()));
    return std::nullopt;
  }
  return parsed.value;
}

// Decimal digits only: 1e3 and 12.0 are refused, since a count is written as one.
std::optional<std::int64_t> read_integer(const YamlNode& node, std::int64_t least,
                                         std::int64_t most, const std::string& what,
                                         Diagnostics& diagnostics) {
  std::int64_t value = 0;
  const char* end = node.text.data() + node.text.size();
  const bool scalar = node.kind == YamlNode::Kind::kScalar && !node.quoted;
  const auto result = std::from_chars(node.text.data(), end, value);
  if (!scalar || result.ec != std::errc() || result.ptr != end || value < least || value > most) {
    diagnostics.add(node, fmt::format("found {}; expected {}, a whole number from {} to {}",
                                      describe(node), what, least, most));
    return std::nullopt;
  }
  return value;
}

// YAML 1.1 also had yes, no, on and off; they are texts in YAML 1.2 and refused here.
std::optional<bool> read_flag(const YamlNode& node, Diagnostics& diagnostics) {
  if (node.kind != YamlNode::Kind::kScalar || scalar_type(node) != ScalarType::kFlag) {
    diagnostics.add(node, fmt::format("found {}; expected true or false", describe(node)));
    return std::nullopt;
  }
  return node.text[0] == 't' || node.text[0] == 'T';
}

// A plain 12 or true is no text: a name that looks like a number is usually a value in the wrong
// place.
std::optional<std::string> read_text(const YamlNode& node, const std::string& what,
                                     Diagnostics& diagnostics) {
  if (node.kind != YamlNode::Kind::kScalar || scalar_type(node) != ScalarType::kText) {
    const bool quotable = node.kind == YamlNode::Kind::kScalar;
    diagnostics.add(
        node,
        fmt::format(
            "found {}; expected {}{}", describe(node), what,
            quotable ? fmt::format(" (if it is meant as text, quote it: \"{}\")", node.text) : ""));
    return std::nullopt;
  }
  return node.text;
}

// Names appear in CSV files, logs and bounded strings on the wire, so they are short and plain.
std::optional<std::string> read_name(const YamlNode& node, const std::string& what,
                                     Diagnostics& diagnostics) {
  const auto text = read_text(node, what, diagnostics);
  if (!text) return std::nullopt;
  const bool bad_byte = std::any_of(text->begin(), text->end(), [](char c) {
    return static_cast<unsigned char>(c) < 0x20 || c == 0x7f || c == ',' || c == '"';
  });
  // YAML itself strips blanks around plain scalars; only quoted ones can have them.
  const bool blank_ends = !text->empty() && (text->front() == ' ' || text->back() == ' ');
  if (text->empty() || text->size() > kMaxName || bad_byte || blank_ends) {
    diagnostics.add(node,
                    fmt::format("found {}; expected {}: 1 to {} bytes without commas, quotes, "
                                "control characters or blanks at its ends",
                                describe(node), what, kMaxName));
    return std::nullopt;
  }
  return text;
}

}  // namespace clearance
