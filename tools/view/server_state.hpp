// The state that the server shares with its connections.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "tools/view/allowed_hosts.hpp"
#include "tools/view/server.hpp"

namespace clearance::view {

// The names of Boost's network library, for the server and its viewers.
namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using Error = beast::error_code;

class Viewer;

struct ServerState {
  ServerState(Content the_content, AllowedHosts the_hosts)
      : content(std::move(the_content)), hosts(std::move(the_hosts)) {}

  Content content;
  AllowedHosts hosts;
  std::string address, session;
  std::set<Viewer*> viewers;
  std::map<std::pair<ChannelId, std::uint32_t>, Message> latest;
  std::map<std::string, std::string> statuses;  // by id: the JSON that is sent
  std::set<std::string> told;                   // the messages on stderr so far
  // Last, since their operations use all of the above and end with them.
  asio::io_context context{1};
  tcp::acceptor acceptor{context};
  asio::steady_timer pause{context};  // while connections cannot be accepted

  void accept();
  // Writes this line to stderr, once; after a few different ones, no more.
  void tell_once(const std::string& line);
};

}  // namespace clearance::view
