#include <fmt/format.h>

#include <vector>

#include "conformance/valve_bus/host_cases.hpp"
#include "conformance/valve_bus/host_expect.hpp"

// The FIFO between the PC and the host: order, fullness, parts of commands.
namespace fieldproof::conformance {
namespace {

using valve_bus::Command;
using valve_bus::HostErrorKind;

constexpr std::size_t kOctets = 4;  // of a command as the PC writes it

// A read that carries its number: a host sends the data of a read as they were written.
Command numbered_read(const HostBench& bench, unsigned number) {
  return {static_cast<std::uint8_t>(number % bench.rules().last_address + 1),
          static_cast<std::uint8_t>(bench.rules().read_command), static_cast<std::uint8_t>(number),
          static_cast<std::uint8_t>(number >> 8)};
}

std::vector<std::uint8_t> stream_of(const HostBench& bench, unsigned first, unsigned count) {
  std::vector<std::uint8_t> octets;
  for (unsigned n = first; n < first + count; ++n) {
    const Command read = numbered_read(bench, n);
    octets.insert(octets.end(), {read.id, read.command, read.data0, read.data1});
  }
  return octets;
}

void answer_numbered(HostBench& bench, CaseJudge& judge, unsigned number) {
  const Command read = numbered_read(bench, number);
  const valve_bus::Response response{bench.random_octet(), bench.random_octet()};
  bench.answer(response, bench.delimiter() + bench.bits(1));
  expect_response(bench, judge, read.id, response);
}

// The read with this number is the next on the line, and is served.
void expect_numbered(HostBench& bench, CaseJudge& judge, unsigned number) {
  expect_request(bench, judge, numbered_read(bench, number));
  answer_numbered(bench, judge, number);
}

void a_burst_keeps_its_order(HostBench& bench, CaseJudge& judge) {
  const auto count = bench.volume(200U, 2'000U);
  unsigned written = 0;
  for (unsigned sent = 0; sent < count; ++sent) {
    const auto room = static_cast<unsigned>(bench.fifo_room() / kOctets);
    const unsigned more = std::min(room, count - written);
    bench.write(stream_of(bench, written, more));
    written += more;
    expect_numbered(bench, judge, sent);
  }
  expect_no_request(bench, judge, 20 * kernel::kMillisecond, "command_doubled",
                    "all commands have been sent");
}

void a_full_fifo_keeps_the_oldest(HostBench& bench, CaseJudge& judge) {
  const unsigned fitting = bench.rules().fifo_octets / kOctets;
  const unsigned lost = bench.volume(3U, 100U);
  judge.expect(!bench.has_overflowed(), "overflow_not_told", "the flag is down before", "it is up");
  bench.write(stream_of(bench, 0, fitting + lost));
  judge.expect(bench.has_overflowed(), "overflow_not_told", "the flag of the overflow is up", "it is down");
  expect_request(bench, judge, numbered_read(bench, 0));
  for (unsigned n = 0; n < lost; ++n) {
    expect_error(bench, judge, {numbered_read(bench, fitting + n).id, HostErrorKind::fifo_overflow});
  }
  answer_numbered(bench, judge, 0);
  for (unsigned n = 1; n < fitting; ++n) expect_numbered(bench, judge, n);
  expect_no_request(bench, judge, 20 * kernel::kMillisecond, "lost_command_sent", "the newest were lost");
}

// Room comes in the middle of a command whose first octet was lost.
void a_lost_command_is_lost_whole(HostBench& bench, CaseJudge& judge) {
  const unsigned fitting = bench.rules().fifo_octets / kOctets;
  bench.write(stream_of(bench, 0, fitting));
  const std::vector<std::uint8_t> lost = stream_of(bench, fitting, 1);
  bench.write(std::span(lost).first(1));
  expect_error(bench, judge, {lost.front(), HostErrorKind::fifo_overflow});
  // With the first request there is room for four octets.
  expect_request(bench, judge, numbered_read(bench, 0));
  bench.write(std::span(lost).subspan(1));
  bench.write(stream_of(bench, fitting + 1, 1));
  expect_nothing_told(bench, judge, kernel::Duration{}, "rest_of_lost_command_kept",
                      "there is room for the next command");
  answer_numbered(bench, judge, 0);
  for (unsigned n = 1; n < fitting; ++n) expect_numbered(bench, judge, n);
  expect_numbered(bench, judge, fitting + 1);
  expect_no_request(bench, judge, 150 * kernel::kMillisecond, "part_sent", "nothing whole is left");
  expect_nothing_told(bench, judge, kernel::kMillisecond, "part_told",
                      "the command has been reported as lost");
}

void the_fifo_goes_round(HostBench& bench, CaseJudge& judge) {
  const unsigned fitting = bench.rules().fifo_octets / kOctets;
  unsigned sent = 0;
  for (int round = 0; round < bench.volume(3, 1'000); ++round) {
    bench.write(stream_of(bench, sent, fitting));
    for (unsigned n = 0; n < fitting; ++n) expect_numbered(bench, judge, sent++);
  }
}

void part_of_a_command_is_not_sent(HostBench& bench, CaseJudge& judge) {
  const kernel::Duration limit = bench.rules().partial_command_limit;
  for (std::size_t count = 1; count < kOctets; ++count) {
    const std::vector<std::uint8_t> part = stream_of(bench, static_cast<unsigned>(count), 1);
    // The rest comes in time.
    bench.write(std::span(part).first(count));
    expect_no_request(bench, judge, limit * 9 / 10, "part_sent", "the rest of the command has not come");
    bench.write(std::span(part).subspan(count));
    judge.expect(!bench.was_told(), "command_torn", "the command is waited for", "it was given up");
    expect_numbered(bench, judge, static_cast<unsigned>(count));
    // It does not come.
    bench.write(std::span(part).first(count));
    expect_no_request(bench, judge, limit * 11 / 10, "part_sent", "the rest of the command has not come");
    bench.write(stream_of(bench, 70, 1));
    const auto error = bench.next_told(kernel::Duration{});
    const auto* seen = error ? std::get_if<valve_bus::HostError>(&error->what) : nullptr;
    judge.expect(seen != nullptr && *seen == valve_bus::HostError{part[0], HostErrorKind::part_of_command},
                 "does_not_resync", "the PC gets the report that part of a command was given up",
                 error ? text_of(*error) : std::string("nothing was reported"));
    expect_numbered(bench, judge, 70);
  }
}

}  // namespace

std::vector<HostCase> host_fifo_cases() {
  const judge::Reference own = valve_sources::own("512 octets, the oldest are kept");
  const judge::Reference ring = valve_sources::paper("FIFO memory as a circular buffer");
  std::vector<HostCase> cases;
  cases.push_back({{.id = "valve_bus/host/fifo/burst_keeps_its_order",
                    .purpose = "RH-21",
                    .requirement = "Commands that the PC writes as fast as there is room are sent in their "
                                   "order, each once.",
                    .reference = ring,
                    .stimulus = "200 commands (2000 at full volume), as many at a time as fit.",
                    .expected = "They are on the line in their order, none lost, none twice.",
                    .tags = {"must"},
                    .catches = {{"loses_commands", "request_wrong"}, {"doubles_commands", "request_wrong"}}},
                   a_burst_keeps_its_order});
  cases.push_back(
      {{.id = "valve_bus/host/fifo/full_fifo_keeps_the_oldest",
        .purpose = "RH-22",
        .requirement = "When the FIFO is full the newest commands are lost, the PC gets a report of "
                       "each, and those in the FIFO are sent.",
        .reference = own,
        .stimulus = "More commands at once than fit.",
        .expected = "The flag and an error for each that does not fit; those that fit are sent.",
        .tags = {"must"},
        .catches = {{"overflow_not_told", "overflow_not_told"}, {"overflow_drops_oldest", "request_wrong"}}},
       a_full_fifo_keeps_the_oldest});
  cases.push_back({{.id = "valve_bus/host/fifo/lost_command_is_lost_whole",
                    .purpose = "RH-22",
                    .requirement = "With the first octet of a command its others are lost, also when there "
                                   "is room for them: no part of a command is sent, and the next is whole.",
                    .reference = own,
                    .stimulus = "A full FIFO, the first octet of a command, room, its other octets, another "
                                "command.",
                    .expected = "The commands that fit and the last one are sent.",
                    .tags = {"must"},
                    .catches = {{"overflow_drops_octets", "rest_of_lost_command_kept"}}},
                   a_lost_command_is_lost_whole});
  cases.push_back({{.id = "valve_bus/host/fifo/goes_round",
                    .purpose = "RH-23",
                    .requirement = "A FIFO that is filled and emptied again and again gives what was "
                                   "written.",
                    .reference = ring,
                    .stimulus = "A thousand times 512 octets.",
                    .expected = "All commands are on the line, exactly.",
                    .tags = {"must", "long"},
                    .catches = {{"fifo_wraps_one_early", "request_wrong"}}},
                   the_fifo_goes_round});
  cases.push_back(
      {{.id = "valve_bus/host/fifo/part_of_a_command_is_not_sent",
        .purpose = "RH-24",
        .requirement = "While the rest of a command has not come nothing is sent for it; after "
                       "100 ms it is given up, this is reported to the PC, and what comes then is a new "
                       "command.",
        .reference = valve_sources::own("a command that stays a part is given up"),
        .stimulus = "One, two, three octets of a command; the rest after 90 ms, or after 110 ms "
                    "another command.",
        .expected = "The first is sent whole, the second given up; the other is sent.",
        .tags = {"must", "timing"},
        .catches = {{"part_sent", "part_sent"},
                    {"never_resyncs", "does_not_resync"},
                    {"resyncs_early", "command_torn"}}},
       part_of_a_command_is_not_sent});
  return cases;
}

}  // namespace fieldproof::conformance
