// The thorough effort of the method in README.md. On the tangent plane of n, each pair of parts
// gives a quadratic model of the distance along n + s. The max-min programme of these models gives
// the step. A step must improve the least of the distances. If it does not, it is shortened, or a
// missing pair of parts joins the programme.
#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/curved/max_min_programme.hpp"
#include "core/curved/thorough.hpp"

namespace clearance {
namespace {

constexpr int kIterations = 60;
constexpr int kTrials = 16;
constexpr int kPointRounds = 12;
constexpr int kBlindSteps = 8;
constexpr double kNoGain = 0x1p-53;  // of a depth, as a part of the pair's size
constexpr std::size_t kModels = 5;   // of one programme

// The quadratic model of one pair of parts around n.
struct PartModel {
  SupportPair at;
  PlaneMatrix hessian_a, hessian_b;  // support Hessians, m
  double weight = 0.0;
};

class DirectionSearch {
 public:
  DirectionSearch(CurvedPair& pair, const Vec3& n, ActiveParts& active) noexcept
      : pair_(pair), n_(n), active_(active) {
    for (std::size_t i = 0; i < active.count; ++i) add_parts(active.pairs[i]);
  }

  // Returns how many support points it took.
  int run() noexcept {
    at_ = pair_.support(n_);
    ++supports_;
    test_caps_on_axis();
    for (int i = 0; i < kIterations && !done_; ++i) {
      place();
      step();
    }
    keep_active();
    return supports_;
  }

 private:
  // ---- the models ----
  [[nodiscard]] bool has(const PartPair& parts) const noexcept {
    for (std::size_t i = 0; i < count_; ++i) {
      if (models_[i].at.parts == parts) return true;
    }
    return false;
  }
  PartModel& next_place() noexcept {
    if (count_ < kModels) return models_[count_++];
    std::size_t least = 0;
    for (std::size_t i = 1; i < count_; ++i) {
      if (models_[i].weight < models_[least].weight) least = i;
    }
    return models_[least];
  }
  void add_parts(const PartPair& parts) noexcept {
    if (has(parts)) return;
    PartModel& f = next_place();
    f = {};
    f.at.parts = parts;
  }
  void keep_weighted() noexcept {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      if (models_[i].weight > 0.0) models_[kept++] = models_[i];
    }
    count_ = kept;
  }

  // ---- at one direction ----
  // The first tangent is the direction in which the support point of a rim moves fastest. So the
  // radius of this rim does not enter the terms of the other tangent.
  void set_tangents() noexcept {
    BodyDefaults::Rim fastest;
    const auto rim_of = [](const BodyView& view, const Vec3& m) {
      return visit(view, [&](const auto& body) { return body.rim(m); });
    };
    const auto a = rim_of(pair_.a, n_), b = rim_of(pair_.b, -pair_.direction_to_b(n_));
    if (a.curvature_radius > 0.0) fastest = a;
    if (b.curvature_radius > fastest.curvature_radius) {
      fastest.tangent = pair_.direction_to_a(b.tangent);
    } else if (fastest.curvature_radius == 0.0) {
      int least = 0;
      n_.cwiseAbs().minCoeff(&least);
      fastest.tangent = n_.cross(Vec3::Unit(least));
    }
    const Vec3& along = fastest.tangent;
    tangents_.x = (along - along.dot(n_) * n_).normalized();
    tangents_.y = n_.cross(tangents_.x);
    tangents_in_b_ = {pair_.direction_to_b(tangents_.x), pair_.direction_to_b(tangents_.y)};
  }

  void place(PartModel& f) noexcept {
    f.at = pair_.support_of(f.at.parts, n_);
    f.hessian_a = support_hessian(pair_.a, f.at.parts.a, n_, tangents_);
    f.hessian_b = support_hessian(pair_.b, f.at.parts.b, -pair_.direction_to_b(n_), tangents_in_b_);
  }

  void place() noexcept {
    set_tangents();
    add_parts(at_.parts);
    for (std::size_t i = 0; i < count_; ++i) place(models_[i]);
  }

