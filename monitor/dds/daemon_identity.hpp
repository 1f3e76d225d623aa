// The identity of a daemon's run, by which clients and other daemons distinguish two daemons or two
// runs.
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
  std::string partner = {};  // its name among partners; empty: it has none
  // The kernel's run on that machine, and CLOCK_BOOTTIME at the start: on one machine they tell
  // ages whatever its wall clock says. Empty: not known.
  std::string boot = {};
  std::int64_t up_ns = 0;

  // "pid 4711 on robot-pc".
  [[nodiscard]] std::string described() const;
};

// Makes a new identity for this process.
[[nodiscard]] DaemonIdentity make_identity(std::string partner = {});

// Writes and reads "clearanced id=00c0ffee... start_ns=1700000000000000000 pid=4711 host=robot-pc",
// with " boot=ID up_ns=N" and " partner=left" behind it if they are known. Returns nothing if the
// text belongs to another program.
[[nodiscard]] std::string to_user_data(const DaemonIdentity& identity);
[[nodiscard]] std::optional<DaemonIdentity> from_user_data(std::string_view text);

// True if both publish side by side: they are partners of different names.
[[nodiscard]] bool are_partners(const DaemonIdentity& one, const DaemonIdentity& other) noexcept;

// True if `one` must stop publishing in favour of the other daemon of the cell, because it started
// later: by the time since the machine's start, or by the wall clocks of two machines. The ids
// decide between equal times, so both daemons come to the same answer.
[[nodiscard]] bool yields_to(const DaemonIdentity& one, const DaemonIdentity& other) noexcept;

}  // namespace clearance
