// MoveIt's allowed collision matrix, by names.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "config/moveit/message.hpp"

namespace clearance::moveit {

class CollisionMatrix {
 public:
  // Replaces all entries. Keeps the former ones and returns what is wrong if the matrix is not
  // square, has not one value for each name, or has a name twice.
  [[nodiscard]] std::optional<FieldFault> set(const AllowedCollisionMatrix& matrix);
  // Removes the entries of a body.
  void forget(const std::string& name);

  // Tells whether two bodies may touch: by the entry of both, or else by their default entries. If
  // both have one, both have to allow it.
  [[nodiscard]] bool allows(const std::string& a, const std::string& b) const;

  // False before the first set().
  [[nodiscard]] bool is_set() const noexcept { return is_set_; }
  // All entries, as set() takes them.
  [[nodiscard]] AllowedCollisionMatrix message() const;
  // The names that have entries of any kind.
  [[nodiscard]] std::set<std::string> names() const;

 private:
  bool is_set_ = false;
  std::map<std::string, std::size_t> places_;  // by name, in rows_
  std::vector<std::vector<bool>> rows_;
  std::map<std::string, bool> defaults_;
};

}  // namespace clearance::moveit
