#include "monitor/ask/planned_stops.hpp"

#include <algorithm>
#include <cmath>

#include "monitor/bodies/directed_rounding.hpp"

namespace clearance {
namespace {

// Speeds of cubics count by parts that are no longer than this share of the motion. Rounding does
// not decide whether a sixty-fourth is one.
constexpr double kPart = 1.01 / 64.0;
constexpr double kShortestPast = 1e-9;      // s
constexpr double kShiftRounding = 0x1p-50;  // of a position that is moved, relative

}  // namespace

PlannedStops::PlannedStops(const Scene& scene) : scene_(scene) {
  joints_.reserve(scene.variables.size());
  onward_.reserve(scene.variables.size());
  robots_.reserve(scene.robots.size());
}

std::optional<std::string> PlannedStops::take(const Question& question, Trajectory& trajectory) {
  counts_ = may_deviate_ = false;
  if (!question.stoppable) return std::nullopt;
  if (auto text = take_joints(question, trajectory)) return text;
  begin_ = trajectory.begin();
  end_ = trajectory.end();
  together_ = robots_.size() > 1;
  goes_on_ =
      !together_ && std::ranges::any_of(onward_, [](double velocity) { return velocity != 0.0; });
  may_deviate_ = together_ || !robots_.front()->keeps_path;
  for (std::size_t k = 0; goes_on_ && k < joints_.size(); ++k) {
    // A sliding joint comes to its limits past the end, and there it leaves the path.
    if (joints_[k].slides && onward_[k] != 0.0) {
      may_deviate_ = true;
      onward_[k] = 0.0;
    }
  }
  if (goes_on_) trajectory.go_on(kShortestPast, onward_);
  pieces_.clear();
  velocities_.clear();
  first_piece_.clear();
  for (std::uint32_t i = 0; i < trajectory.segments(); ++i) {
    first_piece_.push_back(static_cast<std::uint32_t>(pieces_.size()));
    add_pieces(trajectory, trajectory.segment(i), kPart * (end_ - begin_));
  }
  first_piece_.push_back(static_cast<std::uint32_t>(pieces_.size()));
  if (goes_on_ || begin_ == end_) {
    for (std::size_t k = 0; k < joints_.size(); ++k) {
      const double last = trajectory.last_velocity(k);
      velocities_[velocities_.size() - joints_.size() + k] = {std::min(0.0, last),
                                                              std::max(0.0, last)};
    }
  }
  boxes_.resize(velocities_.size());
  reaches_.resize(pieces_.size() * robots_.size());
  count(trajectory);
  return std::nullopt;
}

std::optional<std::string> PlannedStops::take_joints(const Question& question,
                                                     const Trajectory& trajectory) {
  if (!question.beside.empty() || !question.moving.empty()) {
    return "a question with stoppable has no motions in beside or moving: a stop delays the robot, "
           "and they go on; name the joints of all robots that stop in one motion, and state the "
           "places of objects, which then move by their max_speed";
  }
  joints_.clear();
  onward_.clear();
  robots_.clear();
  reaction_ = 0.0;
  for (const std::uint32_t v : trajectory.moved()) {
    const Robot& of = scene_.robots[scene_.variables[v].robot];
    if (!of.stopping.is_stated()) {
      return "robot \"" + of.name +
             "\" states no stopping in the cell, so that nothing is known of its stops: add the "
             "key, or ask without stoppable";
    }
    const auto known = std::ranges::find(robots_, &of.stopping);
    Joint joint{.variable = v, .robot = static_cast<std::uint32_t>(known - robots_.begin())};
    if (known == robots_.end()) robots_.push_back(&of.stopping);
    reaction_ = std::max(reaction_, of.stopping.reaction);
    for (std::size_t j = 0; j < of.joints.size(); ++j) {
      const RobotJoint& each = of.joints[j];
      if (variables_of(each.type) != 1 || each.name != scene_.variables[v].name) continue;
      joint.stop = &of.stopping.joints[j];
      joint.slides = each.type == JointType::kPrismatic;
    }
    if (joint.stop == nullptr) return "joint \"" + scene_.variables[v].name + "\" has no stop";
    onward_.push_back(trajectory.last_velocity(joints_.size()));
    joints_.push_back(joint);
  }
  return std::nullopt;
}

// By halves, as MotionSearch divides a segment: so each of its short stretches is in one piece.
void PlannedStops::add_pieces(const Trajectory& trajectory, const Stretch& stretch,
                              double longest) {
  bool same = true;
  const std::size_t first = velocities_.size();
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    velocities_.push_back(trajectory.velocities(k, stretch));
    same = same && velocities_.back().least == velocities_.back().most;
  }
  const double middle = trajectory.middle(stretch);
  // Between two neighbouring numbers, the middle is one of them.
  const bool has_middle = stretch.from < middle && middle < stretch.to;
  if ((same && !together_) || stretch.to - stretch.from <= longest || !has_middle) {
    pieces_.push_back({.stretch = stretch});
    return;
  }
  velocities_.resize(first);
  add_pieces(trajectory, Trajectory::before(stretch, middle), longest);
  add_pieces(trajectory, Trajectory::after(stretch, middle), longest);
}

