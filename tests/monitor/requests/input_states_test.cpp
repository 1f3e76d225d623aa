// Threads that ask for the inputs of a running loop.
#include "monitor/requests/input_states.hpp"

#include "tests/monitor/requests/commanded_cell.hpp"

namespace clearance::test {
namespace {

class InputStatesTest : public CommandedCell {
 protected:
  static InputStates::Time now() { return std::chrono::steady_clock::now(); }
};

TEST_F(InputStatesTest, AreSharedByThoseThatAskedBeforeAndReadAgainForLaterOnes) {
  start();
  InputStates states(*loop, loop_ended);
  const InputStates::Time before = now();
  const auto first = states.of(cell, before);
  ASSERT_NE(first, nullptr);
  EXPECT_EQ(states.of(cell, before), first);
  poses->put(Pose{});
  poses->settle();
  const auto later = states.of(cell, now());
  ASSERT_NE(later, nullptr);
  EXPECT_GT(later->cycle, first->cycle);
}

TEST_F(InputStatesTest, OfAnotherCellOrAnEndedLoopThereAreNone) {
  start();
  InputStates states(*loop, loop_ended);
  EXPECT_EQ(states.of(std::make_shared<const Cell>(*cell), now()), nullptr);
  end_loop();
  EXPECT_EQ(states.of(cell, now()), nullptr);
}

}  // namespace
}  // namespace clearance::test
