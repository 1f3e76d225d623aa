// Tools with joints are attached to an arm and detached while everything moves: a thousand changes,
// one after another, in random order.
//
// Oracle: the centres of balls by the sum of angles (tests/shared/tool_cell.hpp), the pairs by
// lists of names. The changes are made in the cell's text, and each monitor takes over from the one
// before, as in a running loop.
#include <gtest/gtest.h>

#include <algorithm>
#include <list>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "config/edit/cell_editor.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/monitor/tick/taken_over.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/tool_cell.hpp"

namespace clearance {
namespace {

using test::kStart;
using test::kTick;

using Names = std::pair<std::string, std::string>;

Names link_pair(const std::string& a, const std::string& b) { return std::minmax(a, b); }

// What the test knows of one tool.
struct Tool {
  std::string robot, to;  // `to` is empty while nothing carries it
  Pose base;              // in the world, or in the flange
  double joint = 0.0;     // where it stands, or was sent last
  bool absent = false;
};

// The pairs that the descriptions leave out, and those that are rigid, by the names of the cell.
const std::set<Names> kOfDescriptions = {
    link_pair("foot", "upper"),    link_pair("upper", "lower"),    link_pair("lower", "wrist"),
    link_pair("g_palm", "g_left"), link_pair("g_palm", "g_right"), link_pair("t_neck", "t_tip")};
const std::set<Names> kWithGripper = {link_pair("wrist", "g_palm"), link_pair("lower", "g_palm"),
                                      link_pair("wrist", "g_left"), link_pair("wrist", "g_right")};
const std::set<Names> kWithTorch = {link_pair("wrist", "t_neck")};

class ToolChange : public testing::Test {
 protected:
  ToolChange() {
    test::write_tools(folder_);
    auto opened = CellEditor::open(test::kToolCell, folder_ / "cell.yaml");
    editor_.emplace(std::get<CellEditor>(std::move(opened)));
    scenes_.push_back(read().scene);
    numbers_.emplace(scenes_.back());
    monitor_ = std::make_unique<Monitor>(scenes_.back());
    gripper_ = {"gripper", "", test::at(1.6716, 0.7833, 0), 0.01, false};
    torch_ = {"torch", "", test::at(1.6716, -0.7833, 0), 0.2, false};
  }

  Cell read() {
    auto result = parse_cell(editor_->text(), folder_ / "cell.yaml");
    if (const auto* errors = std::get_if<std::vector<CellError>>(&result)) {
      ADD_FAILURE() << errors->front().text;
      return {};
    }
    return std::get<Cell>(std::move(result));
  }

  [[nodiscard]] Pose root_of(const Tool& tool) const {
    return tool.to.empty() ? tool.base : compose(arm_.flange(), tool.base);
  }
  [[nodiscard]] std::map<std::string, Vec3> centres() const {
    std::map<std::string, Vec3> centres{{"person", person_}};
    arm_.add_centres(centres);
    test::add_gripper(root_of(gripper_), gripper_.joint, centres);
    test::add_torch(root_of(torch_), torch_.joint, centres);
    return centres;
  }

  double draw(double least, double most) { return random_.uniform(least, most); }
  bool draw_one_of(int count) { return random_.integer(1, count) == 1; }

  // Attaches the tool somewhere on the flange.
  CellChange attached(Tool& tool) {
    tool.to = "flange";
    tool.base = {Vec3(draw(0.0, 0.01), 0.0, draw(-0.01, 0.01)),
                 test::turned(Vec3::UnitX(), draw(-1.0, 1.0))};
    tool.absent = false;
    return AttachRobot{.robot = tool.robot, .to = "flange", .carrier_from_root = tool.base};
  }
  // Puts the tool where it is, or elsewhere, or away.
  CellChange detached(Tool& tool) {
    Pose base = root_of(tool);
    if (draw_one_of(3)) base = test::at(draw(-2, 2), draw(-2, 2), draw(-1, 1));
    tool.to = "";
    tool.base = base;
    tool.absent = draw_one_of(4);
    const std::string joint = &tool == &gripper_ ? "finger" : "tilt";
    return DetachRobot{.robot = tool.robot,
                       .world_from_root = base,
                       .joints = {{joint, tool.joint}},
                       .absent = tool.absent};
  }
  // Returns how often a tool changes.
  int change() {
    std::vector<CellChange> changes;
    for (Tool* tool : {&gripper_, &torch_})
      if (!tool->to.empty()) changes.push_back(detached(*tool));
    if (changes.empty() || !draw_one_of(3))
      changes.push_back(attached(draw_one_of(2) ? gripper_ : torch_));
    const auto result = editor_->edit(changes);
    if (const auto* refused = std::get_if<EditRefusal>(&result)) {
      ADD_FAILURE() << refused->path << ": " << refused->reason;
      return 1;
    }
    scenes_.push_back(std::get<Cell>(result).scene);
    const Scene& before = *std::next(scenes_.rbegin());
    monitor_ = test::taken_over(*monitor_, before, scenes_.back(), *numbers_);
    if (scenes_.size() > 2) scenes_.pop_front();
    return static_cast<int>(changes.size());
  }

