// Uses the terminal as a full screen that is redrawn without flicker, and restores it at the end.
#pragma once

#include <termios.h>

#include <optional>
#include <string>
#include <vector>

namespace clearance::watch {

enum class Style { kPlain, kBold, kDim, kGood, kWarning, kAlarm };

// One line of the screen, cut at its width; text is UTF-8, every code point one column wide.
class Line {
 public:
  explicit Line(std::size_t width) : width_(width) {}
  Line& add(const std::string& text, Style style = Style::kPlain);
  // Adds spaces up to a column, if the line is shorter.
  Line& to(std::size_t column);
  [[nodiscard]] const std::string& text() const noexcept { return text_; }

 private:
  std::size_t width_, used_ = 0;
  std::string text_;
};

struct Size {
  std::size_t columns = 80, rows = 24;
};

// Switches to the alternate screen without cursor and echo; the destructor restores everything.
class Screen {
 public:
  Screen();
  ~Screen();
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  [[nodiscard]] static bool available();  // stdout is a terminal that can do it
  [[nodiscard]] Size size() const;        // now: it may have been resized
  void draw(const std::vector<Line>& lines) const;
  [[nodiscard]] bool quit_key() const;  // q was pressed

 private:
  std::optional<termios> before_;
};

}  // namespace clearance::watch