void PlannedStops::count(double factor, bool since_told, Trajectory& trajectory) noexcept {
  counts_ = true;
  factor_ = factor;
  since_told_ = since_told;
  for (std::size_t piece = 0; piece < pieces_.size(); ++piece) bound(piece);
  if (together_) return bound_together();
  if (goes_on_) {
    trajectory.go_on(time_past_the_end(), onward_);
    pieces_.back().stretch.to = trajectory.end();
    bound(pieces_.size() - 1);
  }
  note_earlier();
}

void PlannedStops::bound(std::size_t at) noexcept {
  Piece& piece = pieces_[at];
  piece.braking = piece.reach = 0.0;
  piece.earlier = -kInfinity;
  double* const reaches = reaches_.data() + at * robots_.size();
  std::fill_n(reaches, robots_.size(), 0.0);
  const bool is_past_end = goes_on_ && at + 1 == pieces_.size();
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    const JointStop& stop = *joints_[k].stop;
    const VelocityRange& range = velocities_[at * joints_.size() + k];
    const double forth = rounded_up(factor_ * std::max(0.0, range.most));
    const double back = rounded_up(factor_ * std::max(0.0, -range.least));
    const double fastest = std::max(forth, back);
    piece.braking = std::max(piece.braking, stop.time(fastest));
    Box& box = boxes_[at * joints_.size() + k];
    box = {};
    if (!robots_[joints_[k].robot]->keeps_path) {
      box = {-stop.distance(back), stop.distance(forth)};
    } else {
      const bool has_one_speed = is_past_end || range.least == range.most;
      const double quotient = !has_one_speed  ? stop.longest(fastest)
                              : fastest > 0.0 ? rounded_up(stop.distance(fastest) / fastest)
                                              : 0.0;
      double& reach = reaches[joints_[k].robot];
      reach = std::max(reach, rounded_up(factor_ * quotient));
      piece.reach = std::max(piece.reach, reach);
    }
    if (!is_past_end || !joints_[k].slides) continue;
    const double length = piece.stretch.to - piece.stretch.from;
    box.low -= rounded_up(length * std::max(0.0, -range.least));
    box.high += rounded_up(length * std::max(0.0, range.most));
  }
}

// The motion goes on in a line past the last waypoint: until the brakes act, and then for the reach
// of a stop.
double PlannedStops::time_past_the_end() const noexcept {
  const double reaction = rounded_up(factor_ * reaction_);
  double longest = rounded_up(reaction + pieces_.back().reach);
  for (std::size_t i = 0; i + 1 < pieces_.size(); ++i)
    longest = std::max(longest, rounded_up(pieces_[i].stretch.to - end_ + pieces_[i].reach));
  return std::max(longest, kShortestPast);
}

