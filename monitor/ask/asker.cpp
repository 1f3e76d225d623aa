// Bisects the time of the motion. A stretch keeps a list of the pairs that are not decided in it.
#include "monitor/ask/asker.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "monitor/ask/part_pair.hpp"
#include "monitor/ask/posture.hpp"
#include "monitor/geometry/bounding_sphere.hpp"

namespace clearance {
namespace {

// Shorter stretches are not divided, relative to the duration.
constexpr double kShortest = 0x1p-46;
// The first instant below a margin is known to this, relative to the duration.
constexpr double kInstant = 1e-7;
// The relative error of a computed position of a joint.
constexpr double kPositionRounding = 0x1p-49;

}  // namespace

const char* name(Verdict verdict) noexcept {
  switch (verdict) {
    case Verdict::kFree:
      return "free";
    case Verdict::kBelow:
      return "below";
    case Verdict::kUndecided:
      return "undecided";
  }
  return "";
}

class Asker::Search {
 public:
  explicit Search(const Scene& scene);
  [[nodiscard]] std::optional<std::string> ask(const Question& question, Answer& answer);

 private:
  struct Ordered {
    double distance = 0.0;
    std::uint32_t pair = 0;
    friend bool operator<(const Ordered& a, const Ordered& b) noexcept {
      return a.distance != b.distance ? a.distance < b.distance : a.pair < b.pair;
    }
  };
  void prepare() noexcept;
  [[nodiscard]] std::size_t present_pairs() noexcept;

  // The least distance: `count` pairs of order_ are not decided in the stretch.
  void minimise(const Stretch& stretch, std::size_t count, double known) noexcept;
  // The same for the first instant below answer.margin, from left to right.
  void find_first(const Stretch& stretch, std::size_t count, MarginAnswer& answer) noexcept;
  void decide(MarginAnswer& answer) noexcept;
  void note_upper(const StretchBounds& bounds, double at, const PartPair& pair) noexcept;
  static void note_pair(const PartPair& pair, std::uint32_t& first, std::uint32_t& second) noexcept;
  [[nodiscard]] StretchBounds examine(const Stretch& stretch, double middle, double enough,
                                      PartPair& pair) noexcept;
  [[nodiscard]] bool can_divide(const Stretch& stretch, double middle) const noexcept {
    return stretch.from < middle && middle < stretch.to &&
           stretch.to - stretch.from > kShortest * duration_;
  }
  [[nodiscard]] bool is_exhausted() const noexcept {
    return answer_->queries >= question_->work_limit;
  }
  [[nodiscard]] static bool proves(double lower, double margin) noexcept {
    return margin > 0.0 ? lower >= margin : lower > 0.0;
  }

  const Scene& scene_;
  Posture posture_;
  std::vector<PartPair> pairs_;
  std::vector<Ordered> order_;

