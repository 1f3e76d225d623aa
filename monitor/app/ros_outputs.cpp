#include "monitor/app/ros_outputs.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "monitor/app/options.hpp"

namespace clearance {
namespace {

constexpr std::string_view kAllOutputs = "all";

}  // namespace

Option ros_outputs_option(std::vector<std::string>& asked, std::vector<std::string> excludes) {
  std::vector<std::string> keys = {std::string(kAllOutputs)};
  for (const RosOutput& output : kRosOutputs) keys.emplace_back(output.key);
  return {"--ros2",
          &asked,
          "Write this ROS 2 output too, on its standard topic: markers, diagnostics, "
          "minimum_distance, speed_scaling, monitored_planning_scene, log, messages, or all; "
          "repeatable",
          Check{one_word_of(keys).fault},
          {.excludes = std::move(excludes)}};
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
