// Tells what a URDF or SRDF says and no reader asked for.
#pragma once

#include <tinyxml2.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "config/urdf/urdf.hpp"
#include "config/urdf/xml_format.hpp"
#include "config/urdf/xml_places.hpp"

namespace clearance {

// The words that readers asked for, by element, and the elements and attributes that they got.
class ReadWords {
 public:
  void ask(const tinyxml2::XMLElement& element, const char* name) {
    std::vector<std::string>& asked = asked_[&element];
    if (std::ranges::find(asked, name) == asked.end()) asked.emplace_back(name);
  }
  void mark(const void* read) { read_.insert(read); }

  [[nodiscard]] bool is_read(const void* node) const { return read_.contains(node); }
  [[nodiscard]] const std::vector<std::string>& asked(const tinyxml2::XMLElement& element) const {
    static const std::vector<std::string> kNothing;
    const auto found = asked_.find(&element);
    return found == asked_.end() ? kNothing : found->second;
  }

 private:
  std::unordered_map<const tinyxml2::XMLElement*, std::vector<std::string>> asked_;
  std::unordered_set<const void*> read_;
};

// A fault lacks the name of the file. The note names each other word once; empty: there is none.
struct UnreadWords {
  struct Fault {
    UrdfPlace place;
    std::string text;
  };
  std::vector<Fault> faults;
  std::string note;
};

// Goes through the root and all elements that were read. A word that could place or size geometry
// is a fault, and so is one that is nearly a word that is read, or stands there again.
[[nodiscard]] UnreadWords unread_words(const tinyxml2::XMLElement& root, const ReadWords& words,
                                       const XmlPlaces& places, const XmlFormat& format);

}  // namespace clearance