  // ---- the step ----
  [[nodiscard]] PlaneMatrix mean(const PlaneMatrix PartModel::*hessian) const noexcept {
    PlaneMatrix sum;
    for (std::size_t i = 0; i < count_; ++i) sum.add(models_[i].weight, models_[i].*hessian);
    return sum;
  }
  [[nodiscard]] PlaneMatrix regularised(const PlaneMatrix& a, const PlaneMatrix& b) const noexcept {
    PlaneMatrix q = a;
    q.add(1.0, b);
    // If the bodies overlap, the term is negative as long as q stays positive definite.
    const double x = q.xx + regularisation_, y = q.yy + regularisation_;
    const bool definite = x > 0.0 && x * y - q.xy * q.xy > 0x1p-6 * x * y;
    const double term = regularisation_ > 0.0 || definite ? regularisation_ : -regularisation_;
    q.xx += term;
    q.yy += term;
    return q;
  }
  void set_weights_if_none() noexcept {
    double sum = 0.0;
    for (std::size_t i = 0; i < count_; ++i) sum += models_[i].weight;
    if (sum > 0.0) return;
    for (std::size_t i = 0; i < count_; ++i) {
      if (models_[i].at.parts == at_.parts) models_[i].weight = 1.0;
    }
  }

  // K is the mean of the active models' Hessians by their weights. The programme, which needs K,
  // finds these weights.
  PlaneStep solve() noexcept {
    std::array<PlaneFunction, kModels> functions{};
    for (std::size_t i = 0; i < count_; ++i) {
      const Vec3 w = models_[i].at.points.gap();
      functions[i] = {models_[i].at.value - at_.value,
                      Vec2(w.dot(tangents_.x), w.dot(tangents_.y))};
    }
    set_weights_if_none();
    PlaneStep found;
    const int rounds = count_ == 1 ? 1 : 3;
    for (int round = 0; round < rounds; ++round) {
      hessian_a_ = mean(&PartModel::hessian_a);
      hessian_b_ = mean(&PartModel::hessian_b);
      found = max_min(functions, count_, regularised(hessian_a_, hessian_b_));
      for (std::size_t i = 0; i < count_; ++i) models_[i].weight = found.weights[i];
    }
    return found;
  }

  // Adds the weighted mean of the active parts' support points, moved by the Hessians to where they
  // would be for n + step. Rims are curved, so a gap across the direction remains. `again` says how
  // often the move is repeated for that rest.
  PointPair add_points(const PlaneStep& found, int again = 0) noexcept {
    PointPair points;
    for (std::size_t i = 0; i < count_; ++i) {
      points.a += found.weights[i] * models_[i].at.points.a;
      points.b_B += found.weights[i] * models_[i].at.points.b_B;
    }
    Vec2 step = found.step;
    for (int round = 0;; ++round) {
      const Vec2 on_a = hessian_a_ * step, on_b = hessian_b_ * step;
      points.a += on_a.x() * tangents_.x + on_a.y() * tangents_.y;
      points.b_B -= on_b.x() * tangents_in_b_.x + on_b.y() * tangents_in_b_.y;
      points = pair_.add_points(points.a, points.b_B);
      if (round >= again || pair_.is_converged()) return points;
      const Vec3 w = points.gap();
      const PlaneFunction rest{
          0.0, Vec2(w.dot(tangents_.x), w.dot(tangents_.y)) - at_.value * found.step};
      if (rest.slope.norm() <= 0x1p-53 * pair_.size) return points;
      step = max_min({rest}, 1, regularised(hessian_a_, hessian_b_)).step;
    }
  }

  [[nodiscard]] Vec3 rotated(const Vec2& step) const noexcept {
    return (n_ + step.x() * tangents_.x + step.y() * tangents_.y).normalized();
  }

  void step() noexcept {
    set_regularisation();
    PlaneStep found = solve();
    add_points(found);
    for (int trial = 0; trial < kTrials && !pair_.is_converged(); ++trial) {
      // A step is at most half a right angle: farther away, other parts are active.
      found.step /= std::max(1.0, found.step.norm());
      const Vec3 next = rotated(found.step);
      if (over_caps(next)) return;
      if (next == n_) break;
      const SupportPair there = pair_.support(next);
      ++supports_;
      if (there.value > at_.value || is_blind(found, there)) {
        n_ = next;
        at_ = there;
        keep_weighted();
        return;
      }
      if (has(there.parts)) {
        if (overlap_ && found.value <= kNoGain * pair_.size) break;
        shorten(found, there.value);
        continue;
      }
      add_parts(there.parts);
      for (std::size_t i = 0; i < count_; ++i) place(models_[i]);
      found = solve();
      add_points(found);
    }
    // The bounds have converged. This step makes the direction as accurate as they are.
    if (pair_.is_converged()) {
      pair_.prefer(rotated(found.step));
    } else {
      const PointPair last = add_points(found, kPointRounds);
      const bool deepest = at_.value >= pair_.bounds.lower - pair_.gap_tolerance();
      if (at_.value < 0.0 && deepest) {
        pair_.bounds.deepest = last;
        pair_.bounds.has_deepest = true;
      }
    }
    done_ = true;
  }

