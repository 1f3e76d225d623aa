// Finds the places of elements and attributes in the text of an XML file: tinyxml2 keeps no
// columns.
#pragma once

#include <tinyxml2.h>

#include <string_view>
#include <unordered_map>
#include <vector>

#include "config/urdf/urdf.hpp"

namespace clearance {

// The text has to outlive it.
class XmlPlaces {
 public:
  XmlPlaces(std::string_view text, const tinyxml2::XMLDocument& document);

  [[nodiscard]] UrdfPlace of(const tinyxml2::XMLElement& element) const;
  [[nodiscard]] UrdfPlace of(const tinyxml2::XMLElement& element, std::string_view attribute) const;

 private:
  [[nodiscard]] UrdfPlace at(std::size_t offset) const;

  std::string_view text_;
  std::vector<std::size_t> lines_;  // where each begins
  std::unordered_map<const tinyxml2::XMLElement*, std::size_t> tags_;
};

}  // namespace clearance
