#include "monitor/interface/pair_name.hpp"

namespace clearance {
namespace {

std::string part_name(const Object& object, std::uint32_t part) {
  if (part >= object.parts.size()) return object.name;
  return body_name(object.name, object.parts.size(), object.parts[part].name);
}

}  // namespace

std::string pair_name(const Scene& scene, std::uint32_t pair) {
  if (pair >= scene.pairs.size()) return "pair " + std::to_string(pair);
  const ObjectPair& objects = scene.pairs[pair];
  return pair_name(scene.objects[objects.first].name, scene.objects[objects.second].name);
}

std::string pair_name(const Scene& scene, const PairReport& pair) {
  if (pair.pair >= scene.pairs.size()) return pair_name(scene, pair.pair);
  const ObjectPair& objects = scene.pairs[pair.pair];
  return pair_name(part_name(scene.objects[objects.first], pair.part_a),
                   part_name(scene.objects[objects.second], pair.part_b));
}

}  // namespace clearance
