// Bits that flip in the memory that a monitor holds as constant, while it ticks.
//
// Oracle: the bit that the test itself has flipped. A trial runs in a process of its own, since an
// index with another bit may end the program: that ends publishing, too, by a signal.
//
// Fewer or more of them: CLEARANCE_FLIPS=1000 monitor_tests --gtest_filter='SelfTests.*Flip*'
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <set>

#include "config/cell/cell_file.hpp"
#include "monitor/tick/self_test.hpp"
#include "monitor/tick/tick_state.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/shared/allocation_count.hpp"
#include "tests/shared/places.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/repeats.hpp"
#include "tests/shared/simulated_samples.hpp"

namespace clearance {
namespace {

// A shipped cell in motion: its objects by their simulation, its joints about the middle of their
// ranges.
struct MovingCell {
  explicit MovingCell(const std::string& name)
      : cell(std::get<Cell>(
            read_cell(std::filesystem::path(test::places::sources()) / "config/cells" / name))) {
    state.emplace(cell.scene);
  }
  const SelfTest& tick() {
    const std::int64_t now = test::kStart + ++ticks * test::kTick;
    const double t = 1e-9 * static_cast<double>(ticks * test::kTick);
    PoseBatch batch;
    batch.source = SourceName("test");
    batch.scene_revision = cell.scene.revision;
    batch.samples = simulated_samples(cell.simulation, t, now);
    for (std::uint32_t i = 0; i < cell.scene.variables.size(); ++i) {
      const JointVariable& of = cell.scene.variables[i];
      const bool is_limited = std::isfinite(of.lower) && std::isfinite(of.upper);
      const double middle = is_limited ? 0.5 * (of.lower + of.upper) : 0.0;
      const double range = is_limited ? 0.4 * (of.upper - of.lower) : 0.4;
      batch.joints.push_back(
          {.variable = i, .stamp_ns = now, .position = middle + range * std::sin(0.5 * t)});
    }
    static_cast<void>(state->use(batch));  // not, if the scene's revision has flipped
    report = &state->tick(now);
    state->clear();
    return state->monitor().self_test();
  }

