#include "monitor/dds/daemon_identity.hpp"

#include <fmt/format.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <charconv>
#include <fstream>
#include <random>
#include <tuple>
#include <utility>

#include "monitor/loop/ports.hpp"

namespace clearance {
namespace {

constexpr std::string_view kProgram = "clearanced ";

std::string host_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "?";
}

std::string boot_id() {
  std::ifstream file("/proc/sys/kernel/random/boot_id");
  std::string id;
  file >> id;
  return id;
}

// The text after "key=", up to the next blank; empty when there is no such key.
std::string_view value_of(std::string_view text, std::string_view key) {
  const std::size_t at = text.find(fmt::format(" {}=", key));
  if (at == std::string_view::npos) return {};
  text.remove_prefix(at + key.size() + 2);
  return text.substr(0, text.find(' '));
}

template <class Number>
bool read_number(std::string_view text, Number& out, int base = 10) {
  const char* const end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, out, base);
  return error == std::errc() && stopped == end;
}

}  // namespace

std::string DaemonIdentity::described() const {
  const std::string process = fmt::format("pid {} on {}", pid, host);
  return partner.empty() ? process : fmt::format("'{}', {}", partner, process);
}

DaemonIdentity make_identity(std::string partner) {
  std::random_device random;
  timespec up{};
  ::clock_gettime(CLOCK_BOOTTIME, &up);
  DaemonIdentity identity{.start_ns = SystemClock().realtime_ns(),
                          .pid = getpid(),
                          .host = host_name(),
                          .partner = std::move(partner),
                          .boot = boot_id(),
                          .up_ns = up.tv_sec * std::int64_t{1'000'000'000} + up.tv_nsec};
  while (identity.id == 0) identity.id = std::uint64_t{random()} << 32 | random();
  return identity;
}

std::string to_user_data(const DaemonIdentity& identity) {
  return fmt::format(
      "{}id={:016x} start_ns={} pid={} host={}{}{}", kProgram, identity.id, identity.start_ns,
      identity.pid, identity.host,
      identity.boot.empty() ? "" : fmt::format(" boot={} up_ns={}", identity.boot, identity.up_ns),
      identity.partner.empty() ? "" : " partner=" + identity.partner);
}

std::optional<DaemonIdentity> from_user_data(std::string_view text) {
  DaemonIdentity identity{.host = std::string(value_of(text, "host")),
                          .partner = std::string(value_of(text, "partner")),
                          .boot = std::string(value_of(text, "boot"))};
  if (!identity.boot.empty() && !read_number(value_of(text, "up_ns"), identity.up_ns))
    return std::nullopt;
  if (!text.starts_with(kProgram) || !read_number(value_of(text, "id"), identity.id, 16) ||
      !read_number(value_of(text, "start_ns"), identity.start_ns) ||
      !read_number(value_of(text, "pid"), identity.pid)) {
    return std::nullopt;
  }
  return identity;
}

bool are_partners(const DaemonIdentity& one, const DaemonIdentity& other) noexcept {
  return !one.partner.empty() && !other.partner.empty() && one.partner != other.partner;
}

bool yields_to(const DaemonIdentity& one, const DaemonIdentity& other) noexcept {
  if (!one.boot.empty() && one.boot == other.boot)
    return std::tie(one.up_ns, one.id) > std::tie(other.up_ns, other.id);
  return std::tie(one.start_ns, one.id) > std::tie(other.start_ns, other.id);
}

}  // namespace clearance
