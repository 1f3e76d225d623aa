#include "monitor/publish/contact_log.hpp"

#include <gtest/gtest.h>

#include "monitor/interface/pair_name.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/shared/logged.hpp"

namespace clearance::test {
namespace {

class ContactLogTest : public testing::Test {
 protected:
  static Scene scene_with_a_contact() {
    Scene scene = cell_of({moving("part", {ball(0.1)}), fixed("table", {ball(0.1)}, at(1, 0, 0))});
    AllowedContact contact;
    contact.name = "lift";
    contact.depth = 0.002;
    contact.end.distance = 0.01;
    contact.by = "planner";
    contact.pairs = {0};
    scene.contacts.push_back(contact);
    return scene;
  }
  static ContactReport report(ContactStatus status) {
    ContactReport contact;
    contact.status = status;
    contact.depth = 0.0012;
    contact.since_cycle = 17;
    if (status == ContactStatus::kEnded || status == ContactStatus::kTooLate) {
      contact.ended = ContactEnded::kByDistance;
      contact.ended_cycle = 40;
    }
    return contact;
  }
  void note(ContactStatus status) {
    const ContactReport contact = report(status);
    contacts.note(std::span(&contact, 1));
  }

  Scene scene = scene_with_a_contact();
  std::shared_ptr<Logged> logged = std::make_shared<Logged>();
  LoggedTo log{logged};
  ContactLog contacts{scene};
};

TEST_F(ContactLogTest, TellsWhoAllowsAContactHowDeepItIsAndWhenItEnds) {
  note(ContactStatus::kAllowed);
  note(ContactStatus::kAllowed);
  EXPECT_EQ(logged->count("[contact-allowed]"), 1u);
  EXPECT_TRUE(
      logged->has("part - table: contact 'lift' allowed by planner: 1.2 of 2.0 mm deep, "
                  "since cycle 17, until the distance is 10.0 mm"))
      << logged->text();
}

TEST_F(ContactLogTest, TellsEachViolationAndEachEndOnceUntilItChanges) {
  for (const ContactStatus status :
       {ContactStatus::kAllowed, ContactStatus::kUnknown, ContactStatus::kAllowed,
        ContactStatus::kTooDeep, ContactStatus::kTooDeep, ContactStatus::kAllowed,
        ContactStatus::kEnded, ContactStatus::kAbsent, ContactStatus::kTooLate})
    note(status);
  EXPECT_EQ(logged->count("[contact-allowed]"), 2u);
  EXPECT_EQ(logged->count("[contact-too-deep]"), 1u);
  EXPECT_EQ(logged->count("[contact-ended]"), 1u);
  EXPECT_EQ(logged->count("[contact-too-late]"), 1u);
  EXPECT_TRUE(logged->has("ended by distance at cycle 40")) << logged->text();
}

TEST_F(ContactLogTest, DoesNotFloodTheLog) {
  for (int i = 0; i < 100; ++i)
    note(i % 2 == 0 ? ContactStatus::kAllowed : ContactStatus::kTooDeep);
  EXPECT_EQ(logged->count("[contact-"), ContactLog::kLines);
  contacts.end_second();
  EXPECT_TRUE(logged->has("80 more changes of contacts left out")) << logged->text();
}

TEST_F(ContactLogTest, AChangeOfTheSceneIsNoNewsOfAContact) {
  note(ContactStatus::kAllowed);
  // The same contact is the second entry of the next scene, and the first one is new.
  Scene next = cell_of({fixed("wall", {ball(0.1)}, at(2, 0, 0)), moving("part", {ball(0.1)}),
                        fixed("table", {ball(0.1)}, at(1, 0, 0))});
  AllowedContact other = scene.contacts[0];
  other.name = "lean";
  next.contacts = {other, scene.contacts[0]};
  for (std::uint32_t pair = 0; pair < next.pairs.size(); ++pair) {
    const std::string name = pair_name(next, pair);
    if (name.find("part") == std::string::npos) continue;
    next.contacts[name.find("table") == std::string::npos ? 0 : 1].pairs = {pair};
  }
  contacts.change(next);
  std::vector<ContactReport> reports;
  for (const ContactPair& pair : contact_pairs(next)) {
    reports.push_back(report(ContactStatus::kAllowed));
    reports.back().contact = pair.contact;
    reports.back().pair = pair.pair;
  }
  ASSERT_EQ(reports.size(), 2u);
  contacts.note(reports);
  EXPECT_EQ(logged->count("[contact-allowed]"), 2u) << logged->text();
  EXPECT_EQ(logged->count("'lift'"), 1u) << logged->text();
  EXPECT_EQ(logged->count("'lean'"), 1u) << logged->text();
}

TEST_F(ContactLogTest, AContactThatIsAllowedAnewUnderItsNameIsNews) {
  note(ContactStatus::kAllowed);
  contacts.change(scene);
  ContactReport anew = report(ContactStatus::kAllowed);
  anew.since_cycle = 50;
  contacts.note(std::span(&anew, 1));
  EXPECT_EQ(logged->count("[contact-allowed]"), 2u);
  EXPECT_TRUE(logged->has("since cycle 50")) << logged->text();
}

}  // namespace
}  // namespace clearance::test
