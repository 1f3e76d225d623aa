// The places of links and frames at the stamp of a frame. Oracles: motions that the test makes,
// whose speed it limits.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "monitor/sensors/posture_history.hpp"
#include "tests/monitor/sensors/tf_said.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/shared/random.hpp"

namespace clearance::past_places_test {
namespace {

constexpr std::int64_t kStart = test::kStart, kMs = 1'000'000;

TEST(PastPlaces, LieWithinTheDeviationThatASpeedAllows) {
  Random random(7);
  for (int path = 0; path < 2000; ++path) {
    // A path that always goes at full speed, forth and then back, is the farthest from the
    // line between its ends.
    const double speed = random.uniform(0.1, 3.0), turn_s = random.uniform(0.0, 1.0);
    const auto value = [&](double s) { return speed * (s < turn_s ? s : 2.0 * turn_s - s); };
    const double share = random.uniform(0.0, 1.0);
    const double line = share * value(1.0);
    EXPECT_LE(std::abs(value(share) - line), deviation(share, 1.0 - share, speed, value(1.0)));
  }
  EXPECT_EQ(deviation(0.0, 1.0, 2.0, 0.5), 0.0);
  EXPECT_NEAR(deviation(0.5, 0.5, 2.0, 0.0), 1.0, 1e-12);
  EXPECT_NEAR(deviation(0.5, 0.5, 2.0, 2.0), 0.0, 1e-12) << "no slack is left at full speed";
}

TEST(PastPlaces, OfLinksAreThoseOfTheirJointsAtTheStampAndNeverTheLatestOnes) {
  const Scene scene = test::scara_cell();
  PostureHistory history(scene);
  const auto shoulder = [](double s) { return std::sin(2.0 * s); };  // at most 2 rad/s
  for (int i = 0; i <= 200; ++i) {
    for (const JointSample& sample :
         test::joints(shoulder(i * 0.01), 0.0, 0.0, kStart + i * 10 * kMs))
      history.add(sample, sample.stamp_ns);
  }
  for (const double s : {0.10, 0.3333, 0.5049, 1.2345}) {
    const auto stamp = kStart + static_cast<std::int64_t>(std::llround(s * 1e9));
    EXPECT_TRUE(history.covers(stamp));
    history.place(stamp);
    const PastPose upper = history.link(0, 1);
    ASSERT_TRUE(upper.known);
    const Vec3 tip = transform(upper.world_from_body, Vec3(1.0, 0.0, 0.0));
    const Vec3 truth(std::cos(shoulder(s)), std::sin(shoulder(s)), 0.0);
    EXPECT_LE((tip - truth).norm(), upper.error(1.0)) << s;
    EXPECT_LE(upper.error(1.0), s == 0.10 ? 1e-12 : 2.0 * 0.005 * 2.0) << s;
  }
  const std::int64_t end = kStart + 2000 * kMs;
  EXPECT_FALSE(history.covers(end + kMs));
  history.place(end + 50 * kMs);
  EXPECT_NEAR(history.link(0, 1).error(1.0), 0.1, 0.001) << "2 rad/s for 50 ms";
  history.place(kStart - kMs);
  EXPECT_FALSE(history.link(0, 1).known) << "before everything that is kept";
  EXPECT_TRUE(history.link(0, 0).known) << "nothing moves the foot";
}

// Joints go to and fro at full speed, and turn round at any time. The elbow may turn without a
// limit, so its positions are sent without full turns.
TEST(PastPlaces, OfLinksContainTheMotionWithinTheErrorOfTheStamp) {
  const Scene scene = test::scara_cell();
  Random random(31);
  for (int run = 0; run < 300; ++run) {
    PostureHistory history(scene);
    const double period = random.uniform(0.05, 1.0), drift = random.uniform(-1.0, 1.0),
                 start = random.uniform(-2.0, 2.0);
    const auto zigzag = [&](double s) {
      return std::abs(std::remainder(s, 2.0 * period));  // 1 a second
    };
    const auto shoulder = [&](double s) { return 2.0 * zigzag(s) - 1.0; };  // at most 2 rad/s
    const auto elbow = [&](double s) { return start + 40.0 * drift * s + 9.0 * zigzag(s); };
    for (double s = 0.0; s < 1.0; s += random.uniform(0.002, 0.015)) {
      const auto stamp = kStart + static_cast<std::int64_t>(s * 1e9);
      for (const JointSample& sample :
           test::joints(shoulder(s), std::remainder(elbow(s), 2.0 * M_PI), 0.0, stamp))
        history.add(sample, sample.stamp_ns);
    }
    const double at = random.uniform(0.0, 0.95), within = random.uniform(0.001, 0.1);
    const auto ns = [](double seconds) { return static_cast<std::int64_t>(seconds * 1e9); };
    history.place(kStart + ns(at), ns(within));
    const PastPose upper = history.link(0, 1), lower = history.link(0, 2);
    ASSERT_TRUE(upper.known && lower.known);
    for (int i = -10; i <= 10; ++i) {
      const double s = std::max(0.0, at + 0.1 * i * within * 0.999);
      // |R - R_exact| of a rotation by the angle between them.
      const auto off = [](const PastPose& link, double angle) {
        const Eigen::Quaterniond truth(Eigen::AngleAxisd(angle, Vec3::UnitZ()));
        return 2.0 * std::sin(0.5 * link.world_from_body.orientation.angularDistance(truth));
      };
      EXPECT_LE(off(upper, shoulder(s)), upper.turn_error + 1e-7) << run;
      EXPECT_LE(off(lower, shoulder(s) + elbow(s)), lower.turn_error + 1e-7) << run;
    }
  }
}

// At 100 Hz, a joint with 2 rad/s may leave its place by 10 mrad and be back in time.
// An object that makes a detour at its full speed is farthest from the line between its poses.
TEST(PastPlaces, OfObjectsContainWhereTheyMayHaveBeenBetweenTwoPoses) {
  Object cart = test::moving("cart", {test::ball(0.1)});
  cart.max_speed = 2.0;
  const Scene scene = test::cell_of({cart, test::moving("standing", {test::ball(0.1)})});
  PostureHistory history(scene);
  for (const int ms : {0, 10, 20, 30, 40}) {
    for (const std::uint32_t object : {0u, 1u}) {
      const double x = object == 0 ? 0.001 * ms : 0.0;
      history.add(test::sample(object, test::at(x, 0, 0), kStart + ms * kMs), kStart + ms * kMs);
    }
  }
  history.place(kStart + 35 * kMs);
  const PastPose past = history.object(0);
  ASSERT_TRUE(past.known);
  const Vec3 detour(0.035, std::sqrt(0.01 * 0.01 - 0.005 * 0.005), 0.0);
  EXPECT_LE((detour - past.world_from_body.position).norm(), past.error(0.0) + 1e-12);
  EXPECT_EQ(history.object(1).error(0.0), 0.0) << "it stands";
}

TEST(PastPlaces, OfALinkAtRestHaveNoErrorOfTheStamp) {
  const Scene scene = test::scara_cell();
  PostureHistory history(scene);
  for (int i = 0; i <= 100; ++i) {
    for (const JointSample& sample : test::joints(0.5, 0.0, 0.0, kStart + i * 10 * kMs))
      history.add(sample, sample.stamp_ns);
  }
  history.place(kStart + 500 * kMs, 100 * kMs);
  EXPECT_LT(history.link(0, 1).turn_error, 0.0101);
  history.place(kStart + 1000 * kMs, 100 * kMs);
  EXPECT_NEAR(history.link(0, 1).turn_error, 0.2, 1e-6) << "nothing is known from then on";
}

TEST(PastPlaces, OfJointsAreNotMixedFromTwoSources) {
  const Scene scene = test::scara_cell();
  PostureHistory history(scene);
  for (int i = 0; i < 10; ++i) {
    for (JointSample sample : test::joints(0.0, 0.0, 0.0, kStart + i * kMs))
      history.add(sample, sample.stamp_ns);
    for (JointSample sample : test::joints(1.0, 1.0, 0.1, kStart + i * kMs + kMs / 2)) {
      sample.source = 1;
      history.add(sample, sample.stamp_ns);
    }
  }
  history.place(kStart + 5 * kMs + kMs / 2);
  EXPECT_NEAR(history.link(0, 1).world_from_body.orientation.z(), 0.0, 1e-12);
}

TEST(PastPlaces, OfFramesAreExactWhereTheyStandStillAndHaveAnErrorWhereTheyMove) {
  test::TfSaid frames;
  frames.add("static", "world", test::at(1, 0, 0), 0, true);
  for (int i = 0; i < 10; ++i) {
    frames.add("still", "world", test::at(2, 0, 0), kStart + i * 100 * kMs, false);
    frames.add("moving", "world", test::at(0.1 * i, 0, 0), kStart + i * 100 * kMs, false);
  }
  const std::int64_t at = kStart + 450 * kMs;
  EXPECT_EQ(frames.step("static", at)->parent_from_child.position.x(), 1.0);
  EXPECT_EQ(frames.step("static", at)->shift_error, 0.0);
  EXPECT_EQ(frames.step("still", at)->shift_error, 0.0);
  EXPECT_NEAR(frames.step("moving", at)->parent_from_child.position.x(), 0.45, 1e-12);
  EXPECT_GE(frames.step("moving", at)->shift_error, 0.05);
  EXPECT_EQ(frames.step("moving", kStart + 400 * kMs)->shift_error, 0.0);
  EXPECT_FALSE(frames.step("moving", kStart + 950 * kMs)) << "after the last one";
  EXPECT_FALSE(frames.step("moving", kStart - kMs));
  EXPECT_FALSE(frames.step("other", at));
  Pose nonsense;
  nonsense.orientation.coeffs().setZero();
  frames.add("nonsense", "world", nonsense, kStart, false);
  EXPECT_FALSE(frames.step("nonsense", kStart));
}

// A cart at 1 m/s whose transforms come every 10 ms.
TEST(PastPlaces, OfFramesAtATimeThatIsNotWellKnownEncloseTheMotionWithin) {
  test::TfSaid frames;
  for (int i = 0; i <= 20; ++i)
    frames.add("cart", "map", test::at(0.01 * i, 0, 0), kStart + 10 * i * kMs, false, 1);
  for (const std::int64_t ms : {40, 105, 175}) {
    const auto known = frames.step("cart", kStart + ms * kMs);
    const auto step = frames.step("cart", kStart + ms * kMs, 20 * kMs);
    ASSERT_TRUE(known && step);
    EXPECT_EQ(step->parent_from_child.position, known->parent_from_child.position);
    EXPECT_GE(step->shift_error, 0.02);
    EXPECT_LT(step->shift_error, 0.06);
  }
  EXPECT_FALSE(frames.step("cart", kStart + 10 * kMs, 20 * kMs)) << "before the first one";
  EXPECT_FALSE(frames.step("cart", kStart + 195 * kMs, 20 * kMs)) << "after the last one";
}

// A second source of a joint or an object, whose values the first one cannot have.
TEST(PastPlaces, OfWhatTwoSourcesContradictAreUnknown) {
  const Scene scene = test::scara_cell();
  PostureHistory history(scene);
  const auto add = [&](double position, std::uint32_t source, std::int64_t stamp_ns) {
    for (JointSample sample : test::joints(position, 0.0, 0.0, stamp_ns)) {
      sample.source = source;
      history.add(sample, sample.stamp_ns);
    }
  };
  add(0.0, 1, kStart);
  add(0.004, 2, kStart + 10 * kMs);  // that may be an error of measuring
  history.place(kStart + 20 * kMs);
  EXPECT_TRUE(history.link(0, 1).known);
  add(0.5, 2, kStart + 20 * kMs);
  history.place(kStart + 20 * kMs);
  EXPECT_FALSE(history.link(0, 1).known);
  EXPECT_TRUE(history.link(0, 0).known) << "nothing moves the foot";
  for (int i = 1; i <= 120; ++i) add(0.0, 1, kStart + i * 10 * kMs);
  history.place(kStart + 900 * kMs);
  EXPECT_FALSE(history.link(0, 1).known);
  history.place(kStart + 1200 * kMs);
  EXPECT_TRUE(history.link(0, 1).known) << "the second source has been silent for a second";

  const auto pose = [&](double x, std::uint32_t source, std::int64_t stamp_ns) {
    PoseSample sample = test::sample(1, test::at(x, 0, 0), stamp_ns);
    sample.source = source;
    history.add(sample, sample.stamp_ns);
  };
  pose(0.0, 1, kStart);
  pose(50.0, 2, kStart + kMs);
  history.place(kStart + kMs);
  EXPECT_FALSE(history.object(1).known);
}

// The cell names the source. Another one sends zeros, before it, beside it and after it has died.
TEST(PastPlaces, AreThoseOfTheSourceThatTheCellStatesAndOfNoOther) {
  Scene scene = test::scara_cell(", source: driver");
  scene.objects[1].source = "tracker";
  PostureHistory history(scene);
  SourceNumbers numbers(scene);
  const auto add = [&](const char* source, double value, std::int64_t stamp_ns) {
    PoseBatch batch;
    batch.source = SourceName(source);
    for (const JointSample& sample : test::joints(value, 0.0, 0.0, stamp_ns))
      batch.joints.push_back(sample);
    batch.samples = {test::sample(1, test::at(value, 0, 0), stamp_ns)};
    std::vector<PoseSample> poses;
    std::vector<JointSample> joints;
    numbers.append(batch, poses, joints);
    for (const JointSample& sample : joints) history.add(sample, sample.stamp_ns);
    for (const PoseSample& sample : poses) history.add(sample, sample.stamp_ns);
  };
  const auto expect_at = [&](double value, std::int64_t stamp_ns) {
    history.place(stamp_ns);
    ASSERT_TRUE(history.link(0, 1).known && history.object(1).known);
    EXPECT_NEAR(history.link(0, 1).world_from_body.orientation.z(), std::sin(0.5 * value), 1e-9);
    EXPECT_NEAR(history.object(1).world_from_body.position.x(), value, 1e-9);
  };
  add("other", 0.0, kStart - 10 * kMs);
  history.place(kStart - 5 * kMs);
  EXPECT_FALSE(history.link(0, 1).known || history.object(1).known);
  for (int i = 0; i <= 100; ++i) {
    add("driver", 1.0, kStart + i * 10 * kMs);
    add("tracker", 1.0, kStart + i * 10 * kMs);
    add("other", 0.0, kStart + i * 10 * kMs + kMs);
  }
  expect_at(1.0, kStart + 995 * kMs);
  for (int i = 0; i <= 300; ++i) add("other", 0.0, kStart + 1000 * kMs + i * 10 * kMs);
  expect_at(1.0, kStart + 3900 * kMs);
  EXPECT_GT(history.link(0, 1).error(1.0), 1.9) << "it has been late for 2.9 s";
  // Either of two writers with this name may be the one that is meant.
  add("driver", 1.0, kStart + 4100 * kMs);
  add("driver#2", 0.0, kStart + 4101 * kMs);
  history.place(kStart + 4101 * kMs);
  EXPECT_FALSE(history.link(0, 1).known);
  EXPECT_TRUE(history.object(1).known);
  add("tracker#2", 99.0, kStart + 4102 * kMs);
  history.place(kStart + 4102 * kMs);
  EXPECT_FALSE(history.object(1).known);
}

// A frame that gets another parent keeps its places by the one before.
TEST(PastPlaces, OfAFrameAreThoseByTheParentThatItHadThen) {
  test::TfSaid frames;
  for (int i = 0; i < 5; ++i)
    frames.add("mast", "map", test::at(1, 0, 0), kStart + i * 10 * kMs, false);
  for (int i = 6; i < 9; ++i)
    frames.add("mast", "odom", test::at(4, 0, 0), kStart + i * 10 * kMs, false);
  const auto parent_at = [&](int ms) {
    const auto parent = TfFrames::parent(*frames.frames.used("mast"), kStart + ms * kMs);
    return parent ? *parent->name : "";
  };
  EXPECT_EQ(parent_at(35), "map");
  EXPECT_EQ(frames.step("mast", kStart + 35 * kMs)->parent_from_child.position.x(), 1.0);
  EXPECT_EQ(parent_at(50), "") << "between the two";
  EXPECT_FALSE(frames.step("mast", kStart + 50 * kMs));
  EXPECT_EQ(parent_at(75), "odom");
  EXPECT_EQ(frames.step("mast", kStart + 75 * kMs)->parent_from_child.position.x(), 4.0);
  EXPECT_FALSE(frames.step("mast", kStart + 62 * kMs, 5 * kMs)) << "before the first by it";
}

TEST(PastPlaces, OfAFrameWhosePublisherHasLeftStayAndANewOneGoesOn) {
  test::TfSaid frames;
  const Pose here = test::at(1, 0, 0), there = test::at(2, 0, 0);
  frames.add("plate", "map", here, kStart, true, 1);
  frames.add("mast", "map", here, kStart, false, 1);
  frames.frames.keep({});
  ASSERT_TRUE(frames.step("plate", kStart));
  frames.add("plate", "map", there, kStart, true, 2);
  EXPECT_EQ(frames.step("plate", kStart)->parent_from_child.position.x(), 2.0) << "a new owner";
  frames.add("mast", "map", there, kStart + 10 * kMs, false, 2);
  EXPECT_NEAR(frames.step("mast", kStart + 5 * kMs)->parent_from_child.position.x(), 1.5, 1e-12);
}

}  // namespace
}  // namespace clearance::past_places_test
