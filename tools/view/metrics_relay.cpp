#include "tools/view/metrics_relay.hpp"

#include <fmt/format.h>

#include <boost/asio/local/stream_protocol.hpp>
#include <boost/beast/core/basic_stream.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <boost/system/system_error.hpp>
#include <chrono>
#include <memory>
#include <utility>

namespace clearance::view {
namespace {

namespace beast = boost::beast;
namespace http = boost::beast::http;
using Local = boost::asio::local::stream_protocol;

constexpr std::chrono::seconds kRelayPatience{1};
constexpr std::uint64_t kLongestText = 64 << 20;

// One question to the daemon. It lives as long as its handlers.
class Question : public std::enable_shared_from_this<Question> {
 public:
  Question(boost::asio::io_context& context, std::filesystem::path socket,
           std::function<void(RelayedMetrics)> done)
      : stream_(context), socket_(std::move(socket)), done_(std::move(done)) {
    answer_.body_limit(kLongestText);
    request_.set(http::field::host, "localhost");
  }

  void ask() {
    Local::endpoint endpoint;
    try {
      endpoint = Local::endpoint(socket_.string());
    } catch (const boost::system::system_error& too_long) {
      return fail(too_long.code());
    }
    stream_.expires_after(kRelayPatience);
    stream_.async_connect(endpoint, [self = shared_from_this()](const beast::error_code& error) {
      if (error) return self->fail(error);
      self->write();
    });
  }

 private:
  void write() {
    http::async_write(stream_, request_,
                      [self = shared_from_this()](const beast::error_code& error, std::size_t) {
                        if (error) return self->fail(error);
                        self->read();
                      });
  }
  void read() {
    http::async_read(
        stream_, buffer_, answer_,
        [self = shared_from_this()](const beast::error_code& error, std::size_t) {
          if (error) return self->fail(error);
          auto& answer = self->answer_.get();
          self->done_({answer.result_int(), std::string(answer[http::field::content_type]),
                       std::move(answer.body())});
        });
  }
  void fail(const beast::error_code& error) {
    done_({static_cast<unsigned>(http::status::bad_gateway), "text/plain; charset=utf-8",
           fmt::format("clearance-view: '{0}' does not answer: {1}; expected clearanced with "
                       "--metrics {0} on this machine\n",
                       socket_.string(), error.message())});
  }

  beast::basic_stream<Local> stream_;
  std::filesystem::path socket_;
  std::function<void(RelayedMetrics)> done_;
  http::request<http::empty_body> request_{http::verb::get, "/metrics", 11};
  beast::flat_buffer buffer_;
  http::response_parser<http::string_body> answer_;
};

}  // namespace

void relay_metrics(boost::asio::io_context& context, const std::filesystem::path& socket,
                   std::function<void(RelayedMetrics)> done) {
  std::make_shared<Question>(context, socket, std::move(done))->ask();
}

}  // namespace clearance::view
