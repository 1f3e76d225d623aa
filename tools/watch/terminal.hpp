// The terminal as a full screen, by ncurses.
#pragma once

#include <string>
#include <vector>

struct screen;  // of ncurses

namespace clearance::watch {

enum class Style { kPlain, kBold, kDim, kGood, kWarning, kAlarm };

// One line of the screen, cut at its width. Text is UTF-8; every code point is one column wide.
class Line {
 public:
  struct Span {
    std::string text;  // printable
    Style style;
    bool operator==(const Span&) const = default;
  };

  explicit Line(std::size_t width) : width_(width) {}
  Line& add(const std::string& text, Style style = Style::kPlain);
  // Adds spaces up to a column, if the line is shorter.
  Line& to(std::size_t column);
  [[nodiscard]] const std::vector<Span>& spans() const noexcept { return spans_; }

 private:
  std::size_t width_, used_ = 0;
  std::vector<Span> spans_;
};

struct Size {
  std::size_t columns, rows;
};

// Switches to the alternate screen without cursor and echo; the destructor restores everything.
class Screen {
 public:
  Screen();
  ~Screen();
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  // Returns true when stdout is a terminal on which the cursor can be moved.
  [[nodiscard]] static bool available();
  // The size at the last call of quit_key(), which follows a terminal that is resized.
  [[nodiscard]] Size size() const;
  void draw(const std::vector<Line>& lines);
  // Returns true when q has been pressed.
  [[nodiscard]] bool quit_key();

 private:
  screen* screen_;
  std::vector<Line> drawn_;
};

}  // namespace clearance::watch
