#include "monitor/publish/metrics_server.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <stdexcept>
#include <string>

#include "tests/monitor/publish/metrics_client.hpp"

namespace clearance {
namespace {

using test::ask;
using test::body_of;

class MetricsServerTest : public testing::Test {
 protected:
  [[nodiscard]] std::string reason_of_failure() const {
    try {
      const MetricsServer server(socket);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }
  const test::ScratchFolder folder;
  const std::filesystem::path socket = folder / "metrics.sock";
};

TEST_F(MetricsServerTest, ServesTheLastTextAndRefusesEverythingElse) {
  MetricsServer server(socket);
  EXPECT_TRUE(ask(socket, "GET", "/metrics").starts_with("HTTP/1.1 503")) << "no text yet";
  server.publish("a 1\n");
  server.publish("a 2\n");
  const std::string answer = ask(socket, "GET", "/metrics?name=x");
  EXPECT_TRUE(answer.starts_with("HTTP/1.1 200")) << answer;
  EXPECT_NE(answer.find("Content-Type: text/plain; version=0.0.4"), std::string::npos) << answer;
  EXPECT_EQ(body_of(answer), "a 2\n");
  EXPECT_TRUE(ask(socket, "GET", "/").starts_with("HTTP/1.1 404"));
  EXPECT_TRUE(ask(socket, "POST", "/metrics").starts_with("HTTP/1.1 405"));
}

TEST_F(MetricsServerTest, AClientThatSendsNothingOrNonsenseDelaysNoOther) {
  MetricsServer server(socket);
  server.publish("a 1\n");
  test::UnixClient silent(socket), half(socket), nonsense(socket), endless(socket);
  half.send("GET /metr");
  nonsense.send("\x01\x02\r\n\r\n");
  endless.send("GET /metrics HTTP/1.1\r\nX: " + std::string(100'000, 'x'));
  EXPECT_EQ(body_of(ask(socket, "GET", "/metrics")), "a 1\n");
  EXPECT_EQ(body_of(silent.rest()), "") << "dropped";
  EXPECT_EQ(body_of(half.rest()), "");
  EXPECT_EQ(body_of(nonsense.rest()), "");
  EXPECT_EQ(body_of(endless.rest()), "");
  EXPECT_EQ(body_of(ask(socket, "GET", "/metrics")), "a 1\n");
}

TEST_F(MetricsServerTest, ReplacesASocketThatWasLeftAndNothingElse) {
  {
    MetricsServer server(socket);
    struct stat status {};
    ASSERT_EQ(::stat(socket.c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777, 0660u);
    EXPECT_NE(reason_of_failure().find("in use"), std::string::npos) << reason_of_failure();
    EXPECT_TRUE(test::UnixClient(socket).is_connected()) << "the first server goes on";
  }
  EXPECT_FALSE(std::filesystem::exists(socket));
  {
    // A program that was killed leaves its socket.
    const int fd = ::socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, socket.c_str(), sizeof address.sun_path - 1);
    ASSERT_EQ(::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    ::close(fd);
  }
  EXPECT_EQ(reason_of_failure(), "");
  test::write_text(socket, "a file");
  EXPECT_NE(reason_of_failure().find("no socket"), std::string::npos);
  EXPECT_EQ(std::filesystem::file_size(socket), 6u);
  std::filesystem::remove(socket);
  EXPECT_THROW(MetricsServer(folder / "none" / "metrics.sock"), std::runtime_error);
}

}  // namespace
}  // namespace clearance
