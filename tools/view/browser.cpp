#include "tools/view/browser.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <stdexcept>
#include <vector>

namespace clearance::view {
namespace {

// A first page on a busy machine without a graphics card takes half a minute.
constexpr auto kPatience = std::chrono::seconds(180);
// Where the browser reads and writes (--remote-debugging-pipe).
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
  if (geteuid() == 0) words.emplace_back("--no-sandbox");  // which Chromium insists on for root
  words.emplace_back("about:blank");
  return words;
}

// In the child: never returns.
[[noreturn]] void become_browser(std::vector<std::string> words, int reads, int writes) {
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  // Above 4 first, so that neither is closed by the other's place.
  const int from = fcntl(reads, F_DUPFD, 10), to = fcntl(writes, F_DUPFD, 10);
  dup2(from, kBrowserReads);
  dup2(to, kBrowserWrites);
  const int nowhere = open("/dev/null", O_RDWR);
  for (const int stream : {0, 1, 2}) dup2(nowhere, stream);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execvp(arguments[0], arguments.data());
  _exit(127);
}

}  // namespace

Browser::Browser(int width, int height, std::function<void()> meanwhile)
    : meanwhile_(std::move(meanwhile)) {
  if (!profile_.error().empty()) throw std::runtime_error(profile_.error());
  std::array<int, 2> to{}, from{};
  if (pipe2(to.data(), O_CLOEXEC) != 0 || pipe2(from.data(), O_CLOEXEC) != 0) {
    fail("making pipes for the browser");
  }
  pid_ = fork();
  if (pid_ == 0) become_browser(command(profile_.path(), width, height), to[0], from[1]);
  close(to[0]);
  close(from[1]);
  to_browser_ = to[1];
  from_browser_ = from[0];
  deadline_ = std::chrono::steady_clock::now() + kPatience;
  const nlohmann::json page = call("Target.createTarget", {{"url", "about:blank"}});
  session_ = call("Target.attachToTarget", {{"targetId", page.at("targetId")}, {"flatten", true}})
                 .at("sessionId");
  call("Page.enable");
  call("Emulation.setDeviceMetricsOverride",
       {{"width", width}, {"height", height}, {"deviceScaleFactor", 1}, {"mobile", false}});
}

Browser::~Browser() {
  close(to_browser_);
  close(from_browser_);
  if (pid_ > 0) {
    kill(pid_, SIGTERM);
    waitpid(pid_, nullptr, 0);
  }
}

void Browser::fail(const std::string& what) const {
  throw std::runtime_error(fmt::format(
      "{}: the browser does not answer; is Debian's package chromium installed?", what));
}

void Browser::open(const std::string& url) {
  deadline_ = std::chrono::steady_clock::now() + kPatience;
  call("Page.navigate", {{"url", url}});
}

void Browser::wait_for(const std::string& expression) {
  deadline_ = std::chrono::steady_clock::now() + kPatience;
  for (;;) {
    const nlohmann::json answer =
        call("Runtime.evaluate",
             {{"expression", fmt::format("!!({})", expression)}, {"returnByValue", true}});
    if (answer.at("result").value("value", false)) return;
    for (int i = 0; i < 5; ++i) meanwhile_();
  }
}

void Browser::screenshot(const std::filesystem::path& png) {
  deadline_ = std::chrono::steady_clock::now() + kPatience;
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
  if (write(to_browser_, text.data(), text.size()) != static_cast<ssize_t>(text.size())) {
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
    pollfd readable{.fd = from_browser_, .events = POLLIN, .revents = 0};
    if (poll(&readable, 1, 0) <= 0) {
      meanwhile_();
      continue;
    }
    std::array<char, 65536> piece;
    const ssize_t count = read(from_browser_, piece.data(), piece.size());
    if (count <= 0) fail("reading");
    received_.append(piece.data(), static_cast<std::size_t>(count));
  }
  nlohmann::json message = nlohmann::json::parse(received_.substr(0, end));
  received_.erase(0, end + 1);
  return message;
}

}  // namespace clearance::view
