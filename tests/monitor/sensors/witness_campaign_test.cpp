// A witness raises no false alarm: half an hour of simulated pictures of a machine that is off its
// model by no more than the cell states.
//
// Oracle: pictures are rendered of the true machine, with empty hands.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "core/shapes.hpp"
#include "tests/monitor/sensors/witnessed_cell.hpp"

namespace clearance {
namespace {

using test::two_arms_and_eye;
using test::WitnessedCell;

constexpr double kPicture = 0.1;  // s, between two

// CLEARANCE_WITNESS_MINUTES states how long a run is.
int pictures_of_campaign() {
  const char* const asked = std::getenv("CLEARANCE_WITNESS_MINUTES");
  const double minutes = asked != nullptr ? std::strtod(asked, nullptr) : 0.1;
  return static_cast<int>(60.0 * minutes / kPicture);
}

// Both arms go from one random posture to the next. A person walks about between them and the
// camera, and the errors are drawn anew every ten seconds.
class BusyCell {
 public:
  BusyCell(const std::string& errors, std::uint64_t seed)
      : random_(seed), watched_(two_arms_and_eye(errors), seed), body_(person()) {
    watched_.others().push_back({&body_, {}, 0});
    watched_.set_period(static_cast<std::int64_t>(1e9 * kPicture));
    targets_ = watched_.positions();
  }

  WitnessedCell& watched() noexcept { return watched_; }
  void next() {
    if (picture_++ % 100 == 0) {
      watched_.errors() = test::drawn_errors(watched_.cell().scene, random_);
      walk_ = {random_.uniform(-0.7, 0.7), random_.uniform(-0.7, 0.7), 0.0};
      from_ = Vec3(random_.uniform(0.0, 1.3), random_.uniform(-1.5, 1.5), 0.9);
    }
    const std::vector<JointVariable>& variables = watched_.cell().scene.variables;
    for (std::size_t v = 0; v < variables.size(); ++v) {
      const double step = 0.5 * kPicture * std::min(variables[v].max_speed, 2.0);
      double& at = watched_.positions()[v];
      if (std::abs(targets_[v] - at) <= step)
        targets_[v] = random_.uniform(variables[v].lower, variables[v].upper);
      else
        at += std::copysign(step, targets_[v] - at);
    }
    watched_.others().back().world_from_body.position = from_ + kPicture * (picture_ % 100) * walk_;
    watched_.look(0);
  }

 private:
  static ConvexBody person() {
    return std::get<ConvexBody>(segment(Vec3(0, 0, -0.7), Vec3(0, 0, 0.7), 0.2));
  }

  Random random_;
  WitnessedCell watched_;
  ConvexBody body_;
  std::vector<double> targets_;
  Vec3 from_ = Vec3::Zero(), walk_ = Vec3::Zero();
  int picture_ = 0;
};

// Returns how many pictures saw through a robot; none may be denied, and no hand carry anything.
int run(const std::string& name, const std::string& errors, std::uint64_t seed) {
  BusyCell cell(errors, seed);
  const int pictures = pictures_of_campaign();
  int against = 0, denied = 0, named = 0, judged = 0;
  for (int i = 0; i < pictures; ++i) {
    cell.next();
    const SensorStatus status = cell.watched().status();
    for (const auto& [rays, count] : status.robots) {
      judged += rays.agreeing + rays.through >= Witness::kLeastRays ? 1 : 0;
      against += count.against > 0 ? 1 : 0;
      denied += count.denied ? 1 : 0;
    }
    for (const UnknownPayload& payload : status.payloads) named += payload.is_held ? 1 : 0;
  }
  std::printf(
      "%s: %d pictures, %d judgements of a robot, %d against, %d with a robot denied, %d "
      "with something carried\n",
      name.c_str(), pictures, judged, against, denied, named);
  EXPECT_GT(judged, pictures);
  EXPECT_EQ(denied, 0);
  EXPECT_EQ(named, 0);
  return against;
}

TEST(SecondWitness, RaisesNoFalseAlarmOfAMachineThatIsItsModel) {
  EXPECT_EQ(run("no errors", "", 1), 0);
}

TEST(SecondWitness, RaisesNoFalseAlarmOfAMachineThatIsOffByWhatIsStated) {
  EXPECT_EQ(run("stated errors",
                "errors: {joints: {position: 0.003, translation: 0.0005, rotation: 0.001}, bases: "
                "{translation: 0.003, rotation: 0.002}, mounts: {translation: 0.005, rotation: "
                "0.005}}\n",
                2),
            0);
}

}  // namespace
}  // namespace clearance
