// A cell whose programs have keys of tools/security, and what joins its domain with such keys or
// without.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "monitor/client/client.hpp"
#include "monitor/client/commands.hpp"
#include "monitor/client/questions.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/tools/running_cell.hpp"

namespace clearance::test {

// The folder of a program's keys, as tools/security makes it.
class Keys {
 public:
  explicit Keys(std::vector<std::string> programs) {
    programs.insert(programs.begin(), (folder_ / "keys").string());
    ChildProcess script(places::sources() + "/tools/security", std::move(programs));
    EXPECT_EQ(script.wait(), 0) << script.output();
    said_ = script.output();
  }
  [[nodiscard]] std::filesystem::path of(const std::string& program) const {
    return folder_ / "keys" / program;
  }
  [[nodiscard]] std::string settings(const std::string& program) const {
    return "file://" + (of(program) / "cyclonedds.xml").string();
  }
  [[nodiscard]] const std::string& said() const noexcept { return said_; }

 private:
  ScratchFolder folder_;
  std::string said_;
};

// A program of a test's own with these keys; empty: without any. Each opens another domain of this
// process, which is the same on the network: Cyclone reads settings once for a domain. One with
// keys exists at a time, since Cyclone has one set of permissions for a process. Throws DdsError.
class Joined {
 public:
  Joined(const DdsOptions& dds, const std::string& settings)
      : connection_((set(*dds.domain, settings), in_domain(dds))) {
    ::unsetenv("CYCLONEDDS_URI");
  }
  [[nodiscard]] client::Connection& connection() noexcept { return connection_; }
  [[nodiscard]] Participant& participant() noexcept { return connection_.participant(); }

 private:
  static void set(std::uint32_t domain, const std::string& settings) {
    const std::string all = "<Discovery><ExternalDomainId>" + std::to_string(domain) +
                            "</ExternalDomainId></Discovery>" +
                            (settings.empty() ? "" : "," + settings);
    ::setenv("CYCLONEDDS_URI", all.c_str(), 1);
  }
  static DdsOptions in_domain(DdsOptions dds) {
    static std::uint32_t last = 0;
    dds.domain = 100 + last++ % 130;
    return dds;
  }
  client::Connection connection_;
};

// An arm and a cart that stand still, so that every report has the same distances.
class SecuredCell : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    keys = std::make_unique<Keys>(std::vector<std::string>{});
    const std::string all = "daemon+robot+planner+commander+viewer=all";
    others = std::make_unique<Keys>(std::vector{all});
  }
  static void TearDownTestSuite() {
    keys.reset();
    others.reset();
  }
  SecuredCell() {
    write_text(folder / "scara.urdf", kScaraUrdf);
    write_text(folder / "cell.yaml", R"(
name: secured
units: {length: m, angle: rad}
rate_hz: 200
defaults: {age_limit_ms: 100000}
questions: {from: [planner]}
commands: {from: [commander]}
robots: [{name: arm, urdf: scara.urdf}]
objects:
  - {name: pin, fixed: true, sphere: {radius: 0.1}, pose: {xyz: [9, 0, 0]}}
  - {name: cart, may_jump: true, sphere: {radius: 0.1}}
pairs: [{between: [arm, pin], publish: true}, {between: [pin, cart], publish: true}]
zones: [{name: near, between: [pin, cart], enter_below: 1, leave_above: 1.1}]
simulation: {movers: [{object: cart, centre: {xyz: [9, 5, 0]}, amplitude: [0, 0, 0], frequency_hz: 1}]}
)");
    cell.emplace(std::get<Cell>(read_cell(folder / "cell.yaml")));
  }
  [[nodiscard]] ChildOptions with_keys(const std::string& program) const {
    return {.environment = {{"CYCLONEDDS_URI", own(program)}}};
  }
  // Cyclone's settings for a program of this cell.
  [[nodiscard]] std::string own(const std::string& program) const {
    return is_secured ? keys->settings(program) : "";
  }
  void start_daemon() {
    daemon.emplace(kDaemon, with({(folder / "cell.yaml").string()}, dds_arguments(dds)),
                   with_keys("daemon"));
  }
  void start_robot() {
    robot.emplace(kRobot,
                  with({(folder / "cell.yaml").string(), "--swing", "0", "--rate", "100"},
                       dds_arguments(dds)),
                  with_keys("robot"));
  }
  // A rightful client gets a report in which all pairs are known, of the scene of the cell file and
  // with the true distance of the arm and the pin.
  void expect_the_truth() {
    Joined client(dds, own("client"));
    Distances reports(client.participant(), *cell);
    for (int i = 0; i < 10'000; ++i) {
      const auto report = reports.next();
      ASSERT_NE(report, nullptr) << daemon->output() << robot->output();
      if ((*report)->unknown != 0 || !(*report)->minimum_certified) continue;
      EXPECT_EQ((*report)->scene_revision, cell->scene.revision);
      EXPECT_NEAR((*report)->minimum.lower, 5.0 - 0.2, 1e-9);
      return;
    }
    ADD_FAILURE() << daemon->output();
  }

  static std::unique_ptr<Keys> keys, others;
  bool is_secured = true;
  const ScratchFolder folder;
  std::optional<Cell> cell;
  const DdsOptions dds = own_dds();
  std::optional<ChildProcess> daemon, robot;
};
inline std::unique_ptr<Keys> SecuredCell::keys, SecuredCell::others;

}  // namespace clearance::test
