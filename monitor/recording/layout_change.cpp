// XCDR1 (DDS-XTypes 1.3, section 7.4.1): numbers are aligned to their size, counted from the end of
// the header. Strings and sequences begin with a length of 4 bytes. Structs are their fields in a
// row.
#include "monitor/recording/layout_change.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string_view>

namespace clearance {
namespace {

using Kind = IdlType::Kind;

constexpr std::size_t kHeader = 4;
constexpr std::array<std::byte, 2> kXcdr1LittleEndian = {std::byte{0}, std::byte{1}};

std::size_t aligned(std::size_t at, std::size_t size) { return (at + size - 1) / size * size; }

const IdlField* find(const IdlStruct& fields, std::string_view name) {
  const auto found = std::ranges::find(fields.fields, name, &IdlField::name);
  return found == fields.fields.end() ? nullptr : &*found;
}

// Fields that the daemon leaves at 0 in its recordings: they state how a message came to a client.
bool is_of_delivery(std::string_view field) {
  constexpr std::array<std::string_view, 3> kFields = {"delivery_checksum", "period_ns", "address"};
  return std::ranges::find(kFields, field) != kFields.end();
}

// Finds what a recording of one layout lacks in the other, and whether both are the same.
struct LayoutComparison {
  std::string error;
  bool is_same = true;
  std::set<std::string> not_recorded;

  void compare(const IdlType& recorded, const IdlType& ours, const std::string& where) {
    // An array is named by its length.
    const bool has_name =
        ours.kind == Kind::kNumber || ours.name.ends_with(']') || recorded.name.ends_with(']');
    if (recorded.kind != ours.kind || (has_name && recorded.name != ours.name)) {
      error = fmt::format("{} is {} there and {} here", where, recorded.name, ours.name);
    } else if (ours.kind == Kind::kSequence) {
      compare(*recorded.element, *ours.element, where);
    } else if (ours.kind == Kind::kStruct) {
      compare(*recorded.fields, *ours.fields);
    }
  }
  void compare(const IdlStruct& recorded, const IdlStruct& ours) {
    is_same = is_same && std::ranges::equal(recorded.fields, ours.fields, {}, &IdlField::name,
                                            &IdlField::name);
    for (const IdlField& field : ours.fields) {
      const std::string name = fmt::format("{}.{}", ours.name, field.name);
      if (const IdlField* there = find(recorded, field.name)) {
        compare(there->type, field.type, name);
      } else if (!is_of_delivery(field.name)) {
        not_recorded.insert(name);
      }
    }
  }
};

// Bytes behind the header; every length is checked against what is there.
class Input {
 public:
  explicit Input(std::span<const std::byte> bytes) : bytes_(bytes) {}
  [[nodiscard]] std::size_t at() const { return at_; }
  void go_to(std::size_t at) { at_ = at; }
  [[nodiscard]] bool ok() const { return ok_; }

  std::span<const std::byte> take(std::size_t size, std::size_t alignment) {
    const std::size_t begin = aligned(at_, alignment);
    ok_ = ok_ && begin <= bytes_.size() && size <= bytes_.size() - begin;
    if (!ok_) return {};
    at_ = begin + size;
    return bytes_.subspan(begin, size);
  }
  std::uint32_t take_length() {
    std::uint32_t length = 0;
    const auto bytes = take(sizeof length, sizeof length);
    if (ok_) std::memcpy(&length, bytes.data(), sizeof length);
    // Every element takes a byte or more, so a huge length soon meets the end of the bytes.
    ok_ = ok_ && length <= bytes_.size() - at_;
    return ok_ ? length : 0;
  }

 private:
  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
  bool ok_ = true;
};

void pass_over(const IdlType& type, Input& in) {
  if (type.kind == Kind::kNumber) {
    in.take(type.size, type.size);
  } else if (type.kind == Kind::kString) {
    in.take(in.take_length(), 1);
  } else if (type.kind == Kind::kSequence) {
    for (std::uint32_t left = in.take_length(); left > 0 && in.ok(); --left)
      pass_over(*type.element, in);
  } else {
    for (const IdlField& field : type.fields->fields) pass_over(field.type, in);
  }
}

class Output {
 public:
  explicit Output(std::vector<std::byte>& bytes) : bytes_(bytes) {}

