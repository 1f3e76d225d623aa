#include "config/cell/ros_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "config/yaml/map_reader.hpp"
#include "config/yaml/scalar.hpp"

namespace clearance {
namespace {

constexpr Range kMarkerRates{.least = 0.1, .most = 1000.0};  // Hz

// `true`: the standard topic; `false`: none; or the topic's name.
std::string read_topic(const YamlNode& node, std::string_view standard_topic,
                       Diagnostics& diagnostics) {
  if (node.kind == YamlNode::Kind::kScalar && scalar_type(node) == ScalarType::kFlag) {
    return read_flag(node, diagnostics).value_or(false) ? std::string(standard_topic) : "";
  }
  const auto topic = read_text(node, "true, false or a topic of ROS 2", diagnostics);
  if (topic && !is_ros_topic(*topic)) {
    diagnostics.add(node, fmt::format("found '{}'; expected true, false or a topic of ROS 2 with "
                                      "its namespace: {}",
                                      *topic, standard_topic));
  }
  return topic.value_or("");
}

void refuse_same_topics(const YamlNode& node, const RosSettings& settings,
                        Diagnostics& diagnostics) {
  std::map<std::string, std::string_view> taken;
  const auto take = [&](const std::string& topic, std::string_view key) {
    if (topic.empty()) return;
    const auto [same, is_new] = taken.emplace(topic, key);
    if (is_new) return;
    diagnostics.add(node, fmt::format("found the topic '{}' for both '{}' and '{}'; expected a "
                                      "topic of its own for each",
                                      topic, same->second, key));
  };
  for (const RosOutput& output : kRosOutputs) {
    if (output.topic != &RosOutputs::messages) take(settings.outputs.*output.topic, output.key);
  }
  if (const std::string& space = settings.outputs.messages; !space.empty()) {
    for (const std::string_view name : kRosMessages)
      take(fmt::format("{}/{}", space, name), "messages");
  }
  for (const MoveItInput& input : kMoveItInputs) take(settings.moveit.*input.topic, input.key);
  for (const std::string& topic : settings.trajectories.topics) take(topic, "trajectories");
}

void read_trajectories(MapReader& map, const Quantities& quantities,
                       RosTrajectories& trajectories) {
  Diagnostics& diagnostics = quantities.diagnostics();
  if (const YamlNode* topics = map.optional("trajectories")) {
    for (const YamlNode& item : read_list(*topics, "topics of trajectories", diagnostics)) {
      const std::string topic = read_topic(item, "/joint_trajectory", diagnostics);
      if (!topic.empty()) trajectories.topics.push_back(topic);
    }
  }
  const YamlNode* margins = map.optional("trajectory_margins");
  if (margins == nullptr) return;
  trajectories.margins.clear();
  for (const YamlNode& item : read_list(*margins, "margins", diagnostics)) {
    if (const auto margin = quantities.length(item, "a margin of trajectories", kNotNegative))
      trajectories.margins.push_back(*margin);
  }
  // A motion would be free at all of no margins.
  if (margins->kind == YamlNode::Kind::kSequence && margins->items.empty())
    diagnostics.add(*margins, "found no margin; expected one or more, 0 for contact");
}

bool is_word(char c) noexcept {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

}  // namespace

bool is_ros_topic(std::string_view name) noexcept {
  // In DDS its name begins with "rt", and discovery carries at most 255 bytes.
  constexpr std::size_t kMostBytes = 253;
  if (name.size() < 2 || name.size() > kMostBytes || name.front() != '/' || name.back() == '/')
    return false;
  for (std::size_t i = 1; i < name.size(); ++i) {
    const bool begins = name[i - 1] == '/';
    if (begins ? !is_word(name[i]) || (name[i] >= '0' && name[i] <= '9')
               : !is_word(name[i]) && name[i] != '/') {
      return false;
    }
  }
  return true;
}

std::optional<std::string> read_frame(const YamlNode& node, Diagnostics& diagnostics) {
  auto frame = read_text(node, "a frame of tf", diagnostics);
  if (frame && frame->starts_with('/')) frame->erase(0, 1);
  if (!frame || !frame->empty()) return frame;
  diagnostics.add(node,
                  fmt::format("found {}; expected the name of a frame of tf", describe(node)));
  return std::nullopt;
}

std::string read_ros_topic(const YamlNode& node, std::string_view example,
                           Diagnostics& diagnostics) {
  const auto topic = read_text(node, "a topic of ROS 2", diagnostics);
  if (!topic || is_ros_topic(*topic)) return topic.value_or("");
  diagnostics.add(node, fmt::format("found '{}'; expected a topic of ROS 2 with its namespace: {}",
                                    *topic, example));
  return "";
}

RosStamps read_stamps(const YamlNode& node, Diagnostics& diagnostics) {
  const auto text = read_text(node, "message or sent", diagnostics);
  if (text && *text != "message" && *text != "sent") {
    diagnostics.add(node, fmt::format("found '{}'; expected message (the stamp in it) or sent "
                                      "(when it was sent)",
                                      *text));
  }
  return text == "sent" ? RosStamps::kSent : RosStamps::kMessage;
}

void read_ros(const YamlNode& node, const Quantities& quantities, RosSettings& settings) {
  Diagnostics& diagnostics = quantities.diagnostics();
  MapReader map(node, "the settings of ROS 2", diagnostics);
  for (const RosOutput& output : kRosOutputs) {
    if (const YamlNode* topic = map.optional(output.key))
      settings.outputs.*output.topic = read_topic(*topic, output.standard_topic, diagnostics);
  }
  for (const MoveItInput& input : kMoveItInputs) {
    if (const YamlNode* topic = map.optional(input.key))
      settings.moveit.*input.topic = read_topic(*topic, input.standard_topic, diagnostics);
  }
  if (const YamlNode* group = map.optional("moveit_group")) {
    settings.moveit.group = read_name(*group, "the group of what MoveIt adds", diagnostics)
                                .value_or(settings.moveit.group);
  }
  read_trajectories(map, quantities, settings.trajectories);
  refuse_same_topics(node, settings, diagnostics);
  if (const YamlNode* rate = map.optional("markers_hz")) {
    settings.markers_hz =
        read_number(*rate, kMarkerRates, "the rate of the markers in Hz", diagnostics)
            .value_or(settings.markers_hz);
  }
  if (const YamlNode* frame = map.optional("world_frame"))
    settings.world_frame = read_frame(*frame, diagnostics).value_or("");
  if (const YamlNode* stamps = map.optional("stamps"))
    settings.stamps = read_stamps(*stamps, diagnostics);
  if (const YamlNode* flag = map.optional("use_sim_time"))
    settings.use_sim_time = read_flag(*flag, diagnostics).value_or(false);
  map.refuse_unknown_keys();
}

}  // namespace clearance
