// The comparison must name every published field that is altered alone: message by message, and in
// a recording that is replayed. The recording was made by the first build whose layout must stay
// readable. It contains joints, a person, a zone with `separation`, and gradients.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "monitor/recording/recorded_cell.hpp"
#include "monitor/replay/message_difference.hpp"
#include "monitor/replay/offline_replay.hpp"
#include "monitor/replay/report_recorder.hpp"
#include "monitor/wire/message_fields.hpp"
#include "tests/monitor/replay/recorded_runs.hpp"
#include "tests/shared/places.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance::test {
namespace {

using testing::HasSubstr;

const std::filesystem::path kRecording =
    std::filesystem::path(test::places::sources()) / "tests/monitor/recording/first_layout.mcap";

// Changes the number of index `wanted` in a message, counted from 0, and returns its name. The
// first element of a list stands for all. Fields that no tick determines are skipped unless they
// are requested.
struct Alter {
  std::size_t wanted = 0;
  bool delivery = false;
  std::size_t seen = 0;
  std::string name = {};  // empty: the message has no number of this index
  bool inside = false;    // a struct or list within the message

  template <class Value>
  void operator()(const Field& field, Value& value) {
    if ((field.meaning == Meaning::kDelivery) != delivery && !inside) return;
    if constexpr (HasFields<Value>) {
      within([&] { for_each_field(*this, value); });
    } else if constexpr (MessageSequence<Value>) {
      if (value._length > 0) within([&] { (*this)(field, value._buffer[0]); });
      if (value._length > 0 && is_next(field)) --value._length;
    } else if constexpr (std::is_same_v<Value, clearance_msg_Vector3>) {
      for (double* axis : {&value.x, &value.y, &value.z}) change(field, *axis);
    } else if constexpr (std::is_array_v<Value>) {
      if (is_next(field)) value[0] = 'q';
    } else {
      change(field, value);
    }
  }

 private:
  template <class Visit>
  void within(const Visit& visit) {
    const bool outside = !std::exchange(inside, true);
    visit();
    if (outside) inside = false;
  }
  bool is_next(const Field& field) {
    const bool is_it = seen++ == wanted;
    if (is_it) name = field.name;
    return is_it;
  }
  template <class Number>
  void change(const Field& field, Number& value) {
    if (!is_next(field)) return;
    if constexpr (std::is_same_v<Number, bool>) {
      value = !value;
    } else if constexpr (std::is_same_v<Number, double>) {
      value = std::isfinite(value) ? std::nextafter(value, 1e9) : 0.5;
    } else {
      ++value;
    }
  }
};

// The messages of the recording, one of them altered.
class EveryField : public testing::Test {
 protected:
  void SetUp() override {
    RecordingOutline outlined = outline(kRecording);
    ASSERT_EQ("", outlined.error);
    auto cell = recorded_cell(kRecording, outlined);
    ASSERT_TRUE(cell && std::holds_alternative<Cell>(*cell));
    cell_ = std::get<Cell>(std::move(*cell));
    messages_ = messages_of(kRecording);
    take_newer_messages();
  }

  // Gradients and distances have fields that are newer than the recording.
  void take_newer_messages() {
    const std::filesystem::path file = folder_ / "again.mcap";
    ReportRecorder again(file, cell_);
    const OfflineReplay replay =
        replay_offline(cell_, kRecording, {}, [&](const ReplayedTick& tick) { again.add(tick); });
    ASSERT_TRUE(replay.ok()) << replay.text();
    ASSERT_TRUE(again.close());
    std::vector<Kept> made = messages_of(file);
    for (const TopicKind kind : {TopicKind::kGradients, TopicKind::kDistances}) {
      auto next = made.begin();
      for (Kept& message : messages_) {
        if (message.kind != kind) continue;
        next = std::ranges::find(next, made.end(), kind, &Kept::kind);
        ASSERT_NE(next, made.end());
        message.cdr = (next++)->cdr;
      }
    }
  }

  // The place of the message of index `number` of this kind, counted from 0.
  std::size_t place_of(TopicKind kind, int number) const {
    std::size_t place = 0;
    while (messages_.at(place).kind != kind || number-- > 0) ++place;
    return place;
  }

  // Alters each field of a message in turn, and passes on the altered message and the field's name.
  template <class Message>
  void for_each_alteration(std::size_t place,
                           const std::function<void(const Kept&, const std::string& name)>& judge) {
    for (std::size_t wanted = 0;; ++wanted) {
      Alter alter{.wanted = wanted};
      const Kept altered_message = altered<Message>(
          messages_[place], [&alter](Message& content) { for_each_field(alter, content); });
      if (alter.name.empty()) {
        EXPECT_GT(wanted, 8u);
        return;
      }
      judge(altered_message, alter.name);
    }
  }

