// The plug-in beside FCL in MoveIt, in one process: on motions in scenes with certified truth.
// usage: moveit_bench MOTIONS
// MOTIONS has motions.jsonl, scenes/ and robots/: one JSON a line and a scene, whose keys are read
// below. Prints how often each is wrong, and how often the plug-in's distance is off by more than
// 1e-9 m. Then come times: a line a scene, FCL's over the plug-in's, and a summary. Both take
// turns, state by state.
#include <algorithm>
#include <clearance_moveit/collision_env.hpp>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <geometric_shapes/shapes.h>
#include <srdfdom/model.h>
#include <urdf_parser/urdf_parser.h>
#include <moveit/collision_detection_fcl/collision_env_fcl.hpp>
#include <moveit/robot_model/robot_model.hpp>

namespace {

using collision_detection::AllowedCollisionMatrix;
using collision_detection::CollisionEnv;
using moveit::core::RobotState;
using nlohmann::json;

std::string text_of(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot read " + path);
  return {std::istreambuf_iterator<char>(file), {}};
}

moveit::core::RobotModelPtr model_of(const std::string& folder, const json& scene) {
  const std::string urdf_path = folder + "/" + scene["urdf"].get<std::string>();
  std::string text = text_of(urdf_path);
  const std::string from = "\"meshes/",
                    to = "\"file://" + urdf_path.substr(0, urdf_path.rfind('/')) + "/meshes/";
  for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  const auto urdf = urdf::parseURDF(text);
  const auto srdf = std::make_shared<srdf::Model>();
  srdf->initString(*urdf, text_of(folder + "/" + scene["srdf"].get<std::string>()));
  return std::make_shared<moveit::core::RobotModel>(urdf, srdf);
}

// A capsule is a cylinder and two balls.
void add_object(const json& object, const Eigen::Isometry3d& root,
                collision_detection::World& world) {
  const auto p = object["position"].get<std::vector<double>>(),
             q = object["quat_wxyz"].get<std::vector<double>>();
  const Eigen::Isometry3d place = root * Eigen::Translation3d(p[0], p[1], p[2]) *
                                  Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized();
  const auto add = [&](const shapes::Shape* shape, double along = 0.0) {
    world.addToObject(object["id"], place, shapes::ShapeConstPtr(shape),
                      Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, along)));
  };
  const std::string type = object["type"];
  if (type == "box") {
    const auto size = object["size"].get<std::vector<double>>();
    return add(new shapes::Box(size[0], size[1], size[2]));
  }
  const double radius = object["radius"];
  if (type == "sphere") return add(new shapes::Sphere(radius));
  if (type == "cylinder") return add(new shapes::Cylinder(radius, object["height"]));
  const double length = object["length"];
  add(new shapes::Cylinder(radius, length));
  add(new shapes::Sphere(radius), -0.5 * length);
  add(new shapes::Sphere(radius), 0.5 * length);
}

struct Scene {
  moveit::core::RobotModelPtr model;
  std::unique_ptr<AllowedCollisionMatrix> matrix;
  std::unique_ptr<CollisionEnv> ours, fcl;
  std::vector<RobotState> states;  // of its motions
};

// Fixed links and obstacles are no pairs of the truth.
Scene scene_named(const std::string& folder, const std::string& name,
                  std::map<std::string, moveit::core::RobotModelPtr>& models) {
  const json description = json::parse(text_of(folder + "/scenes/" + name + ".json"));
  auto& model = models[description["srdf"]];
  if (!model) model = model_of(folder, description);
  const auto world = std::make_shared<collision_detection::World>();
  RobotState state(model);
  state.setToDefaultValues();
  state.update();
  for (const json& object : description["objects"])
    add_object(object, state.getGlobalLinkTransform(description["frame"].get<std::string>()),
               *world);
  Scene scene{model,
              std::make_unique<AllowedCollisionMatrix>(*model->getSRDF()),
              std::make_unique<clearance_moveit::CollisionEnv>(model, world),
              std::make_unique<collision_detection::CollisionEnvFCL>(model, world),
              {}};
  for (const auto* link : model->getLinkModelsWithCollisionGeometry()) {
    const auto* above = link;
    while (above != nullptr && above->getParentJointModel()->getVariableCount() != 1)
      above = above->getParentLinkModel();
    if (above != nullptr) continue;
    for (const std::string& id : world->getObjectIds())
      scene.matrix->setEntry(link->getName(), id, true);
  }
  return scene;
}

