// DDS Security with keys of tools/security: who is heard, and who is not. The programs are real
// ones on loopback. Each attack is tried on a cell without security, too, where it succeeds.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "monitor/wire/cdr.hpp"
#include "tests/tools/forged_datagrams.hpp"
#include "tests/tools/secured_cell.hpp"

namespace clearance::test {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using Names = std::set<std::string_view>;

Question swing() {
  Question question;
  question.motion = {
      .joints = {"shoulder"}, .times = {0.0, 2.0}, .positions = {0.0, 0.1}, .velocities = {}};
  question.held = {{"elbow", 0.0}, {"push", 0.0}};
  question.others = OthersMove::kNot;
  return question;
}

// Reads all topics.
class Listener {
 public:
  Listener(const DdsOptions& dds, const std::string& settings) : joined_(dds, settings) {
    for (const Topic& row : kTopics)
      readers_.push_back(joined_.participant().reader(row.kind, Topics{}.*row.name));
  }
  // The topics on which a message has come.
  [[nodiscard]] Names heard() const {
    Names names;
    for (std::size_t i = 0; i < kTopics.size(); ++i) {
      void* sample = nullptr;
      dds_sample_info_t info{};
      if (dds_read(readers_[i], &sample, &info, 1, 1) != 1) continue;
      names.insert(kTopics[i].key);
      dds_return_loan(readers_[i], &sample, 1);
    }
    return names;
  }

 private:
  Joined joined_;
  std::vector<dds_entity_t> readers_;
};

// Sends inputs, commands and questions.
class Attacker {
 public:
  Attacker(const DdsOptions& dds, const std::string& settings, const Scene& scene)
      : revision_(scene.revision), joined_(dds, settings) {}
  void attack() {
    joints_.write(std::vector{1.0, 1.0, 0.1});
    clearance_msg_ObjectPose pose{};
    pose.object = 1;
    pose.stamp_ns = client::now_ns();
    pose.position = {9.0, 1.0, 0.0};
    pose.orientation = {0, 0, 0, 1};
    poses_.write({&pose, 1}, revision_);
    const std::uint64_t command = commands_.post({SetMaxSpeed{.object = "cart", .m_per_s = 1.0}});
    const std::uint64_t question = questions_.post(swing());
    has_result_ = has_result_ || commands_.result(command, milliseconds(5));
    has_answer_ = has_answer_ || questions_.result(question, milliseconds(5));
  }
  [[nodiscard]] bool is_heard() const {
    return joints_.is_heard() || poses_.is_heard() || commands_.is_heard() || questions_.is_heard();
  }
  [[nodiscard]] bool has_result() const noexcept { return has_result_; }
  [[nodiscard]] bool has_answer() const noexcept { return has_answer_; }