  const Question* question_ = nullptr;
  Answer* answer_ = nullptr;
  double duration_ = 0.0, closed_lower_ = kInfinity;
  bool found_ = false;       // an instant below the margin is known
  bool uncertain_ = false;   // a stretch is known that is not proven to be above
  double proven_until_ = 0;  // s: before this, a larger margin was proven
};

Asker::Search::Search(const Scene& scene) : scene_(scene), posture_(scene) {
  Chains& chains = posture_.chains();
  const auto first = posture_.first_part();
  for (const ObjectPair& watched : scene.pairs) {
    std::uint32_t base = watched.first, tip = watched.second;
    const bool swapped = !chains.is_link(tip) || (chains.is_link(base) && !chains.can_move(tip));
    if (swapped) std::swap(base, tip);
    if (!chains.is_link(tip)) continue;
    const Chain chain = chains.between(base, tip);
    for (std::uint32_t a = first[base]; a < first[base + 1]; ++a) {
      for (std::uint32_t b = first[tip]; b < first[tip + 1]; ++b) {
        pairs_.push_back({.base = a,
                          .tip = b,
                          .object_base = base,
                          .object_tip = tip,
                          .swapped = swapped,
                          .chain = chain,
                          .tracking = {}});
      }
    }
  }
  chains.finish();
  order_.resize(pairs_.size());
}

std::size_t Asker::Search::present_pairs() noexcept {
  std::size_t count = 0;
  for (std::uint32_t i = 0; i < pairs_.size(); ++i) {
    const PartPair& pair = pairs_[i];
    if (posture_.is_present(pair.object_base) && posture_.is_present(pair.object_tip)) {
      order_[count++] = {0.0, i};
    }
  }
  return count;
}

void Asker::Search::prepare() noexcept {
  double largest = 0.0;
  for (const double p : question_->motion.positions) largest = std::max(largest, std::abs(p));
  for (const double v : question_->motion.velocities) {
    largest = std::max(largest, std::abs(v) * duration_);
  }
  for (PartPair& pair : pairs_) {
    pair.tracking = {};
    pair.rounding = kPositionRounding * largest * posture_.chains().sum_of_reaches(pair.chain);
    const Object& base = scene_.objects[pair.object_base];
    const bool is_free = !base.fixed && !posture_.chains().is_link(pair.object_base);
    const bool moves = is_free && question_->others == OthersMove::kWithinMaxSpeed;
    pair.unstated_speed = moves ? base.max_speed : 0.0;
    pair.age = posture_.age(pair.object_base);
  }
}

std::optional<std::string> Asker::Search::ask(const Question& question, Answer& answer) {
  if (!question.beside.empty() || !question.moving.empty() || !question.payloads.empty() ||
      question.profile || question.time_scaling) {
    return "this version does not answer `beside`, `moving`, `payloads`, `profile`, `time_scaling`";
  }
  if (auto text = posture_.take(question)) return text;
  if (!(question.tolerance > 0.0) || !(question.margin_tolerance > 0.0)) {
    return "a tolerance is not above 0";
  }
  for (const double margin : question.margins) {
    if (!(margin >= 0.0) || !std::isfinite(margin)) return "a margin is not a number from 0 on";
  }
  question_ = &question;
  answer_ = &answer;
  std::vector<MarginAnswer> room = std::move(answer.margins);
  answer = {};
  answer.margins = std::move(room);
  answer.margins.resize(question.margins.size());
  duration_ = posture_.trajectory().end() - posture_.trajectory().begin();
  prepare();
  const std::size_t count = present_pairs();
  answer.has_pair = count > 0;
  answer.upper = kInfinity;
  closed_lower_ = kInfinity;
  const Stretch whole = posture_.trajectory().whole();
  posture_.place(whole, posture_.trajectory().middle(whole));
  ++answer.placements;
  for (std::size_t i = 0; i < count; ++i) {
    const PartPair& pair = pairs_[order_[i].pair];
    order_[i].distance = least_between(posture_.part(pair.base).sphere_in_world,
                                       posture_.part(pair.tip).sphere_in_world);
  }
  std::sort(order_.begin(), order_.begin() + static_cast<std::ptrdiff_t>(count));
  minimise(whole, count, 0.0);
  answer.lower = std::max(0.0, std::min(closed_lower_, answer.upper));

  // A larger margin is violated no later than a smaller one.
  proven_until_ = posture_.trajectory().begin();
  double last = kInfinity;
  for (std::size_t n = 0; n < question.margins.size(); ++n) {
    double next = -1.0;
    for (const double margin : question.margins) {
      if (margin < last) next = std::max(next, margin);
    }
    if (next < 0.0) break;
    last = next;
    MarginAnswer decided{.margin = next};
    decide(decided);
    for (std::size_t i = 0; i < question.margins.size(); ++i) {
      if (question.margins[i] == next) answer.margins[i] = decided;
    }
  }
  return std::nullopt;
}

StretchBounds Asker::Search::examine(const Stretch& stretch, double middle, double enough,
                                     PartPair& pair) noexcept {
  const StretchBounds bounds =
      bounds_over(stretch, middle, enough, posture_.trajectory().begin(), posture_, pair);
  answer_->queries += bounds.queried ? 1 : 0;
  return bounds;
}

void Asker::Search::note_pair(const PartPair& pair, std::uint32_t& first,
                              std::uint32_t& second) noexcept {
  first = pair.swapped ? pair.object_tip : pair.object_base;
  second = pair.swapped ? pair.object_base : pair.object_tip;
}

void Asker::Search::note_upper(const StretchBounds& bounds, double at,
                               const PartPair& pair) noexcept {
  if (!(bounds.upper < answer_->upper)) return;
  answer_->upper = bounds.upper;
  answer_->time = at;
  note_pair(pair, answer_->first, answer_->second);
  answer_->point_on_first = pair.swapped ? bounds.on_tip : bounds.on_base;
  answer_->point_on_second = pair.swapped ? bounds.on_base : bounds.on_tip;
}

// Both halves of a stretch have the undecided pairs of the stretch. They stand at the front of
// order_, where a half only exchanges them among each other.
void Asker::Search::minimise(const Stretch& stretch, std::size_t count, double known) noexcept {
  if (count == 0) return;
  if (is_exhausted()) {
    answer_->within_work_limit = false;
    closed_lower_ = std::min(closed_lower_, known);
    return;
  }
  const double middle = posture_.trajectory().middle(stretch);
  posture_.place(stretch, middle);
  ++answer_->placements;
  const bool divides = can_divide(stretch, middle);
  std::size_t left = 0;
  double least = kInfinity, closing = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    PartPair& pair = pairs_[order_[i].pair];
    const auto enough = [&] {
      return std::min(question_->far_enough, answer_->upper - question_->tolerance);
    };
    const StretchBounds bounds = examine(stretch, middle, enough(), pair);
    if (bounds.queried) note_upper(bounds, middle, pair);
    // No distance is negative, so a pair in contact is decided as well.
    if (std::max(0.0, bounds.lower) >= enough() || !divides) {
      closed_lower_ = std::min(closed_lower_, bounds.lower);
      continue;
    }
    if (bounds.lower < least) {
      least = bounds.lower;
      closing = bounds.closing;
    }
    std::swap(order_[left++], order_[i]);
  }
  const double inherited = std::max(known, least);
  const Stretch before = posture_.trajectory().before(stretch, middle);
  const Stretch after = posture_.trajectory().after(stretch, middle);
  minimise(closing > 0.0 ? after : before, left, inherited);
  minimise(closing > 0.0 ? before : after, left, inherited);
}

