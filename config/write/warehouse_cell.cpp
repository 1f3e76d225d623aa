// Places racks, pallets and boxes row by row until the wanted number stands, then a robot station,
// then vehicles in the aisles. One seeded generator draws every random number in a fixed order, so
// the text depends on the options alone.
#include "config/write/warehouse_cell.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "config/write/seeded_draw.hpp"
#include "config/yaml/yaml_emitter.hpp"

namespace clearance {
namespace {

// Racks stand in rows along x, m.
constexpr double kBay = 2.8, kDepth = 1.1, kAisle = 3.2;
constexpr std::uint32_t kBaysInRow = 12, kPalletsInBay = 3, kBoxesOnPallet = 2;
constexpr std::uint32_t kLinks = 6;  // of the arm
constexpr double kMostSpeed = 1.5;   // m/s

// The parts of every rack, pallet, forklift and mobile robot: each list stands once in the file,
// under an anchor.
constexpr const char* kRackParts = R"(
- {name: post0, box: {size: [0.1, 0.1, 4]}, pose: {xyz: [-1.3, -0.5, 2]}}
- {name: post1, box: {size: [0.1, 0.1, 4]}, pose: {xyz: [1.3, -0.5, 2]}}
- {name: post2, box: {size: [0.1, 0.1, 4]}, pose: {xyz: [-1.3, 0.5, 2]}}
- {name: post3, box: {size: [0.1, 0.1, 4]}, pose: {xyz: [1.3, 0.5, 2]}}
- {name: shelf0, box: {size: [2.6, 1.0, 0.12]}, pose: {xyz: [0, 0, 0.2]}}
- {name: shelf1, box: {size: [2.6, 1.0, 0.12]}, pose: {xyz: [0, 0, 1.6]}}
- {name: shelf2, box: {size: [2.6, 1.0, 0.12]}, pose: {xyz: [0, 0, 3.0]}}
- {name: brace, capsule: {from: [-1.3, 0.5, 0.4], to: [1.3, 0.5, 3.8], radius: 0.03}})";
constexpr const char* kPalletParts = R"(
- {name: deck, box: {size: [0.8, 0.9, 0.03]}, pose: {xyz: [0, 0, 0.13]}}
- {name: runner0, box: {size: [0.8, 0.1, 0.1]}, pose: {xyz: [0, -0.4, 0.06]}}
- {name: runner1, box: {size: [0.8, 0.1, 0.1]}, pose: {xyz: [0, 0, 0.06]}}
- {name: runner2, box: {size: [0.8, 0.1, 0.1]}, pose: {xyz: [0, 0.4, 0.06]}})";
constexpr const char* kForkliftParts = R"(
- {name: body, box: {size: [1.2, 1.0, 0.8]}, pose: {xyz: [-0.3, 0, 0.55]}}
- {name: counterweight, prism: {base: [[-1.2, -0.4], [-0.9, -0.5], [-0.9, 0.5], [-1.2, 0.4]], z: [0.2, 1]}}
- {name: guard, box: {size: [0.9, 0.9, 0.06]}, pose: {xyz: [-0.4, 0, 2]}}
- {name: mast0, box: {size: [0.12, 0.1, 2.2]}, pose: {xyz: [0.4, -0.35, 1.2]}}
- {name: mast1, box: {size: [0.12, 0.1, 2.2]}, pose: {xyz: [0.4, 0.35, 1.2]}}
- {name: fork0, box: {size: [1.0, 0.12, 0.05]}, pose: {xyz: [0.9, -0.25, 0.15]}}
- {name: fork1, box: {size: [1.0, 0.12, 0.05]}, pose: {xyz: [0.9, 0.25, 0.15]}})";
constexpr const char* kRobotParts = R"(
- {name: base, prism: {base: [[0.45, 0.2], [0.2, 0.45], [-0.2, 0.45], [-0.45, 0.2], [-0.45, -0.2], [-0.2, -0.45], [0.2, -0.45], [0.45, -0.2]], z: [0.03, 0.35]}}
- {name: mast, capsule: {from: [-0.3, 0, 0.4], to: [-0.3, 0, 1.1], radius: 0.04}}
- {name: tray, box: {size: [0.5, 0.6, 0.04]}, pose: {xyz: [0.1, 0, 0.6]}})";

