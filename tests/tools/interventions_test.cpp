// The log of interventions of a running daemon, over real DDS. Python's hashlib and json judge it:
// they share no code with the product.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "monitor/client/client.hpp"
#include "monitor/files/build_info.hpp"
#include "monitor/recording/recorded_cell.hpp"
#include "tests/shared/poses.hpp"
#include "tests/tools/commanding_client.hpp"
#include "tests/tools/running_cell.hpp"

namespace clearance::test {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsSupersetOf;

// Prints nothing if each line is as the page says.
constexpr const char* kOracle = R"(
import hashlib, json, sys
before = "0" * 64
for number, line in enumerate(open(sys.argv[1], "rb").read().split(b"\n")[:-1], 1):
    content, said = line[:-75], json.loads(line)
    assert line[-75:-66] == b',"hash":"', line
    assert said["number"] == number and said["before"] == before, line
    before = hashlib.sha256(content).hexdigest()
    assert said["hash"] == before, line
)";

class InterventionsOfADaemon : public RunsPrograms {
 protected:
  void start(const std::vector<std::string>& more = {}) {
    daemon.emplace(kDaemon, with(with({cell_file, "--commands", "planner", "--interventions", log},
                                      dds_arguments(dds)),
                                 more));
    distances.settle();
    robot.send(0.0);
  }
  void stop() {
    daemon->signal(SIGTERM);
    EXPECT_EQ(daemon->wait(), 0) << daemon->output();
  }
  // The lines of this kind, of a log that both judges accept.
  std::vector<json> lines(const std::string& kind) {
    EXPECT_EQ(run("/usr/bin/python3", {"-c", kOracle, log}), 0) << output;
    EXPECT_EQ(run(kReplay, {"log", log}), 0) << output;
    std::vector<json> found;
    std::istringstream text(read_text(log));
    for (std::string line; std::getline(text, line);)
      if (json one = json::parse(line); one["kind"] == kind) found.push_back(std::move(one));
    return found;
  }
  std::string sha256sum(const std::string& file) {
    EXPECT_EQ(run("/usr/bin/sha256sum", {file}), 0) << output;
    return output.substr(0, 64);
  }
  static std::string with_a_mesh() {
    std::string text = small_cell("interventions");
    const std::string objects = "objects:\n";
    return text.insert(text.find(objects) + objects.size(),
                       "  - {name: block, fixed: true, groups: [still], pose: {xyz: [0, 7, 0]}, "
                       "mesh: {file: block.obj}}\n");
  }

