#include "core/curved/direction_search.hpp"

#include <algorithm>
#include <cmath>

#include "core/curved/cap.hpp"
#include "core/curved/direction_programme.hpp"
#include "core/curved/piece-inl.hpp"

namespace clearance {
namespace {

constexpr int kIterations = 60;
constexpr int kTrials = 16;
constexpr int kPointRounds = 12;
constexpr int kBlindSteps = 8;
// Of one direction: what a programme takes.
constexpr std::size_t kFunctions = 5;

// One of the functions whose least is the distance along a direction: of a pair of pieces.
struct Function {
  SupportPair at;
  PlaneMatrix radii_a, radii_b;  // m
  double weight = 0.0;
};

class DirectionSearch {
 public:
  DirectionSearch(CurvedPair& pair, const Vec3& n, ActivePieces& active) noexcept
      : pair_(pair), n_(n), active_(active) {
    for (std::size_t i = 0; i < active.count; ++i) add_pieces(active.pieces[i]);
  }

  DirectionSearchEnd run() noexcept {
    at_ = pair_.support(n_);
    ++end_.supports;
    test_caps_on_axis();
    while (!done_ && end_.iterations < kIterations) {
      ++end_.iterations;
      place();
      step();
    }
    keep_active();
    return end_;
  }

 private:
  // ---- the functions ----
  [[nodiscard]] bool has(const PiecePair& pieces) const noexcept {
    for (std::size_t i = 0; i < count_; ++i) {
      if (functions_[i].at.pieces == pieces) return true;
    }
    return false;
  }
  Function& next_place() noexcept {
    if (count_ < kFunctions) return functions_[count_++];
    std::size_t least = 0;
    for (std::size_t i = 1; i < count_; ++i) {
      if (functions_[i].weight < functions_[least].weight) least = i;
    }
    return functions_[least];
  }
  void add_pieces(const PiecePair& pieces) noexcept {
    if (has(pieces)) return;
    Function& f = next_place();
    f = {};
    f.at.pieces = pieces;
  }
  void keep_weighted() noexcept {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      if (functions_[i].weight > 0.0) functions_[kept++] = functions_[i];
    }
    count_ = kept;
  }

  // ---- at one direction ----
  // Tangents along the rim that turns fastest, so that its radius stays out of what lies across.
  void set_tangents() noexcept {
    double fastest = 0.0;
    Vec3 along = Vec3::Zero();
    const auto look = [&](const PieceSource& source, const Vec3& m, bool of_a) {
      if (source.body->curved.kind != CurvedShape::Kind::kTruncatedCone) return;
      const Azimuth azimuth = azimuth_of(source, m);
      const double turn =
          std::max(source.body->curved.discs[0].radius, source.body->curved.discs[1].radius) /
          azimuth.across;
      if (!(turn > fastest)) return;
      fastest = turn;
      const Vec3 own(-azimuth.to.y(), azimuth.to.x(), 0.0);
      along = of_a ? own : pair_.direction_to_a(own);
    };
    look(pair_.a, n_, true);
    look(pair_.b, -pair_.direction_to_b(n_), false);
    if (fastest == 0.0) {
      int least = 0;
      n_.cwiseAbs().minCoeff(&least);
      along = n_.cross(Vec3::Unit(least));
    }
    tangents_.x = (along - along.dot(n_) * n_).normalized();
    tangents_.y = n_.cross(tangents_.x);
    tangents_in_b_ = {pair_.direction_to_b(tangents_.x), pair_.direction_to_b(tangents_.y)};
  }

  void place(Function& f) noexcept {
    f.at = pair_.support_of(f.at.pieces, n_);
    f.radii_a = radii_of_curvature(faced(pair_.a, n_), f.at.pieces.a, tangents_);
    f.radii_b = radii_of_curvature(faced(pair_.b, -pair_.direction_to_b(n_)), f.at.pieces.b,
                                   tangents_in_b_);
  }

  void place() noexcept {
    set_tangents();
    add_pieces(at_.pieces);
    for (std::size_t i = 0; i < count_; ++i) place(functions_[i]);
  }

