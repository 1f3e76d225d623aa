// Who a daemon is, so that clients and other daemons can tell two of them apart, and a run from the
// one before it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace clearance {

// Announced as USER_DATA of the distances writer; `id` is in every sample as well.
struct DaemonIdentity {
  std::uint64_t id = 0;       // random, not 0
  std::int64_t start_ns = 0;  // CLOCK_REALTIME
  std::int64_t pid = 0;
  std::string host = {};

  // "pid 4711 on robot-pc".
  [[nodiscard]] std::string described() const;
};

// Of this process, made now.
[[nodiscard]] DaemonIdentity make_identity();

// "clearanced id=00c0ffee... start_ns=1700000000000000000 pid=4711 host=robot-pc", and back;
// nothing when the text is of another program.
[[nodiscard]] std::string to_user_data(const DaemonIdentity& identity);
[[nodiscard]] std::optional<DaemonIdentity> from_user_data(std::string_view text);

// Of two daemons of one cell, whether the first has to give way: it started later. The ids decide
// between equal times, so both sides always come to the same answer.
[[nodiscard]] bool gives_way(const DaemonIdentity& one, const DaemonIdentity& other) noexcept;

}  // namespace clearance
