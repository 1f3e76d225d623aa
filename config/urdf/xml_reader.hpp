// Reads elements and numbers of URDF and SRDF, and keeps every mistake with its line.
#pragma once

#include <tinyxml2.h>

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "config/urdf/urdf.hpp"
#include "core/vec.hpp"

namespace clearance {

// Returns the children of this name, in order.
[[nodiscard]] std::vector<const tinyxml2::XMLElement*> children(const tinyxml2::XMLElement& element,
                                                                const char* name);

enum class Sign { kAny, kPositive };

// An XML file and its mistakes. A value that cannot be read is reported and keeps its default.
class XmlReader {
 public:
  using Element = tinyxml2::XMLElement;

  explicit XmlReader(const std::filesystem::path& file);

  // Returns <robot>; null after a fault that makes all else meaningless: no XML, or xacro.
  [[nodiscard]] const Element* root() const { return root_; }

  void report(const Element& at, const std::string& text) { add(at.GetLineNum(), text); }
  [[nodiscard]] const UrdfFaults& faults() const { return faults_; }

  // Return an attribute, a child element, and an attribute of one; each is required. After a fault
  // they return "", null and "".
  std::string attribute(const Element& element, const char* name);
  const Element* child(const Element& element, const char* name);
  std::string attribute_of_child(const Element& element, const char* child_name, const char* name);

  // Read finite numbers in SI units; lengths and radii have to be positive.
  double number(const Element& element, const char* name, Sign sign = Sign::kAny);
  Vec3 vector(const Element& element, const char* name, Sign sign = Sign::kAny);
  double length(const Element& element, const char* name) {
    return number(element, name, Sign::kPositive);
  }

  // <origin xyz="..." rpy="..."/>: the element and both attributes are optional, zero by default.
  UrdfOrigin origin(const Element& element);

 private:
  bool has_xacro(const std::filesystem::path& file);
  void numbers(const Element& element, const char* name, std::span<double> values, Sign sign);
  void add(int line, const std::string& text);

  std::string file_;
  tinyxml2::XMLDocument document_;
  const Element* root_ = nullptr;
  UrdfFaults faults_;
};

}  // namespace clearance
