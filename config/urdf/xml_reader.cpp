#include "config/urdf/xml_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <system_error>

#include "config/text/printable.hpp"
#include "config/text/sentences.hpp"

namespace clearance {
namespace {

// The first element or attribute that only xacro understands, outside of parts for other programs.
struct FirstXacro : tinyxml2::XMLVisitor {
  int line = 0;  // 0: there is none
  std::string found;

  bool VisitEnter(const tinyxml2::XMLElement& element,
                  const tinyxml2::XMLAttribute* first) override {
    constexpr std::array<std::string_view, 3> kOthers = {"gazebo", "transmission", "ros2_control"};
    if (line != 0 || std::ranges::find(kOthers, element.Name()) != kOthers.end()) return false;
    if (std::string_view(element.Name()).starts_with("xacro:")) {
      line = element.GetLineNum();
      found = fmt::format("<{}>", element.Name());
    }
    for (const auto* at = first; at != nullptr && line == 0; at = at->Next()) {
      const std::string_view value = at->Value();
      if (value.find("${") == value.npos && value.find("$(") == value.npos) continue;
      line = element.GetLineNum();
      found = fmt::format("{}=\"{}\"", at->Name(), value);
    }
    return line == 0;
  }
};

}  // namespace

std::vector<const tinyxml2::XMLElement*> children(const tinyxml2::XMLElement& element,
                                                  const char* name) {
  std::vector<const tinyxml2::XMLElement*> found;
  for (const auto* at = element.FirstChildElement(name); at != nullptr;
       at = at->NextSiblingElement(name)) {
    found.push_back(at);
  }
  return found;
}

XmlReader::XmlReader(const std::filesystem::path& file) : file_(file.string()) {
  if (document_.LoadFile(file_.c_str()) != tinyxml2::XML_SUCCESS) {
    add(std::max(1, document_.ErrorLineNum()),
        fmt::format("not readable as XML: {}; expected URDF or SRDF, with xacro expanded",
                    document_.ErrorName()));
    return;
  }
  root_ = document_.FirstChildElement("robot");
  if (root_ == nullptr) {
    add(1, "found no <robot>; expected it as the root");
  } else if (has_xacro(file)) {
    root_ = nullptr;
  }
}

// Reports the first place that xacro would expand. What comes after it would be a mistake, too.
bool XmlReader::has_xacro(const std::filesystem::path& file) {
  FirstXacro first;
  root_->Accept(&first);
  if (first.line == 0) return false;
  std::filesystem::path expanded = file.filename();
  if (expanded.extension() == ".xacro") {
    expanded.replace_extension();
  } else {
    expanded.replace_extension(".expanded" + expanded.extension().string());
  }
  add(first.line, fmt::format("found {}; expected a file without xacro: expand it (xacro {} > {})",
                              first.found, file.filename().string(), expanded.string()));
  return true;
}

std::string XmlReader::attribute(const Element& element, const char* name) {
  const char* value = element.Attribute(name);
  if (value != nullptr) return value;
  report(element, fmt::format("found <{}> without '{}'", element.Name(), name));
  return "";
}

const XmlReader::Element* XmlReader::child(const Element& element, const char* name) {
  const Element* found = element.FirstChildElement(name);
  if (found == nullptr) {
    report(element, fmt::format("found <{}> without <{}>", element.Name(), name));
  }
  return found;
}

std::string XmlReader::attribute_of_child(const Element& element, const char* child_name,
                                          const char* name) {
  const Element* found = child(element, child_name);
  return found == nullptr ? "" : attribute(*found, name);
}

double XmlReader::number(const Element& element, const char* name, Sign sign) {
  double value = 0.0;
  numbers(element, name, std::span(&value, 1), sign);
  return value;
}

Vec3 XmlReader::vector(const Element& element, const char* name, Sign sign) {
  std::array<double, 3> values{};
  numbers(element, name, values, sign);
  return {values[0], values[1], values[2]};
}

UrdfOrigin XmlReader::origin(const Element& element) {
  UrdfOrigin origin;
  if (const Element* found = element.FirstChildElement("origin")) {
    if (found->Attribute("xyz") != nullptr) origin.xyz = vector(*found, "xyz");
    if (found->Attribute("rpy") != nullptr) origin.rpy = vector(*found, "rpy");
  }
  return origin;
}

// Reads exactly values.size() finite numbers, separated by blanks.
void XmlReader::numbers(const Element& element, const char* name, std::span<double> values,
                        Sign sign) {
  if (element.Attribute(name) == nullptr) {
    static_cast<void>(attribute(element, name));
    return;
  }
  const std::string text = element.Attribute(name);
  const char* at = text.data();
  const char* end = text.data() + text.size();
  const auto skip_blanks = [&] {
    while (at != end && std::string_view(" \t\r\n").find(*at) != std::string_view::npos) ++at;
  };
  bool good = true;
  for (double& value : values) {
    skip_blanks();
    if (at != end && *at == '+') ++at;
    const auto result = std::from_chars(at, end, value);
    good = good && result.ec == std::errc() && std::isfinite(value) &&
           (sign == Sign::kAny || value > 0.0);
    at = result.ptr;
  }
  skip_blanks();
  if (!good || at != end) {
    report(element, fmt::format("found {}=\"{}\"; expected {}{}", name, text,
                                counted(values.size(), "number"),
                                sign == Sign::kPositive ? " above 0" : ""));
  }
}

void XmlReader::add(int line, const std::string& text) {
  faults_.push_back({line, fmt::format("{}:{}: {}", file_, line, excerpt(text))});
}

}  // namespace clearance
