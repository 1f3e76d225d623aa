#include "config/moveit/collision_matrix.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace clearance::moveit {
namespace {

// Two entries of one name contradict each other, and none says which is meant.
std::optional<FieldFault> refuse_double(const char* field, std::vector<std::string> names) {
  std::ranges::sort(names);
  const auto twice = std::ranges::adjacent_find(names);
  if (twice == names.end()) return std::nullopt;
  return FieldFault{field, fmt::format("found '{}' twice; expected each name once", *twice)};
}

}  // namespace

std::optional<FieldFault> CollisionMatrix::set(const AllowedCollisionMatrix& matrix) {
  const std::size_t count = matrix.entry_names.size();
  if (matrix.entry_values.size() != count) {
    return FieldFault{"entry_values", fmt::format("found {} rows for {} names; expected one each",
                                                  matrix.entry_values.size(), count)};
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (matrix.entry_values[i].size() == count) continue;
    return FieldFault{fmt::format("entry_values[{}].enabled", i),
                      fmt::format("found {} values for {} names; expected one each",
                                  matrix.entry_values[i].size(), count)};
  }
  if (matrix.default_entry_values.size() != matrix.default_entry_names.size()) {
    return FieldFault{
        "default_entry_values",
        fmt::format("found {} values for {} names; expected one each",
                    matrix.default_entry_values.size(), matrix.default_entry_names.size())};
  }
  if (auto fault = refuse_double("entry_names", matrix.entry_names)) return fault;
  if (auto fault = refuse_double("default_entry_names", matrix.default_entry_names)) return fault;
  is_set_ = true;
  rows_ = matrix.entry_values;
  places_.clear();
  for (std::size_t i = 0; i < count; ++i) places_[matrix.entry_names[i]] = i;
  defaults_.clear();
  for (std::size_t i = 0; i < matrix.default_entry_names.size(); ++i)
    defaults_[matrix.default_entry_names[i]] = matrix.default_entry_values[i];
  return std::nullopt;
}

void CollisionMatrix::forget(const std::string& name) {
  places_.erase(name);
  defaults_.erase(name);
}

bool CollisionMatrix::allows(const std::string& a, const std::string& b) const {
  const auto row = places_.find(a), column = places_.find(b);
  if (row != places_.end() && column != places_.end())
    return rows_[row->second][column->second] && rows_[column->second][row->second];
  const auto default_a = defaults_.find(a), default_b = defaults_.find(b);
  if (default_a == defaults_.end() && default_b == defaults_.end()) return false;
  return (default_a == defaults_.end() || default_a->second) &&
         (default_b == defaults_.end() || default_b->second);
}

AllowedCollisionMatrix CollisionMatrix::message() const {
  AllowedCollisionMatrix matrix;
  for (const auto& [name, row] : places_) {
    matrix.entry_names.push_back(name);
    std::vector<bool>& values = matrix.entry_values.emplace_back();
    for (const auto& [other, column] : places_) values.push_back(rows_[row][column]);
  }
  for (const auto& [name, allowed] : defaults_) {
    matrix.default_entry_names.push_back(name);
    matrix.default_entry_values.push_back(allowed);
  }
  return matrix;
}

std::set<std::string> CollisionMatrix::names() const {
  std::set<std::string> names;
  for (const auto& [name, place] : places_) names.insert(name);
  for (const auto& [name, allowed] : defaults_) names.insert(name);
  return names;
}

}  // namespace clearance::moveit
