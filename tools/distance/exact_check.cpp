#include "tools/distance/exact_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>

#include "config/text/sentences.hpp"
#include "core/distance.hpp"
#include "core/numerics/error_constants.hpp"
#include "monitor/app/print.hpp"
#include "tools/cases/rational.hpp"

namespace clearance {
namespace {

using Json = nlohmann::json;
using OrderedJson = nlohmann::ordered_json;

// Exact answers are right to 30 digits.
const Rational& digits_left_out() {
  static const Rational share = *rational_from("1e-29");
  return share;
}

// The measure of two points in the origins of their frames, where any error is too large.
constexpr double kLeastScale = std::numeric_limits<double>::min();

ExactNumber exact_number(const Json& value, const char* key) {
  const std::string text = value.is_string() ? value.get<std::string>() : "";
  const auto number = rational_from(text);
  if (!number)
    throw BadLine(fmt::format("{}: expected an exact number as text, as \"0.0625\"", key));
  return {*number, text};
}

bool is_finite(const Json& value) {
  return value.is_number() && std::isfinite(value.get<double>());
}

RationalPoint exact_point(const OrderedJson& list) {
  return {Rational(list[0].get<double>()), Rational(list[1].get<double>()),
          Rational(list[2].get<double>())};
}

// The largest violation of a body's half-spaces by a point, m; 0: it is inside.
double outside(const Json& rows, const RationalPoint& in_body_frame) {
  double worst = 0.0;
  for (const Json& row : rows) {
    Rational over = -Rational(row[3].get<double>()), square = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Rational n(row[i].get<double>());
      over += n * in_body_frame[i];
      square += n * n;
    }
    if (over > 0) worst = std::max(worst, over.get_d() / root_of(square));
  }
  return worst;
}

// World coordinates are doubles; no point can be given more precisely than this, m.
double rounding_of(const RationalPoint& point) {
  return 0x1p-53 * root_of(squared_distance(point, {0, 0, 0}));
}

// Bodies without half-spaces, or with a radius, are not checked.
bool has_rows(const Json& body) {
  return body.contains("halfspaces") && body["halfspaces"].is_array() &&
         body.value("radius", 0.0) == 0.0;
}

// The shortest text that reads back as the same double.
std::string shown(double value) {
  std::array<char, 40> text;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

// The length that the gap between bounds is relative to, m: both bounding radii plus the distance
// of the origins. For an unbounded body, the radius is the largest distance at which its closest
// points may lie.
double size_of(const DistanceCase& asked, std::size_t pose, double farthest) {
  const auto& [world_from_a, world_from_b] = asked.poses[pose];
  const double apart = (world_from_b.position - world_from_a.position).norm();
  const double radius_a = asked.a.bounding_radius + asked.a.radius;
  const double radius_b = asked.b.bounding_radius + asked.b.radius;
  const auto radius = [&](const ConvexBody& body, double own, double of_other) {
    return body.bounded() ? own : std::max(own, of_other + apart + farthest);
  };
  return radius(asked.a, radius_a, radius_b) + radius(asked.b, radius_b, radius_a) + apart;
}

// The entry of a motion, or the value itself for a single pose.
const OrderedJson& entry(const OrderedJson& answer, const char* key, std::size_t k, bool motion) {
  return motion ? answer[key][k] : answer[key];
}

}  // namespace

// One pose of a case.
struct ExactCheck::Question {
  const Json& line;
  const Pose& pose_a;
  const Pose& pose_b;
  ExactNumber distance;
  std::optional<ExactNumber> penetration;
  double scale, size;
  bool promises_near_bounds;  // one of the bodies is bounded; two unbounded ones only have true
                              // bounds
};

// The answer to it, and the faults of the answer.
class ExactCheck::Judge {
 public:
  Judge(const Question& question, double tolerance, double widest)
      : question_(question),
        tolerance_(tolerance),
        widest_(widest),
        measure_(std::max(question.distance.value.get_d(), question.scale)) {}

