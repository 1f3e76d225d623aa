// Swings an arm, more slowly the nearer its hand comes to a post. Beside it runs
//   clearanced PREFIX/share/clearance/cells/seven_joint_arms.yaml
#include <monitor/client/client.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

int main(int argc, char** argv) {
  using namespace clearance::client;
  Connection connection({.partition = argc > 1 ? argv[1] : ""});  // loopback
  Reports reports(connection);
  Catalogue names(connection);
  Pair hand_and_post(names, "left_hand", "post");  // by name, also after a change of the cell
  JointWriter arm(connection, "left arm",
                  {"left_joint1", "left_joint2", "left_joint3", "left_joint4", "left_joint5",
                   "left_joint6", "left_joint7", "left_finger"});
  const std::int64_t end_ns = now_ns() + 1'000'000'000LL * (argc > 2 ? std::atoi(argv[2]) : 10);
  double phase = 0.0;
  for (int heard = 0; now_ns() < end_ns;) {
    arm.write({{-0.6, 0.6 * std::sin(phase), 0.0, -0.2, 0.0, 0.5, 0.0, 0.02}});
    if (!reports.newest(std::chrono::milliseconds(10)) || reports.fail_safe()) continue;
    const auto* hand = hand_and_post.in(*reports);
    if (hand == nullptr) continue;
    phase += 1e-3 * std::clamp(5.0 * hand->lower, 0.0, 1.0);  // -infinity while not known
    if (heard++ % 500 == 0)
      std::printf("%s: %.4f m\n", names.pair_name(*hand, reports->scene_revision).c_str(),
                  hand->lower);
  }
  return reports->evaluated > 0 ? 0 : 1;
}
