#include "monitor/participant/dds_options.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cstdlib>
#include <cstring>

namespace clearance {
namespace {

constexpr std::uint32_t kMaxDomain = 232;  // ports: 7400 + 250 * domain

}  // namespace

// A stated domain wins, so that a variable that is meant for ROS 2 does not move a cell that states
// one. An empty variable counts as not set, as for ROS 2 nodes.
Domain domain_of(const DdsOptions& options) {
  if (options.domain > kMaxDomain) {
    throw DdsError(fmt::format("joining domain {} (0 to 232 exist)", *options.domain),
                   DDS_RETCODE_BAD_PARAMETER);
  }
  const char* const text = std::getenv("ROS_DOMAIN_ID");
  if (options.domain || text == nullptr || *text == '\0') return {.id = options.domain.value_or(0)};
  const char* const end = text + std::strlen(text);
  Domain domain{.is_of_ros = true};
  const auto [rest, fault] = std::from_chars(text, end, domain.id);
  if (fault == std::errc() && rest == end && domain.id <= kMaxDomain) return domain;
  throw DdsError(
      fmt::format("DDS: found ROS_DOMAIN_ID='{}'; expected a domain, 0 to {}. A domain that an "
                  "option or the cell states overrides it",
                  text, kMaxDomain));
}

DdsError::DdsError(const std::string& text) : std::runtime_error(text) {}

DdsError::DdsError(const std::string& attempted, dds_return_t code)
    : std::runtime_error(fmt::format("DDS: {} failed: {}", attempted, dds_strretcode(code))) {}

}  // namespace clearance
