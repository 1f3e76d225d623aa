// clearance.Questions: monitor/client/questions.hpp.
#include "monitor/client/questions.hpp"

#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "tools/python/module/live/connection.hpp"
#include "tools/python/module/live/live.hpp"

namespace clearance::python {
namespace {

struct QuestionParts {
  QuestionParts(SharedConnection joined, const std::string& client)
      : connection(std::move(joined)), questions(*connection, client) {}
  SharedConnection connection;
  client::Questions questions;
};

class Questions : public Live<QuestionParts> {
 public:
  Questions(const std::string& client, const SharedConnection& connection)
      : Live("Questions", connection_of(connection), client) {}

  QuestionResult ask(const Question& question, double timeout, std::uint64_t revision) {
    if (!(timeout >= 0.0 && timeout <= 1e6))
      throw py::value_error("timeout: expected seconds, 0 to 1e6");
    const Use parts = use();
    bool stopped = false;
    const client::QuestionOptions options{.scene_revision = revision,
                                          .stop = [&stopped] { return stopped = interrupted(); }};
    std::optional<QuestionResult> result;
    {
      const Unlocked unlock;
      result = parts->questions.ask(
          question, options, std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 * timeout)));
    }
    if (stopped) throw py::error_already_set();
    if (result) return *result;
    const std::string why =
        parts->questions.is_heard()
            ? "nothing is known of the motion; the daemon may still answer, so ask again "
              "with a longer timeout"
            : "no daemon answers questions on " + parts->connection->where();
    PyErr_SetString(PyExc_TimeoutError,
                    fmt::format("no answer came within {} s: {}", timeout, why).c_str());
    throw py::error_already_set();
  }
};

}  // namespace

void add_live_questions(py::module_& module) {
  py::class_<Questions> questions(module, "Questions", R"(Asks a running daemon about motions.

The daemon adds where joints and objects are now (idl/QUESTIONS.md).)");
  questions
      .def(
          py::init<const std::string&, const SharedConnection&>(), py::arg("client"),
          py::arg("connection") = py::none(),
          R"(client: a name of 1 to 32 bytes under `questions` of the daemon's cell, which no other running
program uses. Raises ValueError and DdsError.)")
      .def("ask", &Questions::ask, py::arg("question"), py::arg("timeout") = 10.0, py::kw_only(),
           py::arg("revision") = 0,
           R"(Asks, and waits for the answer.

revision: refused unless this scene is in force; 0: any. Returns a MotionAnswer, also of a refusal:
look at `answered`, or at is_free(). Raises ValueError for a payload with a Body that has more than 256
vertices or rounded ones, as half-spaces have, and TimeoutError when no answer came within `timeout` s. Releases the interpreter's lock; Ctrl-C ends it.)")
      .def_property_readonly(
          "is_heard", [](Questions& self) { return self.use()->questions.is_heard(); },
          "True when a daemon answers questions on this topic.");
  add_closing(questions);
}

}  // namespace clearance::python
