#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "harness/iut/limits.hpp"
#include "harness/iut/misbehaviour.hpp"
#include "harness/iut/process.hpp"

// The other end of a stream of messages: a process at its standard streams, or who listens at a socket. It is
// supervised: what it does not do in time, or does too much, is Misbehaviour with its evidence, and after
// that the peer is of no use any more.
//
// Limits: the log (its standard error) is kept up to kKeptLog octets, the last ones.
namespace fieldproof::iut {

class Peer {
 public:
  using Clock = std::chrono::steady_clock;

  static constexpr std::size_t kKeptLog = 64U * 1024;

  // `what` names it in sentences: "exec:./node".
  static Peer spawned(std::string what, const std::vector<std::string>& command);
  // Whoever is at the other end of a connected socket.
  static Peer at_socket(std::string what, Descriptor socket);
  static Peer at_unix_socket(std::string what, const std::string& path);
  static Peer at_tcp_port(std::string what, const std::string& host, const std::string& port,
                          std::chrono::milliseconds longest_wait);

  // To one that has gone nothing is sent: the next `receive` tells what it said last, and that it has gone.
  void send(std::span<const std::uint8_t> message, std::chrono::milliseconds limit);
  // The next message, without its length, within the limit after `begin`. Valid until the next call.
  std::span<const std::uint8_t> receive(std::chrono::milliseconds limit,
                                        Clock::time_point begin = Clock::now());
  // Whether there is anything to read although nothing was asked; of a peer that is alive. Of what has
  // come already, without asking the system.
  bool has_more();
  bool has_read_more() const { return begin_ != end_; }

  // It is there and has not ended by itself.
  bool is_alive();
  // Its log since the last time, as text of unknown origin.
  std::string take_log();
  const std::string& what() const { return what_; }
  // Whoever it is, it cannot be used any more.
  void end();

  // Misbehaviour with what is known of it: the last lines of its log stand after the evidence.
  [[noreturn]] void blame(std::string_view reason, const std::string& sentence,
                          std::vector<std::string> evidence = {});

 private:
  explicit Peer(std::string what) : what_(std::move(what)) {}

  void fill(Clock::time_point until);
  bool has_input();
  void read_log();
  [[noreturn]] void blame_end();
  int input() { return process_ ? process_->from_output().number() : socket_.number(); }
  int output() { return process_ ? process_->to_input().number() : socket_.number(); }

  std::string what_;
  std::optional<Process> process_;
  Descriptor socket_;
  std::vector<std::uint8_t> buffer_;
  std::size_t begin_ = 0;  // of what has not been taken
  std::size_t end_ = 0;
  std::string log_;
};

}  // namespace fieldproof::iut
