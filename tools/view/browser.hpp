// Pictures of a page, by a Chromium without a window: the DevTools protocol over two pipes.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "monitor/files/temporary_folder.hpp"

namespace clearance::view {

// One page of one browser. Every call throws std::runtime_error with what was tried when the
// browser does not answer in time.
class Browser {
 public:
  // `meanwhile` is called while the browser is waited for: the server that it asks runs in it.
  Browser(int width, int height, std::function<void()> meanwhile);
  ~Browser();
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  void open(const std::string& url);
  // Until this expression is true in the page.
  void wait_for(const std::string& expression);
  void screenshot(const std::filesystem::path& png);

 private:
  // The result of a method.
  nlohmann::json call(const std::string& method, const nlohmann::json& parameters = {});
  nlohmann::json read_message();
  [[noreturn]] void fail(const std::string& what) const;

  std::function<void()> meanwhile_;
  TemporaryFolder profile_;  // outlives the browser, which writes there
  pid_t pid_ = -1;
  int to_browser_ = -1, from_browser_ = -1;
  std::string received_, session_;
  int calls_ = 0;
  std::chrono::steady_clock::time_point deadline_;
};

}  // namespace clearance::view
