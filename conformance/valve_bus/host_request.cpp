#include <fmt/format.h>

#include "conformance/valve_bus/host_cases.hpp"
#include "conformance/valve_bus/host_expect.hpp"

// What the PC orders and what stands on the line for it.
namespace fieldproof::conformance {
namespace {

using valve_bus::Command;
using valve_bus::HostErrorKind;

constexpr unsigned kWritten = 5;  // nodes that are written to where many would fill the bus with refreshes

Command random_write(HostBench& bench) {
  return {static_cast<std::uint8_t>(1 + bench.random().below(kWritten)),
          static_cast<std::uint8_t>(bench.rules().write_command), bench.random_octet(), bench.random_octet()};
}

void a_write_is_sent_with_its_check(HostBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(10, 1'000); ++n) {
    const Command write = random_write(bench);
    bench.order(write);
    expect_request(bench, judge, write);
  }
}

void each_check_is_the_exclusive_or(HostBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(60, 100'000); ++n) {
    if (bench.random().chance(0.25)) {
      const Command write = random_write(bench);
      bench.order(write);
      expect_request(bench, judge, write);
    } else {
      expect_read_served(bench, judge, bench.random_id());
    }
  }
}

void expect_sent(HostBench& bench, CaseJudge& judge, const Command& command) {
  bench.order(command);
  expect_request(bench, judge, command);
  if (command.command == bench.rules().write_command) return;
  const valve_bus::Response response{bench.random_octet(), bench.random_octet()};
  bench.answer(response);
  expect_response(bench, judge, command.id, response);
}

void expect_refused(HostBench& bench, CaseJudge& judge, const Command& command, HostErrorKind kind,
                    std::string_view sent_reason) {
  bench.order(command);
  // What is refused is refused when its turn comes: after the distance of a write and a refresh.
  expect_no_request(bench, judge, bench.characters(20) + 3 * kernel::kMillisecond, sent_reason,
                    fmt::format("{} is no command", text_of_command(command)));
  expect_error(bench, judge, {command.id, kind});
}

void ids_1_to_99_are_sent(HostBench& bench, CaseJudge& judge) {
  for (unsigned id = 0; id < 256; ++id) {
    for (const unsigned number : {bench.rules().read_command, bench.rules().write_command}) {
      const Command command{static_cast<std::uint8_t>(id), static_cast<std::uint8_t>(number),
                            bench.random_octet(), bench.random_octet()};
      if (id >= bench.rules().first_address && id <= bench.rules().last_address) {
        expect_sent(bench, judge, command);
      } else {
        expect_refused(bench, judge, command, HostErrorKind::refused_id, "refused_id_sent");
      }
    }
  }
}

void undefined_commands_are_refused(HostBench& bench, CaseJudge& judge) {
  for (unsigned number = 2; number < 256; ++number) {
    const Command command{bench.random_id(), static_cast<std::uint8_t>(number), bench.random_octet(),
                          bench.random_octet()};
    expect_refused(bench, judge, command, HostErrorKind::refused_command, "undefined_command_sent");
  }
  expect_host_recovers(bench, judge);
}

}  // namespace

std::vector<HostCase> host_request_cases() {
  std::vector<HostCase> cases;
  cases.push_back({{.id = "valve_bus/host/request/write_is_sent_with_its_check",
                    .purpose = "RH-01",
                    .requirement = "A write of the PC goes out as ID, 0, DATA0, DATA1 and the block check, "
                                   "which the module adds, without gaps.",
                    .reference = valve_sources::paper("frame of the host; check made in the module"),
                    .stimulus = "Writes with random data.",
                    .expected = "Five octets each, at most 1.5 characters apart.",
                    .tags = {"must"},
                    .catches = {{"data_exchanged", "request_wrong"}, {"gap_in_request", "gap_in_frame"}},
                    .not_applicable = for_plain_writes()},
                   a_write_is_sent_with_its_check});
  cases.push_back(
      {{.id = "valve_bus/host/request/check_is_the_exclusive_or",
        .purpose = "RH-05",
        .requirement = "The block check of a request is the exclusive or of its four octets.",
        .reference = valve_sources::paper("block check"),
        .stimulus = "A hundred thousand random reads and writes.",
        .expected = "Each has the right check.",
        .tags = {"must", "long"},
        .catches = {{"request_check_without_id", "check_wrong"}, {"request_check_is_sum", "check_wrong"}},
        .not_applicable = for_plain_writes()},
       each_check_is_the_exclusive_or});
  cases.push_back({{.id = "valve_bus/host/request/ids_1_to_99_are_sent",
                    .purpose = "RH-03",
                    .requirement = "Commands for the IDs 1 to 99 are sent; those for 0 and 100 to 255 are "
                                   "refused, and this is reported to the PC.",
                    .reference = valve_sources::paper("ID 1 to 99"),
                    .details = {{valve_sources::own("refusal is reported as an error"),
                                 {"error_not_told", "error_wrong"}}},
                    .stimulus = "A read and a write for each of the 256 IDs.",
                    .expected = "99 reads and writes on the line, an error for each other.",
                    .tags = {"must"},
                    .catches = {{"sends_id_100", "refused_id_sent"},
                                {"sends_id_0", "refused_id_sent"},
                                {"refuses_id_99", "no_request"},
                                {"refuses_silently", "error_not_told"}},
                    .not_applicable = for_plain_writes()},
                   ids_1_to_99_are_sent});
  cases.push_back({{.id = "valve_bus/host/request/undefined_commands_are_refused",
                    .purpose = "RH-04",
                    .requirement = "Commands 2 to 255 are refused, and this is reported to the PC.",
                    .reference = valve_sources::own("only commands 0 and 1 are defined"),
                    .stimulus = "Each of them once, then a read.",
                    .expected = "Nothing on the line and an error for each; then the read is served.",
                    .tags = {"must"},
                    .catches = {{"sends_any_command", "undefined_command_sent"}}},
                   undefined_commands_are_refused});
  return cases;
}

}  // namespace fieldproof::conformance