  JointSample joint(const std::string& name, double position) {
    const auto& variables = scenes_.back().variables;
    const auto found = std::ranges::find(variables, name, &JointVariable::name);
    JointSample sample;
    sample.variable = static_cast<std::uint32_t>(found - variables.begin());
    sample.position = position;
    sample.stamp_ns = now_;
    sample.source = numbers_->of(SourceName("robot"));
    return sample;
  }

  // Moves all that moves, and ticks. A tool that nothing carries is without power, or says
  // anything.
  const Report& tick() {
    now_ += kTick;
    arm_.shoulder = std::clamp(arm_.shoulder + draw(-3e-3, 3e-3), -2.0, 2.0);
    arm_.elbow = std::clamp(arm_.elbow + draw(-3e-3, 3e-3), -2.0, 2.0);
    arm_.roll = std::clamp(arm_.roll + draw(-3e-3, 3e-3), -2.0, 2.0);
    const double time = 1e-9 * static_cast<double>(now_ - kStart);
    person_ = Vec3(1.9, 0.8 + 0.6 * std::sin(3.0 * time), 0.0);
    std::vector<JointSample> joints = {joint("shoulder", arm_.shoulder), joint("elbow", arm_.elbow),
                                       joint("roll", arm_.roll)};
    if (!gripper_.to.empty())
      gripper_.joint = std::clamp(gripper_.joint + draw(-4e-4, 4e-4), 0.0, 0.04);
    if (!torch_.to.empty()) torch_.joint = std::clamp(torch_.joint + draw(-2e-3, 2e-3), -1.0, 1.0);
    for (const Tool* tool : {&gripper_, &torch_}) {
      const std::string name = tool == &gripper_ ? "g_finger" : "t_tilt";
      if (!tool->to.empty()) joints.push_back(joint(name, tool->joint));
      if (tool->to.empty() && draw_one_of(2)) joints.push_back(joint(name, draw(0.0, 0.04)));
    }
    PoseSample person = test::sample(0, {person_, Eigen::Quaterniond::Identity()}, now_);
    person.source = numbers_->of(SourceName("tracker"));
    return monitor_->tick(std::vector<PoseSample>{person}, joints, now_);
  }

  [[nodiscard]] bool is_fixed(const std::string& name) const {
    return name == "foot" || (name == "g_palm" && gripper_.to.empty());
  }
  [[nodiscard]] bool is_absent(const std::string& name) const {
    return (gripper_.absent && name.starts_with("g_")) || (torch_.absent && name.starts_with("t_"));
  }
  [[nodiscard]] std::set<Names> expected_pairs() const {
    std::set<Names> pairs;
    const auto all = centres();
    for (const auto& [a, unused_a] : all) {
      for (const auto& [b, unused_b] : all) {
        const Names both = link_pair(a, b);
        if (a >= b || kOfDescriptions.contains(both) || (is_fixed(a) && is_fixed(b))) continue;
        if (!gripper_.to.empty() && kWithGripper.contains(both)) continue;
        if (!torch_.to.empty() && kWithTorch.contains(both)) continue;
        pairs.insert(both);
      }
    }
    return pairs;
  }

