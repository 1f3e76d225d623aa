#include "monitor/publish/health_log.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "monitor/inputs/input_record.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/shared/logged.hpp"

namespace clearance::test {
namespace {

// Scenes with a cup and a bowl, in this order or in the other.
class HealthLogTest : public testing::Test {
 protected:
  static Scene scene_of_names(const std::vector<std::string>& names) {
    std::vector<Object> objects;
    for (const std::string& name : names) objects.push_back(moving(name, {ball(0.1)}));
    return cell_of(std::move(objects));
  }
  // One second passes in this scene. The named object is late.
  void second(const Scene& scene, const std::string& late, std::uint64_t overruns) {
    std::vector<std::string> names;
    for (const Object& object : scene.objects) names.push_back(object.name);
    std::vector<clearance_msg_InputAge> inputs(names.size());
    for (std::uint32_t i = 0; i < names.size(); ++i) {
      inputs[i].object = i;
      inputs[i].name = names[i].data();
      inputs[i].stale = names[i] == late;
      inputs[i].age_ns = inputs[i].stale ? 500'000'000 : 0;
    }
    update(inputs, overruns);
  }
  void update(std::vector<clearance_msg_InputAge>& inputs, std::uint64_t overruns = 0) {
    clearance_msg_Health health{};
    health.now_ns = now_ns_ += 1'000'000'000;
    health.overruns = overruns;
    health.inputs._buffer = inputs.data();
    health.inputs._length = static_cast<std::uint32_t>(inputs.size());
    log_.update(health, [] { return std::string(); });
  }
  void response(std::uint64_t late_responses, clearance_msg_InputResponse* slowest = nullptr) {
    clearance_msg_Health health{};
    health.late_responses = late_responses;
    health.responses._buffer = slowest;
    health.responses._length = slowest == nullptr ? 0 : 1;
    log_.update(health, [] { return std::string(); });
  }
  [[nodiscard]] std::size_t lines(const std::string& code) const {
    return logged_->count("[" + code + "]");
  }

