// Random samples of the topic types, for tests of everything that transports them.
#pragma once

#include <cstdint>
#include <random>
#include <string>

#include "monitor/wire/dds_sample.hpp"

namespace clearance::test {

// The wire may carry any bit pattern of a double, including NaN and infinity.
inline double any_double(std::mt19937_64& random) {
  const std::uint64_t kind = random() % 16;
  if (kind == 0) return std::numeric_limits<double>::quiet_NaN();
  if (kind == 1) return -std::numeric_limits<double>::infinity();
  return std::uniform_real_distribution<double>(-10.0, 10.0)(random);
}

inline clearance_msg_Vector3 any_vector(std::mt19937_64& random) {
  return {any_double(random), any_double(random), any_double(random)};
}

inline char* any_text(std::mt19937_64& random) {
  std::string text(random() % 40, ' ');
  for (char& c : text) c = static_cast<char>('a' + random() % 26);
  return dds_string_dup(text.c_str());
}

template <std::size_t N>
void any_bounded_text(std::mt19937_64& random, char (&out)[N]) {
  const std::size_t length = random() % N;
  for (std::size_t i = 0; i < length; ++i) out[i] = static_cast<char>('a' + random() % 26);
  out[length] = '\0';
}

inline void any_pair(std::mt19937_64& random, clearance_msg_PairDistance& pair) {
  pair.pair = static_cast<std::uint32_t>(random());
  pair.part_a = static_cast<std::uint32_t>(random());
  pair.part_b = static_cast<std::uint32_t>(random());
  pair.status = static_cast<std::uint8_t>(random() % 7);
  pair.distance = any_double(random);
  pair.lower = any_double(random);
  pair.upper = any_double(random);
  pair.swept_lower = any_double(random);
  pair.model_error = any_double(random);
  pair.stop_lower = any_double(random);
  pair.witness_a = any_vector(random);
  pair.witness_b = any_vector(random);
  pair.normal = any_vector(random);
  pair.closing_speed = any_double(random);
  pair.time_to_contact = any_double(random);
  pair.age_a_ns = static_cast<std::int64_t>(random());
  pair.age_b_ns = static_cast<std::int64_t>(random());
  pair.evaluated_cycle = random();
  pair.refresh_age_cycles = random();
}

inline void fill(std::mt19937_64& random, Sample<clearance_msg_PoseBatch>& batch) {
  any_bounded_text(random, batch->source);
  batch->sequence_number = random();
  batch->scene_revision = random();
  reserve_sequence(batch->poses, random() % 20);
  for (std::uint32_t i = 0; i < batch->poses._maximum; ++i) {
    clearance_msg_ObjectPose& pose = batch->poses._buffer[batch->poses._length++];
    pose.object = static_cast<std::uint32_t>(random());
    pose.stamp_ns = static_cast<std::int64_t>(random());
    pose.position = any_vector(random);
    pose.orientation = {any_double(random), any_double(random), any_double(random), 1.0};
    pose.has_twist = random() % 2 != 0;
    pose.linear = any_vector(random);
    pose.angular = any_vector(random);
  }
}

inline void fill(std::mt19937_64& random, Sample<clearance_msg_Distances>& report) {
  report->daemon = random();
  report->cycle = random();
  report->now_ns = static_cast<std::int64_t>(random());
  report->publish_ns = static_cast<std::int64_t>(random());
  report->minimum_known = random() % 2 != 0;
  report->lower_all = any_double(random);
  report->swept_lower_all = any_double(random);
  any_pair(random, report->minimum);
  report->queries = static_cast<std::uint32_t>(random());
  reserve_sequence(report->sources, random() % clearance_msg_kMaxSources);
  for (std::uint32_t i = 0; i < report->sources._maximum; ++i) {
    any_bounded_text(random, report->sources._buffer[i].source);
    report->sources._buffer[i].sequence_number = random();
    ++report->sources._length;
  }
  reserve_sequence(report->pairs, random() % 30);
  for (std::uint32_t i = 0; i < report->pairs._maximum; ++i) {
    any_pair(random, report->pairs._buffer[report->pairs._length++]);
  }
}

inline void fill(std::mt19937_64& random, Sample<clearance_msg_Catalogue>& catalogue) {
  catalogue->daemon = random();
  catalogue->scene = any_text(random);
  catalogue->scene_revision = random();
  catalogue->rate_hz = any_double(random);
  catalogue->cell_yaml = any_text(random);
  catalogue->cell_hash = any_text(random);
  catalogue->build = any_text(random);
  reserve_sequence(catalogue->objects, random() % 9);
  for (std::uint32_t i = 0; i < catalogue->objects._maximum; ++i) {
    clearance_msg_CatalogueObject& object =
        catalogue->objects._buffer[catalogue->objects._length++];
    object.id = i;
    object.name = any_text(random);
    object.is_fixed = random() % 2 != 0;
    reserve_sequence(object.parts, random() % 4);
    for (std::uint32_t k = 0; k < object.parts._maximum; ++k) {
      object.parts._buffer[object.parts._length++] = any_text(random);
    }
  }
  reserve_sequence(catalogue->pairs, random() % 9);
  for (std::uint32_t i = 0; i < catalogue->pairs._maximum; ++i) {
    catalogue->pairs._buffer[catalogue->pairs._length++] = {i, i + 1, i + 2, random() % 2 != 0};
  }
  reserve_sequence(catalogue->zones, random() % 5);
  for (std::uint32_t i = 0; i < catalogue->zones._maximum; ++i) {
    catalogue->zones._buffer[catalogue->zones._length++] = {
        i, any_text(random), any_text(random), any_text(random), 0.1, 0.2};
  }
}

inline void fill(std::mt19937_64& random, Sample<clearance_msg_ZoneState>& zone) {
  zone->zone = static_cast<std::uint32_t>(random());
  any_bounded_text(random, zone->name);
  zone->daemon = random();
  zone->active = random() % 2 != 0;
  zone->cause = static_cast<std::uint8_t>(random() % 6);
  zone->cause_object = static_cast<std::uint32_t>(random());
  zone->clearance = any_double(random);
  zone->swept_clearance = any_double(random);
  zone->since_cycle = random();
  zone->now_ns = static_cast<std::int64_t>(random());
}

inline void fill(std::mt19937_64& random, Sample<clearance_msg_Separation>& separation) {
  separation->daemon = random();
  separation->cycle = random();
  separation->now_ns = static_cast<std::int64_t>(random());
  reserve_sequence(separation->zones, random() % 6);
  for (std::uint32_t i = 0; i < separation->zones._maximum; ++i) {
    separation->zones._buffer[separation->zones._length++] = {
        i, 1, i + 1, any_double(random), any_double(random), any_double(random)};
  }
  reserve_sequence(separation->pairs, random() % 20);
  for (std::uint32_t i = 0; i < separation->pairs._maximum; ++i) {
    clearance_msg_PairSeparation& pair = separation->pairs._buffer[separation->pairs._length++];
    pair = {};
    pair.zone = static_cast<std::uint32_t>(random());
    pair.validity = static_cast<std::uint8_t>(random() % 3);
    pair.clearance = any_double(random);
    pair.protective_distance = any_double(random);
    pair.scaling = any_double(random);
    pair.age_robot_ns = static_cast<std::int64_t>(random());
  }
}

inline void fill(std::mt19937_64& random, Sample<clearance_msg_Gradients>& gradients) {
  gradients->daemon = random();
  gradients->cycle = random();
  reserve_sequence(gradients->pairs, 1 + random() % 6);
  reserve_sequence(gradients->alternatives, gradients->pairs._maximum);
  for (std::uint32_t i = 0; i < gradients->pairs._maximum; ++i) {
    clearance_msg_PairGradient& pair = gradients->pairs._buffer[gradients->pairs._length++];
    pair.pair = i;
    pair.status = static_cast<std::uint8_t>(random() % 8);
    pair.distance = any_double(random);
    pair.lower = any_double(random);
    pair.drift = any_double(random);
    gradients->alternatives._buffer[gradients->alternatives._length++] = {
        static_cast<std::uint8_t>(random() % 4), any_double(random), any_double(random)};
  }
}

inline void fill(std::mt19937_64& random, Sample<clearance_msg_Health>& health) {
  health->daemon = random();
  health->cycle = random();
  health->undecodable_samples = random();
  health->other_writers = random();
  health->foreign_reports = random();
  health->tick_p50_us = any_double(random);
  health->overruns = random();
  health->recording = any_text(random);
  health->recording_missing = random();
  reserve_sequence(health->rejected, random() % 6);
  for (std::uint32_t i = 0; i < health->rejected._maximum; ++i) {
    health->rejected._buffer[health->rejected._length++] = {any_text(random), any_text(random),
                                                            random(), any_text(random)};
  }
  reserve_sequence(health->inputs, random() % 6);
  for (std::uint32_t i = 0; i < health->inputs._maximum; ++i) {
    health->inputs._buffer[health->inputs._length++] = {i,
                                                        any_text(random),
                                                        static_cast<std::int64_t>(random()),
                                                        random() % 2 != 0,
                                                        random() % 2 != 0,
                                                        random() % 2 != 0,
                                                        "arm",
                                                        "tracker"};
  }
  reserve_sequence(health->joints, random() % 6);
  for (std::uint32_t i = 0; i < health->joints._maximum; ++i) {
    health->joints._buffer[health->joints._length++] = {i,
                                                        any_text(random),
                                                        static_cast<std::int64_t>(random()),
                                                        random() % 2 != 0,
                                                        random() % 2 != 0,
                                                        "arm",
                                                        "zeros"};
  }
  reserve_sequence(health->witnesses, random() % 6);
  for (std::uint32_t i = 0; i < health->witnesses._maximum; ++i) {
    health->witnesses._buffer[health->witnesses._length++] = {any_text(random),
                                                              any_text(random),
                                                              any_text(random),
                                                              static_cast<std::uint32_t>(random()),
                                                              i,
                                                              random() % 2 != 0,
                                                              any_double(random),
                                                              any_double(random)};
  }
}

}  // namespace clearance::test