  std::string cell_file = path("cell.yaml"), log = path("interventions.jsonl");
  Cell read = [this] {
    write_text(path("block.obj"),
               "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    write_text(cell_file, with_a_mesh());
    return std::get<Cell>(read_cell(cell_file));
  }();
  DdsOptions dds = own_dds();
  Participant participant{dds};
  Distances distances{participant, read};
  Poses robot{participant, read};
  std::optional<ChildProcess> daemon;
};

TEST_F(InterventionsOfADaemon, AreItsStartSourcesChangesOfTheSceneAndEnd) {
  start({"--record", path("run.mcap")});
  CommandingClient planner(participant, "planner"), stranger(participant, "stranger");
  planner.meet();
  stranger.meet();
  ASSERT_TRUE(meets_writers_of(participant, *daemon)) << daemon->output();
  const CellChange wall = AddObject{
      "{name: wall, fixed: true, groups: [still], pose: {xyz: [0, 5, 0]}, box: {size: "
      "[9, 1, 9]}}"};
  const CellChange contact = AllowContact{.contact = "press",
                                          .a = "left",
                                          .b = "wall",
                                          .depth = 0.01,
                                          .by = "an engineer",
                                          .reason = "it presses a part in"};
  EXPECT_EQ(stranger.result_of({wall}).status, CommandStatus::kNotNamed);
  const CommandResult done = planner.result_of({wall, contact});
  ASSERT_TRUE(done.done()) << done.reason;
  const CommandResult noted = planner.result_of({Note{"seen by a person"}});
  EXPECT_TRUE(noted.done()) << noted.reason;
  EXPECT_EQ(noted.scene_revision, done.scene_revision) << "nothing has changed";
  client::Connection connection(dds);
  client::Catalogue catalogue(connection);
  ASSERT_TRUE(eventually([&] {
    catalogue.update();
    return catalogue.revision() == done.scene_revision;
  }));
  write_text(cell_file, "# changed\n" + read_text(cell_file));
  daemon->signal(SIGHUP);
  ASSERT_TRUE(eventually([&] {
    catalogue.update();
    return catalogue.revision() != done.scene_revision;
  }));
  stop();

  const std::vector<json> starts = lines("start"), changes = lines("scene-changed");
  ASSERT_EQ(starts.size(), 1u);
  EXPECT_EQ(starts[0]["build"], kBuild);
  EXPECT_EQ(starts[0]["cell_hash"], read.hash);
  EXPECT_EQ(starts[0]["files"][path("block.obj")], sha256sum(path("block.obj")));
  EXPECT_EQ(starts[0]["revision"], fmt::format("{:016x}", read.scene.revision));
  EXPECT_THAT(starts[0]["command_line"].get<std::vector<std::string>>(),
              IsSupersetOf({std::string("--commands"), std::string("planner"), cell_file}));
  ASSERT_EQ(changes.size(), 2u);
  EXPECT_EQ(changes[0]["by"], "planner");
  EXPECT_EQ(changes[0]["request"], done.request);
  EXPECT_EQ(changes[0]["changes"], json({"add_object", "allow_contact press"}));
  EXPECT_EQ(changes[0]["revision"], fmt::format("{:016x}", done.scene_revision));
  EXPECT_EQ(changes[0]["in_force_from"], done.in_force_from);
  EXPECT_EQ(changes[0]["contacts"]["press"]["by"], "an engineer");
  EXPECT_EQ(changes[1]["by"], "SIGHUP or --reload");
  EXPECT_EQ(changes[1]["cell_hash"], std::get<Cell>(read_cell(cell_file)).hash);
  EXPECT_EQ(lines("noted").size(), 1u);
  EXPECT_EQ(lines("noted")[0]["text"],
            fmt::format("'planner' notes in request {}: seen by a person", noted.request));
  EXPECT_EQ(lines("cell-read-again").size(), 1u);
  EXPECT_EQ(lines("new-source").size(), 1u);
  ASSERT_EQ(lines("command-refused").size(), 1u);
  EXPECT_THAT(lines("command-refused")[0]["text"].get<std::string>(), HasSubstr("'stranger'"));
  ASSERT_EQ(lines("stop").size(), 1u);
  EXPECT_EQ(lines("stop")[0]["cause"], "signal");

  RecordingReader reader(path("run.mcap"));
  for (RecordedMessage message; reader.next(message);) {
  }
  EXPECT_EQ(changes[1]["cell_hash"], reader.about("cell_hash")) << "of the last scene";
  EXPECT_EQ(reader.about("build"), kBuild);
}

TEST_F(InterventionsOfADaemon, ShowThatARunWasKilledAndThatTheLogGoesOn) {
  start();
  ASSERT_TRUE(eventually([&] { return std::filesystem::file_size(log) > 0; }));
  daemon->signal(SIGKILL);
  daemon->wait();
  start({"--ticks", "400"});
  EXPECT_EQ(daemon->wait(), 0) << daemon->output();
  EXPECT_EQ(lines("start").size(), 2u);
  ASSERT_EQ(lines("stop").size(), 1u);
  EXPECT_EQ(lines("stop")[0]["cause"], "--ticks");
  EXPECT_EQ(lines("stop")[0]["ticks"], 400);
  EXPECT_EQ(run(kReplay, {"log", log}), 0);
  EXPECT_THAT(output, HasSubstr("the run before did not end with 'stop'"));
}

TEST_F(InterventionsOfADaemon, WhoseEndWasCutOffLackTheHashThatTheDaemonsLogTold) {
  start();
  stop();
  const std::string told = lines("stop").back()["hash"];
  EXPECT_TRUE(daemon->tells("interventions", {told})) << daemon->output();
  EXPECT_EQ(run(kReplay, {"log", log, "--holds", told}), 0) << output;
  std::string text = read_text(log);
  text.erase(text.rfind('\n', text.size() - 2) + 1);
  write_text(log, text);
  EXPECT_EQ(run(kReplay, {"log", log}), 0);
  EXPECT_THAT(output, HasSubstr("or lines were cut off"));
  EXPECT_EQ(run(kReplay, {"log", log, "--holds", told}), 1);
  EXPECT_THAT(output, HasSubstr("no line has the hash " + told));
  write_text(log, text.substr(0, text.size() - 9));
  EXPECT_EQ(run(kReplay, {"log", log}), 5);
  text[100] ^= 1;
  write_text(log, text);
  EXPECT_EQ(run(kReplay, {"log", log}), 1);
  EXPECT_THAT(output, HasSubstr("line 1 has not the hash that it states"));
  start();
  EXPECT_TRUE(daemon->tells("interventions-broken", {"line 1"}));
  stop();
}

TEST_F(InterventionsOfADaemon, AreRefusedInAFileOfAnotherDaemon) {
  start();
  ChildProcess second(kDaemon, {cell_file, "--interventions", log, "--interface", "lo"});
  EXPECT_EQ(second.wait(), 5);
  EXPECT_TRUE(second.wrote("is written by another program")) << second.output();
  stop();
}

}  // namespace
}  // namespace clearance::test
