// The search for the distance of one motion: over time and over the pairs of parts.
//
// A stretch of time keeps a list of the pairs that are not decided in it. Both halves of a stretch
// get this list. README.md has the method with its proof.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/ask/pair_bounds.hpp"
#include "monitor/ask/part_pairs.hpp"
#include "monitor/ask/posture.hpp"
#include "monitor/interface/question.hpp"

namespace clearance {

class MotionSearch {
 public:
  // The scene must outlive it. Allocates all memory for the search.
  explicit MotionSearch(const Scene& scene);

  // Does what Asker::ask() does, for a question without payloads.
  [[nodiscard]] std::optional<std::string> ask(const Question& question, Answer& answer);

  // Calls use(variable) for all that moves a link, as Chains::for_each_variable() does.
  template <class Use>
  void for_each_variable(std::uint32_t object, const Use& use) const {
    posture_.chains().for_each_variable(object, use);
  }
  // Adds the levers of one of Scene::pairs. Returns what no stated error changes its distance by
  // more than, m; infinity: the pair has no link.
  [[nodiscard]] double add_levers(std::uint32_t pair, std::vector<Lever>& levers) const;
  // Whether a lower bound shows that a limit is kept, m. One of 0 demands that the bodies do not
  // touch, and one below 0 is that of a contact which is meant.
  [[nodiscard]] static bool proves(double lower, double limit) noexcept {
    return limit != 0.0 ? lower >= limit : lower > 0.0;
  }

 private:
  // A query is worth its time only if it may decide the pair. The motion that counts, along the
  // normal, is about this share of all.
  static constexpr double kShareAlongNormal = 0.25;
  // The first instant below a margin, and the end of a contact, are known to this, relative to the
  // duration.
  static constexpr double kInstant = 1e-7;
  // Shorter stretches are not divided for a pair whose bounds at an instant enclose the margin,
  // relative to the duration.
  static constexpr double kUnclear = 0x1p-8;
  [[nodiscard]] static bool is_below(double upper, double limit) noexcept {
    return limit != 0.0 ? upper < limit : upper <= 0.0;
  }
  // A stretch that waits in bounds_by_pair.cpp, and its pairs in waiting_.
  struct WaitingStretch {
    Stretch stretch;
    std::size_t begin = 0, end = 0;
    double width = kInfinity;  // m: no bound that matters is worse by more
    // The worst is first in the heap, and among equal ones the earliest.
    friend bool operator<(const WaitingStretch& a, const WaitingStretch& b) noexcept {
      return a.width != b.width ? a.width < b.width : a.stretch.from > b.stretch.from;
    }
  };
  struct WaitingPair {
    std::uint32_t pair = 0;     // PartPairs
    double lower = -kInfinity;  // m: over the stretch
    bool seeks_least = true;    // its least distance, beside where its margin ends
  };
  // The first `count` pairs of a bundle, in the order of order_, are not decided.
  struct Open {
    std::uint32_t bundle = 0, count = 0;
  };
  // A list of these in open_.
  struct OpenList {
    std::size_t begin = 0, end = 0;
    [[nodiscard]] bool is_empty() const noexcept { return begin == end; }
  };
  // A pair of a zone with `separation`.
  struct SeparatedPair {
    std::uint32_t zone = 0, pair = 0;  // Scene::zones; PartPairs
    std::uint32_t robot = 0;           // the link that the zone limits
    std::uint32_t human = 0;           // the object that it comes near
    double margins = 0.0;              // m
    double human_speed = 0.0;          // m/s
  };
  // A stretch of the profile.
  struct Piece {
    Stretch stretch;
    ProfilePoint point;
    bool divides = true;
    double stated = 0.0;  // m: the part of its width that stated errors make
    [[nodiscard]] double width() const noexcept { return point.upper - point.lower - stated; }
    // The widest piece is first in the heap, and among equally wide ones the earliest.
    friend bool operator<(const Piece& a, const Piece& b) noexcept {
      const double wide_a = a.divides ? a.width() : -1.0;
      const double wide_b = b.divides ? b.width() : -1.0;
      return wide_a != wide_b ? wide_a < wide_b : a.point.from > b.point.from;
    }
  };
  // A contact that is meant between two objects, first < second.
  struct Meant {
    std::uint32_t first = 0, second = 0;
    double least_allowed = 0.0;                      // m: minus the depth
    double until = kInfinity, distance = kInfinity;  // s, m: its ends
    double near_until = kInfinity;                   // s: the instant at which its distance ends it
  };
  // What is known of the least distance: of all pairs, or of one pair of objects.
  struct Least {
    double closed = kInfinity;  // m: the lower bound of all stretches that are decided
    // The least lower bound that an instant so far allows at all, m. It is below the upper one
    // where the model has stated errors.
    double reached = kInfinity;
  };
  // A part pair at the present instant.
  struct Pair {
    const PosedPart& base;
    const PosedPart& tip;
    const ObjectApproach& approach;  // of the base, and what both may come nearer
    double loss;  // m: the distance over the stretch is at least that at the middle less this
  };

