// The state of a monitor through bytes.
//
// Oracle: the monitor that the bytes are of.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "monitor/tick/tick_state.hpp"
#include "monitor/wire/report_checksum.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/monitor/tick/taken_over.hpp"
#include "tests/shared/forged_bytes.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/repeats.hpp"

namespace clearance {
namespace {

using test::kStart;
using test::kTick;

// CLEARANCE_FORGERIES: how many forged states are tried.
std::uint64_t forgeries() {
  const char* const asked = std::getenv("CLEARANCE_FORGERIES");
  return asked == nullptr ? 1'000'000 : std::stoull(asked);
}

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
  const Report& tick(Monitor& monitor) {
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
    return report;
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

TEST_F(SavedState, TellsOfAnotherSourceForAsLongAsTheMonitorThatItIsOf) {
  Monitor monitor(scene);
  const auto hear = [](Monitor& by, std::uint32_t source, std::int64_t now) {
    PoseSample cart = test::sample(1, test::at(1.0, 0.3, 0), now);
    cart.source = source;
    by.tick(std::span(&cart, 1), now);
    return by.input_age(1).other_source;
  };
  hear(monitor, 2, now());
  EXPECT_EQ(hear(monitor, 3, now() + kTick), 3u);
  std::vector<std::byte> bytes;
  save_state(numbers, SceneIds(scene), monitor, bytes);
  JoinedState joined(scene);
  ASSERT_TRUE(joined.restore(bytes, 1));
  TickState restored(scene);
  restored.join(joined);
  int told = 0;
  for (std::int64_t s = 0; s < 20'000'000'000; s += 500'000'000) {
    const std::uint32_t other = hear(monitor, 2, now() + 2 * kTick + s);
    EXPECT_EQ(hear(restored.monitor(), 2, now() + 2 * kTick + s), other) << s;
    told += other == 3 ? 1 : 0;
  }
  EXPECT_EQ(told, 20) << "for ten seconds";
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

// A stranger in the partition forges a state: its length and checksum fit. It is refused, or the
// ticks that go on from it break no invariant and report no bound that is no number. In builds with
// sanitizers, they touch no foreign memory, and read no byte as a flag that is none.
class ForgedState : public SavedState {
 protected:
  ForgedState() {
    scene.objects[1].source = "cart";
    Monitor monitor(scene);
    for (int i = 0; i < 45; ++i, ++ticks) tick(monitor);
    save_state(SourceNumbers(scene), SceneIds(scene),
               *test::taken_over(monitor, scene, scene, numbers), genuine);
    until = ticks;
  }
  void expect_harmless(std::span<const std::byte> bytes) {
    JoinedState joined(scene);
    if (!joined.restore(bytes, 1)) {
      ++refused;
      return;
    }
    TickState restored(scene);
    if (!restored.may_join(joined)) return;
    ++joined_states;
    restored.join(joined);
    ticks = until;
    for (int i = 0; i < 4; ++i, ++ticks) {
      const Report& report = tick(restored.monitor());
      for (const PairReport& pair : report.pairs) ASSERT_LE(pair.lower, pair.upper);
      ASSERT_FALSE(std::isnan(report.lower_all));
    }
  }

  std::vector<std::byte> genuine;
  int until = 0;
  std::uint64_t refused = 0, joined_states = 0;
};

TEST_F(ForgedState, WithAnyOneFieldHostileIsRefusedOrHarmless) {
  for (const std::size_t width : {1, 4, 8}) {
    for (std::size_t at = 0; at + width <= genuine.size(); at += width) {
      for (const std::uint64_t value :
           std::span(test::kHostile).first(repeats(std::size(test::kHostile)))) {
        std::vector<std::byte> bytes = genuine;
        std::memcpy(bytes.data() + at, &value, width);
        expect_harmless(bytes);
        ASSERT_FALSE(HasFatalFailure()) << width << " bytes at " << at << ": " << value;
      }
    }
  }
  EXPECT_GT(refused, genuine.size() / 10);
  EXPECT_GT(joined_states, genuine.size());
}

// A value with a stamp of the future would never be late. Histories may have any stamp.
TEST_F(ForgedState, WithAValueOfTheFutureIsRefused) {
  const std::int64_t year_ns = 365LL * 86'400 * 1'000'000'000;
  std::uint64_t ahead = 0;
  for (std::size_t at = 0; at + 8 <= genuine.size(); ++at) {
    std::int64_t stamp_ns = 0;
    std::memcpy(&stamp_ns, genuine.data() + at, 8);
    if (stamp_ns < test::kStart || stamp_ns > test::kStart + until * test::kTick) continue;
    std::vector<std::byte> bytes = genuine;
    stamp_ns += year_ns;
    std::memcpy(bytes.data() + at, &stamp_ns, 8);
    ahead += JoinedState(scene).restore(bytes, 1) ? 0 : 1;
  }
  EXPECT_GE(ahead, scene.variables.size() + 1 + 2) << "each joint, the cart, and each contact";
}

TEST_F(ForgedState, WithDrawnBytesIsRefusedOrHarmless) {
  Random random(63);
  for (std::uint64_t forgery = 0; forgery < repeats(forgeries(), 16); ++forgery) {
    expect_harmless(test::forged(genuine, random));
    ASSERT_FALSE(HasFatalFailure()) << forgery;
  }
  EXPECT_GT(refused, repeats(forgeries(), 16) / 10);
  EXPECT_GT(joined_states, repeats(forgeries(), 16) / 10);
}

}  // namespace
}  // namespace clearance
