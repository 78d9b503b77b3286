#pragma once

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "harness/iut/message.hpp"
#include "harness/iut/process.hpp"

// For tests: implementations that say what a test wants, whatever they hear.
namespace fieldproof::iut {

inline const RoleName kScriptedRole{"some_bus", "station"};

using MessageOctets = std::vector<std::uint8_t>;

inline MessageOctets octets_of(std::span<const std::uint8_t> message) {
  return {message.begin(), message.end()};
}
inline MessageOctets capabilities_message(std::uint16_t version = kMessageVersion, std::uint8_t unit = 1,
                                          std::string_view name = "script") {
  MessageWriter writer;
  return octets_of(write_capabilities(writer, {version, unit, std::string(name), {kScriptedRole}}));
}
inline MessageOctets echoed_message() {
  constexpr std::uint8_t kEcho[] = {0x00, 0xFF, 0x0A, 0x0D, 0x1A, 0x7F, 0x80, 0x55};
  MessageWriter writer;
  return octets_of(writer.begin(MessageType::echoed).octets(kEcho).finish());
}
// To the echo at the end of a case.
inline MessageOctets echoed_nothing_message() {
  MessageWriter writer;
  return octets_of(writer.begin(MessageType::echoed).finish());
}
inline MessageOctets unsupported_message() {
  MessageWriter writer;
  return octets_of(writer.begin(MessageType::unsupported).finish());
}
inline MessageOctets done_message(kernel::Time next = kernel::kNever) {
  MessageWriter writer;
  return octets_of(writer.begin(MessageType::done).time(next).finish());
}
inline MessageOctets write_message(Item item, std::uint64_t value, kernel::Time when) {
  MessageWriter writer;
  return octets_of(writer.begin(MessageType::write).u16(item).u64(value).time(when).finish());
}

// A program of the shell, step by step.
class Script {
 public:
  Script& then(const std::string& words) {
    words_ += words + "\n";
    return *this;
  }
  Script& says(const MessageOctets& octets) { return then(saying(octets)); }
  // In lock step what can be read at once is one message.
  Script& hears() { return then("dd bs=65536 count=1 of=/dev/null 2>/dev/null"); }
  Script& answers(const MessageOctets& octets) { return hears().says(octets); }
  Script& tests_itself() {
    return answers(capabilities_message()).answers(echoed_message()).answers(unsupported_message());
  }
  // Lives until its input ends.
  Script& stays() { return then("cat >/dev/null"); }

  static std::string saying(const MessageOctets& octets) {
    std::string words = "printf '";
    for (const std::uint8_t octet : octets) words += fmt::format("\\{:03o}", octet);
    return words + "'";
  }
  std::vector<std::string> command() const { return {"/bin/sh", "-c", words_}; }

 private:
  std::string words_;
};

// A folder that is gone with the test.
class ScriptFolder {
 public:
  ScriptFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "iutXXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) std::abort();
    path_ = name;
  }
  ScriptFolder(const ScriptFolder&) = delete;
  ScriptFolder& operator=(const ScriptFolder&) = delete;
  ~ScriptFolder() { std::filesystem::remove_all(path_); }
  std::string file(const std::string& name) const { return (path_ / name).string(); }
  // The octets of a file; none of one that is not there.
  std::string read(const std::string& name) const {
    std::ifstream input(path_ / name);
    return {std::istreambuf_iterator<char>(input), {}};
  }

 private:
  std::filesystem::path path_;
};

// Somebody who listens at a path. A connection is there before it is accepted.
class Listener {
 public:
  explicit Listener(const std::string& path)
      : socket_(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)), path_(path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, path.data(), path.size());
    if (::bind(socket_.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
        ::listen(socket_.number(), 8) != 0) {
      std::abort();
    }
  }
  Descriptor accept() const {
    return Descriptor(::accept4(socket_.number(), nullptr, nullptr, SOCK_CLOEXEC));
  }
  // A connection at which all this has been said already.
  Descriptor accept_and_say(const std::vector<MessageOctets>& all) const {
    MessageOctets joined;
    for (const MessageOctets& octets : all) joined.insert(joined.end(), octets.begin(), octets.end());
    Descriptor connection = accept();
    // At once: the other side may go as soon as it has heard enough.
    if (::write(connection.number(), joined.data(), joined.size()) < 0) std::abort();
    return connection;
  }
  // A connection at which each of these answers what can be read at once: in lock step, one message.
  Descriptor accept_and_answer(const std::vector<MessageOctets>& all) const {
    Descriptor connection = accept();
    std::vector<std::uint8_t> heard(65536);
    for (const MessageOctets& octets : all) {
      if (::read(connection.number(), heard.data(), heard.size()) <= 0) break;
      if (::write(connection.number(), octets.data(), octets.size()) < 0) std::abort();
    }
    return connection;
  }
  // Takes those who have connected and wait, and tells how many there were.
  unsigned accept_waiting() const {
    unsigned count = 0;
    for (pollfd ready{socket_.number(), POLLIN, 0}; ::poll(&ready, 1, 0) == 1; ++count) accept();
    return count;
  }
  const std::string& path() const { return path_; }

 private:
  Descriptor socket_;
  std::string path_;
};

}  // namespace fieldproof::iut
