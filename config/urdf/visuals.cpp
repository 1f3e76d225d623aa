#include "config/urdf/visuals.hpp"

#include <cstdio>
#include <map>
#include <utility>

#include "config/urdf/shape_element.hpp"
#include "config/urdf/xml_reader.hpp"

namespace clearance {
namespace {

using Element = tinyxml2::XMLElement;
using Colours = std::map<std::string, Vec3>;  // by the name of the material

std::optional<Vec3> colour_of(const Element* material) {
  const Element* colour = material == nullptr ? nullptr : material->FirstChildElement("color");
  const char* rgba = colour == nullptr ? nullptr : colour->Attribute("rgba");
  Vec3 found;
  if (rgba == nullptr ||
      std::sscanf(rgba, "%lf %lf %lf", &found.x(), &found.y(), &found.z()) != 3 ||
      !found.allFinite()) {
    return std::nullopt;
  }
  return found.cwiseMax(0.0).cwiseMin(1.0);
}

// A material without a colour of its own is one of the file, by its name.
std::optional<Vec3> colour_of(const Element* material, const Colours& colours) {
  if (material == nullptr) return std::nullopt;
  if (const auto own = colour_of(material)) return own;
  const char* name = material->Attribute("name");
  const auto found = name == nullptr ? colours.end() : colours.find(name);
  return found == colours.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace

std::vector<UrdfVisual> read_visuals(const std::filesystem::path& urdf) {
  XmlReader xml(urdf);
  if (xml.root() == nullptr) return {};
  Colours colours;
  xml.read_version();
  for (const Element* material : xml.children(*xml.root(), "material")) {
    const char* name = material->Attribute("name");
    const auto colour = colour_of(material);
    if (name != nullptr && colour) colours[name] = *colour;
  }
  std::vector<UrdfVisual> visuals;
  for (const Element* link : xml.children(*xml.root(), "link")) {
    const char* name = link->Attribute("name");
    for (const Element* each : xml.children(*link, "visual")) {
      const std::size_t before = xml.faults().size();
      std::vector<std::string> unused_notes;
      auto shape = read_shape(xml, *each, "", unused_notes);
      if (!shape || xml.faults().size() != before) continue;
      visuals.push_back({.link = name == nullptr ? "" : name,
                         .shape = std::move(*shape),
                         .colour = colour_of(each->FirstChildElement("material"), colours)});
    }
  }
  return visuals;
}

}  // namespace clearance