// Along the path, a piece is reached by stops that begin before it, too.
void PlannedStops::note_earlier() noexcept {
  double farthest = 0.0;
  for (const Piece& piece : pieces_) farthest = std::max(farthest, piece.reach);
  for (std::size_t p = 0; p < pieces_.size(); ++p) {
    Piece& piece = pieces_[p];
    for (std::size_t i = p; robots_.front()->keeps_path && i-- > 0;) {
      const double since = piece.stretch.from - pieces_[i].stretch.to;
      if (since > farthest) break;
      if (since > pieces_[i].reach) continue;
      const double from = since_told_ ? 0.0 : pieces_[i].stretch.to - begin_;
      piece.earlier = std::max(piece.earlier, rounded_up(from + pieces_[i].braking));
    }
  }
}

std::size_t PlannedStops::past_window(std::size_t piece, double time) const noexcept {
  const double end = rounded_up(pieces_[piece].stretch.to + time);
  while (piece < pieces_.size() && pieces_[piece].stretch.from <= end) ++piece;
  return piece;
}

// The pieces of all robots, which are told to stop at one instant of a piece. The brakes of each
// act within its reaction. Only later pieces are read, which are still those of bound().
void PlannedStops::bound_together() noexcept {
  for (std::size_t p = 0; p < pieces_.size(); ++p) {
    for (std::size_t r = 0; r < robots_.size(); ++r) {
      const double until_brakes = rounded_up(factor_ * robots_[r]->reaction);
      const std::size_t past = past_window(p, until_brakes);
      double reach = 0.0;
      for (std::size_t i = p; i < past; ++i) {
        pieces_[p].braking = std::max(pieces_[p].braking, pieces_[i].braking);
        reach = std::max(reach, reaches_[i * robots_.size() + r]);
      }
      for (std::size_t k = 0; k < joints_.size(); ++k) {
        if (joints_[k].robot != r) continue;
        Box& box = boxes_[p * joints_.size() + k];
        for (std::size_t i = p; i < past; ++i) {
          box.low = std::min(box.low, boxes_[i * joints_.size() + k].low);
          box.high = std::max(box.high, boxes_[i * joints_.size() + k].high);
        }
        const Box along = path_within(p, k, rounded_up(until_brakes + reach));
        box = {-rounded_up(-box.low - along.low), rounded_up(box.high + along.high)};
      }
    }
  }
}

PlannedStops::Box PlannedStops::path_within(std::size_t p, std::size_t k,
                                            double window) const noexcept {
  const double end = rounded_up(pieces_[p].stretch.to + window);
  double forth = 0.0, back = 0.0;  // the largest speeds
  Box went;
  const auto go = [&](double least, double most, double time) {
    forth = std::max(forth, most);
    back = std::max(back, -least);
    went.high = rounded_up(went.high + rounded_up(time * std::max(0.0, most)));
    went.low = -rounded_up(-went.low + rounded_up(time * std::max(0.0, -least)));
  };
  const std::size_t past = past_window(p, window);
  for (std::size_t i = p; i < past; ++i) {
    const Stretch& part = pieces_[i].stretch;
    const VelocityRange& range = velocities_[i * joints_.size() + k];
    go(range.least, range.most, rounded_up(std::min(end, part.to) - part.from));
  }
  if (end > end_) go(onward_[k], onward_[k], rounded_up(end - end_));
  return {std::max(went.low, -rounded_up(window * back)),
          std::min(went.high, rounded_up(window * forth))};
}

// The brakes act at the place, or before it; and no later than a reaction after the motion. Several
// robots are told at the place.
double PlannedStops::elapsed_at(double t, double braking, double earlier) const noexcept {
  if (since_told_) return reaction_ + std::max(braking, earlier);
  if (together_) return t - begin_ + reaction_ + braking;
  return std::max(std::min(t, end_ + reaction_) - begin_ + braking, earlier);
}

