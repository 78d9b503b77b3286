#include "conformance/valve_bus/host_deeds.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "conformance/valve_bus/host_expect.hpp"

namespace fieldproof::conformance {
namespace {

constexpr std::int64_t kTurnaroundBits = 60;
constexpr unsigned kMostAddress = 99;

// Of each of these the data differ from those before.
valve_bus::Command new_write(HostSide& side, std::uint8_t id) {
  const unsigned number = side.next_number();
  return {id, static_cast<std::uint8_t>(side.bench().rules().write_command),
          static_cast<std::uint8_t>(number), static_cast<std::uint8_t>(0x80 + (number >> 8))};
}

std::array<std::uint8_t, 4> order_of(const valve_bus::Command& command) {
  return {command.id, command.command, command.data0, command.data1};
}

std::int64_t late_frames(HostSide& side, std::uint8_t id) {
  return static_cast<std::int64_t>(side.bench().counters(id).late);
}

// At a slow rate a time-out is hardly longer than a delimiter, and what is wrong in a response comes after
// it.
bool knows_in_time(HostSide& side) {
  const HostBench& bench = side.bench();
  return bench.bits(kTurnaroundBits) + bench.characters(4) < bench.time_out();
}

bool verifies(HostSide& side) {
  return side.bench().pics().supports("verifies_writes");
}

// The read that has just come, as far as the host has sent one.
valve_bus::Response data_of_last_request(const HostSide& side) {
  constexpr std::size_t kData = 2;
  const auto& values = side.requests().back().values;
  if (values.size() <= kData + 1) return {};
  return {static_cast<std::uint8_t>(values[kData]), static_cast<std::uint8_t>(values[kData + 1])};
}

}  // namespace

void order_acknowledged(HostSide& side, std::uint8_t id, unsigned attempts, Acknowledge how) {
  side.drain();
  const valve_bus::Command command = new_write(side, id);
  side.acknowledge_wrongly(command, knows_in_time(side) ? attempts : 0, how);
  side.order(command);
  side.drain();
  side.acknowledge_wrongly({}, 0, Acknowledge::right);
}

void poll_without_end(HostSide& side, std::uint8_t id, unsigned count) {
  constexpr unsigned kWaiting = 8;
  side.drain();
  side.order(new_write(side, id));
  side.drain();
  HostBench& bench = side.bench();
  const auto read = order_of(bench.read_of(id));
  for (unsigned n = 0; n < count + kWaiting; ++n) {
    if (n < count) side.order_octets(read, 1);
    if (n < kWaiting) continue;
    if (!side.await_request()) return;
    side.answer(valve_bus::Response{static_cast<std::uint8_t>(n), 0x3C}, bench.bits(kTurnaroundBits));
    side.expect_refreshed();
  }
  side.note_id(id);
}

void follow_refreshes(HostSide& side, std::uint8_t id, kernel::Duration between, unsigned count,
                      CaseJudge* judge) {
  side.drain();
  HostBench& bench = side.bench();
  const valve_bus::Rules& rules = bench.rules();
  // A read back that nobody answers would be in the way.
  if (verifies(side)) return;
  const valve_bus::Command first = new_write(side, id);
  const valve_bus::Command second = new_write(side, id);
  side.order(first);
  if (!side.await_write(first, bench.observation_timeout())) return;
  side.wait(between);
  side.order(second);
  if (!side.await_write(second, bench.observation_timeout())) return;
  const auto others = static_cast<int>(side.pace().written_nodes());
  const kernel::Duration write = bench.characters(10) + bench.delimiter() + rules.write_distance;
  const kernel::Duration least = rules.refresh * 9 / 10;
  const kernel::Duration most =
      rules.refresh * 11 / 10 + (others > 1 ? 2 * others * write : kernel::Duration{}) +
      (rules.answers_writes ? (others + 1) * bench.characters(20) : kernel::Duration{});
  for (unsigned n = 0; n < count; ++n) {
    const kernel::Time before = side.pace().last_start();
    const bool is_there = side.await_write(second, most + bench.characters(10));
    if (!is_there) {
      if (judge != nullptr) judge->fail("no_refresh", {{"a write to the node again"}, "none", bench.now()});
      return;
    }
    const kernel::Duration period = side.pace().last_start() - before;
    if (judge == nullptr) continue;
    judge->expect(period + kernel::kNanosecond >= least && period - kernel::kNanosecond <= most,
                  "refresh_period_wrong", [&] {
                    return Mismatch{{kernel::describe(least) + " to " + kernel::describe(most)},
                                    kernel::describe(period),
                                    side.pace().last_start()};
                  });
  }
}

void talk_over_refreshes(HostSide& side) {
  side.drain();
  HostBench& bench = side.bench();
  if (!side.pace().has_written() || bench.rules().answers_writes) return;
  // Who talks as a write ends is heard before the next one where the rest after it is some characters longer
  // than the silence that ends a frame.
  if (bench.characters(2) > kernel::kMillisecond) return;
  side.keep_line_busy(bench.rules().refresh * 11 / 10 + 2 * bench.time_out() + bench.characters(10));
}

void write_to_many(HostSide& side, unsigned nodes) {
  side.drain();
  std::vector<std::uint8_t> octets;
  for (unsigned id = 1; id <= nodes; ++id) {
    const auto order = order_of(new_write(side, static_cast<std::uint8_t>(id)));
    octets.insert(octets.end(), order.begin(), order.end());
    side.note_id(static_cast<std::uint8_t>(id));
  }
  side.order_octets(octets, nodes);
  side.drain();
  side.wait(side.pace().longest_refresh() + kernel::kMillisecond);
}

void cut_part(HostSide& side, unsigned count) {
  side.drain();
  const auto octets = order_of(side.bench().read_of(7));
  side.bench().write(std::span(octets).first(count));
  side.restart();
  side.wait(side.bench().rules().partial_command_limit + 10 * kernel::kMillisecond);
}

void write_twice(HostSide& side, std::uint8_t id, unsigned wrong) {
  side.drain();
  for (unsigned n = 0; n < 2; ++n) side.order(new_write(side, id));
  for (unsigned n = 1; n <= 2 && verifies(side); ++n) {
    if (!side.await_request()) return;
    valve_bus::Response response = data_of_last_request(side);
    if (n == wrong) response.data1 = static_cast<std::uint8_t>(response.data1 ^ 1U);
    side.answer(response, side.bench().bits(kTurnaroundBits));
  }
  side.drain();
}

void reject_all(HostSide& side, std::uint8_t id, bool is_late, CaseJudge* judge) {
  side.drain();
  HostBench& bench = side.bench();
  if (!knows_in_time(side)) return;
  side.order(bench.read_of(id));
  if (!is_late) side.order(bench.read_of(id % kMostAddress + 1U));
  for (unsigned attempt = 0; attempt < bench.rules().read_attempts; ++attempt) {
    if (!side.await_request()) return;
    side.answer_octets(std::array<std::uint8_t, 3>{0x5A, 0xC3, 0x00}, bench.bits(kTurnaroundBits));
  }
  if (is_late) {
    const std::int64_t before = late_frames(side, id);
    side.answer(valve_bus::Response{0x5A, 0xC3}, bench.late_turnaround_time());
    side.wait(bench.characters(10));
    return side.note_late(id, late_frames(side, id) - before);
  }
  const kernel::Time end = side.pace().last_end();
  const kernel::Duration least = bench.time_out() + bench.time_out_tolerance() * 4 / 5;
  if (!side.await_request() || judge == nullptr) return;
  const kernel::Duration rest = side.pace().last_start() - end;
  judge->expect(rest + kernel::kNanosecond >= least, "rest_too_short", [&] {
    return Mismatch{{kernel::describe(least) + " or more after the last attempt"},
                    kernel::describe(rest),
                    side.pace().last_start()};
  });
}

// A refresh would end what is late.
void say_late(HostSide& side, std::uint8_t id, unsigned count) {
  side.drain();
  HostBench& bench = side.bench();
  if (side.pace().has_written()) return;
  side.order(bench.read_of(id));
  for (unsigned attempt = 0; attempt < bench.rules().read_attempts; ++attempt) {
    if (!side.await_request()) return;
  }
  const std::int64_t before = late_frames(side, id);
  side.answer(valve_bus::Response{0x5A, 0xC3}, bench.late_turnaround_time());
  for (unsigned n = 1; n < count; ++n) {
    bench.wait(bench.characters(6));
    bench.say(octets_of(valve_bus::Response{0x5A, 0xC3}));
  }
  side.wait(bench.characters(10));
  side.note_late(id, late_frames(side, id) - before);
}

void order_meanwhile(HostSide& side, std::uint8_t id, unsigned tenths, unsigned count) {
  side.drain();
  HostBench& bench = side.bench();
  side.order(bench.read_of(id));
  if (!side.await_request()) return;
  bench.wait(bench.time_out() * tenths / 10);
  std::vector<std::uint8_t> octets;
  for (unsigned n = 0; n < count; ++n) {
    const auto order = order_of(new_write(side, 2));
    octets.insert(octets.end(), order.begin(), order.end());
  }
  side.note_id(2);
  side.order_octets(octets, count);
  side.drain();
}

}  // namespace fieldproof::conformance
