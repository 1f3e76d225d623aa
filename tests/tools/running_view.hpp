// clearance-view as a test starts it, and the output of the scripts in view_js.
#pragma once

#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "tests/shared/places.hpp"
#include "tests/tools/running_cell.hpp"

namespace clearance::test {

inline const std::string kView = test::places::programs() + "/clearance-view";

inline const std::string kScripts = test::places::view_js();

// A folder in the build for pictures that are kept after the run.
inline std::string pictures() {
  const std::filesystem::path folder = test::places::view_pictures();
  std::filesystem::create_directories(folder);
  return folder.string();
}

// Waits until the daemon has poses of all objects, and has then reported for these seconds.
inline void wait_for_poses(const DdsOptions& dds, const Cell& cell, double seconds = 0.0) {
  Participant client(dds);
  Distances reports(client, cell);
  std::optional<std::int64_t> known_ns;
  for (;;) {
    const auto report = reports.next();
    ASSERT_NE(report, nullptr);
    const std::int64_t now_ns = (*report)->now_ns;
    if (!known_ns && (*report)->minimum_known && (*report)->unknown == 0) known_ns = now_ns;
    if (known_ns && 1e-9 * static_cast<double>(now_ns - *known_ns) >= seconds) return;
  }
}

// A cell of two boxes, whose daemon and simulated robot run.
struct RunningSmallCell {
  CellFile cell{small_cell("small")};
  DdsOptions own = own_dds();
  std::vector<std::string> dds = dds_arguments(own);
  ChildProcess daemon{kDaemon, with({cell.path()}, dds)};
  ChildProcess robot{kRobot, with({cell.path(), "--rate", "200"}, dds)};

  // Waits for poses of both boxes; returns the arguments of a program that joins them.
  std::vector<std::string> arguments() {
    wait_for_poses(own, cell.cell());
    return with({cell.path()}, dds);
  }
};

// A script of view_js.
class Script : public ChildProcess {
 public:
  Script(const std::string& name, const std::vector<std::string>& arguments,
         const ChildOptions& options = {})
      : ChildProcess("/usr/bin/env", with({"node", kScripts + "/" + name + ".mjs"}, arguments),
                     options) {}
};

// A script that opens a page. All of a process have one Chromium, which takes a second to start.
class PageScript : public Script {
 public:
  PageScript(const std::string& name, const std::vector<std::string>& arguments)
      : Script(name, arguments, {.environment = {{"CLEARANCE_BROWSER", browser()}}}) {}

 private:
  static std::string browser() {
    static const Script chromium("browser", {});
    EXPECT_TRUE(eventually([] { return chromium.wrote("\n"); })) << chromium.output();
    return chromium.output().substr(0, chromium.output().find('\n'));
  }
};

// Returns the lines of JSON that a script has printed.
inline std::vector<nlohmann::json> lines_of(const ChildProcess& script) {
  std::vector<nlohmann::json> lines;
  std::istringstream text(script.output());
  for (std::string line; std::getline(text, line);) {
    const auto value = nlohmann::json::parse(line, nullptr, false);
    if (value.is_object()) lines.push_back(value);
  }
  return lines;
}

// A viewer on a free port.
class View {
 public:
  explicit View(const std::vector<std::string>& arguments, const ChildOptions& options = {})
      : process_(kView, with(arguments, {"--port", "0"}), options) {
    EXPECT_TRUE(eventually([&] { return process_.wrote("http://127.0.0.1:"); }))
        << process_.output();
    const std::string output = process_.output();
    address_ = output.substr(output.find("http://"));
    address_ = address_.substr(0, address_.find('\n'));
  }
  [[nodiscard]] std::string page() const { return address_; }
  [[nodiscard]] std::string socket() const { return "ws" + address_.substr(4); }
  [[nodiscard]] const ChildProcess& process() const { return process_; }
  int end() {
    process_.signal(SIGTERM);
    return process_.wait();
  }

 private:
  ChildProcess process_;
  std::string address_;
};

}  // namespace clearance::test
