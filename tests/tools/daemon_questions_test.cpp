// Questions about motions to a running daemon, over real DDS. The oracle is the library's own call
// on the same scene, with the positions that were sent.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "core/shapes.hpp"
#include "monitor/ask/asker.hpp"
#include "monitor/client/client.hpp"
#include "monitor/client/commands.hpp"
#include "monitor/client/questions.hpp"
#include "monitor/participant/question_message.hpp"
#include "monitor/wire/cdr.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/shared/byte_writer.hpp"
#include "tests/shared/poses.hpp"
#include "tests/tools/running_cell.hpp"

namespace clearance::test {
namespace {

using std::chrono::milliseconds;

// The finger is a sphere of 0.05 m that circles at 2 m around the origin.
constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
std::string asked_cell(int age_limit_ms) {
  return "name: questions\nunits: {length: m, angle: rad}\nrate_hz: 200\n"
         "defaults: {age_limit_ms: " +
         std::to_string(age_limit_ms) +
         "}\n"
         "questions: {from: [planner, pendant], queue: 4}\n"
         "commands: {from: [planner]}\n"
         "robots: [{name: arm, urdf: scara.urdf}]\n"
         "objects:\n"
         "  - {name: pin, fixed: true, sphere: {radius: 0.1}, pose: {xyz: [2.3, 0, 0]}}\n"
         "  - {name: cart, max_speed: 0.02, may_jump: true, sphere: {radius: 0.1}}\n"
         "pairs: [{between: [arm, pin]}, {between: [arm, cart]}, {between: [arm, arm]}]\n";
}

Question swing(double from, double to) {
  Question question;
  question.motion = {
      .joints = {"shoulder"}, .times = {0.0, 2.0}, .positions = {from, to}, .velocities = {}};
  question.margins = {0.0, 0.1, 0.2};
  return question;
}

class DaemonQuestions : public testing::Test {
 protected:
  void start(int age_limit_ms = 20'000, const std::vector<std::string>& more = {}) {
    write_text(folder / "scara.urdf", kScaraUrdf);
    write_text(folder / "cell.yaml", asked_cell(age_limit_ms));
    cell.emplace(std::get<Cell>(read_cell(folder / "cell.yaml")));
    daemon.emplace(kDaemon,
                   with(with({(folder / "cell.yaml").string()}, dds_arguments(dds)), more));
    joints.emplace(connection, "driver", std::vector<std::string>{"shoulder", "elbow", "push"});
    poses.emplace(connection, "tracker");
    ASSERT_TRUE(eventually([&] { return joints->is_heard() && poses->is_heard(); }))
        << daemon->output();
  }
  // The cart is far away unless said otherwise.
  void send(double shoulder, const Vec3& cart = {-5.0, 0.0, 0.0}, double speed = 0.0) {
    joints->write(std::vector{shoulder, 0.0, 0.0}, std::vector{0.0, speed, 0.0});
    clearance_msg_ObjectPose pose{};
    pose.object = 1;
    pose.stamp_ns = client::now_ns();
    pose.position = {cart.x(), cart.y(), cart.z()};
    pose.orientation = {0, 0, 0, 1};
    poses->write({&pose, 1}, cell->scene.revision);
  }
  // Asks until the inputs that were sent have arrived.
  QuestionResult answer_of(client::Questions& questions, const Question& question,
                           const client::QuestionOptions& options = {}) {
    std::optional<QuestionResult> result;
    EXPECT_TRUE(eventually([&] {
      result = questions.ask(question, options, std::chrono::seconds(30));
      return result && result->status != QuestionStatus::kNoInput;
    })) << (result ? result->reason : daemon->output());
    return result.value_or(QuestionResult{});
  }