  void judge_distance(const Json& distance, const Json& lower, const Json& upper,
                      const std::string& status) {
    const Rational& truth = question_.distance.value;
    const Rational slack = truth * digits_left_out();
    const std::string exact = fmt::format(", exactly {}", question_.distance.text);
    if (!is_finite(distance) || !is_finite(lower) || !is_finite(upper)) {
      faults.push_back("has no number for distance, lower and upper");
      return;
    }
    const double d = distance.get<double>();
    const Rational off = abs(Rational(d) - truth);
    figures.error = off.get_d() / measure_;
    judge_gap(lower.get<double>(), upper.get<double>());
    if (figures.error > tolerance_) faults.push_back(fmt::format("distance {}{}", shown(d), exact));
    if (Rational(lower.get<double>()) > truth + slack) {
      faults.push_back(fmt::format("lower bound {}{}", shown(lower.get<double>()), exact));
    }
    if (Rational(upper.get<double>()) < truth - slack) {
      faults.push_back(fmt::format("upper bound {}{}", shown(upper.get<double>()), exact));
    }
    const bool stopped = status == name(DistanceStatus::kIterationLimit);
    if ((stopped && question_.promises_near_bounds) ||
        (status == name(DistanceStatus::kOverlapping) && truth > 0)) {
      faults.push_back(fmt::format("status {}{}", status, exact));
    }
  }

  void judge_depth(const Json& depth, const Json& lower, const Json& upper) {
    if (!question_.penetration) return;
    const Rational& exact = question_.penetration->value;
    const std::string text = fmt::format(", exactly {}", question_.penetration->text);
    if (!is_finite(depth) || !is_finite(lower) || !is_finite(upper)) {
      if (!question_.promises_near_bounds) return;
      faults.push_back(fmt::format("has no number for penetration and its bounds{}", text));
      return;
    }
    const Rational slack = exact * digits_left_out();
    judge_gap(lower.get<double>(), upper.get<double>());
    figures.depth = Rational(abs(Rational(depth.get<double>()) - exact)).get_d() / question_.scale;
    if (figures.depth > tolerance_) {
      faults.push_back(fmt::format("penetration {}{}", shown(depth.get<double>()), text));
    }
    if (Rational(lower.get<double>()) > exact + slack ||
        Rational(upper.get<double>()) < exact - slack) {
      faults.push_back(fmt::format("penetration from {} to {}{}", shown(lower.get<double>()),
                                   shown(upper.get<double>()), text));
    }
  }

  void judge_witnesses(const OrderedJson& witness_a, const OrderedJson& witness_b,
                       double distance) {
    if (!std::ranges::all_of(witness_a, is_finite) || !std::ranges::all_of(witness_b, is_finite)) {
      faults.push_back("has no witness points");
      return;
    }
    const RationalPoint a = exact_point(witness_a), b = exact_point(witness_b);
    judge_inside("a", a, question_.pose_a);
    judge_inside("b", b, question_.pose_b);
    const double apart = std::abs(root_of(squared_distance(a, b)) - distance);
    const double over = std::max(0.0, apart - rounding_of(a) - rounding_of(b)) / measure_;
    figures.witness = std::max(figures.witness, over);
    if (over > tolerance_) {
      faults.push_back(fmt::format("the witness points are not {} apart, but off by {}",
                                   shown(distance), shown(apart)));
    }
  }

  Figures figures{.answers = 1};
  std::vector<std::string> faults;

 private:
  void judge_gap(double lower, double upper) {
    if (!question_.promises_near_bounds) return;
    const double gap = std::max(0.0, upper - lower - kUnderflow) / question_.size;
    figures.gap = std::max(figures.gap, gap);
    if (!(gap <= widest_)) {
      faults.push_back(fmt::format("bounds from {} to {}, {} of the bodies' size apart",
                                   shown(lower), shown(upper), shown(gap)));
    }
  }

  void judge_inside(const char* which, const RationalPoint& point, const Pose& world_from_body) {
    const Json& body = question_.line[which];
    if (!has_rows(body)) return;
    const double out = outside(body["halfspaces"], in_body(world_from_body, point));
    const double over = std::max(0.0, out - rounding_of(point)) / measure_;
    figures.witness = std::max(figures.witness, over);
    if (over > tolerance_) {
      faults.push_back(fmt::format("witness_{} is {} outside of {}", which, shown(out), which));
    }
  }

