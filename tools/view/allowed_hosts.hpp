// Clients that clearance-view answers: programs, its own page, and pages of stated hosts.
//
// A browser names the host that was asked (Host) and the page that asks (Origin). The page of
// another server has another Origin. A foreign name that was rebound to this machine's address (DNS
// rebinding) shows as another Host.
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace clearance::view {

// "NAME:PORT" of Host, Origin and --allow. An address of IPv6 stands in brackets.
struct Authority {
  std::string name;  // in lower case
  std::optional<std::uint16_t> port;
  bool operator==(const Authority&) const = default;
};

// Nothing: the text is no NAME or NAME:PORT.
[[nodiscard]] std::optional<Authority> authority_of(std::string_view text);

// Says what is wrong with an argument of --allow; empty: nothing.
[[nodiscard]] std::string fault_of_allowed(const std::string& text);

// The headers of a request, each value of its name, and the address and port that it reached.
struct Asked {
  std::vector<std::string> hosts, origins;
  boost::asio::ip::tcp::endpoint reached;
};

class AllowedHosts {
 public:
  // `served`: the host that --host gave. `stated`: NAME, which allows every port, or NAME:PORT; or
  // an origin as browsers write it ("https://NAME", "file://", "null"), which only allows its
  // pages.
  AllowedHosts(const std::string& served, const std::vector<std::string>& stated);

  // Returns an empty text when the request may be answered; else what was found, what was expected,
  // and how to allow it.
  [[nodiscard]] std::string refusal_of(const Asked& asked) const;

 private:
  [[nodiscard]] bool is_own(const Authority& found,
                            const boost::asio::ip::tcp::endpoint& reached) const;
  [[nodiscard]] bool is_stated(const Authority& found) const;
  [[nodiscard]] bool is_allowed_origin(const std::string& origin,
                                       const boost::asio::ip::tcp::endpoint& reached) const;

  std::string served_;
  std::vector<Authority> stated_;
  std::set<std::string> stated_origins_;
};

}  // namespace clearance::view