void Asker::Search::decide(MarginAnswer& answer) noexcept {
  if (!answer_->has_pair || proves(answer_->lower, answer.margin)) {
    answer.verdict = Verdict::kFree;
    return;
  }
  const Stretch whole = posture_.trajectory().whole();
  // The first instant by itself: otherwise a motion that begins too near is divided to the end.
  found_ = uncertain_ = false;
  answer.above_until = whole.from;
  if (proven_until_ <= whole.from) {
    find_first({0, 0, whole.from, whole.from}, present_pairs(), answer);
  }
  if (!found_) {
    uncertain_ = false;
    find_first(whole, present_pairs(), answer);
  }
  answer.verdict = found_ ? Verdict::kBelow : uncertain_ ? Verdict::kUndecided : Verdict::kFree;
  if (found_ && !uncertain_) answer.above_until = answer.below_at;
  if (answer.verdict != Verdict::kFree) proven_until_ = std::max(proven_until_, answer.above_until);
}

void Asker::Search::find_first(const Stretch& stretch, std::size_t count,
                               MarginAnswer& answer) noexcept {
  if (count == 0 || (found_ && stretch.from >= answer.below_at)) return;
  if (stretch.to <= proven_until_ && stretch.from < stretch.to) return;
  const auto note_uncertain = [&](const PartPair& pair) {
    if (!uncertain_ || stretch.from < answer.above_until) {
      answer.above_until = stretch.from;
      if (!found_) note_pair(pair, answer.first, answer.second);
    }
    uncertain_ = true;
  };
  if (is_exhausted()) {
    answer_->within_work_limit = false;
    note_uncertain(pairs_[order_[0].pair]);
    return;
  }
  const double middle = posture_.trajectory().middle(stretch);
  posture_.place(stretch, middle);
  ++answer_->placements;
  std::size_t left = 0;
  for (std::size_t i = 0; i < count; ++i) {
    PartPair& pair = pairs_[order_[i].pair];
    const StretchBounds bounds = examine(stretch, middle, std::max(answer.margin, 1e-300), pair);
    if (proves(bounds.lower, answer.margin)) continue;
    const bool below = bounds.queried &&
                       (answer.margin > 0.0 ? bounds.upper < answer.margin : bounds.upper <= 0.0);
    if (below && (!found_ || middle < answer.below_at)) {
      found_ = true;
      answer.below_at = middle;
      note_pair(pair, answer.first, answer.second);
    }
    if (bounds.queried) note_upper(bounds, middle, pair);
    const bool near = bounds.lower >= answer.margin - question_->margin_tolerance && !below;
    const bool located = found_ && answer.below_at <= stretch.to &&
                         answer.below_at - stretch.from <= kInstant * duration_;
    if (near || located || !can_divide(stretch, middle)) {
      note_uncertain(pair);
      continue;
    }
    std::swap(order_[left++], order_[i]);
  }
  find_first(posture_.trajectory().before(stretch, middle), left, answer);
  find_first(posture_.trajectory().after(stretch, middle), left, answer);
}

Asker::Asker(const Scene& scene) : search_(std::make_unique<Search>(scene)) {}
Asker::~Asker() = default;
Asker::Asker(Asker&&) noexcept = default;
Asker& Asker::operator=(Asker&&) noexcept = default;

std::optional<std::string> Asker::ask(const Question& question, Answer& answer) {
  return search_->ask(question, answer);
}

std::variant<Answer, std::string> ask(const Scene& scene, const Question& question) {
  Answer answer;
  Asker asker(scene);
  if (std::optional<std::string> text = asker.ask(question, answer)) return *text;
  return answer;
}

}  // namespace clearance
