// Goes through the lists of fields (monitor/wire/message_fields.hpp) in both messages and stops at
// the first difference. No text is made before that.
#include "monitor/replay/message_difference.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <string_view>
#include <type_traits>

#include "monitor/interface/pair_name.hpp"
#include "monitor/wire/message_fields.hpp"

namespace clearance {
namespace {

// A name by its index, or the index itself where the scene has no such thing.
template <class Named>
std::string name_of(const std::vector<Named>& all, std::size_t index) {
  return index < all.size() ? fmt::format("'{}'", all[index].name) : fmt::format("{}", index);
}

// A recording may hold a value that this build does not know.
template <class Enumeration>
std::string word_or_number(Enumeration value) {
  const std::string_view word = name(value);
  return word.empty() ? fmt::format("{}", static_cast<int>(value)) : std::string(word);
}

// 17 digits identify a double.
std::string text(const Scene&, Meaning, double value) { return fmt::format("{:.17g}", value); }
std::string text(const Scene&, Meaning, bool value) { return value ? "true" : "false"; }
std::string text(const Scene& scene, Meaning meaning, std::uint64_t value) {
  const auto small = static_cast<std::uint32_t>(value);
  switch (meaning) {
    case Meaning::kPair:
      return pair_name(scene, small);
    case Meaning::kObject:
      return name_of(scene.objects, value);
    case Meaning::kZone:
      return name_of(scene.zones, value);
    case Meaning::kPairStatus:
      return word_or_number(static_cast<PairStatus>(value));
    case Meaning::kZoneCause:
      return word_or_number(static_cast<ZoneCause>(value));
    case Meaning::kValidity:
      return word_or_number(static_cast<SeparationValidity>(value));
    case Meaning::kContact:
      return name_of(scene.contacts, value);
    case Meaning::kContactStatus:
      return word_or_number(static_cast<ContactStatus>(value));
    case Meaning::kContactEnded:
      return word_or_number(static_cast<ContactEnded>(value));
    case Meaning::kGradientStatus:
      return word_or_number(static_cast<GradientStatus>(value));
    default:
      return fmt::format("{}", value);
  }
}
std::string text(const Scene&, Meaning, std::int64_t value) { return fmt::format("{}", value); }

// The pair and the zone that an element of a list is about: " (zone 'stop', hand - box)". The
// message itself is about all of them.
template <class Element>
std::string subject(const Scene& scene, const Element& element) {
  std::string names;
  for_each_field(
      [&](const Field& field, const auto& value) {
        if constexpr (std::is_integral_v<std::remove_cvref_t<decltype(value)>>) {
          if (field.meaning != Meaning::kPair && field.meaning != Meaning::kZone) return;
          if (!names.empty()) names += ", ";
          if (field.meaning == Meaning::kZone) names += "zone ";
          names += text(scene, field.meaning, static_cast<std::uint64_t>(value));
        }
      },
      element);
  return names.empty() ? names : fmt::format(" ({})", names);
}

// Compares field by field until the first difference. A Comparer is within a field of the one that
// made it: together they know the path to a value.
class Comparer {
 public:
  Comparer(const Scene& scene, const DifferenceOptions& options,
           std::optional<std::string>& difference)
      : scene_(scene), options_(options), difference_(difference) {}

  template <HasFields Message>
  void compare(const Message& recorded, const Message& replayed) {
    for_each_field(
        [this](const Field& field, const auto& a, const auto& b) {
          if (difference_ || field.meaning == Meaning::kDelivery) return;
          Comparer inner(scene_, options_, difference_);
          inner.outer_ = this;
          inner.field_ = field;
          inner.type_name_ = FieldsOf<Message>::kType;
          inner.value(a, b);
        },
        recorded, replayed);
  }

 private:
  // Values are compared to the bit: -0 is not 0. Any NaN equals any other, because it only says
  // that a value is not known.
  void value(double recorded, double replayed) {
    if (std::isnan(recorded) && std::isnan(replayed)) return;
    if (std::bit_cast<std::uint64_t>(recorded) != std::bit_cast<std::uint64_t>(replayed))
      tell(recorded, replayed);
  }
  void value(const clearance_msg_Vector3& recorded, const clearance_msg_Vector3& replayed) {
    const std::pair<std::string_view, double clearance_msg_Vector3::*> axes[] = {
        {".x", &clearance_msg_Vector3::x},
        {".y", &clearance_msg_Vector3::y},
        {".z", &clearance_msg_Vector3::z}};
    for (const auto& [axis, member] : axes) {
      if (difference_) return;
      axis_ = axis;
      value(recorded.*member, replayed.*member);
    }
  }
  template <class Integer>
  requires std::is_integral_v<Integer>
  void value(Integer recorded, Integer replayed) {
    if (field_.meaning == Meaning::kCycle &&
        static_cast<std::uint64_t>(recorded) > options_.cycle_offset)
      recorded = static_cast<Integer>(static_cast<std::uint64_t>(recorded) - options_.cycle_offset);
    if (recorded == replayed) return;
    using Shown = std::conditional_t<
        std::is_same_v<Integer, bool>, bool,
        std::conditional_t<std::is_signed_v<Integer>, std::int64_t, std::uint64_t>>;
    tell(static_cast<Shown>(recorded), static_cast<Shown>(replayed));
  }
  template <std::size_t N>
  void value(const char (&recorded)[N], const char (&replayed)[N]) {
    const std::string_view a(recorded), b(replayed);
    if (a != b) tell_text(fmt::format("'{}'", a), fmt::format("'{}'", b));
  }
  template <HasFields Record>
  void value(const Record& recorded, const Record& replayed) {
    subject_of(recorded);
    compare(recorded, replayed);
  }
  template <MessageSequence Sequence>
  void value(const Sequence& recorded, const Sequence& replayed) {
    if (recorded._length != replayed._length) {
      axis_ = ".length";
      tell(std::uint64_t{recorded._length}, std::uint64_t{replayed._length});
      return;
    }
    for (std::uint32_t i = 0; i < recorded._length && !difference_; ++i) {
      index_ = i;
      value(recorded._buffer[i], replayed._buffer[i]);
    }
  }

