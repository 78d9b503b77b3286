#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "conformance/valve_bus/host_scene.hpp"

// The FIFO between the PC and the host: order, fullness, parts of commands.
namespace fieldproof::conformance {
namespace {

using valve_bus::Command;
using valve_bus::HostError;
using valve_bus::HostErrorKind;

constexpr std::size_t kOctets = 4;  // of a command as the PC writes it

// A read that carries its number: a host sends the data of a read as they were written.
Command numbered_read(const HostBench& bench, unsigned number) {
  return bench.read_of(number % bench.rules().last_address + 1, static_cast<std::uint8_t>(number),
                       static_cast<std::uint8_t>(number >> 8));
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
  const valve_bus::Response response = bench.random_response();
  bench.answer(response, bench.delimiter() + bench.bits(1));
  expect_response(bench, judge, numbered_read(bench, number).id, response);
}

// The reads with these numbers are the next on the line, and are served.
void expect_numbered(HostBench& bench, CaseJudge& judge, unsigned first, unsigned count = 1) {
  for (unsigned n = first; n < first + count; ++n) {
    expect_request(bench, judge, numbered_read(bench, n));
    answer_numbered(bench, judge, n);
  }
}

void a_burst_keeps_its_order(HostBench& bench, CaseJudge& judge) {
  const auto count = bench.volume(1'100U, 2'000U);
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

unsigned fitting(const HostScene& scene) {
  return scene.bench.rules().fifo_octets / kOctets;
}

unsigned too_many(const HostScene& scene) {
  return scene.bench.volume(3U, 100U);
}

void expect_room(HostScene& scene, std::size_t commands) {
  scene.judge.expect_equal(scene.bench.fifo_room(), kOctets * commands, "room_wrong",
                           "octets that there is room for");
}

// While its response is awaited nothing is taken from the FIFO.
void read_first(HostScene& scene) {
  scene.bench.write(stream_of(scene.bench, 0, 1));
  expect_request(scene.bench, scene.judge, numbered_read(scene.bench, 0));
  expect_room(scene, fitting(scene));
}

void overfill(HostScene& scene) {
  HostBench& bench = scene.bench;
  bench.write(stream_of(bench, 1, fitting(scene)));
  scene.judge.expect_equal(bench.has_overflowed(), false, "overflow_not_told", "overflow");
  expect_room(scene, 0);
  bench.write(stream_of(bench, 1 + fitting(scene), too_many(scene)));
  scene.judge.expect_equal(bench.has_overflowed(), true, "overflow_not_told", "overflow");
  expect_room(scene, 0);
}

void expect_each_lost_reported(HostScene& scene) {
  for (unsigned n = 1 + fitting(scene); n < 1 + fitting(scene) + too_many(scene); ++n) {
    const HostError lost{numbered_read(scene.bench, n).id, HostErrorKind::fifo_overflow};
    expect_error(scene.bench, scene.judge, lost);
  }
}

// There is room for each that has been sent; the overflow stays up.
void expect_all_that_fit(HostScene& scene) {
  answer_numbered(scene.bench, scene.judge, 0);
  for (unsigned n = 1; n <= fitting(scene); ++n) {
    expect_request(scene.bench, scene.judge, numbered_read(scene.bench, n));
    expect_room(scene, n);
    answer_numbered(scene.bench, scene.judge, n);
  }
  scene.judge.expect_equal(scene.bench.has_overflowed(), true, "overflow_not_told", "overflow");
}

// The octets of the first command that does not fit, and of the next one.
std::vector<std::uint8_t> two_too_many(const HostScene& scene) {
  return stream_of(scene.bench, 1 + fitting(scene), 2);
}

void lose_a_command(HostScene& scene) {
  const std::uint8_t lost = two_too_many(scene).front();
  scene.bench.write({lost});
  expect_error(scene.bench, scene.judge, {lost, HostErrorKind::fifo_overflow});
}

void write_the_rest_and_another(HostScene& scene) {
  answer_numbered(scene.bench, scene.judge, 0);
  expect_request(scene.bench, scene.judge, numbered_read(scene.bench, 1));
  const auto octets = two_too_many(scene);
  scene.bench.write(std::span(octets).subspan(1));
}

void expect_the_others_sent(HostScene& scene) {
  answer_numbered(scene.bench, scene.judge, 1);
  expect_numbered(scene.bench, scene.judge, 2, fitting(scene) - 1);
  expect_numbered(scene.bench, scene.judge, fitting(scene) + 2);
}

void fill_behind_the_first(HostScene& scene) {
  scene.bench.write(stream_of(scene.bench, 1, fitting(scene)));
}

// ---- octets one by one ----

constexpr kernel::Duration kBetweenOctets = 80 * kernel::kMillisecond;

void write_octet_by_octet(HostScene& scene) {
  for (const std::uint8_t octet : stream_of(scene.bench, 7, 1)) {
    scene.bench.wait(kBetweenOctets);
    scene.bench.write({octet});
  }
  scene.judge.expect(!scene.bench.was_told(), "command_torn", "the command is waited for", "it was given up");
  expect_numbered(scene.bench, scene.judge, 7);
}

// So many reads that nobody answers that they outlast a part of a command after them.
void write_reads_and_a_part(HostScene& scene) {
  auto octets = stream_of(scene.bench, 0, fitting(scene) - 1);
  octets.push_back(99);
  scene.bench.write(octets);
}

void expect_reads_sent_but_not_the_part(HostScene& scene) {
  HostBench& bench = scene.bench;
  bool is_reported = false;
  for (unsigned n = 0; n < fitting(scene) - 1; ++n) {
    const HostFrame poll = expect_request(bench, scene.judge, numbered_read(bench, n));
    for (unsigned attempt = 1; attempt < bench.rules().read_attempts; ++attempt) {
      expect_retry(bench, scene.judge, poll);
    }
    while (const auto told = bench.next_told(2 * bench.time_out())) {
      const auto* error = std::get_if<HostError>(&told->what);
      is_reported |= error != nullptr && *error == HostError{99, HostErrorKind::part_of_command};
      if (error != nullptr && error->kind == HostErrorKind::no_response) break;
    }
  }
  scene.judge.expect(is_reported, "does_not_resync", "error 8 of ID 63: part of a command",
                     "it was not reported");
  expect_room(scene, fitting(scene));
}

void fill(HostScene& scene) {
  scene.bench.write(stream_of(scene.bench, scene.round * fitting(scene), fitting(scene)));
}

// One, two or three octets of the command with the number of the round.
void write_part(HostScene& scene) {
  const auto whole = stream_of(scene.bench, scene.round, 1);
  scene.bench.write(std::span(whole).first(1 + scene.round));
}

void write_rest(HostScene& scene) {
  const auto whole = stream_of(scene.bench, scene.round, 1);
  scene.bench.write(std::span(whole).subspan(1 + scene.round));
  scene.judge.expect(!scene.bench.was_told(), "command_torn", "the command is waited for", "it was given up");
  expect_numbered(scene.bench, scene.judge, scene.round);
}

void write_another(HostScene& scene) {
  scene.judge.expect_equal(scene.bench.fifo_room(), kOctets * fitting(scene), "does_not_resync",
                           "octets that there is room for");
  scene.bench.write(stream_of(scene.bench, 70, 1));
  const HostError given_up{numbered_read(scene.bench, scene.round).id, HostErrorKind::part_of_command};
  const auto error = scene.bench.next_told(kernel::Duration{});
  const auto* seen = error ? std::get_if<HostError>(&error->what) : nullptr;
  scene.judge.expect(seen != nullptr && *seen == given_up, "does_not_resync",
                     "the PC gets the report that part of a command was given up",
                     error ? text_of(*error) : std::string("nothing was reported"));
  expect_numbered(scene.bench, scene.judge, 70);
}

HostStep nothing_sent(std::int64_t milliseconds, std::string reason, std::string why_not) {
  return expected(fmt::format("nothing is sent for {} ms: {}", milliseconds, why_not),
                  [milliseconds, reason = std::move(reason), why_not](HostScene& scene) {
                    expect_no_request(scene.bench, scene.judge, milliseconds * kernel::kMillisecond, reason,
                                      why_not);
                  });
}

}  // namespace

std::vector<HostCase> host_fifo_cases() {
  using namespace host_chart;
  const HostStep fill_up = stimulus("the PC fills the FIFO with 512 octets", fill);
  const HostStep first = {"the PC orders a read", "the host sends it, and awaits its response", read_first};
  const HostStep part = stimulus("the PC writes one, two or three octets of a command", write_part);
  const judge::Reference own = valve_sources::own("512 octets, the oldest are kept");
  const judge::Reference ring = valve_sources::paper("FIFO memory as a circular buffer");
  return {
      {{.id = "valve_bus/host/fifo/burst_keeps_its_order",
        .purpose = "RH-21",
        .requirement = "Commands that the PC writes as fast as there is room are sent in their order, each "
                       "once.",
        .reference = ring,
        .stimulus = "1100 commands (2000 at full volume), as many at a time as fit.",
        .expected = "They are on the line in their order, none lost, none twice.",
        .tags = {"must"},
        .catches = {{"loses_commands", "request_wrong"}, {"doubles_commands", "request_wrong"}}},
       a_burst_keeps_its_order},
      on_chart(
          {.id = "valve_bus/host/fifo/full_fifo_keeps_the_oldest",
           .purpose = "RH-22",
           .requirement = "When the FIFO is full the newest commands are lost, the PC gets a report of "
                          "each, and those in the FIFO are sent.",
           .reference = own,
           .tags = {"must"},
           .catches = {{"overflow_not_told", "overflow_not_told"}, {"overflow_drops_oldest", "error_wrong"}}},
          {{1, 1},
           {first,
            {"the PC writes as many commands as fit, and 100 more",
             "the flag of the overflow goes up with these; there is no room any more", overfill},
            expected("the PC gets an error for each that does not fit", expect_each_lost_reported),
            expected("all that fit are sent in their order, each leaves room; the flag stays up",
                     expect_all_that_fit),
            nothing_sent(20, "lost_command_sent", "the newest were lost")}}),
      on_chart(
          {.id = "valve_bus/host/fifo/lost_command_is_lost_whole",
           .purpose = "RH-22",
           .requirement = "With the first octet of a command its others are lost, also when there "
                          "is room for them: no part of a command is sent, and the next is whole.",
           .reference = own,
           .tags = {"must"},
           .catches = {{"overflow_drops_octets", "rest_of_lost_command_kept"}}},
          {{1, 1},
           {first,
            stimulus("the PC fills the FIFO with 512 octets", fill_behind_the_first),
            {"the PC writes the first octet of a command more", "the PC gets an error: FIFO overflow",
             lose_a_command},
            {"the PC writes its other octets and another command, for which there is room now",
             "the next command has been sent", write_the_rest_and_another},
            nothing_reported(kernel::Duration{}, "rest_of_lost_command_kept",
                             "there is room for the next command"),
            expected("all that fit are sent in their order, and the other command", expect_the_others_sent),
            nothing_sent(150, "part_sent", "nothing whole is left"),
            nothing_reported(kernel::kMillisecond, "part_told", "the command has been reported as lost")}}),
      on_chart({.id = "valve_bus/host/fifo/goes_round",
                .purpose = "RH-23",
                .requirement = "A FIFO that is filled and emptied again and again gives what was "
                               "written.",
                .reference = ring,
                .tags = {"must", "long"},
                .catches = {{"fifo_wraps_one_early", "request_wrong"}}},
               {{3, 1'000},
                {fill_up, expected("all commands are on the line in their order",
                                   [](HostScene& scene) {
                                     expect_numbered(scene.bench, scene.judge, scene.round * fitting(scene),
                                                     fitting(scene));
                                   })}}),
      on_chart(
          {.id = "valve_bus/host/fifo/rest_is_awaited_after_each_octet",
           .purpose = "RH-24",
           .requirement = "A command of which each octet comes within 100 ms of the one before is whole.",
           .reference = valve_sources::own("a command that stays a part is given up"),
           .tags = {"must", "timing"},
           .catches = {{"resyncs_early", "command_torn"}}},
          {{1, 5},
           {{"the PC writes the octets of a command 80 ms apart", "the command is sent",
             write_octet_by_octet}}}),
      on_chart({.id = "valve_bus/host/fifo/part_takes_nothing_with_it",
                .purpose = "RH-24",
                .requirement = "When a part of a command is given up, the commands in front of it stay.",
                .reference = valve_sources::own("a command that stays a part is given up"),
                .tags = {"must", "timing"},
                .catches = {{"part_takes_the_fifo", "no_request"}}},
               {{1, 1},
                {stimulus("the PC writes as many reads as leave room for one, and an octet; no node answers",
                          write_reads_and_a_part),
                 expected("all reads are sent; the PC gets an error: part of a command",
                          expect_reads_sent_but_not_the_part)}}),
      on_chart({.id = "valve_bus/host/fifo/part_of_a_command_is_not_sent",
                .purpose = "RH-24",
                .requirement = "While the rest of a command has not come nothing is sent for it; after "
                               "100 ms it is given up, this is reported to the PC, and what comes then is a "
                               "new command.",
                .reference = valve_sources::own("a command that stays a part is given up"),
                .tags = {"must", "timing"},
                .catches = {{"part_sent", "part_sent"},
                            {"never_resyncs", "does_not_resync"},
                            {"resyncs_early", "command_torn"}}},
               {{3, 3},
                {part,
                 nothing_sent(90, "part_sent", "the rest has not come"),
                 {"the PC writes the rest", "the command is sent whole", write_rest},
                 part,
                 nothing_sent(110, "part_sent", "the rest has not come"),
                 {"the PC writes another command",
                  "the PC has got an error: part of a command; the other one is sent", write_another}}}),
  };
}

}  // namespace fieldproof::conformance
