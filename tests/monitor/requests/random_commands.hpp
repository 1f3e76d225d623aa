// A loop that runs while random commands change its cell, and all that has to hold after each.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "monitor/loop/tick_loop.hpp"
#include "monitor/requests/scene_commander.hpp"
#include "tests/monitor/requests/change_text.hpp"
#include "tests/monitor/requests/contact_model.hpp"
#include "tests/monitor/requests/gated_clock.hpp"
#include "tests/monitor/requests/stated_poses.hpp"

namespace clearance::test {

// Every object has one of these names.
inline const std::vector<std::string> kAdded = {
    "p0", "p1", "p2", "p3", "p4", "p5", "p6", "none", "table", "cart", "drone", "part", "floor"};

inline constexpr int kSettling = 45, kRest = 18;  // ticks; all age limits are below both together

// Keeps the last report, and sees that no cycle is missing.
class LastReport final : public ReportSink {
 public:
  void input(const PoseBatch&) noexcept override {}
  void report(const Report& report, std::span<const SourceUse>) noexcept override {
    if (report.cycle != last.cycle + 1) ++gaps;
    last = report;
  }
  void statistics(const LoopStatistics&) noexcept override {}
  Report last;
  int gaps = 0;
};

class RandomCommands : public testing::Test, private CellParts {
 protected:
  ~RandomCommands() override {
    if (!ticking_.joinable()) return;
    stop_ = true;
    clock_.run_freely();
    ticking_.join();
  }

  void start(std::uint64_t seed) {
    random_.emplace(seed << 32);  // the streams of numbers next to each other overlap
    write_text(folder_ / "scara.urdf", kScaraUrdf);
    write_text(folder_ / "cell.yaml", kRandomCommandsCell);
    std::filesystem::create_directory(folder_ / "allowed");
    names_ = {.objects = {"none"},
              .added = kAdded,
              .carriers = {"finger", "lower", "upper", "cart", "drone"},
              .groups = {"things", "things", "movers", "movers", "arm", "none"},
              .templates = {"bin", "rod", "twin", "none"},
              .zones = {"stop", "slow", "arm_zone", "none"},
              .contacts = {"c0", "c1", "c2"},
              .sources = {"camera", "robot", "nobody"},
              .cells = variants(),
              .files = {"", "allowed/other.yaml", "allowed/none.yaml", "cell.yaml"},
              .shapes = {"sphere: {radius: 0.1}", "box: {size: [0.2, 0.1, 0.3]}",
                         "capsule: {from: [0, 0, 0], to: [0, 0, 0.3], radius: 0.05}",
                         "sphere: {radius: -1}"},
              .most_speed = 20.0,
              .least_speed = 5.0};
    write_text(folder_ / "allowed" / "other.yaml", names_.cells[1]);
    draw_.emplace(*random_, names_);
    const auto cell = std::make_shared<const Cell>(read());
    scene_ = cell->scene;
    Places places;
    for (const std::string& name : names_.added) places.poses[name] = random_->pose(1.0);
    places.arm[2] = 0.1;
    senders_.place(places);
    senders_.send_for(scene_, {});
    loop_ = std::make_unique<TickLoop>(cell->scene, senders_, std::vector<ReportSink*>{&reports_},
                                       clock_, TickLoopOptions{});
    changer_ = std::make_unique<SceneChanger>(*loop_, cell, static_cast<CellParts&>(*this));
    commander_ = std::make_unique<SceneCommander>(
        *changer_, *loop_, loop_ended_, CommanderOptions{.began_with = cell->scene.revision});
    ticking_ = std::thread([this] { loop_->run(stop_); });
    settle();
    compare(0);
  }

  [[nodiscard]] std::vector<CellChange> drawn() {
    draw_names();
    std::vector<CellChange> list;
    for (int i = random_->integer(1, random_->integer(1, 4)); i > 0; --i)
      list.push_back((*draw_)());
    return list;
  }

