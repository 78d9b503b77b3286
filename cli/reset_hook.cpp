#include "cli/reset_hook.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>

#include "harness/iut/process.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::cli {
namespace {

using std::chrono::milliseconds;

constexpr std::size_t kKeptOctets = 2000;

// What has been said and not been read yet; the end of all of it is kept.
void drain(iut::Process& process, std::string& said) {
  std::array<char, 4096> piece{};
  for (;;) {
    const ssize_t count = ::read(process.from_errors().number(), piece.data(), piece.size());
    if (count <= 0) return;
    said.append(piece.data(), static_cast<std::size_t>(count));
    if (said.size() > kKeptOctets) said.erase(0, said.size() - kKeptOctets);
  }
}

std::optional<std::string> reset(const std::string& command, const std::string& id, milliseconds limit) {
  constexpr milliseconds kBetweenLooks{20};
  // Both outputs of the command go where they are read.
  iut::Process process({"sh", "-c", "{ " + command + "\n} >&2", "sh", id});
  process.to_input().close();
  std::string said;
  const auto until = std::chrono::steady_clock::now() + limit;
  bool has_ended = false;
  while (!has_ended && std::chrono::steady_clock::now() < until) {
    has_ended = process.has_ended(kBetweenLooks);
    drain(process, said);
  }
  if (has_ended && process.how_it_ended() == "ended with exit code 0") return std::nullopt;
  const std::string how =
      has_ended ? process.how_it_ended() : fmt::format("has not ended within {} ms", limit.count());
  return fmt::format("'{}' {}{}{}", command, how, said.empty() ? "" : ", and said: ", said);
}

}  // namespace

std::function<std::optional<std::string>(const conformance::TestCase&)> reset_hook(std::string command,
                                                                                   milliseconds limit) {
  return [command = std::move(command), limit](const conformance::TestCase& test_case) {
    return reset(command, test_case.id, limit);
  };
}

}  // namespace fieldproof::cli
