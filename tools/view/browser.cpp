#include "tools/view/browser.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <stdexcept>
#include <vector>

#include "tools/shared/child_process.hpp"

namespace clearance::view {
namespace {

// A first page on a busy machine without a graphics card takes half a minute.
constexpr auto kBrowserPatience = std::chrono::seconds(180);
// The descriptors of --remote-debugging-pipe.
constexpr int kBrowserReads = 3, kBrowserWrites = 4;

std::string from_base64(const std::string& text) {
  std::string bytes;
  unsigned value = 0;
  int bits = 0;
  for (const char c : text) {
    constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const std::size_t digit = kDigits.find(c);
    if (digit == std::string_view::npos) break;
    value = (value << 6U) | static_cast<unsigned>(digit);
    if ((bits += 6) < 8) continue;
    bits -= 8;
    bytes += static_cast<char>((value >> static_cast<unsigned>(bits)) & 0xFFU);
  }
  return bytes;
}

std::vector<std::string> command(const std::filesystem::path& profile, int width, int height) {
  std::vector<std::string> words = {"chromium",
                                    "--headless=new",
                                    "--remote-debugging-pipe",
                                    "--no-first-run",
                                    "--hide-scrollbars",
                                    "--use-angle=swiftshader",
                                    "--enable-unsafe-swiftshader",
                                    "--force-color-profile=srgb",
                                    fmt::format("--user-data-dir={}", profile.string()),
                                    fmt::format("--window-size={},{}", width, height)};
  if (geteuid() == 0) words.emplace_back("--no-sandbox");  // Chromium insists on it for root
  words.emplace_back("about:blank");
  return words;
}

// A pipe above the browser's descriptors, closed when a program is executed.
bp::pipe make_pipe() {
  const bp::pipe low;
  return bp::pipe{fcntl(low.native_source(), F_DUPFD_CLOEXEC, kBrowserWrites + 1),
                  fcntl(low.native_sink(), F_DUPFD_CLOEXEC, kBrowserWrites + 1)};
}

// This program blocks the signals that it waits for; the browser must not.
void unblock_signals() {
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
}

}  // namespace

struct Browser::Process {
  bp::pipe to = make_pipe(), from = make_pipe();
  bp::child child;

  // env finds the browser in PATH.
  explicit Process(const std::vector<std::string>& command)
      : child(
            bp::exe = "/usr/bin/env", bp::args = command,
            bp::posix::fd.bind(kBrowserReads, to.native_source()),
            bp::posix::fd.bind(kBrowserWrites, from.native_sink()),
            bp::std_in<bp::null, bp::std_out> bp::null, bp::std_err > bp::null,
            bp::extend::on_exec_setup = [](auto&) { unblock_signals(); }) {
    close(to.native_source());
    to.assign_source(-1);
    close(from.native_sink());
    from.assign_sink(-1);
  }
  // SIGTERM, since the browser has processes of its own to end.
  ~Process() {
    to.close();
    from.close();
    kill(child.id(), SIGTERM);
    std::error_code ignored;
    child.wait(ignored);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
};

Browser::Browser(int width, int height, std::function<void()> meanwhile)
    : meanwhile_(std::move(meanwhile)) {
  if (!profile_.error().empty()) throw std::runtime_error(profile_.error());
  process_ = std::make_unique<Process>(command(profile_.path(), width, height));
  deadline_ = std::chrono::steady_clock::now() + kBrowserPatience;
  const nlohmann::json page = call("Target.createTarget", {{"url", "about:blank"}});
  session_ = call("Target.attachToTarget", {{"targetId", page.at("targetId")}, {"flatten", true}})
                 .at("sessionId");
  call("Page.enable");
  call("Emulation.setDeviceMetricsOverride",
       {{"width", width}, {"height", height}, {"deviceScaleFactor", 1}, {"mobile", false}});
}

Browser::~Browser() = default;

void Browser::fail(const std::string& what) const {
  throw std::runtime_error(fmt::format(
      "{}: the browser does not answer; is Debian's package chromium installed?", what));
}

void Browser::open(const std::string& url) {
  deadline_ = std::chrono::steady_clock::now() + kBrowserPatience;
  call("Page.navigate", {{"url", url}});
}

void Browser::wait_for(const std::string& expression) {
  deadline_ = std::chrono::steady_clock::now() + kBrowserPatience;
  for (;;) {
    const nlohmann::json answer =
        call("Runtime.evaluate",
             {{"expression", fmt::format("!!({})", expression)}, {"returnByValue", true}});
    if (answer.at("result").value("value", false)) return;
    for (int i = 0; i < 5; ++i) meanwhile_();
  }
}

void Browser::screenshot(const std::filesystem::path& png) {
  deadline_ = std::chrono::steady_clock::now() + kBrowserPatience;
  const nlohmann::json answer = call("Page.captureScreenshot", {{"format", "png"}});
  std::ofstream file(png, std::ios::binary);
  file << from_base64(answer.at("data"));
  if (!file.flush()) throw std::runtime_error(fmt::format("cannot write {}", png.string()));
}

nlohmann::json Browser::call(const std::string& method, const nlohmann::json& parameters) {
  const int id = ++calls_;
  nlohmann::json message = {{"id", id}, {"method", method}};
  if (!parameters.is_null()) message["params"] = parameters;
  if (!session_.empty()) message["sessionId"] = session_;
  std::string text = message.dump();
  text += '\0';
  if (write(process_->to.native_sink(), text.data(), text.size()) !=
      static_cast<ssize_t>(text.size())) {
    fail(method);
  }
  for (;;) {
    const nlohmann::json answer = read_message();
    if (answer.value("id", 0) != id) continue;
    if (answer.contains("error")) {
      throw std::runtime_error(fmt::format("{}: {}", method, answer["error"].dump()));
    }
    return answer.at("result");
  }
}

// Messages end with a zero.
nlohmann::json Browser::read_message() {
  std::size_t end = 0;
  while ((end = received_.find('\0')) == std::string::npos) {
    if (std::chrono::steady_clock::now() > deadline_) fail("waiting");
    pollfd readable{.fd = process_->from.native_source(), .events = POLLIN, .revents = 0};
    if (poll(&readable, 1, 0) <= 0) {
      meanwhile_();
      continue;
    }
    std::array<char, 65536> piece;
    const ssize_t count = read(process_->from.native_source(), piece.data(), piece.size());
    if (count <= 0) fail("reading");
    received_.append(piece.data(), static_cast<std::size_t>(count));
  }
  nlohmann::json message = nlohmann::json::parse(received_.substr(0, end));
  received_.erase(0, end + 1);
  return message;
}

}  // namespace clearance::view