  template <class Message>
  void expect_named(TopicKind kind, int number) {
    const std::size_t place = place_of(kind, number);
    const auto original = decoded<Message>(messages_[place]);
    EXPECT_EQ(std::nullopt, message_difference(cell_.scene, *original, *original));
    for_each_alteration<Message>(place, [&](const Kept& other, const std::string& name) {
      EXPECT_THAT(
          message_difference(cell_.scene, *original, *decoded<Message>(other)).value_or("nothing"),
          HasSubstr(name));
    });
    for (std::size_t wanted = 0;; ++wanted) {
      Alter alter{.wanted = wanted, .delivery = true};
      const Kept other = altered<Message>(
          messages_[place], [&alter](Message& content) { for_each_field(alter, content); });
      if (alter.name.empty()) break;
      EXPECT_EQ(std::nullopt, message_difference(cell_.scene, *original, *decoded<Message>(other)))
          << alter.name;
    }
  }

  // `identity` lists the fields that identify a message's tick or zone. If one of them is altered,
  // the comparison reports other messages.
  template <class Message>
  void expect_named_by_a_replay(TopicKind kind, int number, const std::set<std::string>& identity) {
    const std::size_t place = place_of(kind, number);
    for_each_alteration<Message>(place, [&](const Kept& other, const std::string& name) {
      std::vector<Kept> messages = messages_;
      messages[place] = other;
      const std::filesystem::path run = folder_ / "altered.mcap";
      write_messages(run, messages);
      const OfflineReplay result = replay_offline(cell_, run, {.compare = Comparison::kBits});
      if (identity.contains(name)) return;
      ASSERT_FALSE(result.ok()) << name;
      EXPECT_THAT(result.text(), HasSubstr(name));
    });
  }

  ScratchFolder folder_;
  Cell cell_;
  std::vector<Kept> messages_;
};

TEST_F(EveryField, OfAMessageIsComparedButWhatNoTickDetermines) {
  expect_named<clearance_msg_Distances>(TopicKind::kDistances, 30);
  expect_named<clearance_msg_ZoneState>(TopicKind::kZones, 1);
  expect_named<clearance_msg_Separation>(TopicKind::kSeparation, 30);
  expect_named<clearance_msg_Gradients>(TopicKind::kGradients, 30);
}

TEST_F(EveryField, OfAContactIsCompared) {
  Kept& message = messages_.at(place_of(TopicKind::kDistances, 3));
  message = altered<clearance_msg_Distances>(message, [](clearance_msg_Distances& content) {
    reserve_sequence(content.contacts, 1);
    clearance_msg_ContactState& contact = content.contacts._buffer[content.contacts._length++];
    contact = {};
    contact.depth = 0.001;
  });
  expect_named<clearance_msg_Distances>(TopicKind::kDistances, 3);
}

TEST_F(EveryField, OfARecordingIsNamedByItsReplay) {
  write_messages(folder_ / "same.mcap", messages_);
  const OfflineReplay same =
      replay_offline(cell_, folder_ / "same.mcap", {.compare = Comparison::kBits});
  ASSERT_TRUE(same.ok()) << same.text();
  EXPECT_EQ(45u, same.compared);
  // These fields are inputs of a tick: a replay with other times is another run.
  expect_named_by_a_replay<clearance_msg_Distances>(
      TopicKind::kDistances, 30, {"cycle", "now_ns", "clock_offset_ns", "report_delay_ns"});
  expect_named_by_a_replay<clearance_msg_ZoneState>(TopicKind::kZones, 1,
                                                    {"zone", "cycle", "active"});
  expect_named_by_a_replay<clearance_msg_Separation>(TopicKind::kSeparation, 30, {"now_ns"});
  expect_named_by_a_replay<clearance_msg_Gradients>(TopicKind::kGradients, 30, {"now_ns"});
}

TEST_F(EveryField, OfTheFirstTickIsComparedToo) {
  expect_named_by_a_replay<clearance_msg_Gradients>(TopicKind::kGradients, 0, {"now_ns"});
}

TEST_F(EveryField, OfGradientsIsComparedWhereOnlyTheDaemonWasToldToPublishThem) {
  cell_.scene.gradients = false;
  expect_named_by_a_replay<clearance_msg_Gradients>(TopicKind::kGradients, 30, {"now_ns"});
}

TEST_F(EveryField, OfAMessageThatBelongsToNoReportIsNoted) {
  const std::size_t place = place_of(TopicKind::kGradients, 30);
  messages_[place] = altered<clearance_msg_Gradients>(
      messages_[place], [](clearance_msg_Gradients& message) { ++message.now_ns; });
  write_messages(folder_ / "other.mcap", messages_);
  const OfflineReplay replay =
      replay_offline(cell_, folder_ / "other.mcap", {.compare = Comparison::kBits});
  EXPECT_THAT(replay.text(),
              HasSubstr("1 message of gradients or separation belongs to no report"));
}

}  // namespace
}  // namespace clearance::test
