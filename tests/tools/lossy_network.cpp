#include "tests/tools/lossy_network.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <linux/if_tun.h>
#include <net/if.h>
#include <poll.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <random>

namespace clearance::test {
namespace {

std::string failed(const std::string& what) { return what + ": " + std::strerror(errno); }

ifreq named(const char* name) {
  ifreq request{};
  std::strncpy(request.ifr_name, name, IFNAMSIZ - 1);
  return request;
}

// Linux says of lo that it has no multicast.
bool bring_up(int socket, const char* name, short multicast = 0) {
  ifreq request = named(name);
  request.ifr_flags = static_cast<short>(IFF_UP | IFF_RUNNING | multicast);
  return ioctl(socket, SIOCSIFFLAGS, &request) == 0;
}

bool set_address(int socket, unsigned long what, const std::string& text) {
  ifreq request = named("eth0");
  auto* const address = reinterpret_cast<sockaddr_in*>(&request.ifr_addr);
  address->sin_family = AF_INET;
  return inet_pton(AF_INET, text.c_str(), &address->sin_addr) == 1 &&
         ioctl(socket, what, &request) == 0;
}

// Moves the calling thread into a new namespace with lo and eth0. Returns an empty text on success.
std::string enter_namespace(int number, int& tap) {
  if (unshare(CLONE_NEWNET) != 0) return failed("a network namespace cannot be made");
  tap = open("/dev/net/tun", O_RDWR | O_CLOEXEC | O_NONBLOCK);
  if (tap < 0) return failed("/dev/net/tun cannot be opened");
  ifreq request = named("eth0");
  request.ifr_flags = IFF_TAP | IFF_NO_PI;
  if (ioctl(tap, TUNSETIFF, &request) != 0) return failed("a TAP device cannot be made");
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const bool up = bring_up(socket, "lo") &&
                  set_address(socket, SIOCSIFADDR, "10.77.0." + std::to_string(number)) &&
                  set_address(socket, SIOCSIFNETMASK, "255.255.255.0") &&
                  bring_up(socket, "eth0", IFF_MULTICAST);
  const std::string refusal = up ? "" : failed("the TAP device cannot be configured");
  close(socket);
  return refusal;
}

// Returns true for an Ethernet frame with an IPv4 header that has "more fragments" set or a
// non-zero offset.
bool is_ip_fragment(const std::uint8_t* frame, std::size_t size) {
  constexpr std::size_t kEthernet = 14;
  if (size < kEthernet + 20 || frame[12] != 0x08 || frame[13] != 0x00) return false;
  return (frame[kEthernet + 6] & 0x3f) != 0 || frame[kEthernet + 7] != 0;
}

}  // namespace

NetworkNamespace::NetworkNamespace(int number) : thread_([this, number] { live(number); }) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return ready_; });
}

NetworkNamespace::~NetworkNamespace() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
  if (tap_ >= 0) close(tap_);
}

void NetworkNamespace::run(const std::function<void()>& task) {
  std::unique_lock lock(mutex_);
  task_ = &task;
  changed_.notify_all();
  changed_.wait(lock, [this] { return task_ == nullptr; });
}

void NetworkNamespace::live(int number) {
  std::unique_lock lock(mutex_);
  refusal_ = enter_namespace(number, tap_);
  ready_ = true;
  changed_.notify_all();
  for (;;) {
    changed_.wait(lock, [this] { return stop_ || task_ != nullptr; });
    if (stop_) return;
    (*task_)();
    task_ = nullptr;
    changed_.notify_all();
  }
}

LossyWire::LossyWire(int one, int other) : thread_([this, one, other] { carry(one, other); }) {}

LossyWire::~LossyWire() {
  stop_ = true;
  thread_.join();
}

void LossyWire::carry(int one, int other) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> chance(0.0, 1.0);
  std::array<std::uint8_t, 2048> frame;
  std::array<pollfd, 2> ends{
      {{.fd = one, .events = POLLIN, .revents = 0}, {.fd = other, .events = POLLIN, .revents = 0}}};
  while (!stop_) {
    poll(ends.data(), ends.size(), 20);
    for (const int from : {0, 1}) {
      ssize_t size = 0;
      while ((size = read(ends[static_cast<std::size_t>(from)].fd, frame.data(), frame.size())) >
             0) {
        ++frames_;
        fragments_ += is_ip_fragment(frame.data(), static_cast<std::size_t>(size));
        if (chance(random) < loss_) continue;
        // A frame that the other end cannot accept is lost as well.
        if (write(ends[static_cast<std::size_t>(1 - from)].fd, frame.data(),
                  static_cast<std::size_t>(size)) < 0) {
          continue;
        }
      }
    }
  }
}

}  // namespace clearance::test