  // ---- the step ----
  [[nodiscard]] PlaneMatrix curvature(const PlaneMatrix Function::*radii) const noexcept {
    PlaneMatrix sum;
    for (std::size_t i = 0; i < count_; ++i) sum.add(functions_[i].weight, functions_[i].*radii);
    return sum;
  }
  [[nodiscard]] PlaneMatrix hessian(const PlaneMatrix& a, const PlaneMatrix& b) const noexcept {
    PlaneMatrix q = a;
    q.add(1.0, b);
    // Where the bodies overlap the shift is negative, as long as that leaves q positive definite.
    const double x = q.xx + shift_, y = q.yy + shift_;
    const bool definite = x > 0.0 && x * y - q.xy * q.xy > 0x1p-6 * x * y;
    const double shift = shift_ > 0.0 || definite ? shift_ : -shift_;
    q.xx += shift;
    q.yy += shift;
    return q;
  }
  void set_weights_if_none() noexcept {
    double sum = 0.0;
    for (std::size_t i = 0; i < count_; ++i) sum += functions_[i].weight;
    if (sum > 0.0) return;
    for (std::size_t i = 0; i < count_; ++i) {
      if (functions_[i].at.pieces == at_.pieces) functions_[i].weight = 1.0;
    }
  }

  // The curvature is that of the active functions, by their weights; those are found with it.
  PlaneStep solve() noexcept {
    std::array<PlaneFunction, kFunctions> functions{};
    for (std::size_t i = 0; i < count_; ++i) {
      const Vec3 w = functions_[i].at.points.difference();
      functions[i] = {functions_[i].at.apart - at_.apart,
                      Vec2(w.dot(tangents_.x), w.dot(tangents_.y))};
    }
    set_weights_if_none();
    PlaneStep found;
    const int rounds = count_ == 1 ? 1 : 3;
    for (int round = 0; round < rounds; ++round) {
      radii_a_ = curvature(&Function::radii_a);
      radii_b_ = curvature(&Function::radii_b);
      found = highest_least(functions, count_, hessian(radii_a_, radii_b_));
      for (std::size_t i = 0; i < count_; ++i) functions_[i].weight = found.weights[i];
    }
    return found;
  }

  // The points of the active pieces, each moved along as its direction is turned by `step`;
  // `again`: and once more by what is left across that direction, since rims are not straight.
  PointPair add_points(const PlaneStep& found, int again = 0) noexcept {
    PointPair points;
    for (std::size_t i = 0; i < count_; ++i) {
      points.a += found.weights[i] * functions_[i].at.points.a;
      points.own_b += found.weights[i] * functions_[i].at.points.own_b;
    }
    Vec2 turn = found.step;
    for (int round = 0;; ++round) {
      const Vec2 on_a = radii_a_ * turn, on_b = radii_b_ * turn;
      points.a += on_a.x() * tangents_.x + on_a.y() * tangents_.y;
      points.own_b -= on_b.x() * tangents_in_b_.x + on_b.y() * tangents_in_b_.y;
      points = pair_.add_points(points.a, points.own_b);
      if (round >= again || pair_.is_tight()) return points;
      const Vec3 w = points.difference();
      const PlaneFunction rest{
          0.0, Vec2(w.dot(tangents_.x), w.dot(tangents_.y)) - at_.apart * found.step};
      turn = highest_least({rest}, 1, hessian(radii_a_, radii_b_)).step;
    }
  }

  [[nodiscard]] Vec3 turned(const Vec2& step) const noexcept {
    return (n_ + step.x() * tangents_.x + step.y() * tangents_.y).normalized();
  }

  void step() noexcept {
    set_shift();
    PlaneStep found = solve();
    add_points(found);
    for (int trial = 0; trial < kTrials && !pair_.is_tight(); ++trial) {
      // Half a right angle at once: farther away, other pieces count.
      found.step /= std::max(1.0, found.step.norm());
      const Vec3 next = turned(found.step);
      if (over_caps(next)) return;
      if (next == n_) break;
      const SupportPair there = pair_.support(next);
      ++end_.supports;
      if (there.apart > at_.apart || is_blind(found, there)) {
        n_ = next;
        at_ = there;
        keep_weighted();
        return;
      }
      if (has(there.pieces)) {
        shorten(found, there.apart);
        continue;
      }
      add_pieces(there.pieces);
      for (std::size_t i = 0; i < count_; ++i) place(functions_[i]);
      found = solve();
      add_points(found);
    }
    // The step that the bounds no longer need makes the direction as good as they are.
    if (pair_.is_tight()) {
      pair_.prefer(turned(found.step));
    } else {
      const PointPair last = add_points(found, kPointRounds);
      const bool deepest = at_.apart >= pair_.bounds.lower - pair_.gap_tolerance();
      if (at_.apart < 0.0 && deepest) pair_.bounds.deepest = last;
    }
    done_ = true;
  }

