// A recorded run with allowed contacts: as allowed, too deep, withdrawn, allowed anew, ended, too
// late.
//
// Oracles: the height of the part, which the test states; the recording with one figure altered.
#include <gmock/gmock.h>

#include <algorithm>
#include <vector>

#include "monitor/recording/recorded_cell.hpp"
#include "monitor/replay/offline_replay.hpp"
#include "tests/config/cells.hpp"
#include "tests/monitor/replay/recorded_changes.hpp"

namespace clearance::test {
namespace {

using testing::HasSubstr;

constexpr int kContactTicks = 400;

// A part above a table: a contact is allowed, withdrawn, allowed anew until 30 mm, and goes on in a
// cell that has another margin.
class ContactRun : public RecordedChanges {
 protected:
  ContactRun() {
    const std::string head =
        "name: test\nunits: {length: m, angle: rad}\ndefaults: {max_speed: 2}\n"
        "objects:\n  - {name: table, fixed: true, box: {size: [1, 1, 0.1]}}\n";
    const std::string part = "  - {name: part, sphere: {radius: 0.05}";
    const std::string pairs =
        "pairs:\n  - {between: [part, table], publish: true}\nzones:\n"
        "  - {name: near, between: [part, table], enter_below: 0.005, leave_above: 0.01}\n";
    const std::string lift =
        "contacts:\n  - {name: lift, between: [part, table], depth: 0.002, until: {distance: "
        "0.03}, by: planner, reason: the part stands there}\n";
    for (const std::string& text :
         {head + part + "}\n" + pairs + lift, head + part + "}\n" + pairs,
          head + part + "}\n" + pairs + lift, head + part + ", margin: 0.001}\n" + pairs + lift})
      cells.push_back(read_good(text, folder / "cell.yaml"));
  }

  // The distance of the part from the table in a tick, m. It moves by 0.7 mm a tick at most.
  static double distance(int tick) {
    const auto between = [&](int from, double a, int to, double b) {
      const double t = static_cast<double>(tick - from) / (to - from);
      return a + t * (b - a);
    };
    if (tick < 20) return -0.001;
    if (tick < 60) return between(20, -0.001, 60, -0.003);
    if (tick < 100) return between(60, -0.003, 100, -0.001);
    if (tick < 240) return -0.001;
    if (tick < 300) return between(240, -0.001, 300, 0.04);
    if (tick < 360) return between(300, 0.04, 360, -0.001);
    return -0.001;
  }

  class Part final : public PoseSource {
   public:
    explicit Part(const ContactRun& test) : test_(test) {}
    const PoseBatch* next() noexcept override {
      if (tick_ == test_.now) return nullptr;
      ++tick_;
      batch_ = {};
      batch_.source = SourceName("arm");
      batch_.sequence_number = static_cast<std::uint64_t>(tick_);
      batch_.scene_revision = test_.cells.front().scene.revision;
      batch_.samples.push_back(sample(1, at(0, 0, 0.1 + distance(tick_)), kStart + tick_ * kTick));
      return &batch_;
    }

   private:
    const ContactRun& test_;
    PoseBatch batch_;
    int tick_ = 0;
  };

  void record(const RecordingOptions& options = {.overwrite = false}) {
    Part part(*this);
    on_report = [this](const Report& report) {
      contacts.emplace_back(report.contacts.begin(), report.contacts.end());
      zones.push_back(report.zones[0].active);
    };
    RecordedChanges::record(part, kContactTicks, {120, 160, 200}, options, 5);
  }
  // The status in a tick; nothing where no contact is allowed.
  [[nodiscard]] std::optional<ContactStatus> status(int tick) const {
    const auto& of = contacts[static_cast<std::size_t>(tick - 1)];
    return of.empty() ? std::nullopt : std::optional(of.front().status);
  }