  const ScratchFolder folder;
  DdsOptions dds = own_dds();
  client::Connection connection{dds};
  std::optional<Cell> cell;
  std::optional<ChildProcess> daemon;
  std::optional<client::JointWriter> joints;
  std::optional<client::PoseWriter> poses;
};

TEST_F(DaemonQuestions, GetTheAnswerOfTheLibraryForThePresentInputs) {
  start();
  client::Questions questions(connection, "planner");
  send(-1.0);
  const Question question = swing(-1.0, 0.6);
  const QuestionResult result = answer_of(questions, question);
  ASSERT_TRUE(result.done()) << result.reason;
  Question stated = question;
  stated.held = {{"elbow", 0.0}, {"push", 0.0}};
  stated.poses = {{.object = "cart", .world_from_object = {.position = {-5.0, 0.0, 0.0}}}};
  const auto expected = std::get<Answer>(ask(cell->scene, stated));
  EXPECT_EQ(result.lower, expected.lower);
  EXPECT_EQ(result.upper, expected.upper);
  EXPECT_NEAR(result.upper, 0.15, 1e-3);
  EXPECT_EQ(result.time, expected.time);
  EXPECT_EQ(result.first + "-" + result.second, "pin-finger");
  EXPECT_EQ(result.point_on_first, expected.point_on_first);
  ASSERT_EQ(result.margins.size(), 3u);
  EXPECT_TRUE(result.is_free(0.1));
  EXPECT_FALSE(result.is_free(0.2));
  EXPECT_EQ(result.margins[2].verdict, Verdict::kBelow);
  EXPECT_EQ(result.margins[2].below_at, expected.margins[2].below_at);
  EXPECT_EQ(result.margins[2].second, "finger");
  EXPECT_EQ(result.scene_revision, cell->scene.revision);
  EXPECT_GT(result.cycle, 0u);
  EXPECT_EQ(result.start_deviation, 0.0);
  EXPECT_EQ(result.start_joint, "shoulder");
}

TEST_F(DaemonQuestions, SayHowFarTheRobotIsFromTheFirstWaypoint) {
  start();
  client::Questions questions(connection, "planner");
  send(-1.25);
  const QuestionResult result = answer_of(questions, swing(-1.0, 0.6));
  EXPECT_EQ(result.start_deviation, 0.25);
}

// The cart's pose is aged by the time until the answer, and it may come nearer since then.
TEST_F(DaemonQuestions, WidenByTheAgeOfAnObjectsPose) {
  start();
  client::Questions questions(connection, "planner");
  send(-1.0, {2.0 * std::cos(1.0), -2.0 * std::sin(1.0) - 0.35, 0.0});
  Question question = swing(-1.0, -1.0);
  (void)answer_of(questions, question);
  std::this_thread::sleep_for(milliseconds(500));
  const QuestionResult result = answer_of(questions, question);
  ASSERT_TRUE(result.done());
  const double most = 0.2 - 0.02 * (2.0 + 0.5);
  EXPECT_LE(result.lower, most + 1e-9);
  EXPECT_LE(result.upper, most + question.tolerance);
  question.others = OthersMove::kNot;
  EXPECT_NEAR(answer_of(questions, question).lower, 0.2, 1e-9);
}

// No input has come, or it is too old, or it is changing: nothing is said about the motion.
TEST_F(DaemonQuestions, WithInputsThatAreMissingLateOrMovingAreNeverFree) {
  start(300);
  client::Questions questions(connection, "planner");
  const auto refused_for = [&](const std::string& name) {
    std::optional<QuestionResult> result;
    const bool came = eventually([&] {
      result = questions.ask(swing(-1.0, -0.9), {}, std::chrono::seconds(30));
      return result && result->status == QuestionStatus::kNoInput &&
             result->reason.find(name) != std::string::npos;
    });
    EXPECT_TRUE(came) << (result ? result->reason : "");
    EXPECT_EQ(result->lower, -std::numeric_limits<double>::infinity());
    EXPECT_EQ(result->upper, std::numeric_limits<double>::infinity());
    EXPECT_TRUE(result->margins.empty());
    EXPECT_FALSE(result->is_free(0.0));
  };
  refused_for("unknown");
  send(-1.0);
  std::this_thread::sleep_for(milliseconds(400));
  refused_for("older than its age limit");
  EXPECT_TRUE(eventually([&] {
    send(-1.0, {-5, 0, 0}, 0.3);
    const auto result = questions.ask(swing(-1.0, -0.9), {}, std::chrono::seconds(30));
    return result && result->reason.find("elbow") != std::string::npos &&
           result->reason.find("moves") != std::string::npos;
  }));
  EXPECT_TRUE(daemon->tells("question-refused", {"no-input"}));
  // A question needs no input for things that it states.
  Question stated = swing(-1.0, -0.9);
  stated.held = {{"elbow", 0.0}, {"push", 0.0}};
  stated.poses = {{.object = "cart", .world_from_object = {.position = {-5.0, 0.0, 0.0}}}};
  EXPECT_TRUE(questions.ask(stated, {}, std::chrono::seconds(30))->done());
}

TEST_F(DaemonQuestions, AreAboutTheSceneInForce) {
  start();
  client::Questions questions(connection, "planner");
  client::Commands commands(connection, "planner");
  send(-1.0);
  const QuestionResult before = answer_of(questions, swing(-1.0, 0.6));
  ASSERT_TRUE(before.is_free(0.1));
  const auto placed = commands.send({Place{"pin", at(2.15, 0, 0)}}, {}, std::chrono::seconds(30));
  ASSERT_TRUE(placed && placed->done()) << placed->reason;
  const QuestionResult after = answer_of(questions, swing(-1.0, 0.6));
  ASSERT_TRUE(after.done()) << after.reason;
  EXPECT_EQ(after.scene_revision, placed->scene_revision);
  EXPECT_FALSE(after.is_free(0.1));
  const auto other =
      questions.ask(swing(-1.0, 0.6), {.scene_revision = before.scene_revision, .stop = {}},
                    std::chrono::seconds(30));
  EXPECT_EQ(other->status, QuestionStatus::kOtherRevision);
}

// A part that is attached is carried along: here it is 0.3 m from the finger, towards the pin.
TEST_F(DaemonQuestions, IncludeWhatIsAttached) {
  start();
  client::Questions questions(connection, "planner");
  client::Commands commands(connection, "planner");
  send(-1.0);
  (void)answer_of(questions, swing(-1.0, 0.6));
  const auto changed = commands.send(
      {AddObject{"{name: part, fixed: true, sphere: {radius: 0.02}, pose: {xyz: [0, 9, 9]}}"},
       Attach{"part", "finger", at(0.15, 0, 0)}},
      {}, std::chrono::seconds(30));
  ASSERT_TRUE(changed && changed->done()) << changed->path << changed->reason;
  const QuestionResult result = answer_of(questions, swing(-1.0, 0.6));
  ASSERT_TRUE(result.done()) << result.reason;
  EXPECT_EQ(result.first + "-" + result.second, "pin-part");
  EXPECT_NEAR(result.upper, 0.03, 1e-3);
}

// The client's statements count, whatever the daemon knows.
TEST_F(DaemonQuestions, TakeBodiesAgesAndContactsThatTheyState) {
  start();
  client::Questions questions(connection, "planner");
  send(-1.0);
  Question question = swing(-1.0, 0.6);
  question.poses = {
      {.object = "cart", .world_from_object = {.position = {-5.0, 0.0, 0.0}}, .age = 0.5}};
  question.payloads = {{.name = "tool",
                        .shape = std::get<ConvexBody>(box(Vec3(0.15, 0.01, 0.01))),
                        .link = "finger",
                        .link_from_object = Pose(),
                        .touch = {"lower"}}};
  question.margins = {0.1};
  question.contacts = {{.first = "pin", .second = "tool", .depth = 0.01}};
  const QuestionResult result = answer_of(questions, question);
  ASSERT_TRUE(result.done()) << result.reason;
  Question stated = question;
  stated.held = {{"elbow", 0.0}, {"push", 0.0}};
  const auto expected = std::get<Answer>(ask(cell->scene, stated));
  EXPECT_EQ(result.lower, expected.lower);
  EXPECT_EQ(result.upper, expected.upper);
  EXPECT_EQ(result.first + "-" + result.second, "pin-tool");
  EXPECT_NEAR(result.upper, 0.05, 1e-3);
  EXPECT_TRUE(result.is_free(0.1)) << "its contact is meant";
}

TEST_F(DaemonQuestions, ThatDoNotFitAreRefusedWithTheReason) {
  start();
  client::Questions questions(connection, "planner");
  send(-1.0);
  (void)answer_of(questions, swing(-1.0, 0.6));
  const auto refused = [&](const Question& question, QuestionStatus status,
                           const std::string& named) {
    const auto result = questions.ask(question, {}, std::chrono::seconds(30));
    ASSERT_TRUE(result);
    EXPECT_EQ(result->status, status) << result->reason;
    EXPECT_NE((result->path + result->reason).find(named), std::string::npos)
        << result->path << ": " << result->reason;
    EXPECT_EQ(result->lower, -std::numeric_limits<double>::infinity());
  };
  Question question = swing(-1.0, 0.6);
  question.motion.joints = {"knee"};
  refused(question, QuestionStatus::kRefused, "knee");
  question = swing(-1.0, kNotANumber);
  refused(question, QuestionStatus::kMalformed, "motion.positions[1]");
  question = swing(-1.0, 0.6);
  question.motion.times.assign(kMostWaypoints + 1, 0.0);
  refused(question, QuestionStatus::kMalformed, "motion.times");
  question = swing(-1.0, 0.6);
  question.held = {{"elbow", kNotANumber}};
  refused(question, QuestionStatus::kMalformed, "held[0].position");
  question = swing(-1.0, 0.6);
  question.motion.positions.pop_back();
  refused(question, QuestionStatus::kRefused, "positions");
  question = swing(-1.0, 0.6);
  question.margins.assign(kMostMargins + 1, 0.0);
  refused(question, QuestionStatus::kMalformed, "margins");
  // The log leaves refusals out that follow many others, here those without input.
  question = swing(-1.0, 0.6);
  question.motion.joints = {"knee"};
  EXPECT_TRUE(eventually([&] {
    refused(question, QuestionStatus::kRefused, "knee");
    return daemon->told("question-refused", {"planner", "knee"});
  })) << daemon->output();
  EXPECT_TRUE(answer_of(questions, swing(-1.0, 0.6)).done());
}

TEST_F(DaemonQuestions, OfAClientThatIsNotNamedAreRefusedAndOneOnTheCommandLineIsNamed) {
  start(20'000, {"--questions", "tool"});
  send(-1.0);
  client::Questions stranger(connection, "stranger"), tool(connection, "tool");
  EXPECT_EQ(stranger.ask(swing(-1.0, 0.6), {}, std::chrono::seconds(30))->status,
            QuestionStatus::kNotNamed);
  EXPECT_TRUE(answer_of(tool, swing(-1.0, 0.6)).done());
}

// The message is cut off behind the client's name, in the middle and in its last byte. Cyclone
// drops it.
TEST_F(DaemonQuestions, ThatAreCutOffAreCountedAndTheNextOneIsAnswered) {
  start();
  send(-1.0);
  client::Questions questions(connection, "planner");
  (void)answer_of(questions, swing(-1.0, 0.6));
  CdrEncoder encoder;
  const auto whole = encoder.encode(
      *to_wire(MotionQuestion{.client = "pendant", .request = 1, .question = swing(-1.0, 0.6)}));
  Participant participant(dds);
  client::Health health(connection);
  std::uint64_t sent = 0;
  for (const std::size_t size : {std::size_t{16}, whole.size() / 2, whole.size() - 8}) {
    ByteWriter cut(participant, dds.partition, clearance_msg_Question_desc, Topics{}.questions,
                   {whole.begin(), whole.begin() + static_cast<long>(size)});
    ASSERT_TRUE(cut.is_heard() && meets_writers_of(participant, *daemon));
    cut.send();
    ++sent;
    EXPECT_TRUE(eventually([&] {
      health.update();
      return health.message() != nullptr && health.message()->undecodable_samples == sent;
    })) << size;
  }
  EXPECT_TRUE(answer_of(questions, swing(-1.0, 0.6)).done());
}

// 1 s at 10 kHz. Each question is answered or refused as busy, another client gets its answers, and
// no report is missing.
TEST_F(DaemonQuestions, AtTenKilohertzAreAnsweredOrRefusedAsBusyAndNoTickIsMissing) {
  start();
  send(-1.0);
  client::Questions flooding(connection, "planner"), other(connection, "pendant");
  (void)answer_of(flooding, swing(-1.0, 0.6));
  Participant participant(dds);
  Distances distances(participant, *cell);
  distances.settle();
  std::vector<std::uint64_t> requests;
  std::thread flood([&] {
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < 10'000; ++i) {
      requests.push_back(flooding.post(swing(-1.0, 1e-5 * i)));
      std::this_thread::sleep_until(begin + std::chrono::microseconds(100) * i);
    }
  });
  std::uint64_t cycle = 0;
  for (int i = 0; i < 200; ++i) {
    const auto report = distances.next();
    ASSERT_NE(report, nullptr);
    if (cycle != 0) {
      ASSERT_EQ((*report)->cycle, cycle + 1);
    }
    cycle = (*report)->cycle;
  }
  EXPECT_TRUE(answer_of(other, swing(-1.0, 0.6)).done());
  flood.join();
  std::size_t answered = 0, busy = 0;
  for (const std::uint64_t request : requests) {
    const auto result = flooding.result(request);
    if (!result) continue;  // only the last ones are kept
    ASSERT_TRUE(result->done() || result->status == QuestionStatus::kBusy) << result->reason;
    (result->done() ? answered : busy) += 1;
  }
  EXPECT_GT(answered + busy, 0u);
  EXPECT_TRUE(daemon->tells("question-refused", {"planner", "busy"})) << daemon->output();
  EXPECT_TRUE(answer_of(flooding, swing(-1.0, 0.6)).done());
}

TEST_F(DaemonQuestions, AreOffWithoutAClientThatIsNamed) {
  write_text(folder / "scara.urdf", kScaraUrdf);
  std::string text = asked_cell(20'000);
  const std::size_t line = text.find("questions: {");
  text.erase(line, text.find('\n', line) + 1 - line);
  write_text(folder / "cell.yaml", text);
  cell.emplace(std::get<Cell>(read_cell(folder / "cell.yaml")));
  daemon.emplace(kDaemon, with({(folder / "cell.yaml").string()}, dds_arguments(dds)));
  Participant participant(dds);
  Distances distances(participant, *cell);
  distances.settle();
  client::Questions questions(connection, "planner");
  for (int i = 0; i < 50; ++i) ASSERT_NE(distances.next(), nullptr);
  EXPECT_FALSE(questions.is_heard());
}

}  // namespace
}  // namespace clearance::test