  // Compares every pair of the report with the oracle.
  void expect_true(const Report& report) {
    const Scene& scene = scenes_.back();
    const auto places = centres();
    std::set<Names> found;
    double least = kInfinity;
    for (const PairReport& pair : report.pairs) {
      const ObjectPair& objects = scene.pairs[pair.pair];
      const std::string &a = scene.objects[objects.first].name,
                        &b = scene.objects[objects.second].name;
      found.insert(link_pair(a, b));
      if (is_absent(a) || is_absent(b)) {
        EXPECT_EQ(pair.status, PairStatus::kAbsent) << a << " - " << b;
        continue;
      }
      const double truth =
          (places.at(a) - places.at(b)).norm() - test::ball_radius(a) - test::ball_radius(b);
      least = std::min(least, truth);
      EXPECT_LE(pair.lower, truth + kRounding) << a << " - " << b;
      EXPECT_GE(pair.upper, truth - kRounding) << a << " - " << b;
      EXPECT_GT(pair.lower, truth - 1e-6) << a << " - " << b << ": it is known at once";
    }
    EXPECT_EQ(found, expected_pairs());
    EXPECT_EQ(report.unknown, 0u);
    EXPECT_NEAR(report.minimum.lower, least, 1e-6);
    expect_zone(report, places);
  }
  // Tools count as the arm while it carries them.
  void expect_zone(const Report& report, const std::map<std::string, Vec3>& places) {
    double least = kInfinity;
    for (const auto& [name, place] : places) {
      const bool is_arm = !name.starts_with("g_") && !name.starts_with("t_") && name != "person";
      const bool is_carried = (name.starts_with("g_") && !gripper_.to.empty()) ||
                              (name.starts_with("t_") && !torch_.to.empty());
      if (!is_arm && !is_carried) continue;
      least = std::min(least, (place - person_).norm() - 0.3 - test::ball_radius(name));
    }
    // Between both thresholds it depends on before. A crossing within the tick counts as well.
    EXPECT_TRUE(report.zones[0].active || least > 0.2 - 1e-6) << least;
    EXPECT_TRUE(!report.zones[0].active || least < 0.32) << least;
    ticks_inside_ += report.zones[0].active ? 1 : 0;
  }

  // Both sides round: sums of five terms of 3 m.
  static constexpr double kRounding = 1e-12;

  test::ScratchFolder folder_;
  std::optional<CellEditor> editor_;
  std::list<Scene> scenes_;
  std::optional<SourceNumbers> numbers_;
  std::unique_ptr<Monitor> monitor_;
  Random random_{61};
  std::int64_t now_ = kStart;
  test::ToolArm arm_{0.3, -0.5, 0.1};
  Vec3 person_ = Vec3::Zero();
  Tool gripper_, torch_;
  std::uint64_t ticks_inside_ = 0;
};

TEST_F(ToolChange, LeavesNoTickOutAndNoBoundFalseAThousandTimes) {
  constexpr int kChanges = 1000, kTicks = 3;
  std::uint64_t cycle = 0;
  for (int changes = 0; changes < kChanges && !HasFailure();) {
    for (int i = 0; i < kTicks && !HasFailure(); ++i) {
      const Report& report = tick();
      EXPECT_EQ(report.cycle, ++cycle);
      expect_true(report);
    }
    changes += change();
  }
  EXPECT_GT(ticks_inside_, 100u);
  EXPECT_LT(ticks_inside_, cycle - 100);
}

TEST_F(ToolChange, GivesTheTextThatItGaveBefore) {
  const AttachRobot on{.robot = "gripper", .to = "flange", .carrier_from_root = Pose{}};
  const DetachRobot off{.robot = "gripper",
                        .world_from_root = test::at(1.6716, 0.7833, 0),
                        .joints = {{"finger", 0.01}}};
  std::vector<std::string> texts;
  for (const CellChange& change :
       {CellChange(on), CellChange(off), CellChange(on), CellChange(off)}) {
    ASSERT_TRUE(std::holds_alternative<Cell>(editor_->edit(std::vector<CellChange>{change})));
    texts.push_back(editor_->text());
  }
  EXPECT_EQ(texts[0].find("finger: {position"), std::string::npos);
  EXPECT_EQ(texts[2], texts[0]);
  EXPECT_EQ(texts[3], texts[1]);
}

}  // namespace
}  // namespace clearance
