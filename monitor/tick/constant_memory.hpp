// Memory that nothing changes while a monitor lives, as a list of blocks with their names: the
// scene, the tables of its bodies and hulls, and what the monitor has made of both.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "config/scene/scene.hpp"

namespace clearance {

// Values of one table: `count` of `size` bytes, `stride` bytes from one to the next.
struct ConstantBlock {
  const std::byte* at = nullptr;
  std::uint32_t size = 0, stride = 0, count = 0;
  std::uint32_t owner = 0;      // index into ConstantMemory::owners()
  const char* table = nullptr;  // its name; a literal

  // What it costs to read: the cache lines that it has.
  [[nodiscard]] std::size_t cost() const noexcept {
    constexpr std::size_t kLine = 64;
    const std::size_t apart = std::min<std::size_t>(stride, (size + kLine - 1) / kLine * kLine);
    return std::max(kLine, count * apart);
  }
};

class ConstantMemory {
 public:
  // No block that add() makes costs more: what is larger is divided.
  explicit ConstantMemory(std::size_t most_cost) : most_cost_(most_cost) {}

  // The owner of the tables that follow: "the object 'table'".
  void begin(std::string owner) { owners_.push_back(std::move(owner)); }
  // A value without what it holds elsewhere.
  template <class T>
  void add_value(const char* table, const T& value) {
    add(table, &value, sizeof(T), sizeof(T), 1);
  }
  // The same part of all elements: from `first` on, `size` bytes.
  template <class T>
  void add_part(const char* table, std::span<const T> all, const void* first, std::size_t size) {
    if (!all.empty()) add(table, first, size, sizeof(T), all.size());
  }
  // A table with all that it holds elsewhere.
  template <class T, class Allocator>
  void operator()(const char* table, const std::vector<T, Allocator>& all) {
    (*this)(table, std::span<const T>(all));
    for (const T& each : all) add_inside(table, each);
  }
  template <class T>
  void operator()(const char* table, std::span<const T> all) {
    if (!all.empty()) add(table, all.data(), sizeof(T), sizeof(T), all.size());
  }
  void add(const Scene& scene);
  void add(const ConvexBody& body);

  [[nodiscard]] std::span<const ConstantBlock> blocks() const noexcept { return blocks_; }
  [[nodiscard]] const std::vector<std::string>& owners() const noexcept { return owners_; }

 private:
  void add(const char* table, const void* at, std::size_t size, std::size_t stride,
           std::size_t count);
  // What an element holds outside of itself.
  template <class T>
  void add_inside(const char* /*table*/, const T& /*value*/) {
    static_assert(std::is_trivially_destructible_v<T>, "an overload has to list what it holds");
  }
  template <class T>
  void add_inside(const char* table, const std::vector<T>& all) {
    (*this)(table, all);
  }
  void add_inside(const char* table, const std::string& text);
  void add_inside(const char* table, const Object& object);
  void add_inside(const char* table, const Sensor& sensor);
  void add_inside(const char* table, const Robot& robot);
  void add_inside(const char* table, const RobotLink& link);
  void add_inside(const char* table, const RobotJoint& joint);
  void add_inside(const char* table, const JointVariable& variable);
  void add_inside(const char* table, const JointStop& stop);
  void add_inside(const char* table, const StopStep& step);
  void add_inside(const char* table, const NamedPair& rule);
  void add_inside(const char* table, const Zone& zone);
  void add_inside(const char* table, const AllowedContact& contact);

  std::size_t most_cost_;
  std::vector<std::string> owners_;
  std::vector<ConstantBlock> blocks_;
};

}  // namespace clearance