  Scene first_ = scene_of_names({"cup", "bowl"}), turned_ = scene_of_names({"bowl", "cup"});
  std::int64_t now_ns_ = 0;
  HealthLog log_{first_};
  std::shared_ptr<Logged> logged_ = std::make_shared<Logged>();
  LoggedTo to_{logged_};
};

TEST_F(HealthLogTest, TellsOnceThatTheResponseIsLateAndOnceThatItIsNotAnyMore) {
  std::string name = "tracker";
  clearance_msg_InputResponse slowest{name.data(), 20'000.0, 61'500.0};
  response(0);
  EXPECT_EQ(lines("response-late"), 0u);
  response(5, &slowest);
  response(12, &slowest);
  EXPECT_EQ(lines("response-late"), 1u);
  EXPECT_NE(logged_->text().find("5 ticks in the last second"), std::string::npos);
  EXPECT_NE(logged_->text().find("tracker, 61.5 ms"), std::string::npos);
  EXPECT_EQ(lines("response-back"), 0u);
  response(12);
  response(12);
  EXPECT_EQ(lines("response-back"), 1u);
  response(13);
  EXPECT_EQ(lines("response-late"), 2u);
}

TEST_F(HealthLogTest, DoesNotTellAgainWhatAChangedSceneStillHasUnderAnotherNumber) {
  second(first_, "cup", 3);
  EXPECT_EQ(lines("poses-late"), 1u);
  EXPECT_EQ(lines("overruns"), 1u);
  log_.change(turned_);
  second(turned_, "cup", 3);
  EXPECT_EQ(lines("poses-late"), 1u) << logged_->text();
  EXPECT_EQ(lines("poses-back"), 0u);
  EXPECT_EQ(lines("overruns"), 1u) << "none came since";
  second(turned_, "bowl", 3);
  EXPECT_EQ(lines("poses-late"), 2u);
  EXPECT_EQ(lines("poses-back"), 1u);
}

TEST_F(HealthLogTest, TellsAgainOfAnObjectThatWasAwayForAChange) {
  second(first_, "cup", 0);
  const Scene without = scene_of_names({"bowl"});
  log_.change(without);
  second(without, "", 0);
  log_.change(first_);
  second(first_, "cup", 0);
  EXPECT_EQ(lines("poses-late"), 2u) << logged_->text();
}

// Health names the other source for ten seconds after its last sample.
TEST_F(HealthLogTest, TellsOfAnotherSourceWhenItComesAndNotWhenItHasGone) {
  std::string name = "cup";
  const auto other = [&](const std::string& source) {
    std::vector<clearance_msg_InputAge> inputs(1);
    inputs[0].name = name.data();
    source.copy(inputs[0].other_source, sizeof inputs[0].other_source - 1);
    update(inputs);
    return lines("two-sources");
  };
  EXPECT_EQ(other(""), 0u);
  EXPECT_EQ(other("b"), 1u);
  EXPECT_EQ(other("b"), 1u);
  EXPECT_EQ(other(""), 1u) << logged_->text();
  EXPECT_EQ(other("b"), 2u) << "it is back";
}

// A late frame is let go after a while, and a changed cell may have a longer age limit.
TEST_F(HealthLogTest, TellsThatFramesAreBackWhenOneHasComeAndOnlyThen) {
  Scene scene = scene_of_names({"eye"});
  scene.sensors.emplace_back().name = "eye";
  log_.change(scene);
  std::string name = "eye";
  std::int64_t stamp_ns = 1'000'000'000;
  const auto one = [&](bool stale, bool is_known = true) {
    std::vector<clearance_msg_InputAge> inputs(1);
    inputs[0].name = name.data();
    inputs[0].stale = stale;
    inputs[0].age_ns = is_known ? now_ns_ + 1'000'000'000 - stamp_ns : -1;
    update(inputs);
  };
  one(false);
  one(true);
  EXPECT_EQ(lines("frames-late"), 1u);
  one(true, false);
  one(true, false);
  EXPECT_EQ(lines("frames-back"), 0u) << "it was let go";
  stamp_ns = now_ns_;
  one(false);
  EXPECT_EQ(lines("frames-back"), 1u) << logged_->text();
  one(true);
  log_.change(scene);
  one(false);
  EXPECT_EQ(lines("frames-back"), 1u) << "the limit is another one, and no frame came";
  EXPECT_EQ(lines("frames-late"), 2u);
}

// A clock of a simulation that is silent or goes back leaves every age unknown.
TEST_F(HealthLogTest, TellsNoAgeOfAHundredYears) {
  std::string name = "cup";
  std::vector<clearance_msg_InputAge> inputs(1);
  inputs[0].name = name.data();
  inputs[0].stale = true;
  inputs[0].age_ns = 1'020'000'000;
  update(inputs);
  EXPECT_TRUE(logged_->has("pose of cup is 1020 ms old")) << logged_->text();
  inputs[0].stale = false;
  inputs[0].age_ns = 0;
  update(inputs);
  InputRecord record;
  record.has_value = true;
  record.forget_age(now_ns_);
  inputs[0].stale = true;
  inputs[0].age_ns = record.age_ns(now_ns_ + 300'000'000);
  update(inputs);
  EXPECT_TRUE(logged_->has("pose of cup is an unknown time old")) << logged_->text();
}

TEST_F(HealthLogTest, TellsOfOverrunsThatGoOnInPausesThatDouble) {
  std::uint64_t overruns = 0;
  std::vector<int> told;
  for (int s = 0; s < 200; ++s) {
    const std::size_t before = lines("overruns");
    second(first_, "", overruns += 7);
    if (lines("overruns") > before) told.push_back(s);
  }
  EXPECT_EQ(told, (std::vector<int>{0, 10, 30, 70, 150}));
  EXPECT_EQ(logged_->text().find("1400") == std::string::npos, true) << "not told yet";
  for (int s = 0; s < 400; ++s) second(first_, "", overruns);
  EXPECT_NE(logged_->text().find("1400"), std::string::npos) << "the last ones are told, too";
  const std::size_t before = lines("overruns");
  second(first_, "", overruns + 1);
  EXPECT_EQ(lines("overruns"), before + 1) << "after a minute without any it is news";
}

}  // namespace
}  // namespace clearance::test