  // One command, and all that has to hold after it.
  void step(std::vector<CellChange> list) {
    list_ = std::move(list);
    const Scene before = scene_;
    const std::string text = text_before_ = changer_->cell().yaml;
    const std::uint64_t began_after = loop_->state().monitor().cycle();
    choose_silent();
    clock_.run(kRest);  // what is silent is late
    const std::set<std::string> usable = usable_names();
    before_motion_ = senders_.now();
    senders_.begin_motion(next_places());
    const CommandResult result = execute({.changes = list_});
    ASSERT_EQ(result.scene_revision, changer_->cell().scene.revision);
    count(result);
    if (!result.done()) {
      expect_nothing_changed(before, text, result);
      return;
    }
    expect_bodies_stayed(text, usable);
    take_over(before);
    settle();
    compare(began_after);
  }

  CommandResult execute(Command command) {
    command.client = "planner";
    command.request = ++request_;
    senders_.moves = false;
    clock_.run_freely();
    // Only from here on, so that what was asked about present poses does not depend on the time.
    const CommandResult result = commander_->execute(command, false, [this] {
      senders_.moves = true;
      return true;
    });
    clock_.stop();
    return result;
  }

  std::optional<Random> random_;
  [[nodiscard]] std::string figures() const {
    std::string text;
    for (std::size_t i = 0; i < kCommandStatuses; ++i) {
      if (results_[i] > 0)
        text += fmt::format("{} {}, ", name_of(static_cast<CommandStatus>(i)), results_[i]);
    }
    text += "\naccepted by kind:";
    for (const std::uint64_t count : accepted_) text += fmt::format(" {}", count);
    const Agreement& f = figures_;
    return text + fmt::format(
                      "\npairs {}, known {}, with a true distance {}, widest bounds {:.2g} m\n"
                      "zones decided {}, open {}; contacts {}, allowed {}, ended {}\n",
                      f.pairs, f.known, f.true_distances, f.widest, f.zones_decided, f.zones_open,
                      f.contacts, f.contacts_allowed, f.contacts_ended);
  }
  // Samples that the running monitor has refused.
  [[nodiscard]] std::string refusals() const {
    std::string lines;
    for (std::uint32_t i = 0; i < scene_.objects.size(); ++i) {
      const auto& counts = loop_->state().monitor().rejected(i);
      for (std::size_t cause = 0; cause < kRejects; ++cause) {
        if (counts[cause] == 0) continue;
        lines += fmt::format("{}: {} refused as {}\n", scene_.objects[i].name, counts[cause],
                             name(static_cast<Reject>(cause)));
      }
    }
    return lines;
  }

  std::array<std::uint64_t, kCommandStatuses> results_{};
  std::array<std::uint64_t, kChangeKinds> accepted_{};
  std::vector<CellChange> list_;
  std::string text_before_;
  std::uint64_t count_ = 0;
  std::unique_ptr<SceneCommander> commander_;
  Agreement figures_;
  LastReport reports_;

 private:
  static std::vector<std::string> variants() {
    std::vector<std::string> texts(4, kRandomCommandsCell);
    const auto replace = [](std::string& text, const std::string& from, const std::string& to) {
      text.replace(text.find(from), from.size(), to);
    };
    replace(texts[1], "- {between: [movers, arm]}", "- {between: [movers, arm], publish: false}");
    replace(texts[2], "rate_hz: 500", "rate_hz: 400");
    texts[3] = "objects: [";
    return texts;
  }
  [[nodiscard]] Cell read() const {
    CellResult result = read_cell(folder_ / "cell.yaml");
    return std::get<Cell>(std::move(result));
  }

  // Mostly those of the present scene.
  void draw_names() {
    names_.objects.clear();
    names_.attached.clear();
    if (random_->chance(0.3)) names_.objects = {"none", "upper"};
    for (std::uint32_t i = 0; i < scene_.objects.size(); ++i) {
      const Object& object = scene_.objects[i];
      if (!senders_.now().poses.contains(object.name)) continue;
      names_.objects.push_back(object.name);
      if (!object.fixed && !is_sent(scene_, i)) names_.attached.push_back(object.name);
    }
  }