  // What the sphere's own curvature adds: how far apart the bodies are, or nearly so as long as the
  // direction is far off.
  void set_shift() noexcept {
    const double farthest = std::min(pair_.bounds.upper, at_.points.difference().norm());
    const bool overlap = at_.apart < -0x1p-40 * pair_.size;
    shift_ = overlap ? at_.apart : std::max(at_.apart, 0.5 * farthest);
    if (shift_ == 0.0) shift_ = 0x1p-50 * pair_.size;
  }

  // A step that rounding hides: it may still bring the points to each other.
  bool is_blind(const PlaneStep& found, const SupportPair& there) noexcept {
    const double noise = 0x1p-50 * pair_.size;
    if (found.value > noise || there.apart < at_.apart - noise) return false;
    return blind_++ < kBlindSteps;
  }

  // To where a parabola through what is known along the step is highest: its value and slope here,
  // its value there.
  void shorten(PlaneStep& found, double there) const noexcept {
    double slope = 0.0;
    for (std::size_t i = 0; i < count_; ++i) {
      const Vec3 w = functions_[i].at.points.difference();
      slope += found.weights[i] *
               (w.dot(tangents_.x) * found.step.x() + w.dot(tangents_.y) * found.step.y());
    }
    const double highest = 0.5 * slope / (slope - (there - at_.apart));
    found.step *= std::isfinite(highest) ? std::clamp(highest, 0.05, 0.5) : 0.5;
  }

  // ---- caps ----
  [[nodiscard]] static Vec2 across(const Vec3& m) noexcept { return {m.x(), m.y()}; }

  // Does the way to `next` pass the axis? Then the cap may be the closest.
  bool over_caps(const Vec3& next) noexcept {
    const auto passes = [](const Vec3& m, const Vec3& to) {
      return across(m).dot(across(to)) <= 0.0 || across(to).norm() <= 0x1p-40;
    };
    if (pair_.a.body->curved.kind == CurvedShape::Kind::kTruncatedCone && passes(n_, next) &&
        try_cap(true, next)) {
      return true;
    }
    return pair_.b.body->curved.kind == CurvedShape::Kind::kTruncatedCone &&
           passes(-pair_.direction_to_b(n_), -pair_.direction_to_b(next)) && try_cap(false, next);
  }
  void test_caps_on_axis() noexcept { (void)over_caps(n_); }

  // True: the search is at an end or goes on from the axis.
  bool try_cap(bool of_a, const Vec3& towards) noexcept {
    const double along = of_a ? towards.z() : -pair_.direction_to_b(towards).z();
    bool& tried = tried_[(of_a ? 0 : 2) + (along > 0.0 ? 1 : 0)];
    if (tried) return false;
    tried = true;
    const CapTest test = test_cap(pair_, of_a, towards);
    ++end_.supports;
    if (pair_.is_tight()) {
      done_ = true;
      return true;
    }
    if (!(test.support.apart > at_.apart)) return false;
    n_ = test.normal;
    at_ = test.support;
    count_ = 0;
    for (std::size_t i = 0; i < test.count; ++i) add_pieces(test.pieces[i]);
    return true;
  }

  void keep_active() noexcept {
    active_.count = 0;
    for (std::size_t i = 0; i < count_ && active_.count < 3; ++i) {
      if (functions_[i].weight > 0.0) {
        active_.pieces[active_.count++] = functions_[i].at.pieces;
      }
    }
  }

  CurvedPair& pair_;
  Vec3 n_;
  ActivePieces& active_;
  SupportPair at_{};
  Tangents tangents_{}, tangents_in_b_{};
  std::array<Function, kFunctions> functions_{};
  std::size_t count_ = 0;
  PlaneMatrix radii_a_, radii_b_;
  double shift_ = 0.0;
  bool done_ = false;
  int blind_ = 0;
  std::array<bool, 4> tried_{};
  DirectionSearchEnd end_;
};

}  // namespace

DirectionSearchEnd search_direction(CurvedPair& pair, const Vec3& n,
                                    ActivePieces& active) noexcept {
  return DirectionSearch(pair, n, active).run();
}

}  // namespace clearance
