// A motion of a file or a bag, the place where it is asked about, and its answer.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "config/cell/cell.hpp"
#include "monitor/ask/asker.hpp"

namespace clearance {

// A cell, and the memory for questions about it.
struct AskedPlace {
  explicit AskedPlace(Cell&& read) : cell(std::move(read)), asker(cell.scene) {}
  Cell cell;
  Asker asker;
};

struct AskedMotion {
  std::string where = {};          // for messages: the line, or the name
  nlohmann::ordered_json id = {};  // null: it has none
  AskedPlace* place = nullptr;
  Question question = {};
  Answer answer = {};
  std::string error = {};  // why there is no question or no answer; empty: there is
  bool as_expected = true;
  // Rad or m: of a joint's first waypoint from where the bag has it; nothing: it is not of a bag.
  std::optional<double> start_deviation = {};

  [[nodiscard]] const Scene& scene() const noexcept { return place->cell.scene; }
  [[nodiscard]] std::string name() const {
    if (id.is_null()) return "motion " + where;
    return id.is_string() ? id.get<std::string>() : id.dump();
  }
};

}  // namespace clearance
