#include "monitor/recording/robot_description.hpp"

#include <memory>
#include <string_view>

#include "monitor/recording/bag.hpp"
#include "monitor/wire/cdr.hpp"
#include "monitor/wire/ros_types.hpp"

namespace clearance {

std::optional<std::string> robot_description(const std::filesystem::path& bag) {
  constexpr std::string_view kTopic = "robot_description", kType = "std_msgs/msg/String";
  const std::unique_ptr<Bag> opened = open_bag(bag);
  BagMessage message;
  CdrDecoder decoder;
  Sample<std_msgs_msg_dds__String_> text;
  while (opened->next(message)) {
    const BagTopic& topic = *message.topic;
    const bool is_it =
        topic.name.ends_with(kTopic) && topic.type == kType && topic.encoding == "cdr";
    if (is_it && decoder.decode(message.payload, text) && *text->data != '\0') return text->data;
  }
  return std::nullopt;
}

}  // namespace clearance
