// Oracle: single postures of the same motion, sampled densely and then refined around the least.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <vector>

#include "tests/monitor/ask/scara_questions.hpp"

namespace clearance {
namespace {

using test::scara_beside, test::swing;

std::uint64_t from_environment(const char* name, std::uint64_t otherwise) {
  const char* const asked = std::getenv(name);
  return asked != nullptr ? std::strtoull(asked, nullptr, 10) : otherwise;
}

// CLEARANCE_ASK_SEED and CLEARANCE_ASK_SEEDS state the first seed and how many there are,
// CLEARANCE_ASK_MOTIONS how many motions each seed's scene gets. With CLEARANCE_ASK_ONE only the
// motion of that number is examined.
struct Campaign {
  std::uint64_t first_seed = from_environment("CLEARANCE_ASK_SEED", 1);
  std::uint64_t seeds = from_environment("CLEARANCE_ASK_SEEDS", 12);
  std::uint64_t motions = from_environment("CLEARANCE_ASK_MOTIONS", 6);
  std::uint64_t only = from_environment("CLEARANCE_ASK_ONE", ~std::uint64_t{0});
};

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : engine_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  bool with(double chance) { return between(0.0, 1.0) < chance; }

 private:
  std::mt19937_64 engine_;
};

std::string some_object(Draw& draw) {
  const auto number = [&](double low, double high) {
    return std::to_string(draw.between(low, high));
  };
  const std::string place = "pose: {xyz: [" + number(-2.2, 2.2) + ", " + number(-2.2, 2.2) + ", " +
                            number(-0.2, 0.2) + "]}";
  if (draw.with(0.4)) return "fixed: true, sphere: {radius: " + number(0.01, 0.3) + "}, " + place;
  const std::string thin = draw.with(0.5) ? "0.002" : number(0.05, 0.4);
  return "fixed: true, box: {size: [" + number(0.05, 0.8) + ", " + thin + ", 0.6]}, " + place;
}

Question some_motion(Draw& draw) {
  Question question;
  question.motion.joints = {"elbow", "shoulder", "push"};  // not in the order of the robot
  const bool cubic = draw.with(0.5);
  const int rows = 1 + static_cast<int>(draw.between(0.0, 4.0));
  double t = draw.between(-1.0, 1.0);
  for (int row = 0; row < rows; ++row) {
    question.motion.times.push_back(t);
    t += draw.between(0.05, 1.0);
    for (const double largest : {2.0, 2.0, 0.0}) {
      const double position =
          largest > 0.0 ? draw.between(-largest, largest) : draw.between(0.06, 0.14);
      question.motion.positions.push_back(position);
      if (cubic)
        question.motion.velocities.push_back(draw.between(-1.0, 1.0) * (largest > 0.0 ? 1.0 : 0.1));
    }
  }
  question.margins = {0.0, 0.02};
  return question;
}

// The posture of the motion at an instant.
Question posture_at(const Question& question, double t) {
  const JointTrajectory& motion = question.motion;
  std::size_t row = 0;
  while (row + 2 < motion.times.size() && t > motion.times[row + 1]) ++row;
  Question posture;
  // By default, a pair that is nearer than the others by less than 1 mm may be passed over.
  posture.tolerance = 1e-14;
  posture.motion = {.joints = motion.joints, .times = {0.0}, .positions = {}, .velocities = {}};
  for (std::size_t joint = 0; joint < 3; ++joint) {
    const double p0 = motion.positions[3 * row + joint];
    if (motion.times.size() == 1) {
      posture.motion.positions.push_back(p0);
      continue;
    }
    const double p1 = motion.positions[3 * (row + 1) + joint];
    const double length = motion.times[row + 1] - motion.times[row];
    const double u = (t - motion.times[row]) / length, v = 1.0 - u;
    double p = v * p0 + u * p1;
    if (!motion.velocities.empty()) {
      p = p0 * v * v * (1 + 2 * u) + p1 * u * u * (3 - 2 * u) +
          length * u * v *
              (v * motion.velocities[3 * row + joint] -
               u * motion.velocities[3 * (row + 1) + joint]);
    }
    posture.motion.positions.push_back(p);
  }
  return posture;
}

class Sampler {
 public:
  Sampler(Asker& asker, const Question& question) : asker_(asker), question_(question) {}

  double at(double t) {
    EXPECT_FALSE(asker_.ask(posture_at(question_, t), answer_));
    return answer_.upper;
  }
  // The least of `count` samples and of the neighbourhoods of the lowest one.
  double least(int count) {
    const double begin = question_.motion.times.front(), end = question_.motion.times.back();
    double best = at(begin), where = begin;
    const auto try_at = [&](double t) {
      const double distance = at(std::clamp(t, begin, end));
      if (distance < best) {
        best = distance;
        where = std::clamp(t, begin, end);
      }
    };
    for (int i = 1; i <= count; ++i) try_at(begin + (end - begin) * i / count);
    for (double step = (end - begin) / count; step > 1e-9 && best > 0.0; step *= 0.5) {
      try_at(where - step);
      try_at(where + step);
    }
    return best;
  }

 private:
  Asker& asker_;
  const Question& question_;
  Answer answer_;
};

TEST(AskCampaign, NoSampledPostureContradictsAnAnswer) {
  int below = 0, free = 0;
  const Campaign campaign;
  const std::uint64_t end = campaign.first_seed + campaign.seeds;
  for (std::uint64_t seed = campaign.first_seed; seed < end; ++seed) {
    Draw draw(seed);
    const Scene scene = scara_beside(some_object(draw));
    Asker asker(scene), sampling(scene);
    Answer answer;
    for (std::uint64_t i = 0; i < campaign.motions; ++i) {
      const Question question = some_motion(draw);
      if (campaign.only < campaign.motions && i != campaign.only) continue;
      const std::string place = "seed " + std::to_string(seed) + ", motion " + std::to_string(i);
      const auto fault = asker.ask(question, answer);
      if (fault && fault->find("leaves its limits") != std::string::npos) continue;
      ASSERT_FALSE(fault) << place << ": " << *fault;
      const double least = Sampler(sampling, question).least(200);
      ASSERT_LE(answer.lower, least + 1e-12) << place;
      ASSERT_LE(answer.upper - answer.lower, 1e-3) << place;
      for (const MarginAnswer& margin : answer.margins) {
        if (margin.verdict == Verdict::kFree) {
          ASSERT_TRUE(margin.margin > 0.0 ? least >= margin.margin - 1e-12 : least > 0.0) << place;
          ++free;
        } else if (margin.verdict == Verdict::kBelow) {
          const double there = Sampler(sampling, question).at(margin.below_at);
          ASSERT_TRUE(margin.margin > 0.0 ? there < margin.margin + 1e-12 : there <= 1e-12)
              << place << ": " << there << " m at " << margin.below_at << " s, margin "
              << margin.margin;
          ++below;
        }
      }
    }
  }
  if (campaign.seeds < 12) return;  // one scene may be out of reach
  EXPECT_GT(below, 0);
  EXPECT_GT(free, 0);
}

}  // namespace
}  // namespace clearance
