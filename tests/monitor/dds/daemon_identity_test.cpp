#include "monitor/dds/daemon_identity.hpp"

#include <gtest/gtest.h>

namespace clearance {
namespace {

TEST(DaemonIdentity, GoesThroughUserDataAndBack) {
  const DaemonIdentity made = make_identity();
  const auto read = from_user_data(to_user_data(made));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->id, made.id);
  EXPECT_EQ(read->start_ns, made.start_ns);
  EXPECT_EQ(read->pid, made.pid);
  EXPECT_EQ(read->host, made.host);
  EXPECT_FALSE(read->boot.empty());
  EXPECT_EQ(read->boot, made.boot);
  EXPECT_EQ(read->up_ns, made.up_ns);
  EXPECT_NE(made.id, 0u);
  EXPECT_NE(make_identity().id, made.id);
}

TEST(DaemonIdentity, IsNotReadFromOtherPrograms) {
  for (const char* text :
       {"", "clearanced", "clearanced id=1", "id=1 start_ns=2 pid=3 host=x",
        "clearanced id=zz start_ns=2 pid=3 host=x", "clearanced id=1 start_ns=2x pid=3 host=x"}) {
    EXPECT_FALSE(from_user_data(text)) << text;
  }
}

TEST(DaemonIdentity, ExactlyOneOfTwoYields) {
  const DaemonIdentity early{.id = 9, .start_ns = 100}, late{.id = 1, .start_ns = 101},
      as_late{.id = 2, .start_ns = 101};
  EXPECT_TRUE(yields_to(late, early));
  EXPECT_FALSE(yields_to(early, late));
  EXPECT_TRUE(yields_to(as_late, late));
  EXPECT_FALSE(yields_to(late, as_late));
}

TEST(DaemonIdentity, AgesOnOneMachineAreNotToldByItsWallClock) {
  const DaemonIdentity runs{.id = 1, .start_ns = 160, .boot = "b", .up_ns = 100};
  const DaemonIdentity late{.id = 2, .start_ns = 100, .boot = "b", .up_ns = 105};
  EXPECT_TRUE(yields_to(late, runs)) << "its wall clock is behind";
  EXPECT_FALSE(yields_to(runs, late));
  DaemonIdentity elsewhere = late;
  elsewhere.boot = "c";
  EXPECT_FALSE(yields_to(elsewhere, runs));
  EXPECT_TRUE(yields_to(runs, elsewhere));
}

}  // namespace
}  // namespace clearance
