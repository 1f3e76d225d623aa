// clearance.Cell: a cell file or a robot, and its distances in given configurations.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "config/cell/cell_file.hpp"
#include "tools/python/module/configurations.hpp"

namespace clearance::python {

// A checked cell, which does not change. Threads may share it.
class CellObject {
 public:
  CellObject(Cell cell, std::vector<std::string> notes)
      : cell_(std::move(cell)), notes_(std::move(notes)) {}

  [[nodiscard]] const Cell& cell() const noexcept { return cell_; }
  [[nodiscard]] const Scene& scene() const noexcept { return cell_.scene; }
  [[nodiscard]] const std::vector<std::string>& notes() const noexcept { return notes_; }

  // The names of a pair's objects.
  [[nodiscard]] pybind11::tuple pair_names(const ObjectPair& pair) const;

  // The working memory of a call: one that an earlier call gave back, or a new one.
  [[nodiscard]] std::unique_ptr<Configurations> borrow() const;
  void give_back(std::unique_ptr<Configurations> configurations) const;

 private:
  Cell cell_;
  std::vector<std::string> notes_;
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<Configurations>> idle_;
};

using CellClass = pybind11::class_<CellObject, std::shared_ptr<CellObject>>;

// Adds the class Distances, and Cell.distances(), which returns one.
void add_distances(pybind11::module_& module, CellClass& cells);

}  // namespace clearance::python
