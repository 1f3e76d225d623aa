// An accessor names its array by "#id". Assimp checks the count of an array against its numbers, so
// only the accessors are checked here.
#include "config/mesh/collada_check.hpp"

#include <fmt/format.h>

#include <tinyxml2.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <set>
#include <string_view>
#include <vector>

#include "config/text/words.hpp"

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

// The elements that place and shape a surface, with the attributes and children that assimp reads
// or that do neither. What is not listed here is not read: <skew>, <ph> and others.
struct Words {
  std::string_view elements, attributes, children;
};
constexpr std::string_view kPrimitiveWords = "input p vcount extra";
constexpr std::array<Words, 16> kRead = {{
    {"unit", "meter name", ""},
    {"visual_scene", "id name", "asset node evaluate_scene extra"},
    {"node", "id name sid type layer",
     "asset lookat matrix rotate scale translate node instance_camera instance_controller "
     "instance_geometry instance_light instance_node extra"},
    {"lookat matrix rotate scale translate", "sid", ""},
    {"instance_geometry instance_node instance_visual_scene", "url sid name proxy",
     "bind_material extra"},
    {"geometry", "id name", "asset mesh convex_mesh spline brep extra"},
    {"mesh", "",
     "source vertices lines linestrips polygons polylist triangles trifans tristrips extra"},
    {"source", "id name",
     "asset float_array Name_array IDREF_array bool_array int_array technique_common technique"},
    {"float_array", "id name count digits magnitude", ""},
    {"accessor", "source count stride offset", "param"},
    {"vertices", "id name", "input extra"},
    {"polygons polylist", "name count material", kPrimitiveWords},
    {"triangles trifans tristrips", "name count material", kPrimitiveWords},
    {"input", "semantic source offset set", ""},
    {"p vcount", "", ""},
    {"library_geometries", "id name", "asset geometry extra"},
}};

std::string fault_of_words(const XMLElement& element) {
  const auto words = std::ranges::find_if(
      kRead, [&](const Words& each) { return has_word(each.elements, element.Name()); });
  if (words == kRead.end()) return "";
  const auto unread = [&](int line, std::string_view what) {
    return fmt::format(
        "line {} has {} in <{}>, which is not read and could change a place or a size", line, what,
        element.Name());
  };
  for (const auto* at = element.FirstAttribute(); at != nullptr; at = at->Next()) {
    if (!has_word(words->attributes, at->Name()))
      return unread(at->GetLineNum(), fmt::format("the attribute '{}'", at->Name()));
  }
  for (const XMLElement* at = element.FirstChildElement(); at != nullptr;
       at = at->NextSiblingElement()) {
    if (!has_word(words->children, at->Name()))
      return unread(at->GetLineNum(), fmt::format("<{}>", at->Name()));
  }
  return "";
}

// Returns the ids of elements that an instance can name; of geometries, only those of meshes.
std::set<std::string_view> known_ids(const std::vector<const XMLElement*>& all) {
  std::set<std::string_view> ids;
  for (const XMLElement* element : all) {
    const bool is_other = std::string_view(element->Name()) == "geometry" &&
                          element->FirstChildElement("mesh") == nullptr;
    const char* const id = element->Attribute("id");
    if (id != nullptr && !is_other) ids.insert(id);
  }
  return ids;
}

// Assimp leaves out what an instance names, if it does not find a mesh or node of this name in the
// file. It does not apply the matrix of a skin.
std::string fault_of_reference(const XMLElement& element, const std::set<std::string_view>& ids) {
  const std::string_view name = element.Name();
  if (name == "bind_shape_matrix") {
    const std::vector<std::string> numbers =
        words_of(element.GetText() == nullptr ? "" : element.GetText());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      if (std::strtod(numbers[i].c_str(), nullptr) != (i % 5 == 0 ? 1.0 : 0.0))
        return fmt::format(
            "line {} has a <bind_shape_matrix> that moves the surface, which is not "
            "read",
            element.GetLineNum());
    }
  }
  if (name != "instance_geometry" && name != "instance_node" && name != "instance_controller")
    return "";
  const char* const url = element.Attribute("url");
  if (url != nullptr && *url == '#' && ids.contains(url + 1)) return "";
  return fmt::format("line {} has an <{}> of '{}', and the file contains no mesh of that name",
                     element.GetLineNum(), name, url == nullptr ? "" : url);
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
  const std::set<std::string_view> ids = known_ids(elements.all);
  for (const XMLElement* element : elements.all) {
    std::string fault = fault_of_words(*element);
    if (fault.empty()) fault = fault_of_reference(*element, ids);
    if (!fault.empty()) return fault;
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
