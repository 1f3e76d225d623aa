// A bar on stderr that fills up; nothing at all when nobody looks.
#pragma once

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <string>

namespace clearance {

class ProgressBar {
 public:
  // `always`: also when stderr is no terminal.
  explicit ProgressBar(bool always) : shown_(always || ::isatty(STDERR_FILENO) != 0) {}
  ~ProgressBar() { finish(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  // `share` 0 to 1; `text` after the bar.
  void show(double share, const std::string& text) {
    if (!shown_) return;
    constexpr int kWidth = 40;
    const int filled = static_cast<int>(std::clamp(share, 0.0, 1.0) * kWidth);
    std::fprintf(stderr, "\r[%s%s] %3.0f %% %s",
                 std::string(static_cast<std::size_t>(filled), '#').c_str(),
                 std::string(static_cast<std::size_t>(kWidth - filled), '.').c_str(), share * 100.0,
                 text.c_str());
    started_ = true;
  }
  void finish() {
    if (started_) std::fputc('\n', stderr);
    started_ = false;
  }

 private:
  bool shown_;
  bool started_ = false;
};

}  // namespace clearance
