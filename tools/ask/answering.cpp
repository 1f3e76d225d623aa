#include "tools/ask/answering.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <istream>
#include <ostream>
#include <utility>
#include <variant>

#include "config/text/sentences.hpp"
#include "monitor/app/print.hpp"
#include "monitor/app/program.hpp"
#include "monitor/ask/completion.hpp"
#include "monitor/intake/ros_joint_trajectory.hpp"
#include "monitor/pairs/kept_near.hpp"
#include "tools/ask/bag_inputs.hpp"
#include "tools/ask/motion_json.hpp"
#include "tools/cases/case.hpp"
#include "tools/shared/named_distance.hpp"

namespace clearance {
namespace {

using OrderedJson = nlohmann::ordered_json;

double percentile(std::vector<double>& sorted, double share) {
  const auto at = static_cast<std::size_t>(share * static_cast<double>(sorted.size()));
  return sorted[std::min(at, sorted.size() - 1)];
}

}  // namespace

Answering::Answering(const AskOptions& options)
    : options_(options),
      report_(options.files,
              fmt::format("{} in {}{}{}", options.motions, options.cell,
                          options.without.empty() ? "" : ", without ",
                          fmt::join(options.without, ", ")),
              options.expected) {
  defaults_.tolerance = options.tolerance;
  defaults_.only_margins = defaults_.only_verdicts = options.only_verdicts;
  if (options.others_still) defaults_.others = OthersMove::kNot;
  defaults_.stoppable = options.stoppable;
  for (const std::string& name : options.without)
    defaults_.seen.push_back({.sensor = name, .is_known = false});
  if (options.files.any()) defaults_.profile.emplace();
}

std::string Answering::read_margins() {
  defaults_.margins.clear();
  for (const std::string& text : options_.margins) {
    double plain = 0.0;
    const char* const end = text.data() + text.size();
    if (std::from_chars(text.data(), end, plain).ptr == end && plain >= 0.0) {
      defaults_.margins.push_back(plain);
      continue;
    }
    auto found = read_named_distance(text);
    if (const auto* wrong = std::get_if<std::string>(&found)) return "--margin: " + *wrong;
    auto& named = std::get<NamedDistance>(found);
    if (!named.metres || *named.metres < 0.0)
      return "--margin: found '" + text + "'; expected m from 0 on, or A,B=0.05, or ZONE=0.05";
    defaults_.margins_between.push_back({std::move(named.a), std::move(named.b), *named.metres});
  }
  return {};
}

bool Answering::read() {
  if (std::filesystem::is_directory(options_.cell)) return true;
  return add("", options_.cell);
}

std::string Answering::begin_report() { return report_.begin(); }

int Answering::answer_all(std::istream& in, std::ostream& out) {
  std::size_t number = 0;
  for (std::string text; std::getline(in, text);) {
    ++number;
    if (text.find_first_not_of(" \t\r") == std::string::npos) continue;
    AskedMotion motion{.where = std::to_string(number)};
    try {
      const nlohmann::json line = parse_line(text);
      if (line.contains("id")) motion.id = line["id"];
      motion.question = read_question(line, defaults_);
      motion.place = &place_of(line);
    } catch (const BadLine& error) {
      motion.error = error.what();
    } catch (const nlohmann::json::exception& error) {
      motion.error = std::string("not a motion: ") + error.what();
    }
    take(std::move(motion), out);
  }
  return conclude(in.bad() ? "cannot read " + options_.motions : "", "a JSON object a line", out);
}

int Answering::answer_bag(std::ostream& out) {
  std::vector<BagMotion> motions;
  const std::string damage = read_motions(options_.motions, motions);
  const std::string error = answer(motions, out);
  return conclude(damage.empty() ? error : damage,
                  "messages of trajectory_msgs/msg/JointTrajectory", out);
}

std::string Answering::answer(const std::vector<BagMotion>& motions, std::ostream& out) {
  if (motions.empty()) return "";
  std::size_t done = 0;
  const auto take_next = [&](AskedPlace& place) -> AskedMotion {
    const std::string& id = motions[done++].id;
    return {.where = id, .id = id, .place = &place, .question = defaults_};
  };
  const std::string error = for_each_inputs(
      places_.at("")->cell, options_.motions, motions, [&](std::size_t i, InputsOfMotion inputs) {
        AskedMotion motion = take_next(place_of(inputs.cell));
        auto made = motion_of(motions[i].topic, motions[i].cdr, CdrBytes::kUnchecked,
                              motion.scene(), inputs.state);
        if (auto* const reason = std::get_if<std::string>(&made)) {
          motion.error = std::move(*reason);
        } else {
          motion.question.motion = std::get<JointTrajectory>(std::move(made));
          motion.start_deviation =
              start_deviation(motion.scene(), inputs.state, motion.question.motion).deviation;
          motion.error =
              complete(motion.scene(), inputs.state, std::move(inputs.frames), motion.question)
                  .value_or("");
        }
        take(std::move(motion), out);
      });
  while (done < motions.size()) {
    AskedMotion motion = take_next(*places_.at(""));
    motion.error = "the bag has no inputs at or after this motion; expected some";
    take(std::move(motion), out);
  }
  return error;
}

AskedPlace& Answering::place_of(const Cell& cell) {
  AskedPlace& first = *places_.at("");
  if (cell.scene.revision == first.cell.scene.revision) return first;
  auto& place = places_[std::to_string(cell.scene.revision)];
  if (place == nullptr) place = std::make_unique<AskedPlace>(Cell(cell));
  return *place;
}

void Answering::take(AskedMotion motion, std::ostream& out) {
  ++lines_;
  // After what the motion itself states.
  if (options_.expected) motion.question.margins.push_back(*options_.expected);
  if (options_.threads > 1) {
    waiting_.push_back(std::move(motion));
    if (waiting_.size() >= kWaitingForThread * options_.threads) answer_waiting(out);
    return;
  }
  if (motion.error.empty()) ask(motion);
  write(motion, out);
}

void Answering::ask(AskedMotion& motion) {
  double least_us = 1e300;
  for (int i = 0; i < options_.repeat; ++i) {
    const auto start = std::chrono::steady_clock::now();
    motion.error = motion.place->asker.ask(motion.question, motion.answer).value_or("");
    if (!motion.error.empty()) return;
    const std::chrono::duration<double, std::micro> taken =
        std::chrono::steady_clock::now() - start;
    least_us = std::min(least_us, taken.count());
  }
  times_us_.push_back(least_us);
}

void Answering::answer_waiting(std::ostream& out) {
  std::map<AskedPlace*, std::vector<std::size_t>> by_place;
  for (std::size_t i = 0; i < waiting_.size(); ++i) {
    if (waiting_[i].error.empty()) by_place[waiting_[i].place].push_back(i);
  }
  for (const auto& [place, indices] : by_place) {
    std::vector<Question> questions;
    for (const std::size_t i : indices) questions.push_back(std::move(waiting_[i].question));
    std::vector<Answer> answers(indices.size());
    std::vector<std::string> faults(indices.size());
    ask_all(place->cell.scene, questions, answers, faults, options_.threads);
    for (std::size_t k = 0; k < indices.size(); ++k) {
      AskedMotion& motion = waiting_[indices[k]];
      motion.question = std::move(questions[k]);
      motion.answer = std::move(answers[k]);
      motion.error = std::move(faults[k]);
    }
  }
  for (AskedMotion& motion : waiting_) write(motion, out);
  waiting_.clear();
}

void Answering::write(AskedMotion& motion, std::ostream& out) {
  OrderedJson line;
  if (motion.error.empty()) {
    if (!motion.id.is_null()) line["id"] = motion.id;
    line.update(answer_line(motion.answer, motion.scene(), motion.question));
    if (motion.start_deviation) line["start_deviation"] = *motion.start_deviation;
    for (const MarginAnswer& margin : motion.answer.margins)
      undecided_ += margin.verdict == Verdict::kUndecided ? 1 : 0;
    expect(motion);
  } else {
    if (bad_++ == 0) print(stderr, "{}:{}: {}\n", options_.motions, motion.where, motion.error);
    const bool is_of_bag =
        motion.id.is_string() && motion.id.get_ref<const std::string&>() == motion.where;
    if (is_of_bag) {
      line["id"] = motion.id;
    } else {
      line["line"] = std::stoull(motion.where);
    }
    line["error"] = motion.error;
  }
  out << line.dump(-1, ' ', false, OrderedJson::error_handler_t::replace) << '\n';
  report_.add(motion);
}

int Answering::conclude(std::string error, const std::string& expected, std::ostream& out) {
  answer_waiting(out);
  out.flush();
  if (error.empty() && lines_ == 0)
    error = options_.motions + " has no motion; expected " + expected;
  if (error.empty() && !out) error = "could not write all answers to " + options_.out;
  if (error.empty()) error = report_.finish();
  if (!error.empty()) {
    print(stderr, "clearance-ask: {}\n", error);
    return kUsage;
  }
  summarise();
  if (bad_cells_ > 0) return kBadCell;
  return bad_ + failed_ > 0 ? kFailed : kOk;
}

bool Answering::add(const std::string& scene, const std::filesystem::path& file) {
  std::optional<Cell> cell = cell_or_errors(read_cell(file, told_on_stderr()));
  if (!cell) return false;
  std::vector<double> margins = defaults_.margins;
  if (options_.expected) margins.push_back(*options_.expected);
  for (const double margin : margins) {
    const std::vector<std::uint32_t> kept = kept_nearer(cell->scene, margin);
    if (!kept.empty()) print(stderr, "{}\n", kept_nearer_text(cell->scene, margin, kept));
  }
  places_[scene] = std::make_unique<AskedPlace>(std::move(*cell));
  return true;
}

AskedPlace& Answering::place_of(const nlohmann::json& motion) {
  if (!std::filesystem::is_directory(options_.cell)) return *places_.at("");
  const std::string scene = motion.at("scene").get<std::string>();
  const auto found = places_.find(scene);
  if (found != places_.end()) return *found->second;
  const std::filesystem::path file = std::filesystem::path(options_.cell) / (scene + ".yaml");
  if (!add(scene, file)) {
    ++bad_cells_;
    throw BadLine("the cell " + file.string() + " cannot be read");
  }
  return *places_.at(scene);
}

void Answering::expect(AskedMotion& motion) {
  const Answer& answer = motion.answer;
  if (!options_.expected || answer.margins.empty()) return;
  const MarginAnswer& margin = answer.margins[motion.question.margins.size() - 1];
  if (margin.verdict == Verdict::kFree) return;
  ++failed_;
  motion.as_expected = false;
  print(stderr, "{}: {} - {} {} {} m from {} s on; the least distance is in [{:.6f}, {:.6f}] m\n",
        motion.name(), object_name(motion.scene(), motion.question, margin.first),
        object_name(motion.scene(), motion.question, margin.second),
        margin.verdict == Verdict::kBelow ? "comes below" : "may come below", margin.margin,
        margin.above_until, answer.lower, answer.upper);
}

void Answering::summarise() {
  std::sort(times_us_.begin(), times_us_.end());
  print(stderr, "{}, {} with errors, {} undecided", counted(lines_, "motion"), bad_,
        counted(undecided_, "verdict"));
  if (options_.expected) print(stderr, ", {} not as expected", failed_);
  if (!times_us_.empty()) {
    print(stderr, "; p50 {:.1f} us, p99 {:.1f} us, max {:.1f} us a motion",
          percentile(times_us_, 0.5), percentile(times_us_, 0.99), times_us_.back());
  }
  print(stderr, "\n");
}

}  // namespace clearance