  Cell cell;
  std::optional<TickState> state;
  const Report* report = nullptr;
  std::int64_t ticks = 0;
};

std::byte* changeable(const std::byte* constant) { return const_cast<std::byte*>(constant); }

// kOtherName: a flipped index has made the tick write into another table, which is found first.
enum Outcome { kFound, kOtherName, kMissed, kOutcomes };

// Flips the bit and ticks on.
Outcome outcome_of(std::size_t index, std::size_t byte, unsigned bit, MovingCell& moving) {
  const SelfTest& test = moving.state->monitor().self_test();
  const ConstantBlock& block = test.memory().blocks()[index];
  const std::string owner = test.memory().owners()[block.owner];
  *changeable(block.at + byte / block.size * block.stride + byte % block.size) ^= std::byte{1}
                                                                                  << bit;
  for (std::uint64_t i = 0; i < test.ticks(); ++i) {
    if (!moving.tick().failed()) continue;
    const std::string fault = test.fault();
    const bool is_named = fault.find(block.table) != fault.npos && fault.find(owner) != fault.npos;
    // What is asked may itself be flipped.
    return is_named || fault.find("known query") != fault.npos ? kFound : kOtherName;
  }
  return kMissed;
}

class FlippedConstants : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(SelfTests, FlippedConstants,
                         testing::Values("two_arms.yaml", "seven_joint_arms.yaml", "stops.yaml",
                                         "errors.yaml", "camera.yaml", "people.yaml",
                                         "tools.yaml"));

// Every byte of every block is as likely as any other.
TEST_P(FlippedConstants, AreFoundWithinTheNumberOfTicksThatIsToldAndNamed) {
  MovingCell moving(GetParam());
  const char* const asked = std::getenv("CLEARANCE_FLIPS");
  const int flips =
      (asked == nullptr ? static_cast<int>(repeats(10'000, 8)) : std::atoi(asked)) / 6;
  Random random(63);
  const auto blocks = moving.tick().memory().blocks();
  const std::size_t bytes = moving.tick().bytes();
  std::array<int, kOutcomes> outcomes{};
  int ended = 0;
  std::fflush(nullptr);
  for (int trial = 0; trial < flips; ++trial) {
    std::size_t byte = random.next() % bytes, block = 0;
    while (byte >= std::size_t{blocks[block].size} * blocks[block].count)
      byte -= std::size_t{blocks[block].size} * blocks[block].count, ++block;
    const auto bit = static_cast<unsigned>(random.next() % 8);
    const pid_t child = fork();
    if (child == 0) {
      if (std::freopen("/dev/null", "w", stderr) == nullptr) _exit(99);
      for (const int by : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE}) std::signal(by, SIG_DFL);
      alarm(5);  // a flip may leave a loop without an end
      _exit(outcome_of(block, byte, bit, moving));
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    const bool has_outcome = WIFEXITED(status) && WEXITSTATUS(status) < kOutcomes;
    if (has_outcome && WEXITSTATUS(status) == kMissed) {
      ADD_FAILURE() << "not found: bit " << bit << " of byte " << byte << " of '"
                    << blocks[block].table << "' of "
                    << moving.tick().memory().owners()[blocks[block].owner];
    }
    has_outcome ? ++outcomes[static_cast<std::size_t>(WEXITSTATUS(status))] : ++ended;
    ASSERT_FALSE(moving.tick().failed()) << "the next trial begins at another place of the pass";
  }
  EXPECT_LT(ended, flips / 5) << "most are found before they end the program";
  EXPECT_LE(outcomes[kOtherName], flips / 200);
  std::printf(
      "%s: of %d flips in %zu kB, %d found within %llu ticks and named, %d by another table",
      GetParam(), flips, bytes / 1000, outcomes[kFound],
      static_cast<unsigned long long>(moving.tick().ticks()), outcomes[kOtherName]);
  std::printf(", %d ended by a signal\n", ended);
}

// A test that finds what is not there would end a daemon without a reason.
TEST_P(FlippedConstants, AreNotFoundWhereNoneIs) {
  MovingCell moving(GetParam());
  const std::uint64_t pass = moving.tick().ticks();
  for (std::uint64_t i = 0; i < 3 * pass; ++i) ASSERT_FALSE(moving.tick().failed()) << i;
  EXPECT_TRUE(moving.tick().holds());
  const bool has_persons = GetParam() == std::string("people.yaml");  // a tracker lists them
  EXPECT_TRUE(has_persons || moving.report->unknown < moving.report->pairs_total)
      << "the inputs are used";
}

// A copy allocates exactly what the scene holds outside of itself, in grains of 16 bytes. Between
// two allocations are at least as many.
TEST_P(FlippedConstants, HaveNoPlaceInASceneThatIsNotChecked) {
  constexpr std::size_t kGrain = 16;
  const MovingCell moving(GetParam());
  const std::uint64_t before = allocated_bytes();
  const Scene scene = moving.cell.scene;
  const std::uint64_t held = allocated_bytes() - before;
  ConstantMemory memory(SelfTest::kBytesATick);
  memory.add(scene);
  std::map<const std::byte*, std::size_t> places;
  for (const ConstantBlock& block : memory.blocks()) {
    const std::size_t bytes = std::size_t{block.size} * block.count;
    EXPECT_TRUE(places.emplace(block.at, bytes).second) << block.table << " is listed twice";
  }
  EXPECT_EQ(places.erase(reinterpret_cast<const std::byte*>(&scene)), 1u);
  std::size_t listed = 0;
  for (auto place = places.begin(); place != places.end();) {
    const std::byte* const begin = place->first;
    const std::byte* end = begin;
    for (; place != places.end() && place->first == end; ++place) end += place->second;
    listed += (static_cast<std::size_t>(end - begin) + kGrain - 1) / kGrain * kGrain;
  }
  EXPECT_EQ(listed, held);
}

// A successor copies hulls and shares nothing else: what had flipped before counts.
TEST(SelfTests, OfASuccessorFailIfTheMonitorBeforeIsDamaged) {
  MovingCell moving("two_arms.yaml");
  moving.tick();
  EXPECT_FALSE(Monitor(moving.cell.scene, &moving.state->monitor()).self_test().failed());
  *changeable(reinterpret_cast<const std::byte*>(&moving.cell.scene.pairs[3].second)) ^=
      std::byte{1};
  const Monitor after(moving.cell.scene, &moving.state->monitor());
  EXPECT_TRUE(after.self_test().failed());
  EXPECT_EQ(after.self_test().fault(), "a table of the scene before has changed in memory");
}

TEST(KnownQueries, HaveTheAnswersThatWereNotedOnEveryMachine) {
  std::set<std::uint64_t> answers;
  for (const KnownQuery& query : known_queries()) {
    EXPECT_EQ(query.ask(), query.answer) << query.what << " has 0x" << std::hex << query.ask();
    answers.insert(query.answer);
  }
  EXPECT_EQ(answers.size(), known_queries().size());
}

TEST(KnownQueries, HaveAnotherAnswerWhenABitOfABodyOrOfThePoseFlips) {
  for (const KnownQuery& of : known_queries()) {
    KnownQuery query = of;
    query.a_from_b.position.x() = std::nextafter(query.a_from_b.position.x(), 9.0);
    EXPECT_NE(query.ask(), query.answer) << query.what;
  }
}

}  // namespace
}  // namespace clearance
