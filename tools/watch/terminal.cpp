#include "tools/watch/terminal.hpp"

#include <fmt/format.h>

#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdlib>
#include <string_view>

namespace clearance::watch {
namespace {

const char* sequence(Style style) {
  switch (style) {
    case Style::kPlain:
      return "";
    case Style::kBold:
      return "\x1b[1m";
    case Style::kDim:
      return "\x1b[2m";
    case Style::kGood:
      return "\x1b[32m";
    case Style::kWarning:
      return "\x1b[33m";
    case Style::kAlarm:
      return "\x1b[1;31m";
  }
  return "";
}

bool starts_code_point(char byte) { return (static_cast<unsigned char>(byte) & 0xC0) != 0x80; }

// Written in one piece if the terminal accepts it, so that half a frame is never shown.
void put(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(STDOUT_FILENO, bytes.data(), bytes.size());
    if (written <= 0) return;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

}  // namespace

Line& Line::add(const std::string& text, Style style) {
  std::size_t end = 0;
  for (; end < text.size(); ++end) {
    if (!starts_code_point(text[end])) continue;
    if (used_ == width_) break;
    ++used_;
  }
  if (end == 0) return *this;
  text_ += sequence(style);
  for (const char byte : std::string_view(text).substr(0, end)) {
    // Names come from a file: they must not contain control sequences.
    text_ += static_cast<unsigned char>(byte) < 0x20 || byte == 0x7f ? '?' : byte;
  }
  if (style != Style::kPlain) text_ += "\x1b[0m";
  return *this;
}

Line& Line::to(std::size_t column) {
  if (used_ < column) add(std::string(column - used_, ' '));
  return *this;
}

Screen::Screen() {
  termios settings{};
  if (tcgetattr(STDIN_FILENO, &settings) == 0) {
    before_ = settings;
    settings.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    tcsetattr(STDIN_FILENO, TCSANOW, &settings);
  }
  put("\x1b[?1049h\x1b[?25l");
}

Screen::~Screen() {
  put("\x1b[?25h\x1b[?1049l");
  if (before_) tcsetattr(STDIN_FILENO, TCSANOW, &*before_);
}

bool Screen::available() {
  const char* term = std::getenv("TERM");
  return isatty(STDOUT_FILENO) != 0 && term != nullptr && std::string_view(term) != "dumb";
}

Size Screen::size() const {
  winsize window{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &window) != 0 || window.ws_col == 0 || window.ws_row == 0)
    return {};
  return {.columns = window.ws_col, .rows = window.ws_row};
}

void Screen::draw(const std::vector<Line>& lines) const {
  std::string frame = "\x1b[H";
  for (std::size_t i = 0; i < lines.size(); ++i) {
    frame += fmt::format("{}\x1b[K", lines[i].text());
    if (i + 1 < lines.size()) frame += "\r\n";
  }
  put(fmt::format("{}\x1b[J", frame));
}

bool Screen::quit_key() const {
  pollfd keys{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
  char key = 0;
  while (before_ && poll(&keys, 1, 0) > 0 && (keys.revents & POLLIN) != 0) {
    if (read(STDIN_FILENO, &key, 1) != 1) return false;
    if (key == 'q') return true;
  }
  return false;
}

}  // namespace clearance::watch
