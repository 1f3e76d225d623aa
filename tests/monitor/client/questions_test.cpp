// Questions of the client library. tests/tools has those that a daemon answers.
#include "monitor/client/questions.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <stdexcept>
#include <variant>

#include "core/shapes.hpp"
#include "tests/shared/loopback.hpp"

namespace clearance {
namespace {

// Dropped in silence, each of these would have the answer be about another question.
TEST(Questions, ThatNoMessageHoldsAreRefusedAndNotSentWithoutAPart) {
  client::Connection connection(test::own_dds());
  client::Questions questions(connection, "planner");
  const std::function<void(Question&)> unsent[] = {
      [](Question& q) { q.seen.emplace_back().sensor = "eye"; },
      [](Question& q) {
        const HalfSpace floor[] = {{Vec3(0, 0, 1), 0.0}};
        q.payloads.emplace_back().shape = std::get<ConvexBody>(polyhedron_from_halfspaces(floor));
      },
      [](Question& q) {
        const HalfSpace rows[] = {{Vec3(1, 1, 3), 0.1},
                                  {Vec3(-3, 1, -1), 0.1},
                                  {Vec3(1, -3, -1), 0.1},
                                  {Vec3(1, 1, -1), 0.1}};
        q.payloads.emplace_back().shape = std::get<ConvexBody>(polyhedron_from_halfspaces(rows));
      },
  };
  for (const auto& change : unsent) {
    Question question;
    change(question);
    EXPECT_THROW(static_cast<void>(questions.ask(question)), std::invalid_argument);
    EXPECT_THROW(static_cast<void>(questions.post(question)), std::invalid_argument);
  }
  Question sent;
  sent.poses.push_back({.object = "cart", .world_from_object = {}});
  EXPECT_NE(questions.post(sent), 0u);
}

}  // namespace
}  // namespace clearance