  void choose_silent() {
    silent_.clear();
    for (const auto& [name, pose] : senders_.now().poses) {
      if (random_->chance(0.08)) silent_.insert(name);
    }
    if (random_->chance(0.05)) silent_.insert("arm");
    senders_.send_for(scene_, silent_);
  }
  Places next_places() {
    Places places = senders_.now();
    for (auto& [name, pose] : places.poses) {
      const Vec3 step = random_->in_box(0.1);
      const Eigen::Quaterniond turn = turned(random_->direction(), random_->uniform(-0.2, 0.2));
      if (silent_.contains(name)) continue;
      pose.position = (pose.position + step).cwiseMax(-1.2).cwiseMin(1.2);
      pose.orientation = (turn * pose.orientation).normalized();
    }
    const Vec3 turn = random_->in_box(1.0);
    if (silent_.contains("arm")) return places;
    places.arm[0] = std::clamp(places.arm[0] + 0.1 * turn.x(), -2.5, 2.5);
    places.arm[1] += 0.2 * turn.y();
    places.arm[2] = std::clamp(places.arm[2] + 0.03 * turn.z(), 0.0, 0.2);
    return places;
  }
  // The objects that are sent, or are links, and are on time.
  [[nodiscard]] std::set<std::string> usable_names() const {
    std::set<std::string> names;
    const Monitor& monitor = loop_->state().monitor();
    for (std::uint32_t i = 0; i < scene_.objects.size(); ++i) {
      const bool is_known_object = before_motion_.poses.contains(scene_.objects[i].name);
      if (is_known_object && !is_sent(scene_, i)) continue;
      if (monitor.present_pose(i).state == PresentPose::State::kUsable)
        names.insert(scene_.objects[i].name);
    }
    return names;
  }

  void count(const CommandResult& result) {
    ++count_;
    ++results_[static_cast<std::size_t>(result.status)];
    const auto is = [&](CommandStatus status) { return result.status == status; };
    EXPECT_FALSE(is(CommandStatus::kFailed) || is(CommandStatus::kTooSlow) ||
                 is(CommandStatus::kEnding) || is(CommandStatus::kMalformed))
        << name_of(result.status) << ": " << result.reason;
    EXPECT_EQ(reports_.gaps, 0);
    if (!result.done()) return;
    for (const CellChange& change : list_) ++accepted_[change.index()];
  }
  void expect_nothing_changed(const Scene& before, const std::string& text,
                              const CommandResult& result) {
    EXPECT_NE(result.reason, "");
    EXPECT_EQ(changer_->cell().yaml, text);
    EXPECT_EQ(changer_->cell().scene.revision, before.revision);
    EXPECT_LT(result.change, list_.size());
    const CommandResult nothing = execute({.dry_run = true});
    EXPECT_TRUE(nothing.done());
    EXPECT_EQ(nothing.scene_revision, before.revision) << "the editor has another text";
    senders_.begin_motion(senders_.now());
  }

  // The result is that of the same list with a model's poses.
  void expect_bodies_stayed(const std::string& text, const std::set<std::string>& usable) {
    if (std::ranges::none_of(list_, leaves_out_a_pose)) return;
    for (const CellChange& change : list_) {
      if (std::holds_alternative<ReadCellAgain>(change)) return;
    }
    auto opened = CellEditor::open(text, folder_ / "cell.yaml");
    auto& editor = std::get<CellEditor>(opened);
    StatedPoses model(editor, before_motion_, usable);
    const auto stated = model.of(list_);
    if (model.is_open()) return;
    ASSERT_TRUE(stated) << "accepted, although where a body was is not known";
    const auto read = editor.edit(*stated);
    ASSERT_TRUE(std::holds_alternative<Cell>(read));
    const Scene &with_poses = std::get<Cell>(read).scene, &now = changer_->cell().scene;
    ASSERT_EQ(with_poses.objects.size(), now.objects.size());
    const std::vector<Pose> expected = in_world(with_poses, before_motion_),
                            found = in_world(now, before_motion_);
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_LT((expected[i].position - found[i].position).norm(), 1e-9) << now.objects[i].name;
      EXPECT_LT(expected[i].orientation.angularDistance(found[i].orientation), 1e-7)
          << now.objects[i].name;
    }
  }

