// Pairs that a robot's build keeps near. Oracle: closed forms of boxes and a sphere, and postures
// drawn at random with new queries.
#include "monitor/pairs/kept_near.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "monitor/bodies/forward_kinematics.hpp"
#include "tests/monitor/tick/fresh_distance.hpp"
#include "tests/monitor/tick/scara_cell.hpp"

namespace clearance {
namespace {

using Names = std::set<std::string>;

Names names_kept(const Scene& scene, double metres) {
  Names names;
  for (const std::uint32_t pair : kept_nearer(scene, metres)) {
    names.insert(scene.objects[scene.pairs[pair].first].name + " " +
                 scene.objects[scene.pairs[pair].second].name);
  }
  return names;
}

// Neighbours are not watched. Stretched, the lower link begins 1 m beside the foot and 0.85 m above
// it; the finger is 1.25 m from the upper link when it has slid out.
TEST(KeptNear, NamesTheLinksThatNoPostureTakesFartherApart) {
  const Scene scene = test::scara_cell();
  const double foot_to_lower = std::hypot(1.0, 0.85);
  EXPECT_EQ(names_kept(scene, 1.249), Names());
  EXPECT_FALSE(names_kept(scene, foot_to_lower - 1e-3).contains("foot lower"));
  EXPECT_TRUE(names_kept(scene, foot_to_lower + 0.05).contains("foot lower"));
  EXPECT_EQ(names_kept(scene, 1e3), Names({"upper finger", "foot lower"}))
      << "foot and finger have three joints between them, the wall is no link";
  EXPECT_EQ(names_kept(scene, 0.0), Names());
}

TEST(KeptNear, NoPostureIsAsFarApartAsIsRuledOut) {
  const Scene scene = test::scara_cell();
  std::mt19937_64 engine(10);
  std::vector<TrackedVariable> variables(scene.variables.size());
  for (TrackedVariable& variable : variables) variable.input.has_value = true;
  ForwardKinematics kinematics(scene.robots);
  std::map<std::uint32_t, Pose> pose;
  std::map<std::uint32_t, double> farthest;
  for (int i = 0; i < 20'000; ++i) {
    const auto share = [&] { return static_cast<double>(engine() >> 11) * 0x1p-53; };
    variables[0].position = -3.0 + 6.0 * share();
    variables[1].position = -3.2 + 6.4 * share();
    variables[2].position = 0.2 * share();
    kinematics.place(variables, {});
    for (std::size_t link = 0; link < scene.robots[0].links.size(); ++link)
      pose[scene.robots[0].links[link].object] = kinematics.links(0)[link].pose;
    for (std::uint32_t pair = 0; pair < scene.pairs.size(); ++pair) {
      const auto [a, b, publish] = scene.pairs[pair];
      if (!pose.contains(a) || !pose.contains(b)) continue;
      const auto truth = test::fresh_distance(scene.objects[a], pose[a], scene.objects[b], pose[b]);
      farthest[pair] = std::max(farthest[pair], truth.lower);
    }
  }
  int kept = 0;
  for (double metres = 0.02; metres < 3.0; metres += 0.02) {
    for (const std::uint32_t pair : kept_nearer(scene, metres)) {
      EXPECT_LT(farthest[pair], metres) << pair;
      ++kept;
    }
  }
  EXPECT_GT(kept, 100);
}

}  // namespace
}  // namespace clearance