void PlannedStops::find_pieces(const Stretch& stretch, double at) noexcept {
  from_ = first_piece_[stretch.first];
  to_ = first_piece_[stretch.last + 1] - 1;
  at_ = first_piece_[Trajectory::segment_at_middle(stretch)];
  if (!stretch.is_in_one_segment()) return;
  const auto begin = pieces_.begin();
  const auto of_segment = [&](double instant) {
    const auto next = std::partition_point(
        begin + static_cast<std::ptrdiff_t>(from_), begin + static_cast<std::ptrdiff_t>(to_),
        [&](const Piece& piece) { return piece.stretch.to <= instant; });
    return static_cast<std::size_t>(next - begin);
  };
  const std::size_t first = of_segment(stretch.from);
  at_ = of_segment(at);
  std::size_t last = of_segment(stretch.to);
  // A stretch that ends where a piece begins has nothing of that.
  if (last > first && pieces_[last].stretch.from >= stretch.to) --last;
  from_ = first;
  to_ = last;
  at_ = std::min(at_, last);
}

void PlannedStops::place(const Stretch& stretch, double at,
                         std::span<TrackedVariable> variables) noexcept {
  find_pieces(stretch, at);
  Piece most = pieces_[from_], least = pieces_[from_];
  for (std::size_t p = from_ + 1; p <= to_; ++p) {
    most.braking = std::max(most.braking, pieces_[p].braking);
    most.earlier = std::max(most.earlier, pieces_[p].earlier);
    least.braking = std::min(least.braking, pieces_[p].braking);
    least.earlier = std::min(least.earlier, pieces_[p].earlier);
  }
  elapsed_ = {elapsed_at(stretch.to, most.braking, most.earlier),
              elapsed_at(at, pieces_[at_].braking, pieces_[at_].earlier),
              elapsed_at(stretch.from, least.braking, least.earlier)};
  // A slower motion comes to its places later.
  const auto told = [&](double t) { return since_told_ ? (t - begin_) / factor_ : 0.0; };
  clock_ = {begin_ + told(stretch.to) + elapsed_.end, begin_ + told(at) + elapsed_.middle,
            begin_ + told(stretch.from) + elapsed_.begin};
  if (!may_deviate_) return;
  const std::size_t count = joints_.size();
  for (std::size_t k = 0; k < count; ++k) {
    Joint& joint = joints_[k];
    double& position = variables[joint.variable].position;
    if (from_ == to_) {
      const Box& box = boxes_[from_ * count + k];
      const double half = 0.5 * (box.high - box.low);
      const double path = position;
      position += 0.5 * (box.low + box.high);
      if (joint.slides) {
        const JointVariable& limits = scene_.variables[joint.variable];
        position = std::clamp(position, std::min(limits.lower, path), std::max(limits.upper, path));
      }
      const double rounding = half > 0.0 ? kShiftRounding * (std::abs(path) + half) : 0.0;
      joint.deviation = {rounded_up(half + rounding), half, half};
      continue;
    }
    // Several pieces: the path itself is among the places in all of them.
    joint.deviation = {};
    for (std::size_t p = from_; p <= to_; ++p) {
      const Box& box = boxes_[p * count + k];
      joint.deviation.until_end = std::max({joint.deviation.until_end, box.high, -box.low});
    }
  }
}

void PlannedStops::add_deviations(std::span<Nearing> freedom) const noexcept {
  for (const Joint& joint : joints_) {
    Nearing& of = freedom[joint.variable];
    if (joint.deviation.until_end == 0.0) continue;
    of.until_end = rounded_up(of.until_end + joint.deviation.until_end);
    of.until_middle = rounded_down(of.until_middle + joint.deviation.until_middle);
    of.until_begin = rounded_down(of.until_begin + joint.deviation.until_begin);
  }
}

}  // namespace clearance
