#include "tests/monitor/adversary/lying_commands.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace clearance::test::lies {
namespace {

constexpr const char* kPart = "part";
constexpr const char* kTaken = "ball2";  // the ball that is absent for a time
constexpr std::size_t kTakenBody = 2;

Vec3 vec(const std::array<double, 3>& p) { return {p[0], p[1], p[2]}; }

}  // namespace

LyingCommands::LyingCommands(const Cell& cell, const TrueMotion& truth,
                             const std::vector<Fault>& faults)
    : first_(cell), truth_(truth) {
  const auto found = std::ranges::find(faults, Channel::kCommands, &Fault::channel);
  if (found == faults.end()) return;
  fault_ = &*found;
  auto opened = CellEditor::open(cell.yaml, cell.file);
  editor_.emplace(std::get<CellEditor>(std::move(opened)));
}

std::int64_t LyingCommands::due(std::size_t change) const noexcept {
  return change == 0 ? fault_->from : fault_->to;
}

const Cell& LyingCommands::in_force() const noexcept {
  const Cell* cell = &first_;
  auto offer = offers_.begin();
  for (const Cell& each : cells_)
    if ((offer++)->state() == Successor::State::kSucceeded) cell = &each;
  return *cell;
}

std::optional<std::int64_t> LyingCommands::waits_since(std::int64_t t) const noexcept {
  if (fault_ == nullptr) return std::nullopt;
  const std::size_t next =
      cells_.empty() || &in_force() == &cells_.back() ? cells_.size() : cells_.size() - 1;
  return next < 2 && t >= due(next) ? std::optional(due(next)) : std::nullopt;
}

std::size_t LyingCommands::moved_body() const noexcept {
  if (fault_ == nullptr) return kBodies;
  if (fault_->lie == Lie::kAbsent) return kTakenBody;
  return fault_->lie == Lie::kAttached ? kPartBody : kBodies;
}

// Poses are stated: those of the monitor are as old as its inputs.
CellChange LyingCommands::change(bool is_first) const {
  switch (fault_->lie) {
    case Lie::kAttached:
      if (is_first)
        return Attach{
            .object = kPart,
            .to = "arm_tip",
            .carrier_from_object = Pose{vec(kTipFromPart), Eigen::Quaterniond::Identity()}};
      return Detach{.object = kPart,
                    .world_from_object = Pose{truth_.centres(fault_->to)[kPartBody].cast<double>(),
                                              Eigen::Quaterniond::Identity()}};
    case Lie::kAbsent:
      return SetAbsent{.object = kTaken, .absent = is_first};
    case Lie::kUnwatched:
      if (is_first)
        return SetPair{
            .a = "arm", .b = kTaken, .rule = SetPair::Rule::kLeaveOut, .reason = "trial"};
      return SetPair{.a = "arm", .b = kTaken, .rule = SetPair::Rule::kNoException};
    default:
      if (is_first)
        return AllowContact{.contact = "trial",
                            .a = "ball1",
                            .b = kTaken,
                            .depth = 0.02,
                            .by = "trial",
                            .reason = "trial"};
      return WithdrawContact{.contact = "trial"};
  }
}

// A command that names what is not there changes nothing.
Cell LyingCommands::changed() {
  const std::array misspelt{
      CellChange(Attach{.object = kPart, .to = "arm_tpi", .carrier_from_object = Pose{}})};
  EXPECT_TRUE(std::holds_alternative<EditRefusal>(editor_->edit(misspelt)));
  const std::array changes{change(cells_.empty())};
  auto edited = editor_->edit(changes);
  if (const auto* refused = std::get_if<EditRefusal>(&edited))
    ADD_FAILURE() << refused->path << ": " << refused->reason;
  return std::get<Cell>(std::move(edited));
}

void LyingCommands::work(std::int64_t t, TickLoop& loop, ReportSink& sink) {
  if (!offers_.empty()) offers_.back().catch_up();
  if (!waits_since(t) || loop.busy()) return;
  if (&in_force() == &(cells_.empty() ? first_ : cells_.back())) cells_.push_back(changed());
  offers_.emplace_back(loop.state(), cells_.back().scene, std::vector<ReportSink*>{&sink},
                       records_);
  EXPECT_TRUE(loop.offer(offers_.back()));
}

}  // namespace clearance::test::lies
