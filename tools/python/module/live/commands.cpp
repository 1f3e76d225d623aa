// clearance.Commands: monitor/client/commands.hpp.
#include "monitor/client/commands.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <map>
#include <utility>

#include "config/edit/change_reader.hpp"
#include "tools/python/module/arrays.hpp"
#include "tools/python/module/live/connection.hpp"
#include "tools/python/module/live/live.hpp"

namespace clearance::python {
namespace {

std::vector<CellChange> changes_of(const std::string& text) {
  ChangesResult result = read_changes(text, "changes");
  if (const auto* errors = std::get_if<std::vector<CellError>>(&result)) {
    std::string all;
    for (const CellError& error : *errors) all += (all.empty() ? "" : "\n") + error.text;
    throw py::value_error(all);
  }
  return std::get<std::vector<CellChange>>(std::move(result));
}

struct CommandParts {
  CommandParts(SharedConnection joined, const std::string& client)
      : connection(std::move(joined)), commands(*connection, client) {}
  SharedConnection connection;
  client::Commands commands;
};

class Commands : public Live<CommandParts> {
 public:
  Commands(const std::string& client, const SharedConnection& connection)
      : Live("Commands", connection_of(connection), client) {}

  CommandResult send(const std::string& text, double timeout, bool dry_run, std::uint64_t revision,
                     const std::map<std::string, py::bytes>& files) {
    if (!(timeout >= 0.0 && timeout <= 1e6))
      throw py::value_error("timeout: expected seconds, 0 to 1e6");
    const std::vector<CellChange> changes = changes_of(text);
    const Use parts = use();
    client::CommandOptions options{.scene_revision = revision, .dry_run = dry_run};
    for (const auto& [name, bytes] : files) options.files.push_back({name, std::string(bytes)});
    bool stopped = false;
    options.stop = [&stopped] { return stopped = interrupted(); };
    std::optional<CommandResult> result;
    {
      const Unlocked unlock;
      result = parts->commands.send(
          changes, options, std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 * timeout)));
    }
    if (stopped) throw py::error_already_set();
    if (result) return *result;
    const std::string why = parts->commands.is_heard()
                                ? "the changes may be made or not"
                                : "no daemon takes commands on " + parts->connection->where();
    PyErr_SetString(PyExc_TimeoutError,
                    fmt::format("no result came within {} s: {}", timeout, why).c_str());
    throw py::error_already_set();
  }
};

}  // namespace

void add_commands(py::module_& module) {
  std::vector<Enumerator> statuses;
  for (std::size_t i = 0; i < kCommandStatuses; ++i) {
    statuses.push_back(
        {constant_name(name_of(static_cast<CommandStatus>(i))), static_cast<int>(i)});
  }
  // The type is an attribute of the module, which outlives its functions.
  const py::handle status_type =
      add_enum(module, "CommandStatus", statuses, "The answer to a command.").release();
  py::class_<CommandResult>(module, "CommandResult", "The daemon's answer to a command.")
      .def_property_readonly(
          "status",
          [status_type](const CommandResult& r) -> py::object {
            const int value = static_cast<int>(r.status);
            if (value >= static_cast<int>(kCommandStatuses)) return py::int_(value);
            return status_type(value);
          },
          "A CommandStatus, or the number of one that this client does not know.")
      .def_property_readonly("done", &CommandResult::done, "The changes are in force.")
      .def_readonly("change", &CommandResult::change, "Of a refusal: index of the change at fault.")
      .def_readonly("path", &CommandResult::path, "Of a refusal: the field at fault.")
      .def_readonly("reason", &CommandResult::reason, "Of a refusal: a sentence.")
      .def_readonly("revision", &CommandResult::scene_revision, "Of the scene in force afterwards.")
      .def_readonly("in_force_from", &CommandResult::in_force_from,
                    "The first cycle of that revision.")
      .def("__repr__", [](const CommandResult& r) {
        return fmt::format("<clearance.CommandResult: {}{}{}>", name_of(r.status),
                           r.reason.empty() ? "" : ": ", r.reason);
      });
  py::class_<Commands> commands(module, "Commands", R"(Changes the scene of a running daemon.

idl/COMMANDS.md has all changes.)");
  commands
      .def(
          py::init<const std::string&, const SharedConnection&>(), py::arg("client"),
          py::arg("connection") = py::none(),
          R"(client: a name of 1 to 32 bytes under `commands` of the daemon's cell, which no other running
program uses. Raises ValueError and DdsError.)")
      .def("send", &Commands::send, py::arg("changes"), py::arg("timeout") = 10.0, py::kw_only(),
           py::arg("dry_run") = false, py::arg("revision") = 0,
           py::arg("files") = std::map<std::string, py::bytes>(),
           R"(Sends changes, which are made wholly or not at all, and waits for the result.

changes: a YAML list: '- attach: {object: part, to: hand}'. dry_run: only asks. revision: refused
unless this one is in force; 0: any. files: bytes by name, for "sent:NAME".

Returns a CommandResult, also of a refusal. Raises ValueError with every mistake in the text, and
TimeoutError when no result came within `timeout` s. Releases the interpreter's lock; Ctrl-C ends it.)")
      .def_property_readonly(
          "is_heard", [](Commands& self) { return self.use()->commands.is_heard(); },
          "True when a daemon takes commands on this topic.");
  add_closing(commands);
}

}  // namespace clearance::python
