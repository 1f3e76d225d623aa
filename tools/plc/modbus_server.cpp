#include "tools/plc/modbus_server.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <vector>

#include "monitor/app/log_line.hpp"
#include "monitor/client/client.hpp"
#include "monitor/interface/plc_log_lines.hpp"

namespace clearance::plc {
namespace {

// A controller with many blocks asks for fewer in a step of at most 5 ms.
constexpr int kRequestsInStep = 16, kAcceptsInStep = 8;
// A client that has asked for nothing for so long gives its place to a new one.
constexpr std::int64_t kIdleNs = 5'000'000'000, kTellEveryNs = 1'000'000'000;

constexpr int kReadHolding = 3, kReadInput = 4, kMostRegisters = 125;
constexpr std::size_t kHeader = 7, kReadFrame = 12;  // bytes; the unit identifier is in the header

bool writes(int function) noexcept {
  constexpr std::array kWrites = {5, 6, 15, 16, 21, 22, 23};
  return std::ranges::find(kWrites, function) != kWrites.end();
}

int word_at(const std::uint8_t* bytes) noexcept { return bytes[0] << 8 | bytes[1]; }

// "10.0.0.7", and "10.0.0.7:50123".
std::pair<std::string, std::string> names_of(const sockaddr_storage& address, socklen_t size) {
  char host[NI_MAXHOST] = "", port[NI_MAXSERV] = "";
  getnameinfo(reinterpret_cast<const sockaddr*>(&address), size, host, sizeof host, port,
              sizeof port, NI_NUMERICHOST | NI_NUMERICSERV);
  const bool has_colons = address.ss_family == AF_INET6;
  return {host, has_colons ? fmt::format("[{}]:{}", host, port) : fmt::format("{}:{}", host, port)};
}

// Returns a listening socket, or -1 with errno.
int listen_on(const ModbusSettings& settings) {
  addrinfo hints{}, *found = nullptr;
  hints.ai_flags = AI_NUMERICHOST | AI_PASSIVE;
  hints.ai_socktype = SOCK_STREAM;
  errno = EINVAL;
  const std::string port = std::to_string(settings.port);
  if (getaddrinfo(settings.host.c_str(), port.c_str(), &hints, &found) != 0) return -1;
  const int listener =
      socket(found->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, IPPROTO_TCP);
  const int yes = 1;
  setsockopt(listener, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  const bool is_open = bind(listener, found->ai_addr, found->ai_addrlen) == 0 &&
                       listen(listener, ModbusServer::kMostClients) == 0;
  const int error = errno;
  freeaddrinfo(found);
  if (is_open) return listener;
  close(listener);
  errno = error;
  return -1;
}

}  // namespace

ModbusServer::ModbusServer(const ModbusSettings& settings, std::size_t registers)
    : listener_(listen_on(settings)),
      modbus_(modbus_new_tcp("127.0.0.1", 502), modbus_free),  // it opens no socket itself
      mapping_(modbus_mapping_new(0, 0, static_cast<int>(registers), static_cast<int>(registers)),
               modbus_mapping_free) {
  if (listener_ < 0) {
    throw std::runtime_error(fmt::format(
        "cannot listen on {} port {}: {}{}", settings.host, settings.port, std::strerror(errno),
        errno == EACCES ? "; ports below 1024 need the capability CAP_NET_BIND_SERVICE" : ""));
  }
  if (!modbus_ || !mapping_) throw std::runtime_error("libmodbus has no memory");
  sockaddr_storage own{};
  socklen_t size = sizeof own;
  getsockname(listener_, reinterpret_cast<sockaddr*>(&own), &size);
  address_ = names_of(own, size).second;
}

ModbusServer::~ModbusServer() {
  modbus_set_socket(modbus_.get(), -1);
  for (const Client& client : clients_) close(client.socket);
  close(listener_);
}

void ModbusServer::set(std::span<const std::uint16_t> words) {
  std::ranges::copy(words, mapping_->tab_registers);
  std::ranges::copy(words, mapping_->tab_input_registers);
}

// Among clients that have asked for nothing yet, the first one goes; else the one that is idle for
// the longest time; else one of the host that has the most. So no newcomer displaces a controller
// that reads, and no host can take all places.
bool ModbusServer::make_room(const std::string& host) {
  if (clients_.size() < kMostClients) return true;
  const auto rank = [](const Client& each) { return std::pair(each.has_asked, each.last_ns); };
  auto goes = std::ranges::min_element(clients_, {}, rank);
  if (goes->has_asked && client::monotonic_ns() - goes->last_ns < kIdleNs) {
    const auto share = [this](const std::string& of) {
      return std::ranges::count(clients_, of, &Client::host);
    };
    goes = std::ranges::max_element(clients_, {}, [&](const Client& each) {
      return std::pair(share(each.host), -each.last_ns);
    });
    if (share(goes->host) <= share(host) + 1) return false;
  }
  goes->fault = "another client needs its place";
  drop_faulty();
  return true;
}

void ModbusServer::accept_client() {
  --accepts_left_;
  sockaddr_storage peer{};
  socklen_t size = sizeof peer;
  const int socket =
      accept4(listener_, reinterpret_cast<sockaddr*>(&peer), &size, SOCK_NONBLOCK | SOCK_CLOEXEC);
  if (socket < 0) return;
  const auto [host, name] = names_of(peer, size);
  if (!make_room(host)) {
    ++counts_.turned_away;
    close(socket);
    return;
  }
  Client& client = clients_.emplace_back();
  client.socket = socket;
  client.host = host;
  client.peer = name;
  client.left = kRequestsInStep;
  client.last_ns = client::monotonic_ns();
}

void ModbusServer::receive(Client& client) {
  const ssize_t count = recv(client.socket, client.bytes.data() + client.filled,
                             client.bytes.size() - client.filled, 0);
  if (count > 0) {
    client.filled += static_cast<std::size_t>(count);
    answer(client);
  } else if (count == 0 || (errno != EAGAIN && errno != EINTR)) {
    client.fault = "gone";
  }
}

// Answers the whole frames that have come, as many as the client may still ask for.
void ModbusServer::answer(Client& client) {
  while (client.left > 0 && client.filled >= kHeader && client.fault.empty()) {
    const std::uint8_t* const bytes = client.bytes.data();
    const int length = word_at(bytes + 4);  // of what follows
    const std::size_t size = 6 + static_cast<std::size_t>(length);
    if (word_at(bytes + 2) != 0 || length < 2 || size > kLongestFrame) {
      client.fault = "it sends what is no Modbus TCP";
      return;
    }
    if (client.filled < size) return;
    --client.left;
    client.has_asked = true;
    client.last_ns = client::monotonic_ns();
    answer_frame(client, size);
    std::copy(bytes + size, bytes + client.filled, client.bytes.begin());
    client.filled -= size;
  }
}

// modbus_reply() would sleep at a wrong number of registers, so that is answered here.
void ModbusServer::answer_frame(Client& client, std::size_t size) {
  ++counts_.requests;
  const std::uint8_t* const bytes = client.bytes.data();
  const int function = bytes[kHeader];
  if (function != kReadHolding && function != kReadInput) {
    if (writes(function)) {
      ++counts_.refused_writes;
      if (may_tell(told_write_ns_))
        log_line(lines::kPlcWriteRefused, client.peer, function, counts_.refused_writes);
    }
    return refuse(client, MODBUS_EXCEPTION_ILLEGAL_FUNCTION);
  }
  const int registers = size == kReadFrame ? word_at(bytes + kHeader + 3) : 0;
  if (registers < 1 || registers > kMostRegisters)
    return refuse(client, MODBUS_EXCEPTION_ILLEGAL_DATA_VALUE);
  modbus_set_socket(modbus_.get(), client.socket);
  if (modbus_reply(modbus_.get(), bytes, static_cast<int>(size), mapping_.get()) < 0)
    client.fault = "it does not read the answers";
}

void ModbusServer::refuse(Client& client, int exception) {
  modbus_set_socket(modbus_.get(), client.socket);
  if (modbus_reply_exception(modbus_.get(), client.bytes.data(), static_cast<unsigned>(exception)) <
      0)
    client.fault = "it does not read the answers";
}

bool ModbusServer::may_tell(std::int64_t& told_ns) const {
  const std::int64_t now_ns = client::monotonic_ns();
  if (told_ns != 0 && now_ns - told_ns < kTellEveryNs) return false;
  told_ns = now_ns;
  return true;
}

void ModbusServer::drop_faulty() {
  std::erase_if(clients_, [this](const Client& client) {
    if (client.fault.empty()) return false;
    close(client.socket);
    if (client.fault == "gone") return true;
    ++counts_.dropped;
    if (may_tell(told_dropped_ns_))
      log_line(lines::kPlcClientDropped, client.peer, client.fault, counts_.dropped);
    return true;
  });
}

void ModbusServer::step(std::int64_t end_ns) {
  std::vector<pollfd> waits{{listener_, static_cast<short>(accepts_left_ > 0 ? POLLIN : 0), 0}};
  for (const Client& client : clients_)
    waits.push_back({client.socket, static_cast<short>(client.left > 0 ? POLLIN : 0), 0});
  const std::int64_t wait_ns = std::max<std::int64_t>(0, end_ns - client::monotonic_ns());
  const timespec wait{wait_ns / 1'000'000'000, wait_ns % 1'000'000'000};
  if (ppoll(waits.data(), waits.size(), &wait, nullptr) <= 0) return;
  auto ready = waits.begin();
  for (Client& client : clients_) {
    if ((++ready)->revents != 0) receive(client);
  }
  drop_faulty();
  if (waits.front().revents != 0) accept_client();
}

void ModbusServer::serve_until(std::int64_t end_ns) {
  accepts_left_ = kAcceptsInStep;
  for (Client& client : clients_) {
    client.left = kRequestsInStep;
    answer(client);  // what has waited since the step before
  }
  drop_faulty();
  do {
    step(end_ns);
  } while (client::monotonic_ns() < end_ns);
}

}  // namespace clearance::plc