// A person is a capsule of 0.5 m width and 1.8 m height; a capsule stands upright in any heading.
constexpr const char* kPersonCapsule = "{from: [0, 0, 0.25], to: [0, 0, 1.55], radius: 0.25}";
// A link of the arm; the radius of its capsule is added for each link.
constexpr const char* kLinkParts = R"(
- {capsule: {from: [0, 0, 0.06], to: [0, 0, 0.2]}}
- {box: {size: [0.1, 0.14, 0.08]}, pose: {xyz: [0.05, 0, 0.08]}})";
// Pairs near the arm are published; others are reported when they are the minimum, or in a zone.
constexpr const char* kPairs = R"(
- {between: [arm, station]}
- {between: [moving, moving], publish: false}
- {between: [moving, standing], publish: false})";
// Adjacent links touch at their joint.
constexpr const char* kAllowed = R"(
- {between: [pedestal, link0], reason: mounted on it}
- {between: [pedestal, link1], reason: turns just above it}
- {between: [link0, link1], reason: adjacent}
- {between: [link1, link2], reason: adjacent}
- {between: [link2, link3], reason: adjacent}
- {between: [link3, link4], reason: adjacent}
- {between: [link4, link5], reason: adjacent})";
// Hysteresis of 2 to 20 cm keeps zones from flickering with the noise of the poses.
constexpr const char* kZones = R"(
- {name: slow, between: [people, vehicles], enter_below: 2, leave_above: 2.2}
- {name: aisle, between: [vehicles, standing], enter_below: 0.25, leave_above: 0.3}
- {name: stop, between: [arm, station], enter_below: 0.05, leave_above: 0.07})";

// The vehicles and people in the aisles.
enum class Kind : std::uint8_t { kForklift, kRobot, kPerson };

// One kind of moving object.
struct Vehicle {
  const char* name;
  const char* group;
  const char* shape;   // key of its shape
  double back, front;  // extents along -x and +x, m
};
// Extents are rounded up from the parts above.
constexpr Vehicle kVehicles[] = {{"forklift", "vehicles", "parts", 1.2, 1.4},
                                 {"robot", "vehicles", "parts", 0.5, 0.5},
                                 {"person", "people", "capsule", 0.3, 0.3}};

const Vehicle& vehicle(Kind kind) { return kVehicles[static_cast<std::size_t>(kind)]; }

// Makes [ITEM, ITEM, ...] on one line.
template <class... Items>
YAML::Node list(const Items&... items) {
  YAML::Node node(YAML::NodeType::Sequence);
  node.SetStyle(YAML::EmitterStyle::Flow);
  (node.push_back(items), ...);
  return node;
}

// Makes {KEY: VALUE, ...} on one line.
YAML::Node map_on_a_line() {
  YAML::Node node(YAML::NodeType::Map);
  node.SetStyle(YAML::EmitterStyle::Flow);
  return node;
}

// Makes the sections of the cell. Lists of parts are shared nodes, which the emitter writes once,
// under an anchor.
class Warehouse {
 public:
  explicit Warehouse(const WarehouseOptions& options) : options_(options), draw_(options.seed) {
    moving_ = std::max<std::uint32_t>(12, options.objects / 20);
    standing_ = options.objects - moving_;
  }

  // The order of the calls is the order of draws: changing it changes every warehouse.
  std::string yaml() {
    add_racks();
    add_station();
    add_vehicles();
    YAML::Node cell;
    cell["name"] = fmt::format("warehouse_{}", options_.objects);
    cell["units"] = YAML::Load("{length: m, angle: rad}");
    cell["defaults"] = YAML::Load("{max_speed: 2.5, age_limit_ms: 20}");
    cell["objects"] = objects_;
    cell["pairs"] = YAML::Load(kPairs);
    cell["allowed_collisions"] = YAML::Load(kAllowed);
    cell["zones"] = YAML::Load(kZones);
    cell["simulation"]["chains"].push_back(arm_);
    cell["simulation"]["movers"] = movers_;
    YAML::Emitter out;
    out << YAML::Comment(fmt::format("Generated by clearance-scene warehouse {} --seed {}.",
                                     options_.objects, options_.seed));
    out << cell << YAML::Newline;
    return out.c_str();
  }

