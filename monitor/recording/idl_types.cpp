// A reader by recursive descent over words and punctuation.
#include "monitor/recording/idl_types.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <utility>

namespace clearance {
namespace {

// The numbers of IDL 4.2, section 7.4.1.4.4.2, that CDR writes as they are.
constexpr std::array<std::pair<std::string_view, std::uint32_t>, 10> kNumbers = {
    {{"octet", 1},
     {"boolean", 1},
     {"short", 2},
     {"unsigned short", 2},
     {"long", 4},
     {"unsigned long", 4},
     {"float", 4},
     {"long long", 8},
     {"unsigned long long", 8},
     {"double", 8}}};

constexpr std::uint32_t kMostElements = 1024;

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

// Words and single characters of punctuation; comments and blanks are passed over.
std::vector<std::string> tokens_of(std::string_view text) {
  std::vector<std::string> tokens;
  for (std::size_t i = 0; i < text.size();) {
    if (text.substr(i, 2) == "//") {
      i = std::min(text.find('\n', i), text.size());
    } else if (std::isspace(static_cast<unsigned char>(text[i])) != 0) {
      ++i;
    } else {
      const std::size_t begin = i++;
      while (is_word(text[begin]) && i < text.size() && is_word(text[i])) ++i;
      tokens.emplace_back(text.substr(begin, i - begin));
    }
  }
  return tokens;
}

class Parser {
 public:
  explicit Parser(std::string_view text) : tokens_(tokens_of(text)) {}

  IdlTypes parse() {
    while (ok() && at_ < tokens_.size()) definition();
    if (depth_ != 0) fail("the end, within a module");
    return std::move(found_);
  }

 private:
  [[nodiscard]] bool ok() const { return found_.error.empty(); }
  [[nodiscard]] std::string_view peek() const {
    return at_ < tokens_.size() ? std::string_view(tokens_[at_]) : std::string_view();
  }
  std::string take() { return at_ < tokens_.size() ? tokens_[at_++] : std::string(); }
  bool take_if(std::string_view token) {
    const bool is_it = peek() == token;
    if (is_it) ++at_;
    return is_it;
  }
  void expect(std::string_view token) {
    if (ok() && !take_if(token)) fail(fmt::format("'{}'; expected '{}'", peek(), token));
  }
  void fail(const std::string& found) {
    if (ok()) found_.error = fmt::format("found {}", found);
  }

  void definition() {
    if (take_if("module")) {
      take();
      expect("{");
      ++depth_;
    } else if (depth_ > 0 && take_if("}")) {
      expect(";");
      --depth_;
    } else if (take_if("const")) {
      while (ok() && peek() != ";" && !peek().empty()) take();
      expect(";");
    } else if (take_if("@")) {
      expect("final");
      expect("struct");
      structure();
    } else {
      fail(fmt::format("'{}'; expected a module, a constant or a @final struct", peek()));
    }
  }

  void structure() {
    auto made = std::make_shared<IdlStruct>();
    made->name = take();
    expect("{");
    while (ok() && !take_if("}")) {
      if (take_if("@")) expect("key");
      IdlType type = this->type();
      std::string name = take();
      if (take_if("[")) type = array_of(type);
      made->fields.push_back({std::move(name), std::move(type)});
      expect(";");
    }
    expect(";");
    if (ok()) found_.structs[made->name] = made;
  }

  IdlType type() {
    if (take_if("string")) {
      bound();
      return {.kind = IdlType::Kind::kString, .name = "string"};
    }
    if (take_if("sequence")) {
      expect("<");
      IdlType made{.kind = IdlType::Kind::kSequence, .name = "sequence"};
      made.element = std::make_shared<IdlType>(type());
      if (take_if(",")) take();
      expect(">");
      return made;
    }
    std::string name = take();
    while (peek() == "long" || peek() == "short") name += " " + take();
    const auto number = std::ranges::find(kNumbers, name, &decltype(kNumbers)::value_type::first);
    if (number != kNumbers.end())
      return {.kind = IdlType::Kind::kNumber, .name = name, .size = number->second};
    const auto known = found_.structs.find(name);
    if (known == found_.structs.end()) {
      fail(fmt::format("the type '{}'", name));
      return {};
    }
    return {.kind = IdlType::Kind::kStruct, .name = name, .fields = known->second};
  }

  // "3]" behind an opening bracket. The elements stand in a row, as fields do.
  IdlType array_of(const IdlType& element) {
    const std::string length = take();
    expect("]");
    std::uint32_t count = 0;
    const auto read = std::from_chars(length.data(), length.data() + length.size(), count);
    if (read.ptr != length.data() + length.size() || count == 0 || count > kMostElements)
      fail(fmt::format("'{}'; expected an array of 1 to {} elements", length, kMostElements));
    auto made = std::make_shared<IdlStruct>();
    made->name = fmt::format("{}[{}]", element.name, length);
    for (std::uint32_t i = 0; ok() && i < count; ++i)
      made->fields.push_back({std::to_string(i), element});
    return {.kind = IdlType::Kind::kStruct, .name = made->name, .fields = made};
  }

  // "<32>", which the layout does not depend on.
  void bound() {
    if (!take_if("<")) return;
    take();
    expect(">");
  }

  std::vector<std::string> tokens_;
  std::size_t at_ = 0;
  int depth_ = 0;  // modules
  IdlTypes found_;
};

}  // namespace

IdlTypes parse_idl(std::string_view text) { return Parser(text).parse(); }

}  // namespace clearance