  std::vector<std::vector<ContactReport>> contacts;  // by tick
  std::vector<bool> zones;
};

TEST_F(ContactRun, GoesThroughEveryStatusOfAContact) {
  record();
  ASSERT_EQ(contacts.size(), static_cast<std::size_t>(kContactTicks));
  using enum ContactStatus;
  EXPECT_EQ(status(15), kAllowed);
  EXPECT_FALSE(zones[14]);
  EXPECT_EQ(status(60), kTooDeep);
  EXPECT_TRUE(zones[59]);
  EXPECT_EQ(status(110), kAllowed);
  EXPECT_FALSE(zones[109]);
  EXPECT_EQ(status(150), std::nullopt) << "withdrawn";
  EXPECT_TRUE(zones[149]);
  EXPECT_EQ(status(190), kAllowed);
  EXPECT_EQ(status(230), kAllowed);
  EXPECT_EQ(contacts[229][0].since_cycle, contacts[189][0].since_cycle) << "it goes on";
  EXPECT_GT(contacts[189][0].since_cycle, changes[1].began_after);
  EXPECT_EQ(status(300), kEnded);
  EXPECT_EQ(contacts[299][0].ended, ContactEnded::kByDistance);
  EXPECT_EQ(status(390), kTooLate);
  EXPECT_TRUE(zones[389]);
}

TEST_F(ContactRun, ReplaysBitForBit) {
  record();
  std::vector<std::vector<ContactReport>> replayed;
  const OfflineReplay replay = replay_offline(
      cells.front(), run, {.compare = Comparison::kBits}, [&](const ReplayedTick& tick) {
        replayed.emplace_back(tick.report.contacts.begin(), tick.report.contacts.end());
      });
  EXPECT_TRUE(replay.ok()) << replay.text();
  EXPECT_EQ(replay.compared, static_cast<std::uint64_t>(kContactTicks));
  ASSERT_EQ(replayed.size(), contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    ASSERT_EQ(replayed[i].size(), contacts[i].size()) << i;
    for (std::size_t j = 0; j < contacts[i].size(); ++j) {
      EXPECT_EQ(replayed[i][j].status, contacts[i][j].status) << i;
      EXPECT_EQ(replayed[i][j].depth, contacts[i][j].depth) << i;
      EXPECT_EQ(replayed[i][j].since_cycle, contacts[i][j].since_cycle) << i;
      EXPECT_EQ(replayed[i][j].ended_cycle, contacts[i][j].ended_cycle) << i;
    }
  }
}

// In a tick of each status, and in one after the contact was allowed anew.
TEST_F(ContactRun, ARecordingWithAnotherContactDiffersInItsField) {
  record();
  const auto described = described_scenes({run});
  const std::vector<Kept> recorded = messages_of(run);
  const auto expect_named = [&](int tick, const std::string& field,
                                const std::function<void(clearance_msg_ContactState&)>& change) {
    std::vector<Kept> messages = recorded;
    int of = 0;
    for (Kept& message : messages) {
      if (message.kind != TopicKind::kDistances || ++of != tick) continue;
      message = altered<clearance_msg_Distances>(message, [&](clearance_msg_Distances& report) {
        ASSERT_EQ(report.contacts._length, 1u);
        change(report.contacts._buffer[0]);
      });
    }
    const std::filesystem::path file = folder / "altered.mcap";
    {
      RecordingWriter writer(file, Topics{});
      std::size_t scene = 0;
      for (const Kept& message : messages) {
        if (message.kind == TopicKind::kCatalogue) {
          EXPECT_EQ("", writer.attach(cells[scene++]));
          writer.catalogue(*decoded<clearance_msg_Catalogue>(message), message.log_ns);
          continue;
        }
        writer.write(message.kind, message.log_ns, message.publish_ns,
                     std::span<const std::byte>(message.cdr));
      }
      EXPECT_TRUE(writer.close());
    }
    const OfflineReplay replay =
        replay_offline(cells.front(), file, {.compare = Comparison::kBits});
    ASSERT_EQ(replay.failures.size(), 1u) << field;
    EXPECT_EQ(replay.failures[0].tick.recorded, static_cast<std::uint64_t>(tick));
    EXPECT_THAT(replay.failures[0].what, HasSubstr(field));
  };
  for (const int tick : {15, 60, 190, 230, 300, 390}) {
    SCOPED_TRACE(tick);
    expect_named(tick, "status", [](auto& contact) { contact.status ^= 1; });
    expect_named(tick, "depth", [](auto& contact) { contact.depth += 1e-15; });
    expect_named(tick, "since_cycle", [](auto& contact) { ++contact.since_cycle; });
    expect_named(tick, "ended_cycle", [](auto& contact) { ++contact.ended_cycle; });
  }
}

TEST_F(ContactRun, InSeveralFilesReplaysAsOneAndEachFileByItself) {
  record({.roll_ns = 45 * kTick});
  const std::vector<std::filesystem::path> files = later_files();
  ASSERT_GE(files.size(), 7u);
  const OfflineReplay whole =
      replay_offline(cells.front(), run, {.compare = Comparison::kBits, .continued_in = files});
  EXPECT_TRUE(whole.ok()) << whole.text();
  EXPECT_EQ(whole.compared, static_cast<std::uint64_t>(kContactTicks));
  for (const std::filesystem::path& file : files) {
    const auto first = recorded_cell(file, outline(file));
    ASSERT_TRUE(first);
    const OfflineReplay alone =
        replay_offline(std::get<Cell>(*first), file, {.compare = Comparison::kBounds});
    EXPECT_TRUE(alone.ok()) << file << alone.text();
    EXPECT_EQ(alone.compared, alone.ticks);
  }
}

}  // namespace
}  // namespace clearance::test