 private:
  std::uint64_t revision_;
  Joined joined_;
  client::JointWriter joints_{joined_.connection(), "attacker", {"shoulder", "elbow", "push"}};
  client::PoseWriter poses_{joined_.connection(), "attacker"};
  client::Commands commands_{joined_.connection(), "commander"};
  client::Questions questions_{joined_.connection(), "planner"};
  bool has_result_ = false, has_answer_ = false;
};

class Security : public SecuredCell {};

TEST_F(Security, EveryRightfulProgramIsHeardAndAnswered) {
  start_daemon();
  start_robot();
  expect_the_truth();
  EXPECT_TRUE(daemon->tells("started", {"with DDS Security"})) << daemon->output();
  {
    Joined planner(dds, own("planner"));
    client::Questions questions(planner.connection(), "planner");
    const auto answer = questions.ask(swing(), {}, std::chrono::seconds(30));
    ASSERT_TRUE(answer && answer->done()) << (answer ? answer->reason : daemon->output());
    EXPECT_GT(answer->lower, 0.0);
  }
  {
    Joined commander(dds, own("commander"));
    client::Commands commands(commander.connection(), "commander");
    const auto result = commands.send({SetMaxSpeed{.object = "cart", .m_per_s = 1.0}}, {},
                                      std::chrono::seconds(30));
    EXPECT_TRUE(result && result->done());
  }
  ChildProcess watch(kWatch, with({"--plain", "--seconds", "2"}, dds_arguments(dds)),
                     with_keys("viewer"));
  EXPECT_EQ(watch.wait(), 0);
  EXPECT_THAT(watch.output(), HasSubstr(" reports in "));
}

TEST_F(Security, WithoutItEveryAttackSucceeds) {
  is_secured = false;
  start_daemon();
  start_robot();
  expect_the_truth();
  EXPECT_FALSE(daemon->told("started", {"with DDS Security"}));
  const Listener listener(dds, "");
  const Names some{"poses", "joint_states", "distances", "catalogue", "zones", "health"};
  EXPECT_TRUE(eventually([&] { return std::ranges::includes(listener.heard(), some); }));
  Attacker attacker(dds, "", cell->scene);
  EXPECT_TRUE(eventually([&] {
    attacker.attack();
    return daemon->told("new-source", {"poses", "attacker"}) &&
           daemon->told("new-source", {"joints", "attacker"}) && daemon->told("scene-changed") &&
           attacker.is_heard() && attacker.has_result() && attacker.has_answer();
  })) << daemon->output();
}

// Each attack is repeated 200 times; without security, a few are enough.
TEST_F(Security, WhoeverHasNoCertificateOfItsAuthorityReadsNothingAndChangesNothing) {
  start_daemon();
  start_robot();
  expect_the_truth();
  const auto zone_lines = [&] {
    const std::string log = daemon->output();
    int lines = 0;
    for (std::size_t at = 0; (at = log.find("[zone-", at)) != std::string::npos; ++at) ++lines;
    return lines;
  };
  const int lines_before = zone_lines();
  for (const std::string& settings : {std::string(), others->settings("all")}) {
    {
      const Listener listener(dds, settings);
      std::this_thread::sleep_for(std::chrono::seconds(2));
      EXPECT_THAT(listener.heard(), IsEmpty());
    }
    Attacker attacker(dds, settings, cell->scene);
    for (int i = 0; i < 200; ++i) attacker.attack();
    EXPECT_FALSE(attacker.is_heard());
    EXPECT_FALSE(attacker.has_result());
    EXPECT_FALSE(attacker.has_answer());
  }
  EXPECT_THAT(daemon->output(), Not(HasSubstr("attacker")));
  EXPECT_FALSE(daemon->told("scene-changed"));
  EXPECT_EQ(zone_lines(), lines_before) << daemon->output();
  expect_the_truth();
}

// A robot of the test's own, and a stranger who sends datagrams in its name.
class ForgedInputs : public SecuredCell {
 protected:
  void meet() {
    start_daemon();
    robot_program.emplace(dds, own("robot"));
    poses.emplace(robot_program->participant(), *cell, "robot");
    reports.emplace(robot_program->participant(), *cell);
    ASSERT_TRUE(eventually([&] {
      poses->send(0.0);
      return distance() == 4.8;
    })) << daemon->output();
    forged.emplace(poses->writer());
  }
  // The distance of the cart and the pin in the next report, to 1 um; below 0: none.
  double distance() {
    const auto report = reports->next();
    if (report == nullptr) return -2.0;
    for (const auto& pair : std::span((*report)->pairs._buffer, (*report)->pairs._length)) {
      const ObjectPair& objects = cell->scene.pairs[pair.pair];
      if (objects.first + objects.second == 1)
        return std::isfinite(pair.lower) ? std::round(1e6 * pair.lower) / 1e6 : -1.0;
    }
    return -3.0;
  }
  // A batch in the robot's name: the cart is near the pin.
  std::vector<std::byte> lie() {
    PoseBatch batch = poses->sent().back();
    ++batch.sequence_number;
    batch.samples[0].stamp_ns = client::now_ns();
    batch.samples[0].world_from_object.position.y() = 1.0;
    auto sample = make_batch(1);
    to_wire(batch, *sample);
    const auto bytes = encoder.encode(*sample);
    return {bytes.begin(), bytes.end()};
  }
  std::uint32_t next() const { return static_cast<std::uint32_t>(poses->sent().size() + 1); }

