// The generated DDS types, owned: values whose strings and sequences are released with them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>

#include "clearance.h"
#include "commands.h"
#include "partners.h"
#include "questions.h"

namespace clearance {

// The Cyclone descriptor of a topic type; exists for the types of our topics only.
template <class T>
[[nodiscard]] const dds_topic_descriptor_t& topic_descriptor() noexcept = delete;
template <>
[[nodiscard]] inline const dds_topic_descriptor_t&
topic_descriptor<clearance_msg_PoseBatch>() noexcept {
  return clearance_msg_PoseBatch_desc;
}
template <>
[[nodiscard]] inline const dds_topic_descriptor_t&
topic_descriptor<clearance_msg_Distances>() noexcept {
  return clearance_msg_Distances_desc;
}
template <>
[[nodiscard]] inline const dds_topic_descriptor_t&
topic_descriptor<clearance_msg_Catalogue>() noexcept {
  return clearance_msg_Catalogue_desc;
}
template <>
[[nodiscard]] inline const dds_topic_descriptor_t&
topic_descriptor<clearance_msg_ZoneState>() noexcept {
  return clearance_msg_ZoneState_desc;
}
template <>
[[nodiscard]] inline const dds_topic_descriptor_t&
topic_descriptor<clearance_msg_Health>() noexcept {
  return clearance_msg_Health_desc;
}

template <>
[[nodiscard]] inline const dds_topic_descriptor_t&
topic_descriptor<clearance_msg_JointStates>() noexcept {
  return clearance_msg_JointStates_desc;
}
template <>
[[nodiscard]] inline const dds_topic_descriptor_t&
topic_descriptor<clearance_msg_Separation>() noexcept {
  return clearance_msg_Separation_desc;
}
template <>
[[nodiscard]] inline const dds_topic_descriptor_t&
topic_descriptor<clearance_msg_Gradients>() noexcept {
  return clearance_msg_Gradients_desc;
}

template <>
[[nodiscard]] inline const dds_topic_descriptor_t&
topic_descriptor<clearance_msg_Command>() noexcept {
  return clearance_msg_Command_desc;
}
template <>
[[nodiscard]] inline const dds_topic_descriptor_t&
topic_descriptor<clearance_msg_CommandResult>() noexcept {
  return clearance_msg_CommandResult_desc;
}
template <>
[[nodiscard]] inline const dds_topic_descriptor_t&
topic_descriptor<clearance_msg_PartnerTick>() noexcept {
  return clearance_msg_PartnerTick_desc;
}
template <>
[[nodiscard]] inline const dds_topic_descriptor_t&
topic_descriptor<clearance_msg_PartnerState>() noexcept {
  return clearance_msg_PartnerState_desc;
}
template <>
[[nodiscard]] inline const dds_topic_descriptor_t&
topic_descriptor<clearance_msg_PartnerFrame>() noexcept {
  return clearance_msg_PartnerFrame_desc;
}
template <>
[[nodiscard]] inline const dds_topic_descriptor_t&
topic_descriptor<clearance_msg_PartnerScene>() noexcept {
  return clearance_msg_PartnerScene_desc;
}

template <>
[[nodiscard]] inline const dds_topic_descriptor_t&
topic_descriptor<clearance_msg_Question>() noexcept {
  return clearance_msg_Question_desc;
}
template <>
[[nodiscard]] inline const dds_topic_descriptor_t&
topic_descriptor<clearance_msg_Answer>() noexcept {
  return clearance_msg_Answer_desc;
}

// One sample of a topic type, all zero at first. Everything it points to is from dds_alloc and is
// freed with it; Cyclone's reads into it reuse what fits and reallocate what does not.
template <class T>
class Sample {
 public:
  Sample() = default;
  ~Sample() { dds_sample_free(&value_, &topic_descriptor<T>(), DDS_FREE_CONTENTS); }
  Sample(const Sample&) = delete;
  Sample& operator=(const Sample&) = delete;
  Sample(Sample&& other) noexcept : value_(std::exchange(other.value_, T{})) {}
  Sample& operator=(Sample&& other) noexcept {
    std::swap(value_, other.value_);
    return *this;
  }

  [[nodiscard]] T& operator*() noexcept { return value_; }
  [[nodiscard]] const T& operator*() const noexcept { return value_; }
  [[nodiscard]] T* operator->() noexcept { return &value_; }
  [[nodiscard]] const T* operator->() const noexcept { return &value_; }

 private:
  T value_{};
};

// Gives an empty sequence of a sample capacity for `count` elements, all zero, so that filling it
// and taking into it allocate nothing. The sample releases it.
template <class Sequence>
void reserve_sequence(Sequence& sequence, std::size_t count) {
  using Element = std::remove_pointer_t<decltype(sequence._buffer)>;
  if (count == 0) return;
  sequence._buffer =
      static_cast<Element*>(dds_alloc(count * sizeof(Element)));  // zeroed by Cyclone
  sequence._maximum = static_cast<std::uint32_t>(count);
  sequence._length = 0;
  sequence._release = true;
}

}  // namespace clearance
