#include "monitor/publish/metrics_server.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/basic_stream.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <chrono>
#include <functional>
#include <stdexcept>
#include <thread>
#include <utility>

#include "monitor/interface/mutex.hpp"
#include "monitor/loop/realtime.hpp"

namespace clearance {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using Local = asio::local::stream_protocol;
using ErrorCode = boost::system::error_code;

constexpr std::chrono::seconds kLongestExchange{1};
constexpr std::uint32_t kLongestRequest = 8192;
constexpr mode_t kRights = S_IRUSR | S_IWUSR | S_IRGRP | S_IWGRP;
constexpr const char* kType = "text/plain; version=0.0.4; charset=utf-8";

[[noreturn]] void fail(const std::filesystem::path& socket, const std::string& reason) {
  throw std::runtime_error(fmt::format("metrics: '{}' {}", socket.string(), reason));
}

// Removes a socket on which no program listens any more.
void clear(asio::io_context& context, const std::filesystem::path& socket) {
  std::error_code error;
  const auto status = std::filesystem::symlink_status(socket, error);
  if (!std::filesystem::exists(status)) return;
  if (!std::filesystem::is_socket(status))
    fail(socket, "is no socket; expected a path to make one");
  Local::socket probe(context);
  ErrorCode refused;
  probe.connect(Local::endpoint(socket.string()), refused);
  if (!refused) fail(socket, "is in use: another program listens there");
  std::filesystem::remove(socket, error);
}

// One request and its answer. It lives as long as its handlers.
class Exchange : public std::enable_shared_from_this<Exchange> {
 public:
  using Stream = beast::basic_stream<Local>;
  using Answer =
      std::function<http::response<http::string_body>(const http::request<http::empty_body>&)>;

  Exchange(Local::socket socket, Answer answer)
      : stream_(std::move(socket)), answer_(std::move(answer)) {
    parser_.header_limit(kLongestRequest);
  }
  void begin() {
    stream_.expires_after(kLongestExchange);
    http::async_read(stream_, buffer_, parser_,
                     [self = shared_from_this()](const ErrorCode& error, std::size_t) {
                       if (!error) self->reply();
                     });
  }

 private:
  void reply() {
    response_ = answer_(parser_.get());
    http::async_write(stream_, response_,
                      [self = shared_from_this()](const ErrorCode&, std::size_t) {
                        ErrorCode ignored;
                        self->stream_.socket().shutdown(Local::socket::shutdown_both, ignored);
                      });
  }

  Stream stream_;
  Answer answer_;
  beast::flat_buffer buffer_{kLongestRequest};
  http::request_parser<http::empty_body> parser_;
  http::response<http::string_body> response_;
};

}  // namespace

struct MetricsServer::State {
  explicit State(const std::filesystem::path& path)
      : socket(path), acceptor(context), timer(context) {
    clear(context, socket);
    try {
      const Local::endpoint endpoint(socket.string());
      acceptor.open(endpoint.protocol());
      // Until the last line it has at most these rights, and no client can connect before listen().
      ::fchmod(acceptor.native_handle(), kRights);
      acceptor.bind(endpoint);
      ::chmod(socket.c_str(), kRights);
      acceptor.listen();
    } catch (const boost::system::system_error& error) {
      fail(socket, fmt::format("cannot be listened on: {}", error.code().message()));
    }
    accept();
    thread = std::thread([this] {
      name_thread("metrics");
      context.run();
    });
  }
  ~State() {
    context.stop();
    thread.join();
    std::error_code ignored;
    std::filesystem::remove(socket, ignored);
  }

  // Without free file descriptors, accepting fails at once: then it waits.
  void accept() {
    acceptor.async_accept([this](const ErrorCode& error, Local::socket client) {
      if (error) {
        timer.expires_after(kLongestExchange);
        timer.async_wait([this](const ErrorCode&) { accept(); });
        return;
      }
      const auto reply = [this](const auto& request) { return answer(request); };
      std::make_shared<Exchange>(std::move(client), reply)->begin();
      accept();
    });
  }
  http::response<http::string_body> answer(const http::request<http::empty_body>& request) {
    const auto target = request.target().substr(0, request.target().find('?'));
    const bool is_get = request.method() == http::verb::get;
    http::status status = http::status::ok;
    std::string body;
    if (!is_get) {
      status = http::status::method_not_allowed;
    } else if (target != "/metrics") {
      status = http::status::not_found;
      body = "expected /metrics\n";
    } else {
      const Lock lock(mutex);
      body = text;
      if (body.empty()) status = http::status::service_unavailable;
    }
    http::response<http::string_body> response(status, request.version());
    response.set(http::field::content_type, kType);
    response.keep_alive(false);
    response.body() = std::move(body);
    response.prepare_payload();
    return response;
  }

  std::filesystem::path socket;
  asio::io_context context;
  Local::acceptor acceptor;
  asio::steady_timer timer;
  Mutex mutex;
  GUARDED_BY(mutex) std::string text;
  std::thread thread;
};

MetricsServer::MetricsServer(const std::filesystem::path& socket)
    : state_(std::make_unique<State>(socket)) {}
MetricsServer::~MetricsServer() = default;

void MetricsServer::publish(std::string text) {
  const Lock lock(state_->mutex);
  state_->text = std::move(text);
}

}  // namespace clearance
