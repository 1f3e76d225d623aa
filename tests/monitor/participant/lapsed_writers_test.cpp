// Writers with a lease that they have to renew themselves stand for processes that were killed.
#include "monitor/participant/lapsed_writers.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/shared/loopback.hpp"

namespace clearance::test {
namespace {

constexpr std::int64_t kLeaseNs = 50'000'000;

class LapsedWritersTest : public testing::Test {
 protected:
  dds_entity_t writer(std::int64_t lease_ns) {
    return writing.writer(TopicKind::kHealth, "lapsing", {.lease_ns = lease_ns});
  }
  static void write(dds_entity_t writer) {
    const Sample<clearance_msg_Health> message;
    EXPECT_EQ(dds_write(writer, &*message), DDS_RETCODE_OK);
  }
  // The number of writers that match, without those that have lapsed.
  [[nodiscard]] std::size_t present() const {
    std::vector<std::uint64_t> writers = writers_of(reader);
    lapsed.remove_from(writers);
    return writers.size();
  }
  [[nodiscard]] bool becomes(std::size_t count) const {
    return eventually([&] { return present() == count; });
  }

  const DdsOptions dds = own_dds();
  LapsedWriters lapsed;
  Participant reading{dds}, writing{dds};
  dds_entity_t reader = reading.reader(TopicKind::kHealth, "lapsing", 0, lapsed.listener());
};

TEST_F(LapsedWritersTest, AreThoseWhoseLeaseHasEndedUntilTheyAreHeardAgain) {
  const dds_entity_t silent = writer(kLeaseNs);
  write(silent);
  EXPECT_TRUE(eventually([&] { return matched_writers(reader) == 1; }));
  EXPECT_TRUE(becomes(0));
  EXPECT_EQ(matched_writers(reader), 1u) << "it still matches";
  EXPECT_TRUE(eventually([&] {
    write(silent);
    return present() == 1;
  }));
}

// Writers that come, live on or leave afterwards are not taken for lapsed ones.
TEST_F(LapsedWritersTest, AreNoOthers) {
  write(writer(kLeaseNs));
  EXPECT_TRUE(eventually([&] { return matched_writers(reader) == 1; }));
  EXPECT_TRUE(becomes(0));
  const dds_entity_t second = writer(0);
  EXPECT_TRUE(eventually([&] { return matched_writers(reader) == 2; }));
  EXPECT_TRUE(becomes(1));
  const dds_entity_t third = writer(0);
  EXPECT_TRUE(eventually([&] { return matched_writers(reader) == 3; }));
  EXPECT_TRUE(becomes(2));
  dds_delete(second);
  EXPECT_TRUE(eventually([&] { return matched_writers(reader) == 2; }));
  EXPECT_TRUE(becomes(1));
  dds_delete(third);
}

}  // namespace
}  // namespace clearance::test
