// Expectations go on when the cell changes, and objects with new names count from when they are
// known first.
//
// Oracle: distances of spheres on a line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "monitor/replay/offline_replay.hpp"
#include "tests/config/cells.hpp"
#include "tests/monitor/replay/recorded_changes.hpp"

namespace clearance::test {
namespace {

using testing::Contains;
using testing::HasSubstr;

// A hand moves beside a post. From tick 50 on, the cell has a cart as well.
class NewObjects : public RecordedChanges {
 protected:
  NewObjects() {
    const auto add = [this](const std::string& cart) {
      cells.push_back(read_good(
          "name: test\nunits: {length: m, angle: rad}\nobjects:\n"
          "  - {name: post, fixed: true, sphere: {radius: 0.1}}\n" +
              cart +
              "  - {name: hand, may_jump: true, groups: [movers], sphere: {radius: 0.1}}\n"
              "pairs: [{between: [post, movers], publish: true}]\n"
              "zones: [{name: near, between: [post, movers], enter_below: 0.2, "
              "leave_above: 0.3}]\n",
          folder / "cell.yaml"));
    };
    add("");
    add("  - {name: cart, may_jump: true, groups: [movers], sphere: {radius: 0.1}}\n");
  }

  struct Motion {
    int ticks = 1400;
    int cart_from = 300, cart_to = 9999;               // ticks in which it sends
    int silent_from = 9999, silent_to = 9999;          // the hand
    int hand_near_from = 9999, cart_near_from = 9999;  // centres are 0.25 m apart then, 1 m before
  };
  OfflineReplay judge(const Motion& motion) {
    std::filesystem::remove(run);
    Poses poses(*this, motion);
    RecordedChanges::record(poses, motion.ticks, {50}, {.overwrite = true}, 3);
    return replay_offline(cells.front(), run,
                          {.expect_min_distance = 0.2, .expect_no_zone = {"near"}});
  }

  class Poses final : public PoseSource {
   public:
    Poses(NewObjects& test, const Motion& motion) : test_(test), motion_(motion) {}
    const PoseBatch* next() noexcept override {
      if (given_ == test_.now) return nullptr;
      const int tick = ++given_;
      const std::size_t of = tick < 60 ? 0 : 1;
      const Scene& scene = test_.cells[of].scene;
      const std::int64_t stamp_ns = kStart + tick * kTick;
      batch_ = {};
      batch_.source = SourceName("tracker");
      batch_.sequence_number = static_cast<std::uint64_t>(tick);
      batch_.scene_revision = scene.revision;
      for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
        const std::string& name = scene.objects[i].name;
        const bool is_silent = name == "hand"
                                   ? tick >= motion_.silent_from && tick < motion_.silent_to
                                   : tick < motion_.cart_from || tick >= motion_.cart_to;
        if (name == "post" || is_silent) continue;
        const int near_from = name == "hand" ? motion_.hand_near_from : motion_.cart_near_from;
        const double y = tick >= near_from ? 0.25 : 1.0;
        batch_.samples.push_back(sample(i, at(0, y, 0), stamp_ns));
      }
      return &batch_;
    }

   private:
    NewObjects& test_;
    Motion motion_;
    PoseBatch batch_;
    int given_ = 0;
  };
};

TEST_F(NewObjects, CountFromWhenTheyAreKnownFirst) {
  const OfflineReplay good = judge({});
  EXPECT_TRUE(good.ok()) << good.text();
  const OfflineReplay near = judge({.cart_near_from = 700});
  EXPECT_EQ(near.failures.size(), 2u) << near.text();
  EXPECT_THAT(near.text(), HasSubstr("cart"));
  const OfflineReplay silent = judge({.cart_from = 100, .cart_to = 300});
  EXPECT_EQ(silent.failures.size(), 2u)
      << "known, and late for more than 1 s then: " << silent.text();
}

TEST_F(NewObjects, LetTheExpectationsOfOthersGoOn) {
  const OfflineReplay near = judge({.hand_near_from = 200});
  EXPECT_EQ(near.failures.size(), 2u) << near.text();
  EXPECT_THAT(near.text(), HasSubstr("hand"));
  EXPECT_LT(near.failures.front().tick.cycle, 210u);
  const OfflineReplay silent = judge({.silent_from = 80, .silent_to = 250});
  EXPECT_EQ(silent.failures.size(), 2u) << silent.text();
  EXPECT_LT(silent.failures.front().tick.cycle, 260u);
}

TEST_F(NewObjects, OfWhichNothingIsEverHeardBreakTheExpectationsUnlessTheyCameAtTheEnd) {
  const OfflineReplay never = judge({.cart_from = 9999});
  EXPECT_EQ(never.failures.size(), 2u) << never.text();
  EXPECT_THAT(never.text(), HasSubstr("does not tell where"));
  const OfflineReplay at_end = judge({.ticks = 500, .cart_from = 9999});
  EXPECT_TRUE(at_end.ok()) << at_end.text();
  EXPECT_THAT(at_end.notes, Contains(HasSubstr("'cart'")));
}

}  // namespace
}  // namespace clearance::test
