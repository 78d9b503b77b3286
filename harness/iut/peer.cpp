#include "harness/iut/peer.hpp"

#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <optional>
#include <system_error>

#include "harness/iut/message.hpp"
#include "harness/kernel/untrusted_text.hpp"

namespace fieldproof::iut {
namespace {

using std::chrono::milliseconds;

constexpr std::size_t kChunk = 64U * 1024;
constexpr std::size_t kLogLinesShown = 12;

[[noreturn]] void cannot_connect(const std::string& what, const std::string& why) {
  throw kernel::Error(kernel::ErrorKind::implementation,
                      fmt::format("{}: nobody can be reached there: {}", what, why));
}

std::string error_text(int error) {
  return std::system_category().message(error);
}

// Octets as people look at them, with what of them is text.
std::string shown(std::span<const std::uint8_t> octets) {
  constexpr std::size_t kMost = 32;
  std::string digits;
  std::string text;
  for (const std::uint8_t octet : octets.first(std::min(octets.size(), kMost))) {
    digits += fmt::format("{:02X} ", octet);
    text += octet >= 0x20 && octet < 0x7F ? static_cast<char>(octet) : '.';
  }
  return fmt::format("{}{} \"{}\"", digits, octets.size() > kMost ? "..." : "", text);
}

int remaining(Peer::Clock::time_point until) {
  const auto left = std::chrono::ceil<milliseconds>(until - Peer::Clock::now());
  return static_cast<int>(std::max<milliseconds::rep>(0, left.count()));
}

}  // namespace

Peer Peer::spawned(std::string what, const std::vector<std::string>& command) {
  Peer peer(std::move(what));
  peer.process_.emplace(command);
  return peer;
}

Peer Peer::at_socket(std::string what, Descriptor socket) {
  Peer peer(std::move(what));
  peer.socket_ = std::move(socket);
  return peer;
}

Peer Peer::at_unix_socket(std::string what, const std::string& path) {
  Peer peer(std::move(what));
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof address.sun_path) {
    cannot_connect(peer.what_, "the path of a socket has 1 to 107 characters");
  }
  std::memcpy(address.sun_path, path.data(), path.size());
  peer.socket_ = Descriptor(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (::connect(peer.socket_.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    cannot_connect(peer.what_, error_text(errno));
  }
  return peer;
}

Peer Peer::at_tcp_port(std::string what, const std::string& host, const std::string& port,
                       milliseconds longest_wait) {
  Peer peer(std::move(what));
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (const int failure = ::getaddrinfo(host.c_str(), port.c_str(), &hints, &found); failure != 0) {
    cannot_connect(peer.what_, ::gai_strerror(failure));
  }
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> addresses(found, &::freeaddrinfo);
  const timeval limit{longest_wait.count() / 1000, (longest_wait.count() % 1000) * 1000};
  int error = 0;
  for (const addrinfo* one = found; one != nullptr; one = one->ai_next) {
    peer.socket_ = Descriptor(::socket(one->ai_family, one->ai_socktype | SOCK_CLOEXEC, one->ai_protocol));
    // Bounds the time of connecting, too.
    ::setsockopt(peer.socket_.number(), SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof limit);
    if (::connect(peer.socket_.number(), one->ai_addr, one->ai_addrlen) == 0) {
      const int on = 1;  // lock step: each message waits for its answer
      ::setsockopt(peer.socket_.number(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
      return peer;
    }
    error = errno;
  }
  cannot_connect(peer.what_, error_text(error));
}

void Peer::send(std::span<const std::uint8_t> message, milliseconds limit) {
  const auto until = Clock::now() + limit;
  while (!message.empty()) {
    // A pipe takes what fits; one that is full waits for a peer that does not read.
    const ssize_t sent = process_
                             ? ::write(output(), message.data(), message.size())
                             : ::send(output(), message.data(), message.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent > 0) {
      message = message.subspan(static_cast<std::size_t>(sent));
      continue;
    }
    // It does not hear any more. What it has said before that tells more, and `receive` meets its end.
    if (sent < 0 && errno != EAGAIN && errno != EINTR) return;
    pollfd wait{output(), POLLOUT, 0};
    if (::poll(&wait, 1, remaining(until)) == 0) {
      blame(reasons::kHangs, fmt::format("does not take what it is sent within {} ms", limit.count()));
    }
  }
}

namespace {

// A limit is of what an implementation does, and a busy machine is none of it: one that is ready to run when
// the limit is over gets it once more as processor time of its own, in ten times the limit at most.
class Patience {
 public:
  Patience(const std::optional<Process>& process, milliseconds limit, Peer::Clock::time_point begin)
      : process_(process), limit_(limit), last_(begin + kTimes * limit), until_(begin + limit) {}

  Peer::Clock::time_point until() const { return until_; }
  // At the end of it: whether there is more.
  bool goes_on() {
    if (!process_ || Peer::Clock::now() >= last_) return false;
    const Process::Effort effort = process_->effort();
    if (!effort.is_ready) return false;
    if (had_ < milliseconds(0)) had_ = effort.processor_time;
    if (effort.processor_time - had_ >= limit_) return false;
    until_ = std::min(last_, Peer::Clock::now() + std::max(kLeastLook, limit_ / kLooks));
    return true;
  }

 private:
  static constexpr int kTimes = 10;
  static constexpr int kLooks = 8;
  static constexpr milliseconds kLeastLook{1};

  const std::optional<Process>& process_;
  milliseconds limit_;
  Peer::Clock::time_point last_;
  Peer::Clock::time_point until_;
  milliseconds had_{-1};  // processor time when the limit was over
};

}  // namespace

std::span<const std::uint8_t> Peer::receive(milliseconds limit, Clock::time_point begin) {
  Patience patience(process_, limit, begin);
  const auto wait_for = [&](std::size_t octets) {
    while (end_ - begin_ < octets) {
      // What has come by then is an answer, also where this process was the one that was held up.
      if (remaining(patience.until()) == 0 && !has_input() && !patience.goes_on()) {
        // Its descendants may keep the stream open when it has gone.
        if (process_ && process_->has_ended(milliseconds(0)))
          blame(reasons::kCrashed, process_->how_it_ended());
        blame(reasons::kHangs, fmt::format("has not answered within {} ms", limit.count()));
      }
      fill(patience.until());
    }
  };
  wait_for(kMessageHead);
  std::size_t length = 0;
  for (std::size_t n = 0; n < kMessageHead; ++n) length |= std::size_t{buffer_[begin_ + n]} << (8 * n);
  if (length == 0 || length > kLongestMessage) {
    blame(reasons::kGarbage,
          fmt::format("sends a message of {} octets; 1 to {} are possible", length, kLongestMessage),
          {"received: " + shown(std::span(buffer_).subspan(begin_, end_ - begin_))});
  }
  wait_for(kMessageHead + length);
  const auto message = std::span<const std::uint8_t>(buffer_).subspan(begin_ + kMessageHead, length);
  begin_ += kMessageHead + length;
  return message;
}

bool Peer::has_more() {
  return has_read_more() || has_input();
}

bool Peer::has_input() {
  pollfd wait{input(), POLLIN, 0};
  return ::poll(&wait, 1, 0) > 0 && (wait.revents & POLLIN) != 0;
}

void Peer::fill(Clock::time_point until) {
  if (begin_ == end_) begin_ = end_ = 0;
  if (begin_ > 0 && buffer_.size() - end_ < kChunk) {
    std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(begin_),
              buffer_.begin() + static_cast<std::ptrdiff_t>(end_), buffer_.begin());
    end_ -= std::exchange(begin_, 0);
  }
  if (buffer_.size() - end_ < kChunk) buffer_.resize(end_ + kChunk);
  std::array<pollfd, 2> waits{
      {{input(), POLLIN, 0}, {process_ ? process_->from_errors().number() : -1, POLLIN, 0}}};
  if (::poll(waits.data(), waits.size(), remaining(until)) <= 0) return;
  if (waits[1].revents != 0) read_log();
  if (waits[0].revents == 0) return;
  const ssize_t count = ::read(input(), buffer_.data() + end_, buffer_.size() - end_);
  if (count > 0) {
    end_ += static_cast<std::size_t>(count);
  } else if (count == 0 || (errno != EINTR && errno != EAGAIN)) {
    blame_end();
  }
}

void Peer::read_log() {
  if (!process_ || !process_->from_errors()) return;
  std::array<char, 4096> part{};
  for (int n = 0; n < 64; ++n) {  // bounded: one who writes without end must not keep the bench
    const ssize_t count = ::read(process_->from_errors().number(), part.data(), part.size());
    if (count <= 0) {
      if (count == 0) process_->from_errors().close();
      break;
    }
    log_.append(part.data(), static_cast<std::size_t>(count));
    if (log_.size() > 2 * kKeptLog) log_.erase(0, log_.size() - kKeptLog);
  }
}

bool Peer::is_alive() {
  if (process_) return !process_->has_ended(milliseconds(0));
  if (!socket_) return false;
  // The end of the stream can be read as soon as the other side has closed it.
  std::uint8_t octet = 0;
  const ssize_t count = ::recv(socket_.number(), &octet, 1, MSG_PEEK | MSG_DONTWAIT);
  return count > 0 || (count < 0 && (errno == EAGAIN || errno == EINTR));
}

std::string Peer::take_log() {
  read_log();
  if (log_.size() > kKeptLog) log_.erase(0, log_.size() - kKeptLog);
  return std::exchange(log_, {});
}

void Peer::end() {
  if (process_) {
    process_->end_group();
    read_log();
    process_->to_input().close();
    process_->from_output().close();
  }
  socket_.close();
}

void Peer::blame_end() {
  constexpr milliseconds kPatience{500};
  if (!process_) {
    blame(reasons::kGone, "has closed its connection");
  } else if (process_->has_ended(kPatience)) {
    blame(reasons::kCrashed, process_->how_it_ended());
  }
  blame(reasons::kGone, "has closed its standard output and goes on");
}

void Peer::blame(std::string_view reason, const std::string& sentence, std::vector<std::string> evidence) {
  end();
  std::string log = take_log();
  std::vector<std::string> lines;
  for (std::size_t from = 0; from < log.size();) {
    const std::size_t to = std::min(log.find('\n', from), log.size());
    lines.push_back("log: " + kernel::escaped_line(log.substr(from, std::min<std::size_t>(to - from, 200))));
    from = to + 1;
  }
  const std::size_t first = lines.size() - std::min(lines.size(), kLogLinesShown);
  evidence.insert(evidence.end(), lines.begin() + static_cast<std::ptrdiff_t>(first), lines.end());
  throw Misbehaviour(reason, fmt::format("{} {}", what_, sentence), std::move(evidence));
}

}  // namespace fieldproof::iut
