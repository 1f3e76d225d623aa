#include "config/urdf/xml_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <system_error>
#include <utility>
#include <variant>

#include "config/text/file_bytes.hpp"
#include "config/text/sentences.hpp"
#include "config/yaml/quantities.hpp"

namespace clearance {
namespace {

// The first element or attribute that only xacro understands, outside of parts for other programs.
struct FirstXacro : tinyxml2::XMLVisitor {
  const tinyxml2::XMLElement* in = nullptr;  // null: there is none
  std::string found;

  bool VisitEnter(const tinyxml2::XMLElement& element,
                  const tinyxml2::XMLAttribute* first) override {
    constexpr std::array<std::string_view, 3> kOthers = {"gazebo", "transmission", "ros2_control"};
    if (in != nullptr || std::ranges::find(kOthers, element.Name()) != kOthers.end()) return false;
    if (std::string_view(element.Name()).starts_with("xacro:")) {
      in = &element;
      found = fmt::format("<{}>", element.Name());
    }
    for (const auto* at = first; at != nullptr && in == nullptr; at = at->Next()) {
      const std::string_view value = at->Value();
      if (value.find("${") == value.npos && value.find("$(") == value.npos) continue;
      in = &element;
      found = fmt::format("{}=\"{}\"", at->Name(), value);
    }
    return in == nullptr;
  }
};

}  // namespace

XmlReader::XmlReader(const std::filesystem::path& file) : file_(file.string()) {
  auto bytes = read_bytes(file_);
  if (const auto* fault = std::get_if<FileFault>(&bytes)) {
    add({1, 1}, fmt::format("not readable: {}", fault->reason));
    return;
  }
  text_ = std::get<std::string>(std::move(bytes));
  if (document_.Parse(text_.data(), text_.size()) != tinyxml2::XML_SUCCESS) {
    add({std::max(1, document_.ErrorLineNum()), 1},
        fmt::format("not readable as XML: {}; expected URDF or SRDF, with xacro expanded",
                    document_.ErrorName()));
    return;
  }
  places_.emplace(text_, document_);
  root_ = document_.FirstChildElement("robot");
  if (root_ == nullptr) {
    add({1, 1}, "found no <robot>; expected it as the root");
  } else if (has_xacro(file)) {
    root_ = nullptr;
  }
}

// Reports the first place that xacro would expand. What comes after it would be a mistake, too.
bool XmlReader::has_xacro(const std::filesystem::path& file) {
  FirstXacro first;
  root_->Accept(&first);
  if (first.in == nullptr) return false;
  std::filesystem::path expanded = file.filename();
  if (expanded.extension() == ".xacro") {
    expanded.replace_extension();
  } else {
    expanded.replace_extension(".expanded" + expanded.extension().string());
  }
  report(*first.in,
         fmt::format("found {}; expected a file without xacro: expand it (xacro {} > {})",
                     first.found, file.filename().string(), expanded.string()));
  return true;
}

const char* XmlReader::optional(const Element& element, const char* name) {
  words_.ask(element, name);
  const tinyxml2::XMLAttribute* found = element.FindAttribute(name);
  if (found == nullptr) return nullptr;
  words_.mark(found);
  return found->Value();
}

const XmlReader::Element* XmlReader::optional_child(const Element& element, const char* name) {
  words_.ask(element, name);
  const Element* found = element.FirstChildElement(name);
  if (found != nullptr) words_.mark(found);
  return found;
}

std::vector<const XmlReader::Element*> XmlReader::children(const Element& element,
                                                           const char* name) {
  words_.ask(element, name);
  std::vector<const Element*> found;
  for (const auto* at = element.FirstChildElement(name); at != nullptr;
       at = at->NextSiblingElement(name)) {
    words_.mark(at);
    found.push_back(at);
  }
  return found;
}

std::string XmlReader::attribute(const Element& element, const char* name) {
  const char* value = optional(element, name);
  if (value != nullptr) return value;
  report(element, fmt::format("found <{}> without '{}'", element.Name(), name));
  return "";
}

const XmlReader::Element* XmlReader::child(const Element& element, const char* name) {
  const Element* found = optional_child(element, name);
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

// urdfdom ignores a quaternion in a file of version 1.0, and other programs read it: such a file
// does not say one thing.
UrdfOrigin XmlReader::origin(const Element& element) {
  UrdfOrigin origin;
  const Element* found = optional_child(element, "origin");
  if (found == nullptr) return origin;
  if (optional(*found, "xyz") != nullptr) origin.xyz = vector(*found, "xyz");
  const bool has_rpy = optional(*found, "rpy") != nullptr;
  if (has_rpy) origin.rpy = vector(*found, "rpy");
  if (optional(*found, "quat_xyzw") == nullptr) return origin;
  std::array<double, 4> xyzw{};
  const std::size_t before = faults_.size();
  numbers(*found, "quat_xyzw", xyzw, Sign::kAny);
  const Eigen::Quaterniond read(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
  if (faults_.size() != before) return origin;
  if (!has_quaternions_) {
    report(*found, "quat_xyzw",
           "found 'quat_xyzw' in a URDF of version 1.0; expected <robot version=\"1.1\">, or rpy");
  } else if (has_rpy) {
    report(*found, "quat_xyzw", "found 'quat_xyzw' beside 'rpy'; expected one of the two");
  } else if (!(std::abs(read.norm() - 1.0) <= kTypedUnitTolerance)) {
    report(*found, "quat_xyzw",
           fmt::format("found a quaternion of length {:f}; expected a unit quaternion x y z w",
                       read.norm()));
  } else {
    origin.quaternion = read.normalized();
  }
  return origin;
}

void XmlReader::read_version() {
  const char* found = optional(*root_, "version");
  const std::string_view version = found == nullptr ? "1.0" : found;
  has_quaternions_ = version == "1.1" || version == "1.2";
  if (version == "1.0" || has_quaternions_) return;
  report(*root_, "version",
         fmt::format("found version=\"{}\"; expected a URDF of version 1.0, 1.1 or 1.2", version));
}

std::string XmlReader::account_for_the_rest(const XmlFormat& format) {
  UnreadWords rest = unread_words(*root_, words_, *places_, format);
  for (const UnreadWords::Fault& fault : rest.faults) add(fault.place, fault.text);
  return rest.note.empty() ? "" : fmt::format("{}: {}", file_, rest.note);
}

// Reads exactly values.size() finite numbers, separated by blanks.
void XmlReader::numbers(const Element& element, const char* name, std::span<double> values,
                        Sign sign) {
  if (element.Attribute(name) == nullptr) {
    static_cast<void>(attribute(element, name));
    return;
  }
  const std::string text = attribute(element, name);
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
           (sign == Sign::kAny || value >= 0.0);
    at = result.ptr;
  }
  skip_blanks();
  if (!good || at != end) {
    report(
        element, name,
        fmt::format("found {}=\"{}\"; expected {}{}", name, text, counted(values.size(), "number"),
                    sign == Sign::kNotNegative ? " of at least 0" : ""));
  }
}

void XmlReader::add(UrdfPlace place, const std::string& text) {
  faults_.push_back(fault_at(file_, place, text));
}

}  // namespace clearance
