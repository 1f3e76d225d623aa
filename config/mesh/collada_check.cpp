// An accessor names its array by "#id". Assimp checks the count of an array against its numbers, so
// only the accessors are checked here.
#include "config/mesh/collada_check.hpp"

#include <fmt/format.h>

#include <tinyxml2.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <string_view>
#include <vector>

namespace clearance {
namespace {

using tinyxml2::XMLElement;

// All elements of a document, in order.
struct Elements : tinyxml2::XMLVisitor {
  bool VisitEnter(const XMLElement& element, const tinyxml2::XMLAttribute*) override {
    all.push_back(&element);
    return true;
  }
  std::vector<const XMLElement*> all;
};

// Returns `otherwise` for a count that is left out, and the largest one for a text that is no count
// in 32 bits.
std::uint64_t count_of(const XMLElement& element, const char* name, std::uint64_t otherwise) {
  if (element.Attribute(name) == nullptr) return otherwise;
  unsigned value = 0;
  return element.QueryUnsignedAttribute(name, &value) == tinyxml2::XML_SUCCESS ? value : UINT32_MAX;
}

// Returns how many numbers of the array the accessor covers; 32 bits times 32 bits do not overflow
// 64.
std::uint64_t reach_of(const XMLElement& accessor) {
  const std::uint64_t count = count_of(accessor, "count", 0);
  if (count == 0) return 0;
  std::uint64_t params = 0;
  for (const XMLElement* param = accessor.FirstChildElement("param"); param != nullptr;
       param = param->NextSiblingElement("param")) {
    ++params;
  }
  return (count - 1) * count_of(accessor, "stride", 1) + count_of(accessor, "offset", 0) +
         std::max<std::uint64_t>(params, 1);
}

// Assimp hangs on a text that is not a number there. Returns true for all other elements.
bool is_list_of_indices(const XMLElement& element) {
  const std::string_view name = element.Name();
  const char* const text = element.GetText();
  if ((name != "p" && name != "vcount" && name != "v") || text == nullptr) return true;
  return std::string_view(text).find_first_not_of("0123456789+- \t\r\n") == std::string_view::npos;
}

}  // namespace

std::string fault_of_collada(const std::string& xml) {
  tinyxml2::XMLDocument document;
  if (document.Parse(xml.data(), xml.size()) != tinyxml2::XML_SUCCESS) {
    return fmt::format("line {} is not readable as XML: {}", document.ErrorLineNum(),
                       document.ErrorName());
  }
  Elements elements;
  document.Accept(&elements);
  for (const XMLElement* element : elements.all) {
    if (!is_list_of_indices(*element)) {
      return fmt::format("<{}> in line {} holds more than whole numbers", element->Name(),
                         element->GetLineNum());
    }
  }
  std::map<std::string_view, std::uint64_t> numbers;  // by the array's id
  for (const XMLElement* element : elements.all) {
    const char* const id = element->Attribute("id");
    if (id == nullptr || !std::string_view(element->Name()).ends_with("_array")) continue;
    if (!numbers.emplace(id, count_of(*element, "count", 0)).second) {
      return fmt::format("line {} names the array '{}' again", element->GetLineNum(), id);
    }
  }
  for (const XMLElement* element : elements.all) {
    if (std::string_view(element->Name()) != "accessor") continue;
    const char* const source = element->Attribute("source");
    const auto found = numbers.find(source == nullptr || *source == '\0' ? "" : source + 1);
    if (found == numbers.end()) continue;  // assimp refuses it
    if (const std::uint64_t reach = reach_of(*element); reach > found->second) {
      return fmt::format("the accessor in line {} reaches beyond the {} numbers of '{}'",
                         element->GetLineNum(), found->second, found->first);
    }
  }
  return "";
}

}  // namespace clearance
