#include "config/yaml/quantity_nodes.hpp"

#include <cmath>
#include <utility>

#include "config/yaml/yaml_writer.hpp"

namespace clearance {

LengthUnit length_unit_of(const YamlNode& cell) {
  const YamlNode* units = find(cell, "units");
  const YamlNode* length = units == nullptr ? nullptr : find(*units, "length");
  return length != nullptr && length->text == "mm" ? LengthUnit::kMillimetre : LengthUnit::kMetre;
}

// A double in metres that is a quotient of 1000 is written as that number.
YamlNode length_node(double metres, LengthUnit unit) {
  if (unit == LengthUnit::kMetre) return number_node(metres);
  const double product = metres * 1000.0;
  for (const double millimetres :
       {product, std::nextafter(product, -HUGE_VAL), std::nextafter(product, HUGE_VAL)}) {
    if (to_metres(millimetres, unit) == metres) return number_node(millimetres);
  }
  return number_node(product);
}

YamlNode lengths_node(std::span<const double> metres, LengthUnit unit) {
  YamlNode list;
  list.kind = YamlNode::Kind::kSequence;
  for (const double each : metres) list.items.push_back(length_node(each, unit));
  return list;
}

YamlNode pose_node(const Pose& pose, LengthUnit unit) {
  YamlNode node;
  node.kind = YamlNode::Kind::kMap;
  set(node, "xyz", lengths_node({pose.position.data(), 3}, unit));
  const Eigen::Quaterniond& turn = pose.orientation;
  if (turn.vec() == Vec3::Zero()) return node;
  YamlNode quaternion;
  quaternion.kind = YamlNode::Kind::kSequence;
  for (const double each : {turn.x(), turn.y(), turn.z(), turn.w()})
    quaternion.items.push_back(number_node(each));
  set(node, "quaternion", std::move(quaternion));
  return node;
}

}  // namespace clearance
