// Takes pictures of a page with a Chromium without a window, by the DevTools protocol over two
// pipes.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "monitor/files/temporary_folder.hpp"

namespace clearance::view {

// One page of one browser. Every call throws std::runtime_error with what was tried when the
// browser does not answer in time.
class Browser {
 public:
  // Calls `meanwhile` while it waits: the server that the browser asks runs there.
  Browser(int width, int height, std::function<void()> meanwhile);
  ~Browser();
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  void open(const std::string& url);
  // Waits until this expression is true in the page.
  void wait_for(const std::string& expression);
  void screenshot(const std::filesystem::path& png);

 private:
  // The result of a method.
  nlohmann::json call(const std::string& method, const nlohmann::json& parameters = {});
  nlohmann::json read_message();
  [[noreturn]] void fail(const std::string& what) const;

  std::function<void()> meanwhile_;
  TemporaryFolder profile_;  // outlives the browser, which writes there
  struct Process;
  std::unique_ptr<Process> process_;
  std::string received_, session_;
  int calls_ = 0;
  std::chrono::steady_clock::time_point deadline_;
};

}  // namespace clearance::view