struct Motion {
  json line;
  std::vector<double> times;
  std::vector<std::vector<double>> rows;

  explicit Motion(json of) : line(std::move(of)), times(line["times_s"]), rows(line["positions"]) {}
  [[nodiscard]] RobotState state(const Scene& scene, double time) const {
    std::size_t row = 0;
    while (row + 2 < rows.size() && times[row + 1] <= time) ++row;
    const std::size_t next = std::min(row + 1, rows.size() - 1);
    const double share = next == row ? 0.0 : (time - times[row]) / (times[next] - times[row]);
    RobotState state(scene.model);
    state.setToDefaultValues();
    for (const auto& [joint, position] : line["held"].items())
      state.setVariablePosition(joint, position);
    for (std::size_t i = 0; i < rows[row].size(); ++i)
      state.setVariablePosition(line["joints"][i].get<std::string>(),
                                rows[row][i] + share * (rows[next][i] - rows[row][i]));
    state.update();
    return state;
  }
};

bool collides(const CollisionEnv& env, const Scene& scene, const RobotState& state) {
  collision_detection::CollisionResult result;
  env.checkCollision({}, result, state, *scene.matrix);
  return result.collision;
}
double distance(const CollisionEnv& env, const Scene& scene, const RobotState& state) {
  return std::min(env.distanceSelf(state, *scene.matrix), env.distanceRobot(state, *scene.matrix));
}

// Processor time of this thread, in which other programs do not count.
double seconds(const auto& work) {
  const auto now = [] {
    timespec time;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  };
  const double begin = now();
  work();
  return now() - begin;
}

struct Truths {
  int verdicts = 0, ours_wrong = 0, fcl_wrong = 0;
  int distances = 0, ours_off = 0, fcl_off = 0;
  double ours_worst = 0.0, fcl_worst = 0.0;
  int motions = 0, motions_wrong = 0;
  std::vector<double> segments;  // s
};

void judge(const Motion& motion, const Scene& scene, Truths& truths) {
  const json& contact = motion.line["first_below"]["0"];
  const double until = contact.is_null() ? motion.times.back() : contact["t"][0].get<double>();
  const bool from_start =
      !contact.is_null() && contact["t"][1].get<double>() == motion.times.front();
  for (std::size_t i = 0; i < motion.rows.size() && (motion.times[i] <= until || i == 0); ++i) {
    const RobotState state = motion.state(scene, motion.times[i]);
    const bool truth = i == 0 && from_start;
    ++truths.verdicts;
    truths.ours_wrong += collides(*scene.ours, scene, state) != truth;
    truths.fcl_wrong += collides(*scene.fcl, scene, state) != truth;
  }
  if (!contact.is_null()) {  // and at the instant that is certainly in contact
    const RobotState state = motion.state(scene, motion.line["least"]["t"]);
    ++truths.verdicts;
    truths.ours_wrong += !collides(*scene.ours, scene, state);
    truths.fcl_wrong += !collides(*scene.fcl, scene, state);
  } else {
    const RobotState state = motion.state(scene, motion.line["least"]["t"]);
    const double truth = motion.line["least"]["hi"];
    const auto note = [&](const CollisionEnv& env, int& off, double& worst) {
      const double error = std::abs(distance(env, scene, state) - truth);
      off += error > 1e-9;
      worst = std::max(worst, error);
    };
    ++truths.distances;
    note(*scene.ours, truths.ours_off, truths.ours_worst);
    note(*scene.fcl, truths.fcl_off, truths.fcl_worst);
  }
  // Checks of motions leave out pairs of links: a contact of the truth between these decides
  // nothing.
  const auto pair = contact.is_null() ? std::vector<std::string>{}
                                      : contact["pair"].get<std::vector<std::string>>();
  if (std::ranges::all_of(
          pair, [&](const std::string& name) { return scene.model->hasLinkModel(name); }) &&
      !pair.empty())
    return;
  bool met = false;
  for (std::size_t i = 0; i + 1 < std::max<std::size_t>(2, motion.rows.size()); ++i) {
    const RobotState from = motion.state(scene, motion.times[i]);
    const RobotState to =
        motion.state(scene, motion.times[std::min(i + 1, motion.rows.size() - 1)]);
    collision_detection::CollisionResult result;
    truths.segments.push_back(
        seconds([&] { scene.ours->checkRobotCollision({}, result, from, to, *scene.matrix); }));
    met = met || result.collision;
  }
  ++truths.motions;
  truths.motions_wrong += met == contact.is_null();
}

