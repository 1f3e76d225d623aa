#include "config/complaints.hpp"

#include <algorithm>
#include <tuple>

#include "config/scalar.hpp"

namespace clearance {

std::string describe(const YamlNode& node) {
  switch (node.kind) {
    case YamlNode::Kind::kNull:
      return "nothing";
    case YamlNode::Kind::kSequence:
      return node.items.empty() ? "an empty list"
                                : "a list of " + std::to_string(node.items.size());
    case YamlNode::Kind::kMap:
      return "a map";
    case YamlNode::Kind::kScalar:
      break;
  }
  switch (scalar_type(node)) {
    case ScalarType::kNumber:
      return "the number " + node.text;
    case ScalarType::kFlag:
      return node.text;
    case ScalarType::kText:
      break;
  }
  return node.text.empty() ? "an empty text" : "the text '" + node.text + "'";
}

void Complaints::add(int line, int column, const std::string& text) {
  complaints_.push_back({line, column, text});
}

std::vector<CellError> Complaints::sorted() const {
  std::vector<Complaint> ordered = complaints_;
  std::stable_sort(ordered.begin(), ordered.end(), [](const Complaint& a, const Complaint& b) {
    return std::tie(a.line, a.column) < std::tie(b.line, b.column);
  });
  std::vector<CellError> errors;
  for (const Complaint& complaint : ordered) {
    errors.push_back({file_ + ":" + std::to_string(complaint.line) + ":" +
                      std::to_string(complaint.column) + ": " + complaint.text});
  }
  return errors;
}

}  // namespace clearance
