// Reads elements and numbers of URDF and SRDF, and keeps every mistake with its place.
#pragma once

#include <tinyxml2.h>

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "config/urdf/unread_words.hpp"
#include "config/urdf/urdf.hpp"
#include "config/urdf/xml_format.hpp"
#include "config/urdf/xml_places.hpp"
#include "core/vec.hpp"

namespace clearance {

enum class Sign { kAny, kNotNegative };

// An XML file and its mistakes. A value that cannot be read is reported and keeps its default. A
// reader asks for each word that it knows, and calls account_for_the_rest() at the end.
class XmlReader {
 public:
  using Element = tinyxml2::XMLElement;

  explicit XmlReader(const std::filesystem::path& file);

  // Returns <robot>; null after a fault that makes all else meaningless: no XML, or xacro.
  [[nodiscard]] const Element* root() const { return root_; }

  void report(const Element& at, const std::string& text) { add(place_of(at), text); }
  void report(const Element& at, const char* attribute, const std::string& text) {
    add(places_->of(at, attribute), text);
  }
  [[nodiscard]] UrdfPlace place_of(const Element& at) const { return places_->of(at); }
  [[nodiscard]] const UrdfFaults& faults() const { return faults_; }

  // Return an attribute, the first child element of this name, and all of them, in order.
  const char* optional(const Element& element, const char* name);
  const Element* optional_child(const Element& element, const char* name);
  std::vector<const Element*> children(const Element& element, const char* name);

  // Return an attribute, a child element, and an attribute of one; each is required. After a fault
  // they return "", null and "".
  std::string attribute(const Element& element, const char* name);
  const Element* child(const Element& element, const char* name);
  std::string attribute_of_child(const Element& element, const char* child_name, const char* name);

  // Read finite numbers in SI units.
  double number(const Element& element, const char* name, Sign sign = Sign::kAny);
  Vec3 vector(const Element& element, const char* name, Sign sign = Sign::kAny);
  double length(const Element& element, const char* name) {
    return number(element, name, Sign::kNotNegative);
  }

  // <origin xyz="..." rpy="..."/>, or with quat_xyzw="..." since URDF 1.1: the element and its
  // attributes are optional, zero by default.
  UrdfOrigin origin(const Element& element);

  // Reads the version of a URDF, from "1.0" to "1.2"; a file without one has 1.0.
  void read_version();

  // Reports what could change geometry and no reader asked for. Returns a note that names all other
  // such words; empty: there are none.
  std::string account_for_the_rest(const XmlFormat& format);

 private:
  bool has_xacro(const std::filesystem::path& file);
  void numbers(const Element& element, const char* name, std::span<double> values, Sign sign);
  void add(UrdfPlace place, const std::string& text);

  std::string file_, text_;
  tinyxml2::XMLDocument document_;
  std::optional<XmlPlaces> places_;  // of a document that could be parsed
  ReadWords words_;
  const Element* root_ = nullptr;
  bool has_quaternions_ = false;  // by its version
  UrdfFaults faults_;
};

}  // namespace clearance
