#include "tools/watch/terminal.hpp"

#include <unistd.h>

#include <clocale>
#include <cstdio>
#include <stdexcept>

#include "config/text/printable.hpp"

// These headers come last, because they define macros with common names. The two that remain are
// removed again.
#define NCURSES_NOMACROS
#include <curses.h>
#include <term.h>
#undef columns
#undef lines

namespace clearance::watch {
namespace {

enum Colour : short { kGreen = 1, kYellow, kRed };

attr_t attributes(Style style) {
  switch (style) {
    case Style::kPlain:
      return A_NORMAL;
    case Style::kBold:
      return A_BOLD;
    case Style::kDim:
      return A_DIM;
    case Style::kGood:
      return COLOR_PAIR(kGreen);
    case Style::kWarning:
      return COLOR_PAIR(kYellow);
    case Style::kAlarm:
      return A_BOLD | COLOR_PAIR(kRed);
  }
  return A_NORMAL;
}

bool starts_code_point(char byte) { return (static_cast<unsigned char>(byte) & 0xC0) != 0x80; }

}  // namespace

// Names come from a file or from DDS: they are made printable.
Line& Line::add(const std::string& text, Style style) {
  const std::string shown = printable(text);
  std::size_t end = 0;
  for (; end < shown.size(); ++end) {
    if (!starts_code_point(shown[end])) continue;
    if (used_ == width_) break;
    ++used_;
  }
  if (end > 0) spans_.push_back({shown.substr(0, end), style});
  return *this;
}

Line& Line::to(std::size_t column) {
  if (used_ < column) add(std::string(column - used_, ' '));
  return *this;
}

// Only the encoding is taken from the locale, so numbers keep their decimal points.
Screen::Screen() {
  std::setlocale(LC_CTYPE, "C.UTF-8");
  screen_ = newterm(nullptr, stdout, stdin);
  if (screen_ == nullptr) throw std::runtime_error("the terminal cannot be used; try --plain");
  cbreak();
  noecho();
  nodelay(stdscr, true);
  curs_set(0);
  start_color();
  use_default_colors();
  init_pair(kGreen, COLOR_GREEN, -1);
  init_pair(kYellow, COLOR_YELLOW, -1);
  init_pair(kRed, COLOR_RED, -1);
}

Screen::~Screen() {
  endwin();
  delscreen(screen_);
}

bool Screen::available() {
  if (isatty(STDOUT_FILENO) == 0) return false;
  int result = 0;
  if (setupterm(nullptr, STDOUT_FILENO, &result) != OK) return false;
  const bool moves = cursor_address != nullptr;
  del_curterm(cur_term);
  return moves;
}

Size Screen::size() const {
  return {.columns = static_cast<std::size_t>(getmaxx(stdscr)),
          .rows = static_cast<std::size_t>(getmaxy(stdscr))};
}

// A line that has changed is sent as a whole, so that it replaces text that another program wrote
// over it.
void Screen::draw(const std::vector<Line>& lines) {
  werase(stdscr);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const int row = static_cast<int>(i);
    wmove(stdscr, row, 0);
    for (const Line::Span& span : lines[i].spans()) {
      wattrset(stdscr, static_cast<int>(attributes(span.style)));
      waddstr(stdscr, span.text.c_str());
    }
    const bool same = i < drawn_.size() && drawn_[i].spans() == lines[i].spans();
    if (!same) wredrawln(stdscr, row, 1);
  }
  wattrset(stdscr, A_NORMAL);
  wrefresh(stdscr);
  drawn_ = lines;
}

bool Screen::quit_key() {
  const bool from_keyboard = isatty(STDIN_FILENO) != 0;
  for (int key = wgetch(stdscr); key != ERR; key = wgetch(stdscr)) {
    if (key == 'q' && from_keyboard) return true;
  }
  return false;
}

}  // namespace clearance::watch
