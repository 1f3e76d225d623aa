// MoveIt's allowed collision matrix, as exceptions from the pairs of a cell.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "config/edit/cell_change.hpp"
#include "config/moveit/message.hpp"
#include "monitor/moveit/known_scene.hpp"

namespace clearance::moveit {

class CollisionMatrix {
 public:
  // Replaces all entries. Keeps the former ones and returns what is wrong if the matrix is not
  // square, or if it has not one value for each name.
  [[nodiscard]] std::optional<FieldFault> set(const AllowedCollisionMatrix& matrix);
  // Removes the entries of a body.
  void forget(const std::string& name);

  // Tells whether two bodies may touch: by the entry of both, or else by their default entries. If
  // both have one, both have to allow it.
  [[nodiscard]] bool allows(const std::string& a, const std::string& b) const;

  // Returns the changes after which the exceptions that follow the matrix are those that it states.
  // `present` are such exceptions, and `watched` the pairs besides. There are none before the first
  // set().
  [[nodiscard]] std::vector<CellChange> exceptions(const std::set<NamePair>& watched,
                                                   const std::set<NamePair>& present) const;

 private:
  bool is_set_ = false;
  std::map<std::string, std::size_t> places_;  // by name, in rows_
  std::vector<std::vector<bool>> rows_;
  std::map<std::string, bool> defaults_;
};

}  // namespace clearance::moveit