 private:
  // Returns the end of the longest row, m.
  [[nodiscard]] double aisle_length() const {
    const double bays = std::min(rows_ > 1 ? kBaysInRow : bays_, kBaysInRow);
    return kBay * bays;
  }
  // The middle of a row of racks; the aisle is on its positive side.
  [[nodiscard]] static double row_y(std::uint32_t row) { return row * (kDepth + kAisle); }

  // A moving object; the caller adds its shape.
  YAML::Node object(const std::string& name, const YAML::Node& groups) {
    YAML::Node node;
    node["name"] = name;
    node["groups"] = groups;
    objects_.push_back(node);
    return node;
  }

  // A fixed object, rotated about the vertical; the caller adds its shape.
  YAML::Node stand(const std::string& name, double x, double y, double z, double yaw,
                   const YAML::Node& groups = list("standing")) {
    YAML::Node node = object(name, groups);
    node["fixed"] = true;
    node["pose"] = map_on_a_line();
    node["pose"]["xyz"] = list(decimals(x, 3), decimals(y, 3), decimals(z, 3));
    node["pose"]["rpy"] = list("0", "0", decimals(yaw, 3));
    ++stood_;
    return node;
  }

  // Whole edge lengths, m.
  static YAML::Node box(const std::string& x, const std::string& y, const std::string& z) {
    YAML::Node node = map_on_a_line();
    node["size"] = list(x, y, z);
    return node;
  }

  // Bay by bay until all but the station have been placed.
  void add_racks() {
    constexpr std::uint32_t kStation = 3;
    const std::uint32_t wanted = standing_ - kStation;
    while (stood_ < wanted) {
      const std::uint32_t row = bays_ / kBaysInRow, column = bays_ % kBaysInRow;
      rows_ = row + 1;
      add_bay(kBay * (column + 0.5), row_y(row), wanted);
      ++bays_;
    }
  }

  // A rack, and as many of its pallets and boxes as are still wanted. Heights are those of the
  // shelves.
  void add_bay(double x, double y, std::uint32_t wanted) {
    stand(fmt::format("rack{}", bays_), x, y, 0.0, 0.0)["parts"] = rack_parts_;
    for (std::uint32_t i = 0; i < kPalletsInBay && stood_ < wanted; ++i) {
      const double px = x + draw_.uniform(-0.7, 0.7), top = 0.27 + 1.4 * i;
      stand(fmt::format("pallet{}_{}", bays_, i), px, y, top, draw_.uniform(-0.05, 0.05))["parts"] =
          pallet_parts_;
      for (std::uint32_t k = 0; k < kBoxesOnPallet && stood_ < wanted; ++k) {
        const double height = draw_.uniform(0.2, 0.6);
        const double width = draw_.uniform(0.4, 0.7), length = draw_.uniform(0.25, 0.35);
        stand(fmt::format("box{}_{}_{}", bays_, i, k), px + (k == 0 ? -0.2 : 0.2), y,
              top + 0.16 + 0.5 * height, draw_.uniform(-0.04, 0.04))["box"] =
            box(decimals(length, 3), decimals(width, 3), decimals(height, 3));
      }
    }
  }

  // An arm on a pedestal behind the end of the first aisle, and the station that it picks from.
  void add_station() {
    const double x = aisle_length() + 2.5, y = row_y(0) + 0.5 * kAisle;
    const YAML::Node groups = list("standing", "station");
    stand("pedestal", x, y, 0.3, 0.0, groups)["box"] = box("0.4", "0.4", "0.6");
    stand("conveyor", x + 0.9, y, 0.25, 0.0, groups)["box"] = box("0.6", "3", "0.5");
    stand("tote", x - 0.8, y, 0.15, 0.3, groups)["box"] = box("0.4", "0.6", "0.3");
    arm_["name"] = "arm";
    arm_["base"] = map_on_a_line();
    arm_["base"]["xyz"] = list(decimals(x, 3), decimals(y, 3), "0.62");
    for (std::uint32_t i = 0; i < kLinks; ++i) add_link(i);
  }

