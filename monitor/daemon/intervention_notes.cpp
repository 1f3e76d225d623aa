#include "monitor/daemon/intervention_notes.hpp"

#include <fmt/format.h>

#include <string>
#include <variant>

#include "config/text/sha256.hpp"
#include "monitor/participant/command_message.hpp"
#include "monitor/wire/cdr.hpp"

namespace clearance {
namespace {

using nlohmann::ordered_json;

// "attach part": the change and what it names.
std::string text_of(const CellChange& change) {
  const std::string name(kChangeNames[change.index()]);
  return std::visit(
      [&name](const auto& of) {
        if constexpr (requires { of.object; }) return name + " " + of.object;
        if constexpr (requires { of.robot; }) return name + " " + of.robot;
        if constexpr (requires { of.zone; }) return name + " " + of.zone;
        if constexpr (requires { of.contact; }) return name + " " + of.contact;
        if constexpr (requires { of.a; }) return name + " " + of.a + ", " + of.b;
        return name;
      },
      change);
}

}  // namespace

ordered_json note_of(const SceneTask& task) {
  const auto* const given = std::get_if<GivenCommand>(&task);
  if (given == nullptr) return {{"by", sender_of(task)}};
  const Command& command = given->command;
  ordered_json note = {{"by", command.client}, {"request", command.request}};
  for (const CellChange& change : command.changes) note["changes"].push_back(text_of(change));
  CdrEncoder encoder;
  const auto cdr = encoder.encode(*to_wire(command));
  note["content"] = sha256({reinterpret_cast<const char*>(cdr.data()), cdr.size()});
  return note;
}

std::vector<std::string> notes_of(const SceneTask& task) {
  std::vector<std::string> notes;
  const auto* const given = std::get_if<GivenCommand>(&task);
  if (given == nullptr || given->command.dry_run) return notes;
  for (const CellChange& change : given->command.changes)
    if (const auto* const note = std::get_if<Note>(&change)) notes.push_back(note->text);
  return notes;
}

ordered_json note_of(const Cell& cell) {
  ordered_json note = {{"revision", fmt::format("{:016x}", cell.scene.revision)},
                       {"cell_hash", cell.hash}};
  for (std::size_t i = 0; i < cell.files.size(); ++i)
    note["files"][cell.files[i].string()] = cell.file_hashes[i];
  for (const AllowedContact& contact : cell.scene.contacts)
    note["contacts"][contact.name] = {{"by", contact.by}, {"reason", contact.reason}};
  return note;
}

}  // namespace clearance
