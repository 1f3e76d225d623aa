// Programs that clearance-view answers, and what it does when the machine gives it no more
// connections.
#include <arpa/inet.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <ctime>
#include <fstream>
#include <future>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/tools/running_cell.hpp"
#include "tests/tools/running_view.hpp"

namespace clearance::test {
namespace {

using nlohmann::json;

constexpr int kGranted = 200, kSwitched = 101, kForbidden = 403;

// A viewer without a daemon.
struct LonelyView {
  explicit LonelyView(const std::vector<std::string>& more = {}, const ChildOptions& options = {})
      : view(with(with({cell.path()}, more), dds_arguments(own_dds())), options) {}
  CellFile cell{small_cell("small")};
  View view;
};

// The answers to these cases of access.mjs.
std::vector<json> answers(const View& view, const std::vector<json>& cases) {
  std::vector<std::string> arguments = {view.page()};
  for (const json& each : cases) arguments.push_back(each.dump());
  Script script("access", arguments);
  EXPECT_EQ(script.wait(), 0) << script.output();
  std::vector<json> found = lines_of(script);
  EXPECT_EQ(found.size(), cases.size()) << script.output();
  found.resize(cases.size());
  return found;
}

void expect_answered(const json& answer, bool is_answered) {
  SCOPED_TRACE(answer.dump());
  EXPECT_EQ(answer.value("page", 0), is_answered ? kGranted : kForbidden);
  EXPECT_EQ(answer.value("scene", 0), is_answered ? kGranted : kForbidden);
  EXPECT_EQ(answer.value("socket", 0), is_answered ? kSwitched : kForbidden);
}

TEST(ViewAccess, ItsOwnPageAndProgramsAreAnswered) {
  const LonelyView lonely;
  for (const json& answer :
       answers(lonely.view, {json::object(),
                             {{"origin", nullptr}},
                             {{"host", "localhost:PORT"}, {"origin", "http://localhost:PORT"}},
                             {{"host", "LocalHost:PORT"}, {"origin", "http://127.0.0.1:PORT"}}})) {
    expect_answered(answer, true);
  }
}

TEST(ViewAccess, PagesOfOtherServersAndForeignNamesForThisMachineAreNotAnswered) {
  const LonelyView lonely;
  const std::vector<json> found = answers(
      lonely.view, {{{"origin", "http://foreign.example"}},
                    {{"origin", "https://127.0.0.1:PORT"}},
                    {{"origin", "http://127.0.0.1"}},
                    {{"origin", "http://127.0.0.1:1"}},
                    {{"origin", "http://127.0.0.1:PORT.foreign.example"}},
                    {{"origin", "null"}},
                    {{"origin", "file://"}},
                    {{"origin", ""}},
                    {{"host", "foreign.example:PORT"}, {"origin", nullptr}},
                    {{"host", "foreign.example:PORT"}, {"origin", "http://foreign.example:PORT"}},
                    {{"host", "localhost.foreign.example:PORT"}, {"origin", nullptr}},
                    {{"host", "127.0.0.1"}, {"origin", nullptr}},
                    {{"host", "127.0.0.1:1"}, {"origin", nullptr}},
                    {{"host", "127.0.0.2:PORT"}, {"origin", nullptr}}});
  for (const json& answer : found) expect_answered(answer, false);
  // The answer names what was refused, and the option that allows it.
  EXPECT_THAT(found[0].value("text", ""), testing::HasSubstr("--allow http://foreign.example"));
  EXPECT_THAT(found[8].value("text", ""), testing::HasSubstr("--allow foreign.example:"));
}

TEST(ViewAccess, StatedHostsAndOriginsAreAnsweredAndNoOthers) {
  const LonelyView lonely(
      {"--allow", "robot.example", "--allow", "desk:9000", "--allow", "https://viewer.example"});
  const std::vector<json> cases = {
      {{"host", "robot.example:PORT"}, {"origin", "http://robot.example:PORT"}},
      {{"host", "Robot.Example"}, {"origin", "https://robot.example"}},
      {{"host", "desk:9000"}, {"origin", "http://desk:9000"}},
      {{"origin", "https://viewer.example"}}};
  for (const json& answer : answers(lonely.view, cases)) expect_answered(answer, true);
  const std::vector<json> others = {
      {{"host", "desk:9001"}, {"origin", nullptr}},
      {{"host", "viewer.example:PORT"}, {"origin", nullptr}},
      {{"origin", "http://viewer.example"}},
      {{"origin", "https://viewer.example:444"}},
      {{"host", "robot.example.foreign.example:PORT"}, {"origin", nullptr}}};
  for (const json& answer : answers(lonely.view, others)) expect_answered(answer, false);
}

TEST(ViewAccess, AnAllowedHostThatIsNoneIsWrongUsage) {
  for (const char* const wrong : {"two words", "desk:port", "desk:70000", "::1", "-/"}) {
    ChildProcess view(kView, {"cell.yaml", fmt::format("--allow={}", wrong)});
    EXPECT_EQ(view.wait(), 2) << wrong << ": " << view.output();
  }
}

TEST(ViewAccess, InABrowserOnlyItsOwnPageGetsTheCell) {
  const LonelyView lonely;
  const std::string page = lonely.view.page();
  const std::string port = page.substr(page.rfind(':') + 1, page.rfind('/') - page.rfind(':') - 1);
  PageScript script("foreign_page", {port});
  EXPECT_EQ(script.wait(std::chrono::seconds(200)), 0) << script.output();
  ASSERT_EQ(lines_of(script).size(), 1u) << script.output();
  const json all = {{"opens", true}, {"reads", true}}, none = {{"opens", false}, {"reads", false}};
  EXPECT_EQ(lines_of(script).front(),
            (json{{"own", all}, {"localhost", all}, {"otherPort", none}, {"rebound", none}}));
}

// ---- Connections that the machine does not give

// Processor time of a process so far, s.
double processor_time(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/stat");
  std::string text((std::istreambuf_iterator<char>(file)), {});
  std::istringstream fields(text.substr(text.rfind(')') + 2));
  std::string skipped;
  for (int i = 0; i < 11; ++i) fields >> skipped;
  double user = 0, system = 0;
  fields >> user >> system;
  return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

// Processor time that this thread gets by spinning for two seconds, s.
double spin() {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(2);
  while (std::chrono::steady_clock::now() < end) {
  }
  timespec used{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
  return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

// Connections to a port of loopback that ask for nothing.
class IdleConnections {
 public:
  IdleConnections(std::uint16_t port, int count) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    for (int i = 0; i < count; ++i) {
      sockets_.push_back(socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0));
      static_cast<void>(
          connect(sockets_.back(), reinterpret_cast<const sockaddr*>(&address), sizeof address));
    }
  }
  ~IdleConnections() {
    for (const int each : sockets_) close(each);
  }
  IdleConnections(const IdleConnections&) = delete;
  IdleConnections& operator=(const IdleConnections&) = delete;

 private:
  std::vector<int> sockets_;
};

// A spinning program gets as much of the processor as a spinning thread of the test beside it.
TEST(ViewAccess, WithoutFileDescriptorsItWaitsAndServesAgainWhenThereAreSome) {
  const LonelyView lonely({}, {.most_descriptors = 64});
  const std::string page = lonely.view.page();
  const auto port = static_cast<std::uint16_t>(std::stoi(page.substr(page.rfind(':') + 1)));
  {
    const IdleConnections idle(port, 100);
    ASSERT_TRUE(
        eventually([&] { return lonely.view.process().wrote("cannot accept a connection"); }));
    const double before = processor_time(lonely.view.process().pid());
    auto spinning = std::async(std::launch::async, spin);
    const double reference = spinning.get();
    EXPECT_LT(processor_time(lonely.view.process().pid()) - before, 0.25 * reference);
  }
  const std::vector<json> found = answers(lonely.view, {json::object()});
  expect_answered(found.front(), true);
}

}  // namespace
}  // namespace clearance::test