  // Reads the text as a file of its own: that is the scene of all that follows.
  void take_over(const Scene& before) {
    const Cell& now = changer_->cell();
    write_text(folder_ / "again.yaml", now.yaml);
    auto again = read_cell(folder_ / "again.yaml");
    ASSERT_TRUE(std::holds_alternative<Cell>(again))
        << "accepted, but the reader refuses it:\n"
        << std::get<std::vector<CellError>>(again).front().text;
    EXPECT_EQ(std::get<Cell>(again).scene.revision, now.scene.revision);
    scene_ = std::get<Cell>(std::move(again)).scene;
    forget_inputs(before);
    senders_.send_for(scene_, silent_);
  }
  // By scene_map.hpp: what has no counterpart in the scene before is not known any more.
  void forget_inputs(const Scene& before) {
    std::erase_if(senders_.last_sent, [&](const auto& entry) {
      if (entry.first == "arm") return false;
      const auto index_in = [&](const Scene& scene) {
        const auto found = std::ranges::find(scene.objects, entry.first, &Object::name);
        return static_cast<std::uint32_t>(found - scene.objects.begin());
      };
      const std::uint32_t was = index_in(before), is = index_in(scene_);
      if (was == before.objects.size() || is == scene_.objects.size()) return true;
      const Object &a = before.objects[was], &b = scene_.objects[is];
      return !is_sent(before, was) || !is_sent(scene_, is) || a.absent != b.absent ||
             a.source != b.source;
    });
  }
  void settle() {
    senders_.moves = true;
    clock_.run(kSettling);
    inputs_ = {.first_tick_ns = clock_.realtime_ns(), .ticks = kRest};
    clock_.run(kRest);
    inputs_.last_sent = senders_.last_sent;
    for (auto& [name, stamp] : inputs_.last_sent) {
      if (stamp >= inputs_.first_tick_ns) stamp = inputs_.first_tick_ns;
    }
  }
  void compare(std::uint64_t began_after) {
    const Report& report = reports_.last;
    const Monitor& running = loop_->state().monitor();
    EXPECT_EQ(report.scene_revision, scene_.revision);
    EXPECT_EQ(report.cycle, running.cycle());
    const std::vector<Pose> world = in_world(scene_, senders_.now());
    const Scene in_force = with_contacts(scene_, true), ended = with_contacts(scene_, false);
    RebuiltMonitor rebuilt(in_force, senders_, inputs_);
    Comparison comparison(scene_, running, report, rebuilt, world, figures_);
    comparison.expect_equal_pairs();
    comparison.expect_right_zones();
    const auto has_ended = [](const ContactReport& c) { return c.ended != ContactEnded::kNot; };
    if (std::ranges::any_of(report.contacts, has_ended)) {
      RebuiltMonitor after(ended, senders_, inputs_);
      contacts_.expect_right(scene_, report, began_after, rebuilt, after, figures_);
    } else {
      contacts_.expect_right(scene_, report, began_after, rebuilt, rebuilt, figures_);
    }
  }

  std::vector<ReportSink*> prepare(const std::shared_ptr<const Cell>&) override {
    return {&reports_};
  }
  void follow(const SceneInForce&) noexcept override {}
  void abandon() override {}

  ScratchFolder folder_;
  DrawnNames names_;
  std::optional<DrawnChange> draw_;
  GatedClock clock_;
  RandomSenders senders_{clock_};
  Scene scene_;  // in force, as the reader reads it from the text
  Places before_motion_;
  std::set<std::string> silent_;
  SettledInputs inputs_;
  ContactModel contacts_;
  std::unique_ptr<TickLoop> loop_;
  std::unique_ptr<SceneChanger> changer_;
  std::atomic<bool> stop_{false}, loop_ended_{false};
  std::thread ticking_;
  std::uint64_t request_ = 0;
};

}  // namespace clearance::test
