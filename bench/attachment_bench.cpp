// One call of an implementation in another process, in lock step, beside a bare ping-pong of the same octets
// over the same kind of stream.
#include <sys/socket.h>
#include <unistd.h>
#include <span>

#include <array>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "bench/rows.hpp"
#include "harness/iut/message_device.hpp"
#include "harness/iut/server.hpp"
#include "harness/kernel/check.hpp"
#include "protocols/valve_bus/attached_node.hpp"
#include "protocols/valve_bus/node.hpp"

namespace fieldproof::bench {
namespace {

constexpr std::uint64_t kCalls = 500;
// Of "on time" and of "done": length, type, time.
constexpr std::size_t kOctets = 13;
using Octets = std::array<char, kOctets>;

bool pass_octets(int from, int to) {
  Octets octets{};
  for (std::size_t have = 0; have < kOctets;) {
    const ssize_t count = ::read(from, octets.data() + have, kOctets - have);
    if (count <= 0) return false;
    have += static_cast<std::size_t>(count);
  }
  return ::write(to, octets.data(), kOctets) == static_cast<ssize_t>(kOctets);
}

void ping_pong(int out, int in) {
  Octets octets{};
  FIELDPROOF_CHECK(::write(out, octets.data(), kOctets) == static_cast<ssize_t>(kOctets), "the peer listens");
  for (std::size_t have = 0; have < kOctets;) {
    const ssize_t count = ::read(in, octets.data() + have, kOctets - have);
    FIELDPROOF_CHECK(count > 0, "the peer answers");
    have += static_cast<std::size_t>(count);
  }
}

// A process that reads and writes so many octets and does nothing else. It ends with its input.
class PingPongProcess {
 public:
  PingPongProcess() {
    std::array<int, 2> there{};
    std::array<int, 2> back{};
    FIELDPROOF_CHECK(::pipe(there.data()) == 0 && ::pipe(back.data()) == 0, "there are pipes");
    const pid_t child = ::fork();
    FIELDPROOF_CHECK(child >= 0, "there are processes");
    if (child == 0) {
      ::close(there[1]);
      while (pass_octets(there[0], back[1])) {
      }
      ::_exit(0);
    }
    ::close(there[0]);
    ::close(back[1]);
    out_ = iut::Descriptor(there[1]);
    in_ = iut::Descriptor(back[0]);
  }
  void call() const { ping_pong(out_.number(), in_.number()); }

 private:
  iut::Descriptor out_;
  iut::Descriptor in_;
};

Batch bare_pipe() {
  const auto peer = std::make_shared<PingPongProcess>();
  return [peer]() -> std::uint64_t {
    for (std::uint64_t n = 0; n < kCalls; ++n) peer->call();
    return kCalls;
  };
}

class NoBench final : public iut::Bench {
  void send(unsigned, kernel::Time, std::span<const std::uint16_t>) override {}
  void transmit(unsigned, line::Waveform&) override {}
  void write(iut::Item, std::uint64_t, kernel::Time) override {}
  std::uint64_t read(iut::Item, kernel::Time) override { return 0; }
};

// A node that is on and has nothing to do.
struct CalledNode {
  explicit CalledNode(iut::Peer peer) : device(std::move(peer), {"valve_bus", "node"}, {}) {
    device.begin({"valve_bus/node/bench/call", 0, {}}, bench);
    device.set_power(true, now);
  }
  std::uint64_t call() {
    for (std::uint64_t n = 0; n < kCalls; ++n) device.on_time(now += kernel::kMicrosecond);
    return kCalls;
  }

  NoBench bench;
  iut::MessageDevice device;
  kernel::Time now{};
};

Batch calls_over_pipes() {
  const auto node = std::make_shared<CalledNode>(
      iut::Peer::spawned("exec:station", {FIELDPROOF_EXE, "station", "valve_bus/node"}));
  return [node] { return node->call(); };
}

// The two ends of a socket; the other one is served by a thread until this one is closed.
template <typename Serve>
std::shared_ptr<iut::Descriptor> served_socket(Serve serve) {
  std::array<int, 2> ends{};
  FIELDPROOF_CHECK(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()) == 0, "there are sockets");
  std::thread([serve, other = ends[1]] {
    const iut::Descriptor socket(other);
    serve(socket.number());
  }).detach();
  return std::make_shared<iut::Descriptor>(ends[0]);
}

Batch bare_socket() {
  const auto socket = served_socket([](int end) {
    while (pass_octets(end, end)) {
    }
  });
  return [socket]() -> std::uint64_t {
    for (std::uint64_t n = 0; n < kCalls; ++n) ping_pong(socket->number(), socket->number());
    return kCalls;
  };
}

Batch calls_over_a_socket() {
  const auto socket = served_socket([](int end) {
    iut::serve(
        end, end, {"valve_bus", "node"},
        [](const iut::RoleName&) {
          return std::make_unique<valve_bus::ServedNode>(
              [](const auto& configuration) { return std::make_unique<valve_bus::Node>(configuration); });
        },
        "node");
  });
  const auto node = std::make_shared<CalledNode>(iut::Peer::at_socket("unix:pair", std::move(*socket)));
  return [node] { return node->call(); };
}

const Rows kRows({
    {"one call of an implementation", "over pipes: ping-pong with a process", "calls", "", 0, bare_pipe,
     true},
    {"one call of an implementation", "exec:", "calls", "over pipes", 0.5, calls_over_pipes, true},
    {"one call of an implementation", "over a socket: ping-pong with a thread", "calls", "", 0, bare_socket,
     true},
    {"one call of an implementation", "unix:", "calls", "over a socket", 0.5, calls_over_a_socket, true},
});

}  // namespace
}  // namespace fieldproof::bench