struct Ratios {
  std::vector<double> all;
  double ours = 0.0, fcl = 0.0;
  long calls = 0;
  double add(double ours_s, double fcl_s, long count) {
    ours += ours_s;
    fcl += fcl_s;
    calls += count;
    all.push_back(fcl_s / ours_s);
    return all.back();
  }
  void print(const char* what) {
    std::ranges::sort(all);
    std::printf(
        "%-14s FCL / ours: least %.2f median %.2f most %.2f; ours %.1f us, FCL %.1f us, %zu "
        "scenes\n",
        what, all.front(), all[all.size() / 2], all.back(), 1e6 * ours / calls, 1e6 * fcl / calls,
        all.size());
  }
};

// Both take turns, state by state, in several rounds over all states of the scene. The least time
// of each state counts.
template <class Work>
void time_both(const Scene& scene, const Work& work, double& ours, double& fcl) {
  std::vector<double> least_ours(scene.states.size(), 1e9), least_fcl = least_ours;
  for (int round = 0; round < 5; ++round) {
    for (std::size_t i = 0; i < scene.states.size(); ++i) {
      const RobotState& state = scene.states[i];
      least_ours[i] = std::min(least_ours[i], seconds([&] { work(*scene.ours, state); }));
      least_fcl[i] = std::min(least_fcl[i], seconds([&] { work(*scene.fcl, state); }));
    }
  }
  ours += std::accumulate(least_ours.begin(), least_ours.end(), 0.0);
  fcl += std::accumulate(least_fcl.begin(), least_fcl.end(), 0.0);
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::fprintf(stderr, "usage: moveit_bench MOTIONS\n");
    return 2;
  }
  const std::string folder = arguments[1];
  std::map<std::string, moveit::core::RobotModelPtr> models;
  std::map<std::string, Scene> scenes;
  Truths truths;
  std::istringstream lines(text_of(folder + "/motions.jsonl"));
  for (std::string text; std::getline(lines, text);) {
    const Motion motion(json::parse(text));
    const std::string name = motion.line["scene"];
    if (!scenes.contains(name)) scenes.emplace(name, scene_named(folder, name, models));
    Scene& scene = scenes.at(name);
    judge(motion, scene, truths);
    for (int i = 0; i <= 10; ++i)
      scene.states.push_back(motion.state(
          scene, motion.times.front() + 0.1 * i * (motion.times.back() - motion.times.front())));
  }
  std::printf("verdicts  %d: wrong ours %d, FCL %d\n", truths.verdicts, truths.ours_wrong,
              truths.fcl_wrong);
  std::printf("distances %d: off by more than 1e-9 m: ours %d (worst %.1e), FCL %d (worst %.1e)\n",
              truths.distances, truths.ours_off, truths.ours_worst, truths.fcl_off,
              truths.fcl_worst);
  std::ranges::sort(truths.segments);
  const auto share = [&](double of) {
    return 1e6 * truths.segments[static_cast<std::size_t>(of * (truths.segments.size() - 1.0))];
  };
  std::printf("motions   %d: wrong ours %d; %zu segments: p50 %.0f us, p99 %.0f us, most %.0f us\n",
              truths.motions, truths.motions_wrong, truths.segments.size(), share(0.5), share(0.99),
              share(1.0));
  Ratios checks, contacts, distances;
  for (const auto& [name, scene] : scenes) {
    const long calls = static_cast<long>(scene.states.size());
    double ours[3] = {}, fcl[3] = {};
    time_both(
        scene, [&](const auto& env, const auto& state) { (void)collides(env, scene, state); },
        ours[0], fcl[0]);
    time_both(
        scene,
        [&](const auto& env, const auto& state) {
          collision_detection::CollisionRequest request;
          request.contacts = true;
          request.max_contacts = 100;
          collision_detection::CollisionResult result;
          env.checkCollision(request, result, state, *scene.matrix);
        },
        ours[1], fcl[1]);
    time_both(
        scene, [&](const auto& env, const auto& state) { (void)distance(env, scene, state); },
        ours[2], fcl[2]);
    std::printf("%-36s check %.2f contacts %.2f distance %.2f\n", name.c_str(),
                checks.add(ours[0], fcl[0], calls), contacts.add(ours[1], fcl[1], calls),
                distances.add(ours[2], fcl[2], calls));
  }
  checks.print("checkCollision");
  contacts.print("contacts");
  distances.print("distance");
}
