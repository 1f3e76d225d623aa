// Passes the metrics of a daemon on: from the Unix socket of `clearanced --metrics` to whoever asks
// the view's port for /metrics.
#pragma once

#include <boost/asio/io_context.hpp>
#include <filesystem>
#include <functional>
#include <string>

namespace clearance::view {

struct RelayedMetrics {
  unsigned status = 0;  // of HTTP; 502: the socket did not answer
  std::string type;     // Content-Type
  std::string body;     // the daemon's text, or a sentence with the path and the reason
};

// Asks the daemon, and calls `done` in a thread of the context, once. It gives up after a second.
void relay_metrics(boost::asio::io_context& context, const std::filesystem::path& socket,
                   std::function<void(RelayedMetrics)> done);

}  // namespace clearance::view
