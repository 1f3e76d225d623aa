#include "monitor/intake/raw_message.hpp"

namespace clearance {

TopicName as_in_ros(std::string_view dds_name, std::string_view dds_type) {
  constexpr std::string_view kRosPrefix = "rt/", kMessages = "::msg::dds_::";
  const std::size_t package_end = dds_type.find(kMessages);
  if (!dds_name.starts_with(kRosPrefix) || package_end == std::string_view::npos ||
      !dds_type.ends_with('_')) {
    return {std::string(dds_name), std::string(dds_type)};
  }
  const std::string package(dds_type.substr(0, package_end));
  const std::string message(dds_type.substr(package_end + kMessages.size()));
  return {std::string(dds_name.substr(kRosPrefix.size() - 1)),
          package + "/msg/" + message.substr(0, message.size() - 1)};
}

}  // namespace clearance
