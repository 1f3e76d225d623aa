// A progress bar on stderr; it prints nothing when stderr is not a terminal.
#pragma once

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include "monitor/app/print.hpp"

namespace clearance {

class ProgressBar {
 public:
  ProgressBar() = default;
  ~ProgressBar() { finish(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  // `share` 0 to 1; `text` after the bar.
  void show(double share, const std::string& text) {
    if (!shown_) return;
    constexpr int kWidth = 40;
    const int filled = static_cast<int>(std::clamp(share, 0.0, 1.0) * kWidth);
    print(stderr, "\r[{}{}] {:3.0f} % {}", std::string(static_cast<std::size_t>(filled), '#'),
          std::string(static_cast<std::size_t>(kWidth - filled), '.'), share * 100.0, text);
    started_ = true;
  }
  void finish() {
    if (started_) print(stderr, "\n");
    started_ = false;
  }

 private:
  bool shown_ = ::isatty(STDERR_FILENO) != 0;
  bool started_ = false;
};

}  // namespace clearance