  // Remembers how to name an element, since most are equal and need no name.
  template <class Record>
  void subject_of(const Record& record) {
    record_ = &record;
    describe_ = [](const Scene& scene, const void* of) {
      return subject(scene, *static_cast<const Record*>(of));
    };
  }

  // "pairs[2] (hand - box)", behind what it is in.
  [[nodiscard]] std::string path() const {
    std::string path = outer_ == nullptr ? "" : outer_->path();
    if (field_.name.empty()) return path;
    if (!path.empty()) path += '.';
    path += field_.name;
    if (index_) path += fmt::format("[{}]", *index_);
    if (describe_ != nullptr) path += describe_(scene_, record_);
    return path;
  }
  template <class Value>
  void tell(const Value& recorded, const Value& replayed) {
    tell_text(text(scene_, field_.meaning, recorded), text(scene_, field_.meaning, replayed));
  }
  void tell_text(const std::string& recorded, const std::string& replayed) {
    const bool is_recorded =
        options_.not_recorded == nullptr ||
        !options_.not_recorded->contains(fmt::format("{}.{}", type_name_, field_.name));
    if (!is_recorded) return;
    difference_ = fmt::format("{}{}: {} {}, {} {}", path(), axis_, options_.first, recorded,
                              options_.second, replayed);
  }

  const Scene& scene_;
  const DifferenceOptions& options_;
  std::optional<std::string>& difference_;
  const Comparer* outer_ = nullptr;
  Field field_{};
  std::string_view type_name_;  // of the message that has the field
  std::string_view axis_;
  std::optional<std::uint32_t> index_;
  const void* record_ = nullptr;
  std::string (*describe_)(const Scene&, const void*) = nullptr;
};

std::optional<std::string> bounds_difference(const Scene& scene, const std::string& entry,
                                             const clearance_msg_PairDistance& recorded,
                                             const clearance_msg_PairDistance& replayed) {
  if (recorded.pair != replayed.pair) return std::nullopt;
  if (recorded.lower <= replayed.upper && replayed.lower <= recorded.upper) return std::nullopt;
  return fmt::format("{} ({}) bounds: recorded {:.17g} to {:.17g}, replayed {:.17g} to {:.17g}",
                     entry, pair_name(scene, recorded.pair), recorded.lower, recorded.upper,
                     replayed.lower, replayed.upper);
}

}  // namespace

template <class Message>
std::optional<std::string> message_difference(const Scene& scene, const Message& recorded,
                                              const Message& replayed,
                                              const DifferenceOptions& options) {
  std::optional<std::string> difference;
  Comparer(scene, options, difference).compare(recorded, replayed);
  return difference;
}

template std::optional<std::string> message_difference(const Scene&, const clearance_msg_Distances&,
                                                       const clearance_msg_Distances&,
                                                       const DifferenceOptions&);
template std::optional<std::string> message_difference(const Scene&,
                                                       const clearance_msg_Separation&,
                                                       const clearance_msg_Separation&,
                                                       const DifferenceOptions&);
template std::optional<std::string> message_difference(const Scene&, const clearance_msg_Gradients&,
                                                       const clearance_msg_Gradients&,
                                                       const DifferenceOptions&);
template std::optional<std::string> message_difference(const Scene&, const clearance_msg_ZoneState&,
                                                       const clearance_msg_ZoneState&,
                                                       const DifferenceOptions&);

std::optional<std::string> bounds_difference(const Scene& scene,
                                             const clearance_msg_Distances& recorded,
                                             const clearance_msg_Distances& replayed) {
  auto found = bounds_difference(scene, "minimum", recorded.minimum, replayed.minimum);
  if (!found && recorded.pairs._length != replayed.pairs._length) {
    found = fmt::format("pairs.length: recorded {}, replayed {}", recorded.pairs._length,
                        replayed.pairs._length);
  }
  for (std::uint32_t i = 0; i < recorded.pairs._length && !found; ++i) {
    found = bounds_difference(scene, fmt::format("pairs[{}]", i), recorded.pairs._buffer[i],
                              replayed.pairs._buffer[i]);
  }
  return found;
}

}  // namespace clearance
