#include "monitor/app/ros_outputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "config/text/sentences.hpp"

namespace clearance {
namespace {

constexpr std::string_view kAllOutputs = "all";

std::string is_ros_output(const std::string& text) {
  std::vector<std::string> keys = {std::string(kAllOutputs)};
  for (const RosOutput& output : kRosOutputs) keys.emplace_back(output.key);
  if (std::ranges::find(keys, text) != keys.end()) return {};
  return fmt::format("found '{}'; expected {}", text, one_of(keys));
}

}  // namespace

CLI::Option* add_ros_outputs(CLI::App& app, std::vector<std::string>& asked) {
  return app
      .add_option("--ros2", asked,
                  "Write this ROS 2 output too, on its standard topic: markers, diagnostics, "
                  "minimum_distance, speed_scaling, monitored_planning_scene, messages, or all; "
                  "repeatable")
      ->allow_extra_args(false)
      ->check(is_ros_output);
}

void add_asked(const std::vector<std::string>& asked, RosOutputs& outputs) {
  for (const RosOutput& output : kRosOutputs) {
    const bool is_asked = std::ranges::find(asked, output.key) != asked.end() ||
                          std::ranges::find(asked, kAllOutputs) != asked.end();
    std::string& topic = outputs.*output.topic;
    if (is_asked && topic.empty()) topic = output.standard_topic;
  }
}

}  // namespace clearance
