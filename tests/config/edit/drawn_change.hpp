// Draws changes of a cell at random: every kind, often possible, and often not.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "config/edit/cell_change.hpp"
#include "tests/shared/random.hpp"

namespace clearance::test {

inline constexpr std::size_t kChangeKinds = std::variant_size_v<CellChange>;

// The names that changes are drawn from. Some of them may be missing in the cell.
struct DrawnNames {
  // Names of the cell, and some that it lacks; names that changes add.
  std::vector<std::string> objects, added;
  std::vector<std::string> attached = {};  // objects that are attached, as far as that is known
  std::vector<std::string> carriers;       // what only carries: links
  std::vector<std::string> robots = {"no_robot"}, joints = {"no_joint"};
  std::vector<std::string> groups, templates, zones, contacts, sources;
  std::vector<std::string> cells, files;  // texts for ReplaceCell, files for ReadCellAgain
  std::vector<std::string> shapes;        // of objects that are added: "sphere: {radius: 50}"
  double length = 1.0;                    // the unit of lengths in the cell, m
  double most_speed = 2.0;                // of SetMaxSpeed, m/s
  double least_speed = -0.1;              // and the least one
};

class DrawnChange {
 public:
  DrawnChange(Random& random, const DrawnNames& names) : random_(random), names_(names) {}

  // A change of any kind: an overload of make() below draws each, so that none can be forgotten.
  [[nodiscard]] CellChange operator()() {
    std::size_t kind = below(kChangeKinds);
    const bool is_whole = std::holds_alternative<ReplaceCell>(of_kind(kind)) ||
                          std::holds_alternative<ReadCellAgain>(of_kind(kind));
    if (is_whole && below(4) != 0) kind = below(kChangeKinds);
    return of_kind(kind);
  }
  [[nodiscard]] CellChange of_kind(std::size_t kind) {
    return [&]<std::size_t... kinds>(std::index_sequence<kinds...>) {
      using Make = CellChange (*)(DrawnChange&);
      constexpr std::array<Make, kChangeKinds> kMake = {[](DrawnChange& self) -> CellChange {
        return self.make(std::type_identity<std::variant_alternative_t<kinds, CellChange>>());
      }...};
      return kMake[kind](*this);
    }
    (std::make_index_sequence<kChangeKinds>());
  }

 private:
  std::size_t below(std::size_t count) {
    return static_cast<std::size_t>(random_.integer(0, static_cast<int>(count) - 1));
  }
  bool one_in(std::size_t count) { return below(count) == 0; }
  const std::string& one_of(const std::vector<std::string>& list) {
    return list[below(list.size())];
  }
  const std::string& object() { return one_of(one_in(12) ? names_.added : names_.objects); }
  const std::string& carrier() { return one_in(2) ? one_of(names_.carriers) : object(); }
  const std::string& object_or_group() { return one_in(3) ? one_of(names_.groups) : object(); }
  // Now and then near the origin, where what is attached overlaps its carrier.
  Pose pose() {
    return {random_.in_box(one_in(4) ? 0.2 : 1.5),
            one_in(2) ? Eigen::Quaterniond::Identity() : random_.rotation()};
  }
  std::optional<Pose> maybe_pose() {
    return one_in(2) ? std::nullopt : std::optional<Pose>(pose());
  }
  std::optional<double> maybe(double value) {
    return one_in(3) ? std::nullopt : std::optional(value);
  }
  double in_cell(double metres) const { return metres / names_.length; }

  // An entry of `objects`, now and then one with a mistake.
  std::string entry() {
    const Vec3 p = random_.in_box(1.5);
    const std::string where =
        fmt::format("{{xyz: [{}, {}, {}]}}", in_cell(p.x()), in_cell(p.y()), in_cell(p.z()));
    std::string text = "{name: " + (one_in(3) ? object() : one_of(names_.added));
    if (!one_in(5)) text += ", groups: [" + one_of(names_.groups) + "]";
    switch (below(5)) {
      case 0:
        text += fmt::format(", fixed: true, pose: {}", where);
        break;
      case 1:
        text += fmt::format(", attached: {{to: {}, pose: {}}}", carrier(), where);
        break;
      case 2:
        text += fmt::format(", max_speed: {}, age_limit_ms: 30",
                            in_cell(random_.uniform(names_.least_speed, names_.most_speed)));
        break;
      case 3:
        text += ", absent: true";
        break;
      default:
        break;
    }
    if (one_in(4)) return text + ", template: " + one_of(names_.templates) + "}";
    if (one_in(12)) return text + "}";
    return text + ", " + one_of(names_.shapes) + "}";
  }

