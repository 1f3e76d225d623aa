#include "motion_check.hpp"

#include "motion_scene.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <monitor/ask/asker.hpp>
#include <utility>
#include <vector>

#include <moveit/robot_model/revolute_joint_model.hpp>

namespace clearance_moveit {
namespace {

using moveit::core::JointModel;
using moveit::core::RobotState;

bool is_single(const JointModel& joint) {
  return joint.getType() == JointModel::REVOLUTE || joint.getType() == JointModel::PRISMATIC;
}

// The joint's motion; that of a continuous joint is the shorter arc.
double step(const JointModel& joint, double from, double to) {
  const bool wraps = joint.getType() == JointModel::REVOLUTE &&
                     static_cast<const moveit::core::RevoluteJointModel&>(joint).isContinuous();
  return wraps ? std::remainder(to - from, 2.0 * M_PI) : to - from;
}

// Calls use(joint, name, from, step) for each variable that does not follow another one.
template <class Use>
void for_each_variable(const RobotState& from, const RobotState& to, const Use& use) {
  for (const JointModel* joint : from.getRobotModel()->getJointModels()) {
    if (joint->getMimic() != nullptr) continue;
    for (const std::string& name : joint->getVariableNames()) {
      const double begin = from.getVariablePosition(name);
      use(*joint, name, begin, step(*joint, begin, to.getVariablePosition(name)));
    }
  }
}

// The figures that bound the motion of any point of the robot.
struct Travel {
  double turned = 0.0;  // rad: the sum over all joints that turn
  double slid = 0.0;    // m: the sum over all joints that slide
  double out = 0.0;     // m: how far all joints that slide stand from zero at most, as a sum

  // The joint stands at `at`, and moves from `begin` to `end`.
  void add(const JointModel& joint, double at, double begin, double end) {
    const bool slides = joint.getType() == JointModel::PRISMATIC;
    (slides ? slid : turned) += std::max(std::abs(begin - at), std::abs(end - at));
    if (slides) out += std::max({std::abs(at), std::abs(begin), std::abs(end)});
  }
  // No joint that turns has a point of the robot farther from its axis than `reach` and `out`, m.
  [[nodiscard]] double most(double reach) const {
    return 1.001 * (slid + (turned == 0.0 ? 0.0 : turned * (reach + out)));
  }
};

// The scene of the last motion of a thread. As a rule the next one is in the same scene, and to
// make a scene takes longer than to answer.
struct Prepared {
  moveit::core::RobotModelConstPtr model;
  std::vector<Pose> rests;
  PosedParts links, world;
  std::vector<clearance::ObjectPair> pairs;
  std::unique_ptr<const clearance::Scene> scene;
  std::optional<clearance::Asker> asker;

  [[nodiscard]] bool is_of(const moveit::core::RobotModelConstPtr& of,
                           const std::vector<Pose>& at_rest, const PosedParts& robot,
                           const PosedParts& around,
                           const std::vector<clearance::ObjectPair>& watched) const {
    return asker && model == of && std::ranges::equal(rests, at_rest, clearance::same_pose) &&
           links.owners == robot.owners && links.parts == robot.parts &&
           world.owners == around.owners && world.parts == around.parts &&
           std::ranges::equal(pairs, watched, [](const auto& a, const auto& b) {
             return a.first == b.first && a.second == b.second;
           });
  }
};

// Returns why there is no answer.
std::optional<std::string> ask(const moveit::core::RobotModelConstPtr& model,
                               const std::vector<Pose>& rests, const PosedParts& links,
                               const PosedParts& world, std::vector<clearance::ObjectPair> pairs,
                               const clearance::Question& question, clearance::Answer& answer) {
  static thread_local Prepared last;
  if (!last.is_of(model, rests, links, world, pairs)) {
    last = {};
    auto made = motion_scene(*model, rests, links, world, pairs);
    if (auto* text = std::get_if<std::string>(&made)) return std::move(*text);
    last.scene =
        std::make_unique<const clearance::Scene>(std::get<clearance::Scene>(std::move(made)));
    last.asker.emplace(*last.scene);
    last.model = model;
    last.rests = rests;
    last.links = links;
    last.world = world;
    last.pairs = std::move(pairs);
  }
  return last.asker->ask(question, answer);
}

}  // namespace

RobotState state_at(const RobotState& from, const RobotState& to, double share) {
  RobotState state(from);
  for_each_variable(from, to,
                    [&](const JointModel&, const std::string& name, double begin, double step) {
                      state.setVariablePosition(name, begin + share * step);
                    });
  state.update();
  return state;
}

std::variant<MotionVerdict, std::string> check_motion(const RobotState& from, const RobotState& to,
                                                      const PosedParts& robot,
                                                      const PosedParts& links,
                                                      const PosedParts& world, PairFilter& filter,
                                                      const MotionRequest& request) {
  clearance::Question question;
  question.motion.times = {0.0, 1.0};
  std::vector<double> ends;
  Travel travel;
  std::string fault;
  for_each_variable(
      from, to, [&](const JointModel& joint, const std::string& name, double begin, double step) {
        if (is_single(joint)) {
          if (step != to.getVariablePosition(name) - begin && !joint.getMimicRequests().empty())
            fault = "the joint '" + joint.getName() + "' has mimics and takes the shorter arc";
          question.motion.joints.push_back(name);
          question.motion.positions.push_back(begin);
          ends.push_back(begin + step);
          travel.add(joint, begin, begin, begin + step);
          for (const JointModel* follower : joint.getMimicRequests()) {
            const double factor = follower->getMimicFactor(), offset = follower->getMimicOffset();
            travel.add(*follower, *from.getJointPositions(follower), factor * begin + offset,
                       factor * (begin + step) + offset);
          }
          return;
        }
        if (step != 0.0)
          fault = "the joint '" + joint.getName() + "' has several variables and moves";
      });
  if (!fault.empty()) return fault;
  question.motion.positions.insert(question.motion.positions.end(), ends.begin(), ends.end());
  question.others = clearance::OthersMove::kNot;
  question.only_margins = !request.distance;
  question.only_verdicts = !request.instant;
  question.tolerance = 1e-6;

  const moveit::core::RobotModelConstPtr& model = from.getRobotModel();
  const std::vector<Pose> rests = rests_of(from);
  const double within =
      request.distance ? clearance::kInfinity : travel.most(reach(*model, rests, links));
  const PosedParts leaves = with_leaves(world, robot, within);
  clearance::Answer answer;
  if (auto text = ask(model, rests, links, leaves, watched_pairs(links, leaves, filter), question,
                      answer)) {
    return *text;
  }
  if (!answer.has_pair) return MotionVerdict{true, 0.0, clearance::kInfinity};
  const clearance::MarginAnswer& contact = answer.margins.front();
  MotionVerdict verdict{contact.verdict == clearance::Verdict::kFree, 0.0, answer.lower};
  if (!verdict.is_free) {
    const bool is_below = contact.verdict == clearance::Verdict::kBelow;
    verdict.contact_at = is_below ? contact.below_at : contact.above_until;
  }
  return verdict;
}

}  // namespace clearance_moveit
