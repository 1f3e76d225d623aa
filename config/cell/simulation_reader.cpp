// Reads chains and movers like any other section. It keeps the line that moves each object, since
// only one may.
#include "config/cell/simulation_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "config/cell/ros_reader.hpp"
#include "config/text/spelling.hpp"
#include "config/yaml/map_reader.hpp"

namespace clearance {
namespace {

// URDF has more types; a simulation needs these.
const std::array<std::string, 2> kJointKinds = {"revolute", "prismatic"};
// A cell's fastest rate shows nothing faster.
constexpr Range kFrequencies{.least = 0.0, .most = 10'000.0};  // Hz

// Reads chains and movers. Each moving object may be moved once.
class SimulationReader {
 public:
  SimulationReader(const ObjectList& list, const Quantities& quantities)
      : list_(list), quantities_(quantities), diagnostics_(quantities.diagnostics()) {}

  SimulatedChain read_chain(const YamlNode& node);
  void read_mover(const YamlNode& node, Simulation& simulation);

 private:
  SimulatedJoint read_joint(const YamlNode& node);
  Swing read_swing(MapReader& map, JointKind kind) const;
  JointKind read_kind(MapReader& map) const;
  std::optional<std::uint32_t> read_object(const YamlNode& node);
  double read_frequency(const YamlNode& node) const;
  Pose read_pose(const YamlNode* node) const;

  const ObjectList& list_;
  const Quantities& quantities_;
  Diagnostics& diagnostics_;
  // The line that moves each object, by its id.
  std::map<std::uint32_t, int> moved_in_line_;
};

// A missing pose, or one with a mistake, is the identity.
Pose SimulationReader::read_pose(const YamlNode* node) const {
  return node == nullptr ? Pose{} : quantities_.pose(*node).value_or(Pose{});
}

// 0 Hz, the default, stands still.
double SimulationReader::read_frequency(const YamlNode& node) const {
  return read_number(node, kFrequencies, "a frequency in Hz", diagnostics_).value_or(0.0);
}

// Reads a moving object that nothing else of the simulation moves.
std::optional<std::uint32_t> SimulationReader::read_object(const YamlNode& node) {
  const auto name = read_name(node, "an object's name", diagnostics_);
  if (!name) return std::nullopt;
  std::vector<std::string> names;
  for (const Object& object : list_.objects) names.push_back(object.name);
  const auto found = std::find(names.begin(), names.end(), *name);
  if (found == names.end()) {
    if (list_.names_known) {
      diagnostics_.add(
          node, fmt::format("found the unknown object '{}'; expected one of the cell's{}", *name,
                            did_you_mean(*name, names)));
    }
    return std::nullopt;
  }
  const auto index = static_cast<std::uint32_t>(found - names.begin());
  if (std::ranges::any_of(list_.stated, [&](const StatedAttachment& stated) {
        return stated.place == list_.places[index];
      })) {
    diagnostics_.add(
        node,
        fmt::format("found the attached object '{}'; expected one that is not "
                    "attached, since its carrier moves this one: leave it out of the simulation",
                    *name));
    return std::nullopt;
  }
  if (list_.objects[index].is_seen()) {
    diagnostics_.add(node, fmt::format("found the sensor '{}'; expected a moving object: what a "
                                       "sensor sees is not moved by itself",
                                       *name));
  } else if (list_.objects[index].fixed) {
    diagnostics_.add(node,
                     fmt::format("found the fixed object '{}'; expected a moving one", *name));
  } else if (const auto [same, is_new] = moved_in_line_.emplace(index, node.line); !is_new) {
    diagnostics_.add(
        node,
        fmt::format("found the object '{}' again; expected it to be moved once (first in line {})",
                    *name, same->second));
  }
  return index;
}

// The joint is revolute unless the cell says prismatic.
JointKind SimulationReader::read_kind(MapReader& map) const {
  const YamlNode* node = map.optional("type");
  if (node == nullptr) return JointKind::kRevolute;
  const auto text = read_text(*node, "revolute or prismatic", diagnostics_);
  if (text && *text != "revolute" && *text != "prismatic") {
    diagnostics_.add(*node, fmt::format("found {}; expected revolute or prismatic{}",
                                        describe(*node), did_you_mean(*text, kJointKinds)));
  }
  return text == "prismatic" ? JointKind::kPrismatic : JointKind::kRevolute;
}

// Centre and amplitude are angles of a revolute joint, lengths of a prismatic one.
Swing SimulationReader::read_swing(MapReader& map, JointKind kind) const {
  const auto value = [&](const char* key) {
    const YamlNode* node = map.optional(key);
    if (node == nullptr) return 0.0;
    const std::string what = std::string("the joint's ") + key;
    return (kind == JointKind::kRevolute ? quantities_.angle(*node, what)
                                         : quantities_.length(*node, what))
        .value_or(0.0);
  };
  Swing swing;
  swing.centre = value("centre");
  swing.amplitude = value("amplitude");
  if (const YamlNode* node = map.optional("frequency_hz"))
    swing.frequency_hz = read_frequency(*node);
  if (const YamlNode* node = map.optional("phase")) {
    swing.phase = quantities_.angle(*node, "the phase").value_or(0.0);
  }
  return swing;
}

// Reads a joint, and the objects that its link carries.
SimulatedJoint SimulationReader::read_joint(const YamlNode& node) {
  SimulatedJoint joint;
  MapReader map(node, "a joint", diagnostics_);
  if (const YamlNode* objects = map.optional("objects")) {
    for (const YamlNode& item :
         read_list(*objects, "objects that ride on the link", diagnostics_)) {
      if (const auto object = read_object(item)) joint.objects.push_back(*object);
    }
  }
  joint.parent_from_joint = read_pose(map.optional("origin"));
  if (const YamlNode* axis = map.optional("axis")) {
    joint.axis =
        quantities_.direction(*axis, "the joint's axis").value_or(Vec3::UnitZ()).normalized();
  }
  joint.kind = read_kind(map);
  joint.motion = read_swing(map, joint.kind);
  map.refuse_unknown_keys();
  return joint;
}

// Reads the joints from the base outwards.
SimulatedChain SimulationReader::read_chain(const YamlNode& node) {
  SimulatedChain chain;
  MapReader map(node, "a chain", diagnostics_);
  if (const YamlNode* name = map.required("name")) {
    chain.name = read_name(*name, "a chain's name", diagnostics_).value_or("");
  }
  chain.world_from_base = read_pose(map.optional("base"));
  if (const YamlNode* joints = map.required("joints")) {
    for (const YamlNode& joint : read_list(*joints, "joints", diagnostics_)) {
      chain.joints.push_back(read_joint(joint));
    }
  }
  map.refuse_unknown_keys();
  return chain;
}

// Reads one object, or a frame of tf, that swings about a centre and may spin.
void SimulationReader::read_mover(const YamlNode& node, Simulation& simulation) {
  SimulatedMover mover;
  MapReader map(node, "a mover", diagnostics_);
  const YamlNode* const frame = map.optional("frame");
  if (const YamlNode* object = frame != nullptr ? map.optional("object") : map.required("object")) {
    mover.object = read_object(*object).value_or(0);
    if (frame != nullptr)
      diagnostics_.add(*object,
                       "found 'object' beside 'frame' of a mover; expected one of the two");
  }
  mover.centre = read_pose(map.optional("centre"));
  if (const YamlNode* amplitude = map.optional("amplitude")) {
    mover.amplitude =
        quantities_.lengths(*amplitude, "the swing's amplitude").value_or(Vec3::Zero());
  }
  if (const YamlNode* frequency = map.optional("frequency_hz"))
    mover.frequency_hz = read_frequency(*frequency);
  if (const YamlNode* phase = map.optional("phase")) {
    mover.phase = quantities_.angle(*phase, "the phase").value_or(0.0);
  }
  if (const YamlNode* spin = map.optional("spin")) {
    mover.spin = quantities_.angles(*spin, "the spin a second").value_or(Vec3::Zero());
  }
  map.refuse_unknown_keys();
  if (frame == nullptr) {
    simulation.movers.push_back(mover);
    return;
  }
  const std::string name = read_frame(*frame, diagnostics_).value_or("");
  if (std::ranges::find(simulation.frames, name, &SimulatedFrame::name) != simulation.frames.end())
    diagnostics_.add(*frame, fmt::format("found the frame '{}' again; expected it once", name));
  simulation.frames.push_back({name, mover});
}

}  // namespace

// Both lists may be absent: an empty section is allowed, since a cell may get its motion later.
Simulation read_simulation(const YamlNode& node, const ObjectList& objects,
                           const Quantities& quantities) {
  Diagnostics& diagnostics = quantities.diagnostics();
  Simulation simulation;
  SimulationReader reader(objects, quantities);
  MapReader map(node, "the simulation", diagnostics);
  if (const YamlNode* chains = map.optional("chains")) {
    for (const YamlNode& chain : read_list(*chains, "chains", diagnostics)) {
      simulation.chains.push_back(reader.read_chain(chain));
    }
  }
  if (const YamlNode* movers = map.optional("movers")) {
    for (const YamlNode& mover : read_list(*movers, "movers", diagnostics)) {
      reader.read_mover(mover, simulation);
    }
  }
  map.refuse_unknown_keys();
  return simulation;
}

}  // namespace clearance
