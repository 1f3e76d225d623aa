// The state of a SceneTranslator as bytes.
#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "monitor/bodies/tracked_object.hpp"
#include "monitor/inputs/state_bytes.hpp"
#include "monitor/intake/scene_translator.hpp"

namespace clearance::moveit {
namespace {

// Far above what a scene has: bytes of something else are refused before they take much memory.
constexpr std::size_t kMost = 1 << 20;

class Writer {
 public:
  explicit Writer(std::vector<std::byte>& bytes) : out_(bytes) {}
  void put(const std::string& text) { out_.put(std::span<const char>(text)); }
  void put(double value) { out_.put(value); }
  void put(bool value) { out_.put(static_cast<std::uint8_t>(value)); }
  void put(const Pose& pose) {
    const Eigen::Quaterniond& q = pose.orientation;
    for (const double value : pose.position) put(value);
    for (const double value : {q.x(), q.y(), q.z(), q.w()}) put(value);
  }
  void put(const std::vector<bool>& flags) {
    put_count(flags.size());
    for (const bool flag : flags) put(flag);
  }
  template <class List, class PutOne>
  void put_each(const List& list, const PutOne& put_one) {
    put_count(list.size());
    for (const auto& each : list) put_one(each);
  }

 private:
  void put_count(std::size_t count) { out_.put(static_cast<std::uint64_t>(count)); }
  StateWriter out_;
};

// After bytes that do not fit, all values are empty.
class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : in_(bytes) {}
  [[nodiscard]] bool complete() const { return in_.complete(); }
  std::string text() {
    std::vector<char> letters;
    in_.take_list(letters, kMost);
    return {letters.begin(), letters.end()};
  }
  template <class T>
  T value() {
    T taken{};
    in_.take(taken);
    return taken;
  }
  bool flag() { return value<std::uint8_t>() != 0; }
  Pose pose() {
    std::array<double, 7> v{};
    for (double& each : v) each = value<double>();
    return {{v[0], v[1], v[2]}, {v[6], v[3], v[4], v[5]}};
  }
  std::vector<bool> flags() {
    std::vector<bool> list(count());
    for (std::size_t i = 0; i < list.size(); ++i) list[i] = flag();
    return list;
  }
  std::size_t count() { return std::min<std::size_t>(value<std::uint64_t>(), kMost); }

 private:
  StateReader in_;
};

}  // namespace

void SceneTranslator::save(std::vector<std::byte>& bytes) const {
  Writer out(bytes);
  out.put_each(world_from_frame_, [&](const auto& each) {
    out.put(each.first);
    out.put(each.second);
  });
  out.put_each(subframes_, [&](const auto& each) {
    out.put(each.first);
    out.put(each.second.object);
    out.put(each.second.object_from_subframe);
  });
  out.put_each(padded_, [&](const auto& each) {
    out.put(each.first);
    out.put(each.second);
  });
  const AllowedCollisionMatrix matrix = matrix_.message();
  out.put(matrix_.is_set());
  out.put_each(matrix.entry_names, [&](const std::string& name) { out.put(name); });
  out.put_each(matrix.entry_values, [&](const std::vector<bool>& row) { out.put(row); });
  out.put_each(matrix.default_entry_names, [&](const std::string& name) { out.put(name); });
  out.put(matrix.default_entry_values);
}

bool SceneTranslator::restore(std::span<const std::byte> bytes) {
  Reader in(bytes);
  SceneTranslator read(meshes_);
  for (std::size_t left = in.count(); left > 0; --left) {
    const std::string name = in.text();
    const Pose world_from_frame = in.pose();
    if (!is_usable(world_from_frame)) return false;
    read.world_from_frame_[name] = world_from_frame;
  }
  for (std::size_t left = in.count(); left > 0; --left) {
    Subframe& subframe = read.subframes_[in.text()];
    subframe.object = in.text();
    subframe.object_from_subframe = in.pose();
    if (!is_usable(subframe.object_from_subframe)) return false;
  }
  for (std::size_t left = in.count(); left > 0; --left) {
    const std::string name = in.text();
    const double padding = in.value<double>();
    if (!(padding >= 0.0 && padding <= kLargestCoordinate)) return false;
    read.padded_[name] = padding;
  }
  AllowedCollisionMatrix matrix;
  const bool is_set = in.flag();
  for (std::size_t left = in.count(); left > 0; --left) matrix.entry_names.push_back(in.text());
  for (std::size_t left = in.count(); left > 0; --left) matrix.entry_values.push_back(in.flags());
  for (std::size_t left = in.count(); left > 0; --left)
    matrix.default_entry_names.push_back(in.text());
  matrix.default_entry_values = in.flags();
  if (!in.complete() || (is_set && read.matrix_.set(matrix))) return false;
  *this = std::move(read);
  return true;
}

}  // namespace clearance::moveit
