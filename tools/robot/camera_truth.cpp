#include "tools/robot/camera_truth.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <span>
#include <utility>

#include "config/text/sentences.hpp"
#include "core/distance.hpp"
#include "core/shapes.hpp"
#include "monitor/app/print.hpp"
#include "monitor/interface/report.hpp"
#include "monitor/loop/realtime.hpp"

namespace clearance {
namespace {

constexpr double kLongArm = 1.0;                 // m: a joint turns points that are this far away
constexpr std::int64_t kSameNs = 1'000;          // stamps that differ by less are equal
constexpr double kRounding = 1e-6;               // m, of the truth itself
constexpr std::chrono::milliseconds kPause{50};  // between comparisons

const ConvexBody& a_point() {
  static const ConvexBody body = std::get<ConvexBody>(point(Vec3::Zero(), 0.0));
  return body;
}

// The part's distance to a point of the world, m.
double distance_of(const Part& part, const Pose& world_from_part, const Vec3& at,
                   TrackingState& state) {
  return distance(part.shape, a_point(), world_from_part, {at, {1, 0, 0, 0}}, state).upper;
}
double radius_of(const Part& part) { return part.shape.bounding_radius + part.shape.radius; }

double median(std::vector<float> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return double{*middle};
}

}  // namespace

CameraTruth::CameraTruth(const Cell& cell, client::Connection& connection, SimulatedWorld world,
                         const SimulationTime& time, double joint_rate_hz)
    : cell_(cell),
      time_(time),
      reports_(connection),
      world_(std::move(world)),
      known_(known_bodies(cell.scene)),
      frames_(cell.scene.sensors.size()) {
  for (const JointVariable& variable : cell.scene.variables)
    joint_motion_ += 2.0 / joint_rate_hz * variable.plausible_speed() * kLongArm;
  thread_ = std::thread([this] { run(); });
}

CameraTruth::~CameraTruth() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

// The size of the slab or ball around a point: its depth's error along the ray, and half a pixel to
// each side.
void CameraTruth::sent(const SentFrame& sent) {
  const Sensor& sensor = cell_.scene.sensors[sent.sensor];
  Frame frame{.stamp_ns = sent.stamp_ns, .points = {}, .sizes = {}};
  const Mat3 turn = rotation_matrix(sent.world_from_sensor.orientation);
  const double pixel = std::max(1.0 / sent.truth.camera().fx, sensor.spacing);
  for (std::size_t i = 0; i < sent.is_sent.size(); ++i) {
    if (!sent.is_sent[i] || is_left_out(sensor, sent.world, sent.truth.labels()[i])) continue;
    const Vec3 at = sent.truth.point(i);
    const double measured = at.z() + sensor.error_at(at.z());  // at most
    const double ray = at.norm() / at.z();
    frame.points.push_back((sent.world_from_sensor.position + turn * at).cast<float>());
    frame.sizes.push_back(
        static_cast<float>(2.0 * ray * sensor.error_at(measured) + 1.5 * pixel * measured));
  }
  const Lock lock(mutex_);
  frames_[sent.sensor].push_back(std::move(frame));
  if (frames_[sent.sensor].size() > kKept) frames_[sent.sensor].pop_front();
}

bool CameraTruth::is_left_out(const Sensor& sensor, const SimulatedWorld& world,
                              std::uint32_t label) const {
  return world.is_of_robot(label) || (sensor.knows && std::ranges::binary_search(known_, label));
}

void CameraTruth::run() {
  name_thread("truth");
  while (!stop_) {
    if (reports_.newest(kPause) && reports_->scene_revision == cell_.scene.revision) {
      for (std::uint32_t i = 0; i < cell_.scene.sensors.size(); ++i) compare(i, *reports_);
      compare_bodies(*reports_);
    }
    SystemClock clock;
    clock.sleep_until(clock.monotonic_ns() + std::chrono::nanoseconds(kPause).count());
  }
}

std::optional<CameraTruth::Frame> CameraTruth::frame_of(std::uint32_t sensor,
                                                        std::int64_t stamp_ns) {
  const Lock lock(mutex_);
  const auto frame = std::ranges::find_if(frames_[sensor], [&](const Frame& each) {
    return std::llabs(each.stamp_ns - stamp_ns) <= kSameNs;
  });
  return frame == frames_[sensor].end() ? std::nullopt : std::optional(*frame);
}

// All pairs of a report with the sensor have one frame.
void CameraTruth::compare(std::uint32_t sensor, const clearance_msg_Distances& report) {
  const std::uint32_t seen = cell_.scene.sensors[sensor].object;
  const std::int64_t now_ns = report.now_ns + report.clock_offset_ns;
  std::optional<std::vector<Vec3>> points;
  for (const clearance_msg_PairDistance& pair :
       std::span(report.pairs._buffer, report.pairs._length)) {
    const ObjectPair& objects = cell_.scene.pairs[pair.pair];
    const bool is_known =
        std::isfinite(pair.lower) && pair.status <= static_cast<std::uint8_t>(PairStatus::kStale);
    if ((objects.first != seen && objects.second != seen) || !is_known) continue;
    const bool is_first = objects.first == seen;
    if (!points) {
      const auto frame = frame_of(sensor, now_ns - (is_first ? pair.age_a_ns : pair.age_b_ns));
      if (!frame) {
        ++unknown_;
        return;
      }
      points = outside_of_shells(cell_.scene.sensors[sensor], *frame, shells_of(seen, report));
      most_blind_ = std::max(most_blind_, frame->points.size() - points->size());
    }
    compare(pair, now_ns - (is_first ? pair.age_b_ns : pair.age_a_ns), *points);
  }
}

void CameraTruth::compare_bodies(const clearance_msg_Distances& report) {
  const std::int64_t now_ns = report.now_ns + report.clock_offset_ns;
  for (const clearance_msg_PairDistance& pair :
       std::span(report.pairs._buffer, report.pairs._length)) {
    const ObjectPair& of = cell_.scene.pairs[pair.pair];
    const Object &a = cell_.scene.objects[of.first], &b = cell_.scene.objects[of.second];
    const bool is_fresh = std::isfinite(pair.lower) &&
                          pair.status < static_cast<std::uint8_t>(PairStatus::kStale) &&
                          (a.fixed || b.fixed || pair.age_a_ns == pair.age_b_ns);
    if (a.is_seen() || b.is_seen() || !is_fresh) continue;
    world_.place(time_.seconds_of_stamp(now_ns - (a.fixed ? pair.age_b_ns : pair.age_a_ns)));
    if (!world_.object(of.first) || !world_.object(of.second)) continue;
    double truth = kInfinity;
    for (const Part& part_a : a.parts) {
      for (const Part& part_b : b.parts) {
        TrackingState state;
        truth = std::min(
            truth, distance(part_a.shape, part_b.shape,
                            compose(*world_.object(of.first), part_a.object_from_part),
                            compose(*world_.object(of.second), part_b.object_from_part), state)
                       .upper);
      }
    }
    Found& found = found_[pair.pair];
    const double outside = std::max(pair.lower - truth, truth - pair.upper);
    ++found.compared;
    found.least = std::min(found.least, truth);
    found.worst = std::max(found.worst, outside);
    found.above += outside > kRounding;
    found.gaps.push_back(static_cast<float>(truth - pair.lower));
  }
}

CameraTruth::Shells CameraTruth::shells_of(std::uint32_t seen,
                                           const clearance_msg_Distances& report) const {
  Shells shells;
  for (const clearance_msg_HiddenState& hidden :
       std::span(report.hidden._buffer, report.hidden._length)) {
    const ObjectPair& objects = cell_.scene.pairs[hidden.pair];
    if (objects.first == seen) shells[objects.second] = hidden.thickness;
    if (objects.second == seen) shells[objects.first] = hidden.thickness;
  }
  return shells;
}

// Links without a pair with the sensor are not reported: theirs is taken to be twice as thick as
// the thickest one.
std::vector<Vec3> CameraTruth::outside_of_shells(const Sensor& sensor, const Frame& frame,
                                                 const Shells& reported) {
  double thickest = joint_motion_;
  for (const auto& [object, thickness] : reported) thickest = std::max(thickest, thickness);
  world_.place(time_.seconds_of_stamp(frame.stamp_ns));
  std::vector<OwnPart> own;
  for (std::uint32_t i = 0; i < cell_.scene.objects.size(); ++i) {
    if (!is_left_out(sensor, world_, i) || !world_.object(i)) continue;
    for (const Part& part : cell_.scene.objects[i].parts) {
      const auto shell = reported.find(i);
      const bool is_reported = shell != reported.end();
      own.push_back({&part, compose(*world_.object(i), part.object_from_part),
                     is_reported ? shell->second + kRounding : 2.0 * thickest, is_reported});
    }
  }
  std::vector<Vec3> outside;
  for (std::size_t i = 0; i < frame.points.size(); ++i) {
    const Vec3 at = frame.points[i].cast<double>();
    if (!is_in_shell(own, at, double{frame.sizes[i]})) outside.push_back(at);
  }
  return outside;
}

bool CameraTruth::is_in_shell(std::span<const OwnPart> parts, const Vec3& point, double size) {
  return std::ranges::any_of(parts, [&](const OwnPart& each) {
    const double shell = each.shell + (each.is_reported ? 0.0 : size),
                 reach = radius_of(*each.part) + shell;
    if ((point - each.place.position).squaredNorm() > reach * reach) return false;
    TrackingState state;
    return distance_of(*each.part, each.place, point, state) <= shell;
  });
}

void CameraTruth::compare(const clearance_msg_PairDistance& pair, std::int64_t body_ns,
                          const std::vector<Vec3>& points) {
  const ObjectPair& objects = cell_.scene.pairs[pair.pair];
  const std::uint32_t body =
      cell_.scene.objects[objects.first].is_seen() ? objects.second : objects.first;
  world_.place(time_.seconds_of_stamp(body_ns));
  const double truth = distance_to(body, points);
  if (truth == kInfinity) return;
  Found& found = found_[pair.pair];
  ++found.compared;
  found.least = std::min(found.least, truth);
  found.worst = std::max(found.worst, pair.lower - truth);
  found.above += pair.lower > truth + kRounding;
  found.gaps.push_back(static_cast<float>(truth - pair.lower));
}

// The spheres of the parts order the points: most are farther than the nearest one found.
double CameraTruth::distance_to(std::uint32_t object, const std::vector<Vec3>& points) const {
  double least = kInfinity;
  if (!world_.object(object)) return least;
  for (const Part& part : cell_.scene.objects[object].parts) {
    const Pose place = compose(*world_.object(object), part.object_from_part);
    const double radius = radius_of(part);
    const auto nearest = std::ranges::min_element(
        points, {}, [&](const Vec3& at) { return (at - place.position).squaredNorm(); });
    TrackingState state;
    if (nearest != points.end()) least = std::min(least, distance_of(part, place, *nearest, state));
    for (const Vec3& at : points) {
      const double reach = radius + std::max(least, 0.0);
      if ((at - place.position).squaredNorm() > reach * reach) continue;
      least = std::min(least, distance_of(part, place, at, state));
    }
  }
  return least;
}

void CameraTruth::tell() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
  if (found_.empty()) {
    print(stdout,
          "truth    not compared: no report has a known pair that is published, and the frame "
          "that it used\n");
    return;
  }
  for (const auto& [pair, found] : found_) {
    const ObjectPair& objects = cell_.scene.pairs[pair];
    print(stdout,
          "truth    {} - {}: {}, least true distance {:.4f} m, lower bounds {:.1f} mm below "
          "the truth (median), {} not within the bounds{}\n",
          cell_.scene.objects[objects.first].name, cell_.scene.objects[objects.second].name,
          counted(found.compared, "report"), found.least, 1e3 * median(found.gaps), found.above,
          found.above == 0 ? "" : fmt::format(", by up to {:.3g} m", found.worst));
  }
  print(stdout, "         of the surface that is visible; {} of a frame in the blind shell{}\n",
        most_blind_ == 0 ? "no pixel" : fmt::format("at most {}", counted(most_blind_, "pixel")),
        most_blind_ == 0 ? "" : ", left out");
  if (unknown_ > 0)
    print(stdout, "         {} could not be compared: the frames are not kept\n",
          counted(unknown_, "report"));
}

}  // namespace clearance