  [[nodiscard]] std::optional<std::string> fault(const Question& question) const;
  void begin(const Question& question, Answer& answer);
  [[nodiscard]] OpenList all_pairs() noexcept;
  void place(const Stretch& stretch, double at) noexcept;
  [[nodiscard]] Pair pair_at(std::uint32_t pair, const TipMotion& motion) noexcept;
  // Sorts out the far ones of the first `count` pairs of a bundle, and returns how many are left. A
  // pair is far if the spheres around its parts show that its distance over the stretch is above
  // `enough`, m. They show so by far more than all roundings. Most pairs end here.
  [[nodiscard]] std::uint32_t near_ones(const Bundle& bundle, std::uint32_t count,
                                        const TipMotion& motion, double enough) noexcept;
  [[nodiscard]] double gap(const Pair& at, std::uint32_t pair, double enough) const noexcept;
  [[nodiscard]] PairAtMiddle query(const Pair& at, std::uint32_t pair) noexcept;
  [[nodiscard]] const Bundle& bundle_of(std::uint32_t pair) const noexcept {
    return pairs_.bundles()[pairs_.pairs()[pair].bundle];
  }
  void note_upper(const PairAtMiddle& found, double upper, double at, std::uint32_t pair) noexcept;
  void note_pair(std::uint32_t pair, std::uint32_t& first, std::uint32_t& second) const noexcept;
  [[nodiscard]] bool can_divide(const Stretch& stretch, double middle) const noexcept;
  [[nodiscard]] bool is_exhausted() const noexcept {
    return answer_->queries + answer_->placements >= question_->work_limit;
  }

  // Each pair of objects has its own least distance and its own margin.
  [[nodiscard]] bool is_by_pair() const noexcept { return !question_->margins_by_pair.empty(); }
  [[nodiscard]] Least& least_of(std::uint32_t pair) noexcept {
    return leasts_[is_by_pair() ? watched_[pair] : 0];
  }

  // The least distance (least_distance.cpp).
  void find_least();
  void seed_upper(const OpenList& all) noexcept;
  [[nodiscard]] bool is_as_good_as_at_middle(double lower, double model_error,
                                             const PairAtMiddle& found,
                                             const Pair& at) const noexcept;
  void minimise(const Stretch& stretch, const OpenList& list, double known) noexcept;

  // Each pair of objects by itself (bounds_by_pair.cpp).
  void make_room_by_pair();
  void bound_by_pair() noexcept;
  void wait_for_all() noexcept;
  [[nodiscard]] KnownBound known_of(std::size_t objects) const noexcept;  // Scene::pairs
  void examine(const WaitingStretch& waiting) noexcept;
  void bound_over(const Stretch& stretch, double middle, const Pair& at, const Bundle& bundle,
                  const TipMotion& motion, WaitingPair& of) noexcept;
  void close(const Stretch& stretch, const WaitingPair& of) noexcept;
  [[nodiscard]] double margin_of(std::uint32_t pair) const noexcept {
    return question_->margins_by_pair[watched_[pair]];
  }
  [[nodiscard]] double enough_for_least(std::uint32_t pair) noexcept;
  [[nodiscard]] bool seeks_first(const Stretch& stretch, const WaitingPair& of) const noexcept;

