#include "config/urdf/unread_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <utility>

#include "config/text/printable.hpp"
#include "config/text/sentences.hpp"
#include "config/text/spelling.hpp"
#include "config/text/words.hpp"

namespace clearance {
namespace {

using Element = tinyxml2::XMLElement;

// An attribute, an element or a text that no reader asked for.
struct Unread {
  const Element& in;
  std::string_view name;
  std::string shown;  // "the attribute 'x'"
  UrdfPlace place;
  bool is_geometry;  // it is, or contains, a word that places or sizes something
  bool is_neutral;   // such a word whose value changes nothing: zeros, or a scale of ones
};

// Tells whether the value is as if the attribute were missing.
bool is_neutral(const tinyxml2::XMLAttribute& attribute) {
  const std::string_view name = attribute.Name();
  if (name != "xyz" && name != "rpy" && name != "scale") return false;
  const double expected = name == "scale" ? 1.0 : 0.0;
  const char* at = attribute.Value();
  char* end = nullptr;
  int count = 0;
  for (double value = std::strtod(at, &end); end != at; value = std::strtod(at, &end)) {
    if (value != expected) return false;
    at = end;
    ++count;
  }
  return count == 3 && std::string_view(at).find_first_not_of(" \t\r\n") == std::string_view::npos;
}

bool is_neutral(const Element& element) {
  if (std::string_view(element.Name()) != "origin" || !element.NoChildren()) return false;
  for (const auto* each = element.FirstAttribute(); each != nullptr; each = each->Next())
    if (!is_neutral(*each)) return false;
  return true;
}

bool has_geometry(const Element& element, std::string_view geometry) {
  if (has_word(geometry, element.Name())) return true;
  for (const auto* each = element.FirstAttribute(); each != nullptr; each = each->Next())
    if (has_word(geometry, each->Name())) return true;
  for (const auto* each = element.FirstChildElement(); each != nullptr;
       each = each->NextSiblingElement())
    if (has_geometry(*each, geometry)) return true;
  return false;
}

class Walk {
 public:
  Walk(const ReadWords& words, const XmlPlaces& places, const XmlFormat& format)
      : words_(words), places_(places), format_(format) {}

  void through(const Element& element);
  UnreadWords take();

 private:
  void judge(const Unread& unread);
  void refuse(const Unread& unread, const std::vector<std::string>& asked);

  const ReadWords& words_;
  const XmlPlaces& places_;
  const XmlFormat& format_;
  UnreadWords found_;
  std::map<std::string, std::pair<UrdfPlace, std::size_t>> named_;  // first place, count
};

void Walk::through(const Element& element) {
  for (const auto* each = element.FirstAttribute(); each != nullptr; each = each->Next()) {
    if (words_.is_read(each)) continue;
    judge({element, each->Name(), fmt::format("the attribute '{}'", each->Name()),
           places_.of(element, each->Name()), has_word(format_.geometry, each->Name()),
           is_neutral(*each)});
  }
  for (const auto* each = element.FirstChild(); each != nullptr; each = each->NextSibling()) {
    if (const Element* child = each->ToElement()) {
      if (words_.is_read(child)) {
        through(*child);
        continue;
      }
      judge({element, child->Name(), fmt::format("<{}>", child->Name()), places_.of(*child),
             has_geometry(*child, format_.geometry), is_neutral(*child)});
    } else if (each->ToText() != nullptr) {
      judge({element, "", fmt::format("the text '{:.40}'", printable(each->Value())),
             places_.of(element), false, false});
    }
  }
}

void Walk::judge(const Unread& unread) {
  const std::vector<std::string>& asked = words_.asked(unread.in);
  const std::string_view in = unread.in.Name();
  const bool is_again = std::ranges::find(asked, unread.name) != asked.end();
  bool is_known = false;
  for (const OtherWords& each : format_.others) {
    if (each.element != in || is_again) continue;
    if (has_word(each.silent, unread.name)) return;
    is_known = has_word(each.named, unread.name);
  }
  if (unread.name == "name" || unread.name.starts_with("xmlns")) return;
  // A word with a namespace is of a program that has its own.
  const bool is_nearly = unread.name.find(':') == unread.name.npos && !unread.name.empty() &&
                         !did_you_mean(unread.name, asked).empty();
  const bool counts = is_nearly || unread.is_geometry || has_word(format_.strict, in);
  if (is_again || (counts && !is_known && !unread.is_neutral)) return refuse(unread, asked);
  const auto named = named_.emplace(fmt::format("{} in <{}>", unread.shown, in),
                                    std::pair(unread.place, std::size_t{0}));
  ++named.first->second.second;
}

void Walk::refuse(const Unread& unread, const std::vector<std::string>& asked) {
  const bool is_again = std::ranges::find(asked, unread.name) != asked.end();
  found_.faults.push_back(
      {unread.place,
       is_again
           ? fmt::format("found {} in <{}> again; expected it once", unread.shown, unread.in.Name())
           : fmt::format("found {} in <{}>, which is not read and could change a place or a "
                         "size; expected {}{}",
                         unread.shown, unread.in.Name(), asked.empty() ? "none" : one_of(asked),
                         did_you_mean(unread.name, asked))});
}

UnreadWords Walk::take() {
  std::vector<std::string> all;
  for (const auto& [shown, at] : named_) {
    const auto& [place, count] = at;
    all.push_back(
        fmt::format("{} ({}:{}{})", shown, place.line, place.column,
                    count == 1 ? "" : fmt::format(" and {}", counted(count - 1, "other place"))));
  }
  if (!all.empty()) found_.note = fmt::format("not used: {}", fmt::join(all, ", "));
  return std::move(found_);
}

}  // namespace

UnreadWords unread_words(const Element& root, const ReadWords& words, const XmlPlaces& places,
                         const XmlFormat& format) {
  Walk walk(words, places, format);
  walk.through(root);
  return walk.take();
}

}  // namespace clearance
