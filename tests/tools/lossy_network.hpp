// Two machines on a network that loses packets: two network namespaces of this process and a wire
// between them. The namespaces have no names visible to other processes. The kernel's netem is not
// needed, which few container kernels have.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace clearance::test {

// A thread in its own network namespace, which has lo and eth0 (a TAP device) with 10.77.0.N.
// Programs that the thread starts are in the namespace, too.
class NetworkNamespace {
 public:
  explicit NetworkNamespace(int number);
  ~NetworkNamespace();
  NetworkNamespace(const NetworkNamespace&) = delete;
  NetworkNamespace& operator=(const NetworkNamespace&) = delete;

  // The reason why the namespace could not be created; empty if it exists.
  [[nodiscard]] const std::string& refusal() const noexcept { return refusal_; }
  // The other end of eth0, which carries Ethernet frames.
  [[nodiscard]] int frames() const noexcept { return tap_; }
  // Runs the task in the namespace, and waits until it is done.
  void run(const std::function<void()>& task);

 private:
  void live(int number);

  int tap_ = -1;
  std::string refusal_;
  std::mutex mutex_;
  std::condition_variable changed_;
  const std::function<void()>* task_ = nullptr;
  bool ready_ = false, stop_ = false;
  std::thread thread_;
};

// Carries frames between two namespaces, and drops a fraction of them.
class LossyWire {
 public:
  LossyWire(int one, int other);
  ~LossyWire();
  LossyWire(const LossyWire&) = delete;
  LossyWire& operator=(const LossyWire&) = delete;

  void lose(double share) { loss_ = share; }  // fraction of lost frames, 0 to 1
  [[nodiscard]] std::uint64_t frames() const { return frames_; }
  // The number of frames that carried only a part of an IPv4 datagram.
  [[nodiscard]] std::uint64_t ip_fragments() const { return fragments_; }

 private:
  void carry(int one, int other);

  std::atomic<double> loss_{0.0};
  std::atomic<std::uint64_t> frames_{0}, fragments_{0};
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace clearance::test