  const Question& question_;
  double tolerance_, widest_;
  double measure_;  // errors of distance and points are relative to this, m
};

void ExactCheck::Figures::add(const Figures& other) {
  answers += other.answers;
  wrong += other.wrong;
  error = std::max(error, other.error);
  gap = std::max(gap, other.gap);
  witness = std::max(witness, other.witness);
  depth = std::max(depth, other.depth);
}

std::vector<std::string> ExactCheck::faults(const Json& line, const DistanceCase& asked,
                                            const OrderedJson& answer) {
  const char* const key = asked.motion ? "distances" : "distance";
  if (!line.contains(key)) {
    ++without_;
    return {};
  }
  const Json& exact = line[key];
  const Json& depths = line.value(asked.motion ? "penetrations" : "penetration", Json());
  if (asked.motion && (!exact.is_array() || exact.size() != asked.poses.size())) {
    throw BadLine("distances: expected one a pose");
  }
  const double reach = std::max(asked.a.bounding_radius, asked.b.bounding_radius);
  std::vector<std::string> all;
  for (std::size_t k = 0; k < asked.poses.size(); ++k) {
    const Json& depth = asked.motion && depths.is_array() ? depths.at(k) : depths;
    Question question{
        line,
        asked.poses[k].first,
        asked.poses[k].second,
        exact_number(asked.motion ? exact[k] : exact, key),
        depth.is_null() ? std::optional<ExactNumber>() : exact_number(depth, "penetration"),
        std::max(line.value("scale", reach), kLeastScale),
        0.0,
        asked.a.bounded() || asked.b.bounded()};
    const double deep = question.penetration ? question.penetration->value.get_d() : 0.0;
    question.size =
        std::max(size_of(asked, k, question.distance.value.get_d() + deep), kLeastScale);
    const auto given = [&](const char* name) { return entry(answer, name, k, asked.motion); };
    Judge judge(question, tolerance_, widest_);
    judge.judge_distance(given("distance"), given("lower"), given("upper"), given("status"));
    judge.judge_depth(given("penetration"), given("penetration_lower"), given("penetration_upper"));
    if (judge.faults.empty()) {
      judge.judge_witnesses(given("witness_a"), given("witness_b"), given("distance"));
    }
    judge.figures.wrong = judge.faults.empty() ? 0 : 1;
    families_[line.value("family", "cases")].add(judge.figures);
    for (const std::string& fault : judge.faults) {
      all.push_back((asked.motion ? fmt::format("pose {}: ", k) : "") + fault);
    }
  }
  return all;
}

ExactCheck::Figures ExactCheck::total() const {
  Figures sum;
  for (const auto& [family, figures] : families_) sum.add(figures);
  return sum;
}

void ExactCheck::print_row(const std::string& name, const Figures& figures) {
  print(stderr, "{:<20} {:8} {:9.1e} {:9.1e} {:9.1e} {:9.1e} {:6}\n", name, figures.answers,
        figures.error, figures.gap, figures.witness, figures.depth, figures.wrong);
}

void ExactCheck::print_summary() const {
  print(stderr,
        "{:<20} {:>8} {:>9} {:>9} {:>9} {:>9} {:>6}   largest, over the scale; gap over the size\n",
        "family", "answers", "error", "gap", "witness", "depth", "wrong");
  for (const auto& [family, figures] : families_) print_row(family, figures);
  const Figures sum = total();
  print_row("all", sum);
  if (without_ > 0) print(stderr, "{} carried no exact answer\n", counted(without_, "line"));
  print(stderr, "{}\n",
        sum.answers == 0 ? "nothing was checked"
        : sum.wrong == 0
            ? "every bound holds and is as near as promised, every answer is within the "
              "tolerance"
            : "some answers are wrong");
}

bool ExactCheck::good() const {
  const Figures sum = total();
  return sum.answers > 0 && sum.wrong == 0;
}

}  // namespace clearance