  // The curvature of the unit sphere adds d, the distance. While the direction is far from the
  // best, d is at least half the distance of the points.
  void set_regularisation() noexcept {
    const double farthest = std::min(pair_.bounds.upper, at_.points.gap().norm());
    overlap_ = at_.value < -0x1p-40 * pair_.size;
    regularisation_ = overlap_ ? at_.value : std::max(at_.value, 0.5 * farthest);
    if (regularisation_ == 0.0) regularisation_ = 0x1p-50 * pair_.size;
  }

  [[nodiscard]] double noise() const noexcept { return 0x1p-50 * pair_.size; }

  // A step whose gain is below rounding may still bring the points closer. The bounds of a depth do
  // not need these points.
  bool is_blind(const PlaneStep& found, const SupportPair& there) noexcept {
    if (found.value > noise() || there.value < at_.value - noise()) return false;
    return blind_++ < (overlap_ ? 1 : kBlindSteps);
  }

  // Shortens the step to the maximum of the parabola through the value and the slope at n and the
  // value at n + step.
  void shorten(PlaneStep& found, double there) const noexcept {
    double slope = 0.0;
    for (std::size_t i = 0; i < count_; ++i) {
      const Vec3 w = models_[i].at.points.gap();
      slope += found.weights[i] *
               (w.dot(tangents_.x) * found.step.x() + w.dot(tangents_.y) * found.step.y());
    }
    const double highest = 0.5 * slope / (slope - (there - at_.value));
    found.step *= std::isfinite(highest) ? std::clamp(highest, 0.05, 0.5) : 0.5;
  }

  // ---- caps ----
  [[nodiscard]] static Vec2 across(const Vec3& m) noexcept { return {m.x(), m.y()}; }

  // If the step to `next` passes the axis, the cap may be closest.
  bool over_caps(const Vec3& next) noexcept {
    const auto passes = [](const Vec3& m, const Vec3& to) {
      return across(m).dot(across(to)) <= 0.0 || across(to).norm() <= 0x1p-40;
    };
    if (has_caps(*pair_.a.body) && passes(n_, next) && try_cap(true, next)) return true;
    return has_caps(*pair_.b.body) &&
           passes(-pair_.direction_to_b(n_), -pair_.direction_to_b(next)) && try_cap(false, next);
  }
  void test_caps_on_axis() noexcept { (void)over_caps(n_); }

  // True: the search has ended, or continues from the axis.
  bool try_cap(bool cap_is_of_a, const Vec3& towards) noexcept {
    const double along = cap_is_of_a ? towards.z() : -pair_.direction_to_b(towards).z();
    bool& tried = tried_[(cap_is_of_a ? 0 : 2) + (along > 0.0 ? 1 : 0)];
    if (tried) return false;
    tried = true;
    const CapTest test = test_cap(pair_, cap_is_of_a, towards);
    ++supports_;
    if (pair_.is_converged()) {
      done_ = true;
      return true;
    }
    if (!(test.support.value > at_.value)) return false;
    n_ = test.normal;
    at_ = test.support;
    count_ = 0;
    for (std::size_t i = 0; i < test.count; ++i) add_parts(test.parts[i]);
    return true;
  }

  void keep_active() noexcept {
    active_.count = 0;
    for (std::size_t i = 0; i < count_ && active_.count < 3; ++i) {
      if (models_[i].weight > 0.0) {
        active_.pairs[active_.count++] = models_[i].at.parts;
      }
    }
  }

  CurvedPair& pair_;
  Vec3 n_;
  ActiveParts& active_;
  SupportPair at_{};
  Tangents tangents_{}, tangents_in_b_{};
  std::array<PartModel, kModels> models_{};
  std::size_t count_ = 0;
  PlaneMatrix hessian_a_, hessian_b_;
  double regularisation_ = 0.0;
  bool done_ = false, overlap_ = false;
  int blind_ = 0;
  std::array<bool, 4> tried_{};
  int supports_ = 0;
};

}  // namespace

int search_direction(CurvedPair& pair, const Vec3& n, ActiveParts& active) noexcept {
  assert(is_unit_or_unknown(n));
  const int supports = DirectionSearch(pair, n, active).run();
  assert(is_unit_or_unknown(pair.bounds.normal));
  return supports;
}

}  // namespace clearance
