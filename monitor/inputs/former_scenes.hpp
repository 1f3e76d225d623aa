// Facts about the last scenes before the one in force, by revision.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace clearance {

// When there are more than kMost, a new one takes the place of the one that has been there longest.
// Does not allocate.
template <class Kept>
class FormerScenes {
 public:
  static constexpr std::size_t kMost = 8;
  struct Entry {
    std::uint64_t revision = 0;
    Kept kept = {};
  };

  // The entry of this revision, or the place of a new one. A scene that was in force before keeps
  // its place, so that attaching and detaching again and again does not displace the scene whose
  // ids senders have.
  [[nodiscard]] Entry& slot(std::uint64_t revision) noexcept {
    for (std::size_t i = 0; i < size(); ++i) {
      if (entries_[i].revision == revision) return entries_[i];
    }
    Entry& entry = entries_[count_++ % kMost];
    entry.revision = revision;
    return entry;
  }
  // Null: it is none of the last scenes.
  [[nodiscard]] const Entry* find(std::uint64_t revision) const noexcept {
    for (std::size_t i = 0; i < size(); ++i) {
      if (entries_[i].revision == revision) return &entries_[i];
    }
    return nullptr;
  }
  // In the order in which slot() makes another list of them that is alike from then on.
  template <class Use>
  void for_each(const Use& use) {
    for (std::size_t i = 0; i < size(); ++i) use(entries_[place(i)]);
  }
  template <class Use>
  void for_each(const Use& use) const {
    for (std::size_t i = 0; i < size(); ++i) use(entries_[place(i)]);
  }
  void clear() noexcept { count_ = 0; }
  [[nodiscard]] std::size_t size() const noexcept { return std::min(count_, kMost); }

 private:
  // The place of an entry, the oldest one first.
  [[nodiscard]] std::size_t place(std::size_t i) const noexcept {
    return ((count_ > kMost ? count_ % kMost : 0) + i) % kMost;
  }

  std::array<Entry, kMost> entries_;
  std::size_t count_ = 0;  // those that are lost included
};

}  // namespace clearance
