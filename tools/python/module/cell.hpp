// clearance.Cell: a cell file or a robot, and its distances in given configurations.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "config/cell/cell_file.hpp"
#include "monitor/ask/asker.hpp"
#include "monitor/interface/mutex.hpp"
#include "tools/python/module/configurations.hpp"

namespace clearance::python {

// Objects that calls have given back. Threads may share it.
template <class T>
class Idle {
 public:
  [[nodiscard]] std::unique_ptr<T> borrow(const Scene& scene) {
    {
      const Lock lock(mutex_);
      if (!idle_.empty()) {
        auto one = std::move(idle_.back());
        idle_.pop_back();
        return one;
      }
    }
    return std::make_unique<T>(scene);
  }
  void give_back(std::unique_ptr<T> one) {
    const Lock lock(mutex_);
    idle_.push_back(std::move(one));
  }

 private:
  Mutex mutex_;
  GUARDED_BY(mutex_) std::vector<std::unique_ptr<T>> idle_;
};

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
  [[nodiscard]] std::unique_ptr<Configurations> borrow() const { return idle_.borrow(scene()); }
  [[nodiscard]] std::unique_ptr<Asker> borrow_asker() const { return askers_.borrow(scene()); }
  void give_back(std::unique_ptr<Configurations> used) const { idle_.give_back(std::move(used)); }
  void give_back(std::unique_ptr<Asker> used) const { askers_.give_back(std::move(used)); }

 private:
  Cell cell_;
  std::vector<std::string> notes_;
  mutable Idle<Configurations> idle_;
  mutable Idle<Asker> askers_;
};

using CellClass = pybind11::class_<CellObject, std::shared_ptr<CellObject>>;

// Adds the classes of questions about motions, Cell.ask() and ask().
void add_questions(pybind11::module_& module, CellClass& cells);
// Adds the class Distances, and Cell.distances(), which returns one.
void add_distances(pybind11::module_& module, CellClass& cells);

}  // namespace clearance::python
