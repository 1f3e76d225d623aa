// A recorded run whose cell changes three times: an arm takes a part, the whole cell is replaced,
// and the part stands where it was put down. Poses and joints come in, also for scenes before.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/monitor/replay/recorded_changes.hpp"
#include "tests/monitor/tick/scara_cell.hpp"

namespace clearance::test {

class ChangingRun : public RecordedChanges {
 protected:
  static constexpr int kTicks = 235;

  // The cells in their order. Objects have other ids in each.
  ChangingRun() {
    write_text(folder / "scara.urdf", kScaraUrdf);
    const std::string head =
        "name: test\nunits: {length: m, angle: rad}\nrobots: [{name: arm, urdf: scara.urdf}]\n";
    const std::string wall =
        "  - {name: wall, fixed: true, half_space: {normal: [-1, 0, 0], offset: -2.2}}\n";
    const std::string cart = "  - {name: cart, may_jump: true, sphere: {radius: 0.1}}\n";
    const std::string pairs =
        "pairs:\n  - {between: [arm, wall], publish: true}\n"
        "  - {between: [cart, arm], publish: true}\n  - {between: [cart, part], publish: true}\n";
    const std::string zones =
        "zones:\n  - {name: near, between: [upper, wall], enter_below: 1.31, leave_above: 1.32}\n";
    const auto add = [&](const std::string& text) {
      // The file is the same one each time, as after SIGHUP.
      cells.push_back(read_good(text, folder / "cell.yaml"));
    };
    add(head + "objects:\n" + wall + cart +
        "  - {name: part, may_jump: true, sphere: {radius: 0.05}}\n" + pairs + zones);
    add(head + "objects:\n" + wall + cart +
        "  - {name: part, attached: {to: finger}, sphere: {radius: 0.05}}\n" + pairs + zones);
    add(head +
        "objects:\n  - {name: bin, fixed: true, box: {size: [1, 1, 1]}, pose: {xyz: [0, -3, "
        "0]}}\n" +
        cart + wall + "  - {name: part, attached: {to: finger}, sphere: {radius: 0.05}}\n" + pairs +
        "  - {between: [part, bin], publish: true}\nzones:\n"
        "  - {name: over, between: [part, bin], enter_below: 3, leave_above: 3.2}\n"
        "  - {name: near, between: [upper, wall], enter_below: 1.31, leave_above: 1.32}\n");
    add(head + "objects:\n" + cart +
        "  - {name: part, fixed: true, sphere: {radius: 0.05}, pose: {xyz: [0, -2, 0]}}\n" + wall +
        pairs + "  - {between: [part, arm], publish: true}\n");
  }

  // Changes are offered before ticks 50, 100 and 150, and each catches up `lag` ticks later.
  void record(const RecordingOptions& options = {.overwrite = false}, int lag = 7) {
    on_report = [this](const Report& report) { unknown.push_back(report.unknown); };
    Poses poses(*this);
    RecordedChanges::record(poses, kTicks, {50, 100, 150}, options, lag);
  }

  // A batch of joints and one of poses each tick. The sender of poses knows the scene of 20 ticks
  // ago, one batch in ten is for a scene that never was, and some are of a scene without a
  // revision.
  class Poses final : public PoseSource {
   public:
    explicit Poses(ChangingRun& test) : test_(test) {}
    const PoseBatch* next() noexcept override {
      if (given_ == 2 * test_.now) return nullptr;
      const int of = given_ / 2 + 1;
      return given_++ % 2 == 0 ? joints(of) : poses(of);
    }

   private:
    const Cell& known(int tick) const {
      return test_.cells[std::min<std::size_t>(std::max(0, tick - 20) / 50, 3)];
    }
    static std::int64_t stamp(int tick) { return kStart + tick * kTick; }
    const PoseBatch* joints(int tick) {
      const Scene& scene = known(tick).scene;
      batch_ = {};
      batch_.source = SourceName("driver");
      batch_.sequence_number = static_cast<std::uint64_t>(tick);
      batch_.scene_revision = scene.revision;
      const double swing = std::sin(0.0012 * tick);
      const double positions[] = {1.2 * swing, 0.5 * swing, 0.1 + 0.05 * swing};
      for (std::uint32_t i = 0; i < 3; ++i)
        batch_.joints.push_back(joint(i, positions[i], stamp(tick)));
      return &batch_;
    }
    const PoseBatch* poses(int tick) {
      const Scene& scene = known(tick).scene;
      batch_ = {};
      batch_.source = SourceName("camera");
      batch_.sequence_number = static_cast<std::uint64_t>(tick);
      batch_.scene_revision = tick % 10 == 0 ? 77 : tick % 10 == 5 ? 0 : scene.revision;
      for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
        const Object& object = scene.objects[i];
        if (object.name != "cart" && (object.name != "part" || object.fixed)) continue;
        if (!test_.is_moving(scene, i)) continue;
        const double along = object.name == "cart" ? 0.3 * std::sin(0.05 * tick) : 1.5;
        batch_.samples.push_back(sample(i, at(along, 1.5, 0.2), stamp(tick)));
      }
      return &batch_;
    }
    ChangingRun& test_;
    PoseBatch batch_;
    int given_ = 0;
  };

  // Objects with poses of their own: the part is attached in all cells but the first and last.
  static bool is_moving(const Scene& scene, std::uint32_t object) {
    return scene.objects[object].name == "cart" || scene.objects[object].may_jump;
  }

  std::vector<std::uint32_t> unknown;  // by tick
};

}  // namespace clearance::test
