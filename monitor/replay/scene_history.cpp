#include "monitor/replay/scene_history.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <variant>

namespace clearance {

SceneHistory::SceneHistory(const Cell& first) : first_(first) {}

SceneHistory::SceneHistory(const Cell& first, const std::vector<std::filesystem::path>& files,
                           std::function<void(Scene&)> adapt, bool is_recorded)
    : first_(first), adapt_(std::move(adapt)) {
  (is_recorded ? described_ : of_others_) = described_scenes(files);
  if (is_recorded) former_ = former_scenes(files.front());
}

bool SceneHistory::has_changes() const noexcept {
  return std::ranges::any_of(described_, [this](const DescribedScene& scene) {
    return scene.revision != first_.scene.revision;
  });
}

std::size_t SceneHistory::changes_left_out() const noexcept {
  std::size_t count = 0;
  for (std::size_t i = 1; i < of_others_.size(); ++i)
    count += of_others_[i].revision != of_others_[i - 1].revision ? 1 : 0;
  return count;
}

const DescribedScene* SceneHistory::next_change(std::uint64_t daemon, std::uint64_t joined,
                                                std::uint64_t cycle) const {
  const DescribedScene* next = nullptr;
  for (const DescribedScene& scene : described_) {
    if (scene.daemon != daemon || scene.joined != joined || scene.since.from <= cycle) continue;
    if (next == nullptr || scene.since.from < next->since.from) next = &scene;
  }
  return next;
}

const Cell* SceneHistory::cell(std::uint64_t revision) {
  return revision == first_.scene.revision ? &first_ : read(described_, revision);
}

const Cell* SceneHistory::recorded(std::uint64_t revision) { return read(of_others_, revision); }

const Cell* SceneHistory::read(const std::vector<DescribedScene>& scenes, std::uint64_t revision) {
  if (const auto known = read_.find(revision); known != read_.end()) return known->second.get();
  const auto described =
      std::ranges::find(scenes.rbegin(), scenes.rend(), revision, &DescribedScene::revision);
  if (described == scenes.rend()) return nullptr;
  CellResult read = cell_of(*described);
  if (const auto* errors = std::get_if<std::vector<CellError>>(&read)) {
    error_ = errors->front().text;
    return nullptr;
  }
  auto cell = std::make_unique<Cell>(std::move(std::get<Cell>(read)));
  if (cell->scene.revision != revision) {
    error_ = fmt::format("this build reads it as another one, {:016x}", cell->scene.revision);
    return nullptr;
  }
  adapt_(cell->scene);
  return read_.emplace(revision, std::move(cell)).first->second.get();
}

}  // namespace clearance
