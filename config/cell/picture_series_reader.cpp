#include "config/cell/picture_series_reader.hpp"

#include "config/yaml/map_reader.hpp"
#include "config/yaml/scalar.hpp"

namespace clearance {
namespace {

constexpr std::int64_t kMostFrames = 16;       // a megabyte each
constexpr std::int64_t kMostWitnessed = 1000;  // frames
constexpr Range kShareOfRays{.least = 0.0, .most = 1.0};

}  // namespace

void read_persistence(const YamlNode& node, Diagnostics& diagnostics, Sensor& sensor) {
  MapReader map(node, "'persist' of a sensor", diagnostics);
  const YamlNode* frames = map.required("frames");
  const YamlNode* of = map.required("of");
  map.refuse_unknown_keys();
  if (frames == nullptr || of == nullptr) return;
  const auto most = read_integer(*of, 1, kMostFrames, "frames", diagnostics);
  sensor.persist_of = static_cast<std::uint32_t>(most.value_or(kMostFrames));
  sensor.persist_frames = static_cast<std::uint32_t>(
      read_integer(*frames, 1, sensor.persist_of, "of these frames", diagnostics).value_or(1));
}

void read_witness(const YamlNode& node, Diagnostics& diagnostics, Sensor& sensor) {
  if (sensor.kind != SensorKind::kDepthImage) {
    diagnostics.add(node, "found 'witness'; expected it of depth images only");
    return;
  }
  sensor.is_witness = true;
  if (node.kind != YamlNode::Kind::kMap) {
    sensor.is_witness = read_flag(node, diagnostics).value_or(false);
    return;
  }
  MapReader map(node, "'witness' of a sensor", diagnostics);
  if (const YamlNode* share = map.optional("share"))
    sensor.witness_share =
        read_number(*share, kShareOfRays, "a share of rays, 0 to 1", diagnostics).value_or(0.05);
  if (const YamlNode* frames = map.optional("frames"))
    sensor.witness_frames = static_cast<std::uint32_t>(
        read_integer(*frames, 1, kMostWitnessed, "frames in a row", diagnostics).value_or(1));
  map.refuse_unknown_keys();
}

}  // namespace clearance