  // Axes alternate between z and y, so that the arm does not stay in one plane. Amplitudes are
  // small enough that it clears the station.
  void add_link(std::uint32_t i) {
    const std::string name = fmt::format("link{}", i);
    YAML::Node parts = YAML::Load(kLinkParts);
    parts[0]["capsule"]["radius"] = decimals(0.07 - 0.006 * i, 3);
    object(name, list("moving", "arm"))["parts"] = parts;
    const double phase = draw_.uniform(0.0, 6.28), hz = draw_.uniform(0.1, 0.3);
    YAML::Node joint = map_on_a_line();
    joint["objects"] = list(name);
    joint["origin"] = map_on_a_line();
    joint["origin"]["xyz"] = list("0", "0", decimals(i == 0 ? 0.0 : 0.26, 2));
    joint["axis"] = i % 2 == 0 ? list("0", "0", "1") : list("0", "1", "0");
    joint["amplitude"] = decimals(draw_.uniform(0.2, 0.35), 3);
    joint["frequency_hz"] = decimals(hz, 3);
    joint["phase"] = decimals(phase, 3);
    arm_["joints"].push_back(joint);
  }

  // Vehicles take turns over the aisles, each in a stretch of its own along x.
  void add_vehicles() {
    const std::uint32_t count = moving_ - kLinks;
    const std::uint32_t aisles = std::max(1u, rows_);
    const std::uint32_t in_aisle = (count + aisles - 1) / aisles;
    const double stretch = aisle_length() / in_aisle;
    for (std::uint32_t i = 0; i < count; ++i) {
      // There are forklifts only where the aisle is long enough for them.
      const bool room = stretch > 3.6;
      const Kind kind = i % 4 == 1           ? Kind::kPerson
                        : i % 4 == 0 && room ? Kind::kForklift
                                             : Kind::kRobot;
      const double from = stretch * (i / aisles);
      add_vehicle(kind, i, from, stretch, row_y(i % aisles) + 0.5 * (kDepth + kAisle));
    }
  }

  // Back and forth within its stretch of the aisle, no faster than kMostSpeed.
  void add_vehicle(Kind kind, std::uint32_t number, double from, double stretch, double y) {
    constexpr double kGap = 0.5;
    const Vehicle& it = vehicle(kind);
    const std::string name = fmt::format("{}{}", it.name, number);
    object(name, list("moving", it.group))[it.shape] =
        vehicle_shapes_[static_cast<std::size_t>(kind)];
    const double amplitude = std::max(0.0, 0.5 * (stretch - it.back - it.front - kGap));
    const double speed = draw_.uniform(0.6, 1.0) * kMostSpeed;
    const double hz =
        amplitude > 0.0 ? std::min(1.0, speed / (2.0 * std::numbers::pi * amplitude)) : 0.0;
    const double phase = draw_.uniform(0.0, 6.28), aside = draw_.uniform(-0.5, 0.5);
    YAML::Node mover = map_on_a_line();
    mover["object"] = name;
    mover["centre"] = map_on_a_line();
    mover["centre"]["xyz"] =
        list(decimals(from + 0.5 * kGap + it.back + amplitude, 3), decimals(y + aside, 3), "0");
    mover["amplitude"] = list(decimals(amplitude, 3), "0", "0");
    mover["frequency_hz"] = decimals(hz, 4);
    mover["phase"] = decimals(phase, 3);
    if (kind == Kind::kRobot) mover["spin"] = list("0", "0", "0.8");
    movers_.push_back(mover);
  }

  const WarehouseOptions options_;
  SeededDraw draw_;
  std::uint32_t moving_ = 0, standing_ = 0;
  std::uint32_t stood_ = 0, bays_ = 0, rows_ = 0;
  const YAML::Node rack_parts_ = YAML::Load(kRackParts), pallet_parts_ = YAML::Load(kPalletParts);
  const std::array<YAML::Node, 3> vehicle_shapes_ = {
      YAML::Load(kForkliftParts), YAML::Load(kRobotParts), YAML::Load(kPersonCapsule)};
  YAML::Node objects_, arm_, movers_;
};

}  // namespace

std::string warehouse_cell(const WarehouseOptions& options) { return Warehouse(options).yaml(); }

}  // namespace clearance