  void put(std::span<const std::byte> bytes, std::size_t alignment) {
    bytes_.resize(kHeader + aligned(bytes_.size() - kHeader, alignment));
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }
  template <class Number>
  void put(Number number) {
    put(std::as_bytes(std::span(&number, 1)), sizeof number);
  }
  void put_not_recorded(const IdlType& type) {
    if (type.kind == Kind::kStruct) {
      for (const IdlField& field : type.fields->fields) put_not_recorded(field.type);
    } else if (type.kind == Kind::kString) {
      put(std::uint32_t{1});  // the terminating zero
      put(std::byte{0});
    } else if (type.kind == Kind::kSequence) {
      put(std::uint32_t{0});
    } else if (type.name == "double") {
      put(std::numeric_limits<double>::quiet_NaN());
    } else {
      constexpr std::array<std::byte, 8> kZero{};
      put(std::span(kZero).first(type.size), type.size);
    }
  }

 private:
  std::vector<std::byte>& bytes_;
};

void copy(const IdlType& recorded, const IdlType& ours, Input& in, Output& out);

// Finds the start of each recorded field, then goes through the fields of this build.
void copy(const IdlStruct& recorded, const IdlStruct& ours, Input& in, Output& out) {
  std::vector<std::size_t> begins;
  for (const IdlField& field : recorded.fields) {
    begins.push_back(in.at());
    pass_over(field.type, in);
  }
  const std::size_t end = in.at();
  for (const IdlField& field : ours.fields) {
    if (!in.ok()) return;
    const IdlField* there = find(recorded, field.name);
    if (there == nullptr) {
      out.put_not_recorded(field.type);
      continue;
    }
    in.go_to(begins[static_cast<std::size_t>(there - recorded.fields.data())]);
    copy(there->type, field.type, in, out);
  }
  in.go_to(end);
}

void copy(const IdlType& recorded, const IdlType& ours, Input& in, Output& out) {
  if (ours.kind == Kind::kStruct) {
    copy(*recorded.fields, *ours.fields, in, out);
  } else if (ours.kind == Kind::kNumber) {
    out.put(in.take(ours.size, ours.size), ours.size);
  } else {
    const std::uint32_t length = in.take_length();
    out.put(length);
    if (ours.kind == Kind::kString) out.put(in.take(length, 1), 1);
    for (std::uint32_t left = length; ours.kind == Kind::kSequence && left > 0 && in.ok(); --left)
      copy(*recorded.element, *ours.element, in, out);
  }
}

}  // namespace

LayoutChange::LayoutChange(std::string_view recorded_idl, std::string_view our_idl,
                           std::string_view type) {
  const IdlTypes recorded = parse_idl(recorded_idl), ours = parse_idl(our_idl);
  const auto there = recorded.structs.find(type), here = ours.structs.find(type);
  if (!recorded.error.empty() || there == recorded.structs.end() || here == ours.structs.end()) {
    error_ = recorded.error.empty()
                 ? fmt::format("its schema has no struct {}", type)
                 : fmt::format("its schema is not understood: {}", recorded.error);
    return;
  }
  recorded_ = {.kind = Kind::kStruct, .name = std::string(type), .fields = there->second};
  ours_ = {.kind = Kind::kStruct, .name = std::string(type), .fields = here->second};
  LayoutComparison comparison;
  comparison.compare(*recorded_.fields, *ours_.fields);
  error_ = comparison.error;
  is_same_ = comparison.is_same;
  not_recorded_ = comparison.not_recorded;
}

std::span<const std::byte> LayoutChange::apply(std::span<const std::byte> cdr) {
  if (cdr.size() < kHeader || !std::ranges::equal(cdr.first(2), kXcdr1LittleEndian)) return {};
  out_.assign(cdr.begin(), cdr.begin() + kHeader);
  Input in(cdr.subspan(kHeader));
  Output out(out_);
  copy(recorded_, ours_, in, out);
  const bool is_whole = in.ok() && cdr.size() - kHeader - in.at() < kHeader;
  if (!is_whole) return {};
  const std::size_t padding = aligned(out_.size(), kHeader) - out_.size();
  out_.resize(out_.size() + padding);
  out_[3] = static_cast<std::byte>(padding);
  return out_;
}

}  // namespace clearance
