#include "conformance/valve_bus/host_orders.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <vector>

namespace fieldproof::conformance {
namespace {

using valve_bus::Command;

constexpr unsigned kOrderOctets = 4;
constexpr unsigned kReadTurns = 3;
constexpr std::int64_t kOrdinaryTurnaroundBits = 60;
// Where the rest of a command comes in time for sure.
constexpr std::int64_t kQuickBitRate = 20'000;

void append_order(std::vector<std::uint8_t>& octets, const Command& command,
                  std::size_t count = kOrderOctets) {
  const std::array<std::uint8_t, kOrderOctets> all{command.id, command.command, command.data0, command.data1};
  octets.insert(octets.end(), all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count));
}

// Of each of these the data differ.
Command numbered_order(const HostBench& bench, std::uint8_t id, unsigned number, bool is_read = false) {
  const valve_bus::Rules& rules = bench.rules();
  return {id, static_cast<std::uint8_t>(is_read ? rules.read_command : rules.write_command),
          static_cast<std::uint8_t>(number), static_cast<std::uint8_t>(0xC0 + (number >> 8))};
}

}  // namespace

line::Levels levels_of_response(const HostBench& bench, const valve_bus::Response& response) {
  line::Levels levels;
  for (const std::uint8_t octet : octets_of(response)) levels.append(bench.levels_of(octet));
  return levels;
}

void order_burst(HostSide& side, const HostBurst& burst) {
  side.drain();
  std::vector<std::uint8_t> octets;
  for (unsigned n = 0; n < burst.count; ++n) {
    const auto id = static_cast<std::uint8_t>(1 + std::min(n, burst.nodes));
    append_order(octets, numbered_order(side.bench(), id, side.next_number(), burst.is_read));
    side.note_id(id);
  }
  append_order(octets, numbered_order(side.bench(), 7, 0), burst.part);
  side.order_octets(octets, burst.count);
  if (!burst.is_read) side.expect_turns(burst.count);
  side.drain();
  side.expect_turns(0);
  if (burst.part > 0) side.wait(side.bench().rules().partial_command_limit + 10 * kernel::kMillisecond);
  side.note_fifo();
}

void fill_up(HostSide& side, unsigned count, unsigned part) {
  side.drain();
  HostBench& bench = side.bench();
  if (bench.rules().bit_rate < kQuickBitRate) part = 0;
  side.order(numbered_order(bench, 1, 0, true));
  if (!side.await_request()) return;
  std::vector<std::uint8_t> octets;
  for (unsigned n = 0; n < count; ++n) append_order(octets, numbered_order(bench, 2, side.next_number()));
  std::vector<std::uint8_t> last;
  append_order(last, numbered_order(bench, 3, side.next_number()));
  octets.insert(octets.end(), last.begin(), last.begin() + part);
  side.order_octets(octets, count + 1);
  side.note_fifo();
  side.answer(valve_bus::Response{0x5A, 0xC3}, bench.bits(kOrdinaryTurnaroundBits));
  if (part > 0) {
    side.await_command();
    std::vector<std::uint8_t> rest(last.begin() + part, last.end());
    append_order(rest, numbered_order(bench, 4, side.next_number()));
    side.order_octets(rest, 2);
  }
  side.drain();
  side.note_fifo();
}

void order_torn(HostSide& side, unsigned count, kernel::Duration between) {
  side.drain();
  std::vector<std::uint8_t> octets;
  append_order(octets, numbered_order(side.bench(), 5, side.next_number()));
  side.order_octets(std::span(octets).first(count), 1);
  // A refresh may be on the line at that instant.
  side.bench().write_later(std::span(octets).subspan(count), between);
  side.wait(between);
}

void serve_late(HostSide& side, std::uint8_t id, const valve_bus::Response& response) {
  side.drain();
  HostBench& bench = side.bench();
  // At a slow rate the line is not silent for about a time-out then, and a refresh may be due.
  if (side.pace().has_written() && bench.characters(10) >= bench.time_out()) return;
  side.order(bench.read_of(id));
  for (unsigned attempt = 0; attempt < bench.rules().read_attempts; ++attempt) {
    if (!side.await_request()) return;
  }
  side.answer(response, bench.late_turnaround_time());
}

// A host may take the command for a refresh that is due, and reports what it likes of that.
void talk_over(HostSide& side, std::uint8_t id, unsigned halves) {
  side.drain();
  HostBench& bench = side.bench();
  if (side.pace().has_written()) return;
  // Whether the time-out begins with the order or with what is on the line is open.
  if (halves == 1 && bench.characters(15) > bench.time_out()) return;
  side.talk(halves * bench.time_out() / 2 + bench.characters(halves > 1 ? 20 : 0), bench.read_of(id));
}

void read_in_turn(HostSide& side, unsigned nodes, CaseJudge* judge) {
  side.drain();
  HostBench& bench = side.bench();
  const bool has_refreshes = side.pace().has_written();
  for (unsigned n = 0; n < kReadTurns * nodes; ++n)
    side.order(bench.read_of(static_cast<std::uint8_t>(1 + n % nodes)));
  kernel::Time before{};
  kernel::Duration shortest = kernel::Duration::max();
  kernel::Duration longest{};
  for (unsigned n = 0; n < kReadTurns * nodes; ++n) {
    if (!side.await_request()) return;
    const kernel::Time start = side.pace().last_start();
    if (n % nodes == 0 && n > 0) {
      shortest = std::min(shortest, start - before);
      longest = std::max(longest, start - before);
    }
    if (n % nodes == 0) before = start;
    const valve_bus::Response response{static_cast<std::uint8_t>(n), 0x3C};
    side.answer(response, bench.bits(kOrdinaryTurnaroundBits));
  }
  if (judge == nullptr || has_refreshes) return;
  judge->expect(longest - shortest <= shortest / 100, "period_jitters", [&] {
    return Mismatch{
        {fmt::format("equal responses, and a period of {} within 1 %", kernel::describe(shortest))},
        kernel::describe(longest)};
  });
}

}  // namespace fieldproof::conformance
