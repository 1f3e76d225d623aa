#include "tools/view/allowed_hosts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/ip/address.hpp>
#include <cctype>
#include <charconv>

#include "config/text/printable.hpp"

namespace clearance::view {
namespace {

namespace ip = boost::asio::ip;
constexpr std::uint16_t kHttpPort = 80, kHttpsPort = 443;
constexpr std::string_view kHttp = "http://", kHttps = "https://";

std::string lower(std::string_view text) {
  std::string small(text);
  std::ranges::transform(small, small.begin(), [](unsigned char c) { return std::tolower(c); });
  return small;
}

std::string_view without_brackets(std::string_view name) {
  return name.size() > 1 && name.front() == '[' && name.back() == ']'
             ? name.substr(1, name.size() - 2)
             : name;
}

// An IPv4 address that came through a socket of IPv6 is the IPv4 address.
ip::address plain(const ip::address& address) {
  return address.is_v6() && address.to_v6().is_v4_mapped()
             ? ip::address(ip::make_address_v4(ip::v4_mapped, address.to_v6()))
             : address;
}

bool is_origin_form(std::string_view text) {
  return text == "null" || text.find("://") != std::string_view::npos;
}

}  // namespace

std::optional<Authority> authority_of(std::string_view text) {
  constexpr std::string_view kNameCharacters =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-._[]:";
  if (text.find_first_not_of(kNameCharacters) != std::string_view::npos) return std::nullopt;
  const std::size_t colon = text.rfind(':');
  const std::size_t bracket = text.rfind(']');
  const bool has_port =
      colon != std::string_view::npos && (bracket == std::string_view::npos || colon > bracket);
  Authority found{.name = lower(text.substr(0, has_port ? colon : text.size())), .port = {}};
  if (found.name.empty() ||
      (found.name.front() != '[' && found.name.find(':') != std::string::npos))
    return std::nullopt;
  if (!has_port) return found;
  const std::string_view digits = text.substr(colon + 1);
  std::uint16_t port = 0;
  const auto [end, error] = std::from_chars(digits.begin(), digits.end(), port);
  if (error != std::errc{} || end != digits.end()) return std::nullopt;
  found.port = port;
  return found;
}

std::string fault_of_allowed(const std::string& text) {
  if (is_origin_form(text) || authority_of(text)) return {};
  return fmt::format("found '{}'; expected NAME, NAME:PORT, or an origin: https://NAME",
                     excerpt(text));
}

AllowedHosts::AllowedHosts(const std::string& served, const std::vector<std::string>& stated)
    : served_(lower(without_brackets(served))) {
  for (const std::string& text : stated) {
    if (is_origin_form(text)) {
      stated_origins_.insert(lower(text));
    } else if (const auto host = authority_of(text)) {
      stated_.push_back(*host);
    }
  }
}

// The address that a request reached can be no foreign name, so every address of this machine is
// its own.
bool AllowedHosts::is_own(const Authority& found, const ip::tcp::endpoint& reached) const {
  if (found.port.value_or(kHttpPort) != reached.port()) return false;
  const std::string_view name = without_brackets(found.name);
  const ip::address address = plain(reached.address());
  if (name == served_ || (name == "localhost" && address.is_loopback())) return true;
  boost::system::error_code error;
  const ip::address named = ip::make_address(name, error);
  return !error && plain(named) == address;
}

bool AllowedHosts::is_stated(const Authority& found) const {
  return std::ranges::any_of(stated_, [&](const Authority& stated) {
    return stated.name == found.name && (!stated.port || stated.port == found.port);
  });
}

// The page itself is served without encryption; a stated host may encrypt what it passes on.
bool AllowedHosts::is_allowed_origin(const std::string& origin,
                                     const ip::tcp::endpoint& reached) const {
  if (stated_origins_.contains(lower(origin))) return true;
  const bool encrypted = origin.starts_with(kHttps);
  if (!encrypted && !origin.starts_with(kHttp)) return false;
  auto page = authority_of(std::string_view(origin).substr((encrypted ? kHttps : kHttp).size()));
  if (!page) return false;
  if (!encrypted && is_own(*page, reached)) return true;
  if (!page->port) page->port = encrypted ? kHttpsPort : kHttpPort;
  return is_stated(*page);
}

std::string AllowedHosts::refusal_of(const Asked& asked) const {
  if (asked.hosts.size() != 1) {
    return fmt::format("found {} headers 'Host' in the request; expected one", asked.hosts.size());
  }
  const auto host = authority_of(asked.hosts.front());
  if (!host || !(is_own(*host, asked.reached) || is_stated(*host))) {
    return fmt::format(
        "found a request for the host '{0}'; expected an address of this program, or a host that "
        "--allow states: --allow {0}",
        excerpt(asked.hosts.front()));
  }
  for (const std::string& origin : asked.origins) {
    if (is_allowed_origin(origin, asked.reached)) continue;
    return fmt::format(
        "found a request by a page of '{0}'; expected this program's own page, or one of an origin "
        "that --allow states: --allow {0}",
        excerpt(origin));
  }
  return {};
}

}  // namespace clearance::view
