// The looks of robots' links, as their URDFs have them, for the page. Nothing is decided by them.
#pragma once

#include <future>
#include <string>

#include "config/cell/cell.hpp"
#include "tools/view/server.hpp"

namespace clearance::view {

// JSON: {"visuals": [{"object", "pose", "mesh", "colour"}], "meshes": [{"positions",
// "triangles"}]}, in metres, each pose in its object's frame. Links that are no objects, meshes
// that cannot be read, and triangles beyond two million are left out. It takes seconds for large
// meshes.
[[nodiscard]] std::string visuals_json(const Cell& cell);

// Reads them when a page asks for the first time, beside the thread that serves.
class Visuals {
 public:
  // The cell must outlive this.
  explicit Visuals(const Cell& cell) : cell_(cell) {}
  // The JSON, or "null" while it is being made.
  [[nodiscard]] Resource get();

 private:
  const Cell& cell_;
  std::future<std::string> made_;
  Resource resource_;
};

}  // namespace clearance::view
