#include "monitor/examples/arm/made_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <random>

namespace clearance::people {
namespace {

constexpr double kFrameS = 1.0 / 30.0;

// %L and %S: the side's name, and where left is.
constexpr const char* kArm =
    R"(JOINT {0}Shoulder {{ OFFSET {1}3 10 0 CHANNELS 3 Zrotation Xrotation Yrotation
JOINT {0}Arm {{ OFFSET {1}16 0 0 CHANNELS 3 Zrotation Xrotation Yrotation
JOINT {0}ForeArm {{ OFFSET 0 -31.5 0 CHANNELS 3 Zrotation Xrotation Yrotation
JOINT {0}Hand {{ OFFSET 0 -26.5 0 CHANNELS 3 Zrotation Xrotation Yrotation
End Site {{ OFFSET 0 -18.5 0 }} }} }} }} }}
)";
constexpr const char* kLeg =
    R"(JOINT {0}UpLeg {{ OFFSET {1}10 -2 0 CHANNELS 3 Zrotation Xrotation Yrotation
JOINT {0}Leg {{ OFFSET 0 -43 0 CHANNELS 3 Zrotation Xrotation Yrotation
JOINT {0}Foot {{ OFFSET 0 -42 0 CHANNELS 3 Zrotation Xrotation Yrotation
JOINT {0}ToeBase {{ OFFSET 0 -6 13 CHANNELS 3 Zrotation Xrotation Yrotation
End Site {{ OFFSET 0 0 6 }} }} }} }} }}
)";

std::string hierarchy() {
  std::string text =
      "HIERARCHY\nROOT Hips { OFFSET 0 0 0 CHANNELS 6 Xposition Yposition Zposition Zrotation "
      "Xrotation Yrotation\n"
      "JOINT Spine { OFFSET 0 12 0 CHANNELS 3 Zrotation Xrotation Yrotation\n"
      "JOINT Spine1 { OFFSET 0 26 0 CHANNELS 3 Zrotation Xrotation Yrotation\n"
      "JOINT Neck { OFFSET 0 16 0 CHANNELS 3 Zrotation Xrotation Yrotation\n"
      "JOINT Head { OFFSET 0 9 0 CHANNELS 3 Zrotation Xrotation Yrotation\n"
      "End Site { OFFSET 0 20 2 } } }\n";
  for (const auto& [name, sign] : {std::pair("Left", ""), std::pair("Right", "-")})
    text += fmt::format(kArm, name, sign);
  text += "} }\n";
  for (const auto& [name, sign] : {std::pair("Left", ""), std::pair("Right", "-")})
    text += fmt::format(kLeg, name, sign);
  return text + "}\n";
}

}  // namespace

std::string walking_and_reaching(std::uint32_t seed, int frames) {
  std::mt19937 random(seed);
  const auto draw = [&](double from, double to) {
    return from + (to - from) * static_cast<double>(random()) / std::mt19937::max();
  };
  const double round_s = draw(7.0, 9.0), leg = draw(20.0, 28.0), arm = draw(15.0, 25.0);
  const double reach = draw(70.0, 85.0), lean = draw(15.0, 25.0), side = draw(-15.0, 15.0);
  std::string text = hierarchy();
  text += fmt::format("MOTION\nFrames: {}\nFrame Time: {:.6f}\n", frames, kFrameS);
  for (int i = 0; i < frames; ++i) {
    const double turn = 2.0 * std::numbers::pi * i * kFrameS / round_s;
    const double near = 0.5 - 0.5 * std::cos(turn);  // 1: where it reaches out
    const double walks = std::abs(std::sin(turn));
    const double out = std::clamp(6.0 * near - 5.0, 0.0, 1.0);
    const double step = std::sin(2.0 * std::numbers::pi * 0.9 * i * kFrameS);
    std::vector<double> row = {
        2.0 * step * walks, 93.0 + 1.5 * walks * step * step, 150.0 * near, 0.0, 2.0,
        4.0 * step * walks};
    const auto joint = [&](double z, double x, double y) { row.insert(row.end(), {z, x, y}); };
    joint(0, 0.4 * lean * out + 2.0, -4.0 * step * walks);  // spine
    joint(0, 0.6 * lean * out, 12.0 * out);
    joint(0, 5.0 * std::sin(0.7 * turn), 10.0 * std::sin(1.3 * turn));  // neck, head
    joint(0, -10.0 * out, 5.0 * std::sin(turn));
    joint(0, 0, 3.0 * step * walks);  // collar bone, arm, forearm and hand of the left
    joint(6, arm * step * walks + 4.0, 0);
    joint(0, -15.0 - 10.0 * walks, 0);
    joint(5, -10.0, 0);
    joint(0, 0, 18.0 * out);  // of the right
    joint(-6, -(arm * step * walks) - reach * out + 4.0, side * out);
    joint(0, -20.0 * (1.0 - out) - 5.0, 0);
    joint(-5, -25.0 * out, 0);
    for (const double phase : {1.0, -1.0}) {  // legs
      joint(0, -leg * phase * step * walks - 3.0, 0);
      joint(0, 8.0 + 30.0 * walks * std::max(0.0, -phase * step), 0);
      joint(0, -5.0, 0);
      joint(0, 0, 0);
    }
    for (const double value : row) text += fmt::format("{:.3f} ", value);
    text.back() = '\n';
  }
  return text;
}

}  // namespace clearance::people