  CdrEncoder encoder;
  std::optional<Joined> robot_program;
  std::optional<Poses> poses;
  std::optional<Distances> reports;
  std::optional<ForgedDatagrams> forged;
};

TEST_F(ForgedInputs, AreBelievedWithoutSecurity) {
  is_secured = false;
  meet();
  EXPECT_TRUE(eventually([&] {
    forged->data(next(), lie());
    forged->send(*dds.domain);
    return distance() != 4.8;
  }));
  EXPECT_TRUE(eventually([&] {
    forged->farewell();
    forged->send(*dds.domain);
    return daemon->told("writer-left", {"clearance/poses"});
  })) << daemon->output();
}

// A flood of 200 times 30 datagrams to every port. The robot is heard during and after it.
TEST_F(ForgedInputs, AreNotBelievedWithSecurityAndStarveNoProgram) {
  meet();
  for (std::uint32_t i = 0; i < 200; ++i) {
    const std::vector<std::byte> bytes = lie();
    for (std::uint32_t number = 0; number < 10; ++number) {
      forged->data(next() + number, bytes);
      forged->send(*dds.domain);
      forged->heartbeat(1'000'000 + i);
      forged->send(*dds.domain);
      forged->farewell();
      forged->send(*dds.domain);
    }
    ASSERT_EQ(distance(), 4.8) << i;
  }
  EXPECT_FALSE(daemon->told("writer-left")) << daemon->output();
  poses->move_by({0.0, 1.0, 0.0});
  EXPECT_TRUE(eventually([&] {
    poses->send(0.0);
    return distance() == 5.8;
  })) << daemon->output();
}

const Names kReports{"catalogue", "distances", "zones", "health", "separation", "gradients"};
const Names kPartnerTopics{"partner_ticks", "partner_states", "partner_frames", "partner_scenes"};

Names joined(Names names, const Names& more) {
  names.insert(more.begin(), more.end());
  return names;
}

TEST_F(Security, EveryRoleReadsAndWritesItsTopicsAndNoOthers) {
  const Names inputs{"poses", "joint_states"}, results{"command_results", "answers"};
  const Names requests{"commands", "questions"};
  const Names seen = joined(joined(joined(kReports, inputs), results), requests);
  const std::map<std::string, std::pair<Names, Names>> roles{
      {"daemon", {joined(seen, kPartnerTopics), joined(joined(kReports, results), kPartnerTopics)}},
      {"robot", {kReports, inputs}},
      {"client", {kReports, {}}},
      {"planner", {joined(kReports, {"answers"}), {"questions"}}},
      {"commander", {joined(kReports, results), requests}},
      {"viewer", {seen, {}}}};
  Names all_read, all_written;
  for (const auto& [role, expected] : roles) {
    Joined program(dds, keys->settings(role));
    Names reads, writes;
    for (const Topic& row : kTopics) {
      for (const std::string& name : {Topics{}.*row.name, Topics{}.*row.name + "/share/left"}) {
        const auto note = [&](Names& to, const auto& make) {
          try {
            make();
            to.insert(row.key);
          } catch (const DdsError& error) {
            EXPECT_THAT(error.what(), HasSubstr("Not Allowed By Security"));
          }
        };
        note(reads, [&] { program.participant().reader(row.kind, name); });
        note(writes, [&] { program.participant().writer(row.kind, name); });
      }
    }
    EXPECT_EQ(reads, expected.first) << role;
    EXPECT_EQ(writes, expected.second) << role;
    all_read.merge(reads);
    all_written.merge(writes);
  }
  EXPECT_EQ(all_read.size(), kTopics.size());
  EXPECT_EQ(all_written.size(), kTopics.size());
}

TEST_F(Security, PermissionsOfAnotherProgramOrThatAreChangedAreRefused) {
  const std::filesystem::path viewer = keys->of("viewer"), stolen = folder / "stolen";
  std::filesystem::copy(viewer, stolen);
  const std::string settings = read_text(viewer / "cyclonedds.xml");
  const auto file = [&](const std::string& name) { return (viewer / name).string(); };
  const auto joins_with = [&](const std::filesystem::path& permissions) {
    std::string own = settings;
    own.replace(own.find(file("permissions.p7s")), file("permissions.p7s").size(), permissions);
    write_text(stolen / "cyclonedds.xml", own);
    try {
      Joined(dds, "file://" + (stolen / "cyclonedds.xml").string());
      return true;
    } catch (const DdsError&) {
      return false;
    }
  };
  EXPECT_TRUE(joins_with(viewer / "permissions.p7s"));
  EXPECT_FALSE(joins_with(keys->of("robot") / "permissions.p7s"));
  std::string changed = read_text(viewer / "permissions.p7s");
  changed.insert(changed.find("<subscribe>"),
                 "<publish><topics><topic>clearance/poses</topic></topics></publish>");
  write_text(stolen / "changed.p7s", changed);
  EXPECT_FALSE(joins_with(stolen / "changed.p7s"));
}

TEST_F(Security, NoKeyIsReadableByOthersOrPartOfAnyOutput) {
  start_daemon();
  Joined client(dds, own("client"));
  Distances reports(client.participant(), *cell);
  ASSERT_NE(reports.next(), nullptr) << daemon->output();
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(keys->of(""))) {
    using std::filesystem::perms;
    EXPECT_EQ(entry.status().permissions() & (perms::group_all | perms::others_all), perms::none)
        << entry.path();
    if (entry.path().filename() != "key.pem") continue;
    ++files;
    const std::string key = read_text(entry.path());
    const std::string line = key.substr(key.find('\n') + 1, 40);
    EXPECT_THAT(keys->said(), Not(HasSubstr(line)));
    EXPECT_THAT(daemon->output(), Not(HasSubstr(line)));
  }
  EXPECT_EQ(files, 7) << "of six programs and the authority";
}