  CellChange make(std::type_identity<AddObject>) { return AddObject{entry()}; }
  CellChange make(std::type_identity<ReplaceObject>) { return ReplaceObject{entry()}; }
  CellChange make(std::type_identity<AddFromTemplate>) {
    return AddFromTemplate{
        one_of(names_.templates), one_in(8) ? object() : one_of(names_.added),
        one_in(3) ? std::vector{one_of(names_.groups)} : std::vector<std::string>{}, pose()};
  }
  CellChange make(std::type_identity<RemoveObject>) { return RemoveObject{object()}; }
  CellChange make(std::type_identity<SetAbsent>) { return SetAbsent{object(), one_in(2)}; }
  CellChange make(std::type_identity<Attach>) {
    return Attach{object(),
                  carrier(),
                  maybe_pose(),
                  one_in(2) ? std::vector{object_or_group()} : std::vector<std::string>{},
                  one_in(4) ? std::optional(random_.uniform(-0.01, 0.3)) : std::nullopt,
                  true};
  }
  CellChange make(std::type_identity<Detach>) {
    return Detach{names_.attached.empty() || one_in(4) ? object() : one_of(names_.attached),
                  maybe_pose()};
  }
  CellChange make(std::type_identity<AttachRobot>) {
    return AttachRobot{one_of(names_.robots), carrier(), maybe_pose(), maybe(0.01), one_in(2)};
  }
  CellChange make(std::type_identity<DetachRobot>) {
    std::vector<JointPosition> joints;
    if (one_in(2)) joints.push_back({one_of(names_.joints), random_.uniform(-0.1, 1.0)});
    return DetachRobot{one_of(names_.robots), maybe_pose(), joints, one_in(2), one_in(4)};
  }
  CellChange make(std::type_identity<Place>) { return Place{object(), pose()}; }
  CellChange make(std::type_identity<SetMaxSpeed>) {
    return SetMaxSpeed{object(), maybe(random_.uniform(names_.least_speed, names_.most_speed))};
  }
  CellChange make(std::type_identity<SetMargin>) {
    return SetMargin{object(), maybe(random_.uniform(-0.005, 0.05))};
  }
  CellChange make(std::type_identity<SetAgeLimit>) {
    const std::int64_t ms = 1'000'000;
    return SetAgeLimit{object(),
                       one_in(3) ? std::nullopt : std::optional(ms * random_.integer(-2, 30))};
  }
  CellChange make(std::type_identity<SetSource>) {
    return SetSource{object(), one_in(3) ? std::nullopt : std::optional(one_of(names_.sources))};
  }
  CellChange make(std::type_identity<SetPair>) {
    constexpr std::size_t kRules = static_cast<std::size_t>(SetPair::Rule::kNoException) + 1;
    return SetPair{object_or_group(), object_or_group(), static_cast<SetPair::Rule>(below(kRules)),
                   one_in(8) ? "" : "drawn"};
  }
  CellChange make(std::type_identity<SetZoneThresholds>) {
    const double enter = random_.uniform(-0.01, 0.3);
    return SetZoneThresholds{one_of(names_.zones), enter, enter + random_.uniform(-0.01, 0.1)};
  }
  CellChange make(std::type_identity<AllowContact>) {
    ContactEnd end;
    if (one_in(3)) end.distance = random_.uniform(-0.001, 0.3);
    if (one_in(3)) end.duration_ns = 1'000'000 * std::int64_t{random_.integer(0, 3000)};
    if (one_in(4)) end.time_ns = 1'700'000'000'123'456'789;
    if (one_in(4)) end.last_cycle = static_cast<std::uint64_t>(random_.integer(1, 100'000));
    return AllowContact{one_of(names_.contacts),
                        object_or_group(),
                        object_or_group(),
                        one_in(3) ? 0.02 : random_.uniform(-0.002, 0.1),
                        end,
                        "drawn",
                        "drawn"};
  }
  CellChange make(std::type_identity<WithdrawContact>) {
    return WithdrawContact{one_of(names_.contacts)};
  }
  CellChange make(std::type_identity<ReplaceCell>) { return ReplaceCell{one_of(names_.cells)}; }
  CellChange make(std::type_identity<Note>) { return Note{one_in(4) ? "" : "drawn"}; }
  CellChange make(std::type_identity<ReadCellAgain>) { return ReadCellAgain{one_of(names_.files)}; }

  Random& random_;
  const DrawnNames& names_;
};

}  // namespace clearance::test