  // Contacts that are meant (meant_contacts.cpp).
  [[nodiscard]] std::optional<std::string> take_contacts(const Question& question);
  void take_contacts_of_scene();
  void end_contacts() noexcept;
  [[nodiscard]] bool stays_near(const Stretch& stretch, std::uint32_t contact) noexcept;
  // The distance that a pair has to keep up to an instant of a placed stretch, its end or its
  // middle, m: a margin, or less for a contact.
  [[nodiscard]] double limit_until(double instant, bool is_middle, std::uint32_t pair,
                                   double margin) const noexcept {
    if (!exempt_.empty() && exempt_[pair] != 0) return -kInfinity;
    if (contacts_.empty() || contact_of_[pair] == kNotMeant) return margin;
    const Meant& meant = contacts_[contact_of_[pair]];
    const bool is_allowed =
        instant <= meant.near_until && posture_.latest(instant, is_middle) <= meant.until;
    return is_allowed ? meant.least_allowed : margin;
  }

  // The margins (first_below.cpp).
  void decide_margins();
  void decide(MarginAnswer& answer) noexcept;
  // A margin counts for no other pairs from now on; all pairs: none is exempt.
  void exempt_kept(double margin);
  void exempt_all_but(const MarginBetween& margin);
  [[nodiscard]] bool is_asked_about(std::uint32_t first, std::uint32_t second) const noexcept;
  void mark(const std::vector<std::uint32_t>& pairs, std::uint8_t value);  // of objects; in exempt_
  void find_first(const Stretch& stretch, const OpenList& list, MarginAnswer& answer) noexcept;
  void find_first_in_halves(const Stretch& stretch, double middle, const OpenList& list,
                            MarginAnswer& answer) noexcept;

  // The distance over time (profile.cpp).
  void make_profile(const ProfileRequest& request);
  void bound_piece(Piece& piece) noexcept;
  [[nodiscard]] bool is_in_profile(const ProfileRequest& request,
                                   std::uint32_t pair) const noexcept;

  // Time scaling (time_scaling.cpp).
  void collect_separated();
  [[nodiscard]] std::optional<std::string> fault_of_scaling() const;
  void scale_time();
  void scale(const Stretch& stretch, std::size_t count, double known) noexcept;
  void scale_stops();
  [[nodiscard]] Verdict stops_scaled(double factor, MarginAnswer& limit);

  const Scene& scene_;
  Posture posture_;
  PartPairs pairs_;
  std::vector<std::uint32_t> order_;  // indices of pairs, bundle by bundle
  std::vector<Open> open_;            // the lists of all levels, one after the other
  std::vector<WaitingStretch> stretches_;
  std::vector<WaitingPair> waiting_;
  std::vector<Piece> pieces_;  // a heap
  OpenList profiled_;
  ObjectApproach approach_;  // of the last pair_at(), if it is not the object's own
  std::vector<SeparatedPair> separated_;
  std::vector<std::uint32_t> scaled_;  // indices into separated_

  static constexpr std::uint32_t kNotMeant = ~0u;
  std::vector<Meant> contacts_;            // in ascending order of objects
  std::vector<std::uint32_t> contact_of_;  // by pair of parts, unless there is no contact

  std::vector<std::uint8_t> exempt_;  // by pair of parts: the margin does not count; empty: none is
  // By margin, the pairs of objects that no posture keeps it for. They depend on the scene alone.
  std::map<double, std::vector<std::uint32_t>> kept_;

  const Question* question_ = nullptr;
  Answer* answer_ = nullptr;
  double duration_ = 0.0;
  std::vector<Least> leasts_;           // one, or by Scene::pairs
  std::vector<std::uint32_t> watched_;  // by pair of parts: index into Scene::pairs
  bool found_ = false;                  // an instant below the margin is known
  bool uncertain_ = false;              // a stretch is known that is not proven to be above
  double proven_until_ = 0.0;           // s: before this, a larger margin was proven
  // Margins are of stops at lower speeds, so that the bounds of the answer are not theirs.
  bool only_stops_ = false;
};

}  // namespace clearance
