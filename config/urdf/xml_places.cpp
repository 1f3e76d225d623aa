// Start tags stand in the text in the order in which elements stand in the document.
#include "config/urdf/xml_places.hpp"

#include <algorithm>

namespace clearance {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";

// Returns the place behind `end`, or the end of the text.
std::size_t after(std::string_view text, std::string_view end, std::size_t from) {
  const std::size_t found = text.find(end, from);
  return found == text.npos ? text.size() : found + end.size();
}

// Returns the place behind the '>' of a tag; quoted values may contain one.
std::size_t end_of_tag(std::string_view text, std::size_t at) {
  while (at < text.size() && text[at] != '>') {
    const bool quoted = text[at] == '"' || text[at] == '\'';
    at = quoted ? after(text, text.substr(at, 1), at + 1) : at + 1;
  }
  return at;
}

// Finds the '<' of every element, outside of comments and other markup.
std::vector<std::size_t> start_tags(std::string_view text) {
  std::vector<std::size_t> tags;
  for (std::size_t at = text.find('<'); at < text.size(); at = text.find('<', at)) {
    const std::string_view rest = text.substr(at);
    if (rest.starts_with("<!--")) {
      at = after(text, "-->", at);
    } else if (rest.starts_with("<![CDATA[")) {
      at = after(text, "]]>", at);
    } else if (rest.starts_with("<?")) {
      at = after(text, "?>", at);
    } else if (rest.starts_with("<!") || rest.starts_with("</")) {
      at = after(text, ">", at);
    } else {
      tags.push_back(at);
      at = end_of_tag(text, at);
    }
  }
  return tags;
}

}  // namespace

XmlPlaces::XmlPlaces(std::string_view text, const tinyxml2::XMLDocument& document) : text_(text) {
  lines_.push_back(0);
  for (std::size_t at = text.find('\n'); at != text.npos; at = text.find('\n', at + 1))
    lines_.push_back(at + 1);
  struct Elements : tinyxml2::XMLVisitor {
    std::vector<const tinyxml2::XMLElement*> all;
    bool VisitEnter(const tinyxml2::XMLElement& element, const tinyxml2::XMLAttribute*) override {
      all.push_back(&element);
      return true;
    }
  } elements;
  document.Accept(&elements);
  const std::vector<std::size_t> tags = start_tags(text);
  for (std::size_t i = 0; i < std::min(tags.size(), elements.all.size()); ++i)
    tags_[elements.all[i]] = tags[i];
}

UrdfPlace XmlPlaces::at(std::size_t offset) const {
  const auto next = std::upper_bound(lines_.begin(), lines_.end(), offset);
  return {static_cast<int>(next - lines_.begin()), static_cast<int>(offset - *(next - 1)) + 1};
}

UrdfPlace XmlPlaces::of(const tinyxml2::XMLElement& element) const {
  const auto tag = tags_.find(&element);
  return tag == tags_.end() ? UrdfPlace{element.GetLineNum(), 1} : at(tag->second);
}

UrdfPlace XmlPlaces::of(const tinyxml2::XMLElement& element, std::string_view attribute) const {
  const auto tag = tags_.find(&element);
  if (tag == tags_.end()) return of(element);
  std::size_t at_name = tag->second + 1 + std::string_view(element.Name()).size();
  for (;;) {
    at_name = text_.find_first_not_of(kBlanks, at_name);
    const std::size_t equals = text_.find('=', at_name);
    const std::size_t quote = text_.find_first_of("\"'", equals);
    if (at_name == text_.npos || quote == text_.npos) return of(element);
    const std::string_view name = text_.substr(at_name, equals - at_name);
    if (name.substr(0, name.find_last_not_of(kBlanks) + 1) == attribute) return at(at_name);
    at_name = after(text_, text_.substr(quote, 1), quote + 1);
  }
}

}  // namespace clearance
