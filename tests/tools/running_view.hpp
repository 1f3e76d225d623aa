// clearance-view as a test starts it, and the output of the scripts in view_js.
#pragma once

#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
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

// Waits until the daemon has poses of both boxes.
inline void wait_for_poses(const DdsOptions& dds, const Cell& cell) {
  Participant client(dds);
  Distances reports(client, cell);
  for (;;) {
    const auto report = reports.next();
    ASSERT_NE(report, nullptr);
    if ((*report)->minimum_known && (*report)->unknown == 0) return;
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
