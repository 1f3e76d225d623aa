// The state of a monitor through bytes.
//
// Oracle: the monitor that the bytes are of.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "monitor/tick/tick_state.hpp"
#include "monitor/wire/report_checksum.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/monitor/tick/taken_over.hpp"

namespace clearance {
namespace {

using test::kStart;
using test::kTick;

// A robot whose joints move, and now and then jump or are late; a zone and an allowed contact.
class SavedState : public testing::Test {
 protected:
  static Scene make() {
    Scene scene = test::scara_cell();
    for (ObjectPair& pair : scene.pairs) pair.publish = true;
    scene.contacts.emplace_back().pairs = {1, 2};
    scene.contacts[0].end.last_cycle = 150;
    scene.gradients = true;
    return scene;
  }
  void tick(Monitor& monitor) {
    std::vector<JointSample> joints;
    const double t = 0.001 * ticks;
    for (std::uint32_t i = 0; i < 3 && ticks % 60 < 30; ++i) {
      JointSample& sample = joints.emplace_back();
      sample.variable = i;
      sample.stamp_ns = now();
      sample.position = 0.1 * std::sin(5.0 * t + i) + (ticks % 97 == 0 ? 2.0 : 0.0);
    }
    const PoseSample cart = test::sample(1, test::at(1.0 + std::sin(t), 0.3, 0), now());
    const Report& report = monitor.tick({&cart, 1}, joints, now());
    checksum = checksum_of(report);
    rest = checksum_of_rest(report, monitor.checksum());
  }
  [[nodiscard]] std::int64_t now() const { return kStart + ticks * kTick; }

  Scene scene = make();
  SourceNumbers numbers{scene};
  int ticks = 0;
  std::uint64_t checksum = 0, rest = 0;
};

TEST_F(SavedState, GivesTheSameBitsInEveryLaterTick) {
  auto monitor = std::make_unique<Monitor>(scene);
  for (int round = 0; round < 4; ++round) {
    for (int i = 0; i < 45; ++i, ++ticks) tick(*monitor);
    monitor = test::taken_over(*monitor, scene, scene, numbers);
    std::vector<std::byte> bytes;
    save_state(numbers, SceneIds(scene), *monitor, bytes);
    JoinedState joined(scene);
    ASSERT_TRUE(joined.restore(bytes, 1));
    TickState restored(scene);
    ASSERT_TRUE(restored.may_join(joined));
    restored.join(joined);
    for (int i = 0; i < 60; ++i, ++ticks) {
      tick(*monitor);
      const std::uint64_t expected = checksum, expected_rest = rest;
      tick(restored.monitor());
      ASSERT_EQ(checksum, expected) << round << ' ' << i;
      ASSERT_EQ(rest, expected_rest) << round << ' ' << i;
    }
  }
}

TEST_F(SavedState, OfAnotherSceneOrCutOffIsRefused) {
  const Monitor monitor(scene);
  std::vector<std::byte> bytes;
  save_state(numbers, SceneIds(scene), monitor, bytes);
  Scene other = scene;
  other.zones.clear();
  EXPECT_FALSE(JoinedState(other).restore(bytes, 1));
  for (const std::size_t length : {bytes.size() - 1, bytes.size() / 2, std::size_t{0}}) {
    EXPECT_FALSE(JoinedState(scene).restore(std::span(bytes).first(length), 1)) << length;
  }
  bytes.push_back({});
  EXPECT_FALSE(JoinedState(scene).restore(bytes, 1));
}

}  // namespace
}  // namespace clearance