class SecurityScript : public RunsPrograms {
 protected:
  int make(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), path("keys"));
    return run(places::sources() + "/tools/security", arguments);
  }
};

TEST_F(SecurityScript, AddsProgramsAndLeavesThoseThatAreThere) {
  ASSERT_EQ(make({"viewer", "robot+commander=arm", "--writes", "robot=rt/camera/*", "--reads",
                  "viewer=left/poses", "--at", "/elsewhere"}),
            0)
      << output;
  EXPECT_THAT(output, HasSubstr("CYCLONEDDS_URI=file:///elsewhere/arm/cyclonedds.xml"));
  EXPECT_THAT(read_text(path("keys/arm/cyclonedds.xml")), HasSubstr("file:/elsewhere/arm/key.pem"));
  const std::string arm = read_text(path("keys/arm/permissions.p7s"));
  for (const char* topic : {"clearance/poses", "clearance/commands", "rt/camera/*"})
    EXPECT_THAT(arm, HasSubstr("<topic>" + std::string(topic) + "</topic>"));
  const std::string viewer = read_text(path("keys/viewer/permissions.p7s"));
  EXPECT_THAT(viewer, HasSubstr("<topic>left/poses</topic>"));
  EXPECT_THAT(viewer, Not(HasSubstr("<publish>")));
  const std::string key = read_text(path("keys/arm/key.pem"));
  ASSERT_EQ(make({"--days", "2", "arm", "client"}), 2) << "'arm' is a name and no role";
  ASSERT_EQ(make({"--days", "2", "robot=arm", "client"}), 0) << output;
  EXPECT_EQ(read_text(path("keys/arm/key.pem")), key);
  std::filesystem::create_directory(path("keys/planner"));
  ASSERT_EQ(make({"planner", "robot+planner"}), 0) << output;
  EXPECT_TRUE(std::filesystem::is_empty(path("keys/planner")));
  EXPECT_TRUE(std::filesystem::exists(path("keys/robot-planner/cyclonedds.xml")));
  EXPECT_EQ(read_text(path("keys/client/identity_ca.cert.pem")),
            read_text(path("keys/ca/cert.pem")));
}

TEST_F(SecurityScript, RefusesWhatIsNoRoleNameOrOptionAndMakesNothing) {
  using Line = std::vector<std::string>;
  for (const auto& [arguments, found] :
       {std::pair{Line{"captain"}, "no role 'captain'"}, std::pair{Line{"robot=a/b"}, "name 'a/b'"},
        std::pair{Line{"robot=ca"}, "name 'ca'"}, std::pair{Line{"--days", "0"}, "--days '0'"},
        std::pair{Line{"--at", "here"}, "--at 'here'"},
        std::pair{Line{"--writes", "rt/tf"}, "found 'rt/tf'"},
        std::pair{Line{"--writes", "robot=<a>"}, "found 'robot=<a>'"},
        std::pair{Line{"--key"}, "no option --key"}}) {
    EXPECT_EQ(make(arguments), 2) << found;
    EXPECT_THAT(output, HasSubstr(found));
    EXPECT_FALSE(std::filesystem::exists(path("keys")));
  }
}

}  // namespace
}  // namespace clearance::test
