#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "conformance/valve_bus/node_cases.hpp"
#include "conformance/valve_bus/node_expect.hpp"

// When a node answers, how long it holds the line, which clocks it understands.
namespace fieldproof::conformance {
namespace {

double microseconds(kernel::Duration duration) {
  return static_cast<double>(duration.count()) * 1e-6;
}

std::uint16_t set_random_switches(NodeBench& bench) {
  const auto switches = static_cast<std::uint16_t>(bench.random().below(0x10000));
  bench.boards().set_input(0, switches);
  return switches;
}

void turn_round_is_within_its_span(NodeBench& bench, CaseJudge& judge) {
  kernel::Duration shortest = kernel::Duration::max();
  kernel::Duration longest{};
  for (int n = 0; n < bench.volume(20, 10'000); ++n) {
    bench.clear_observations();
    const std::uint16_t switches = set_random_switches(bench);
    const kernel::Time end = bench.read();
    bench.await_response_window();
    const Transmission answer = expect_answer(bench, judge, switches, end);
    const kernel::Duration turnaround_time = answer.characters.front().start - end;
    // Where an instant is not known exactly, what is certain of it.
    const iut::TimingUncertainty doubt = bench.doubt_of(answer);
    shortest = std::min(shortest, turnaround_time + doubt.later);
    longest = std::max(longest, turnaround_time - doubt.earlier);
  }
  judge.measure("shortest turnaround", "us", microseconds(shortest));
  judge.measure("longest turnaround", "us", microseconds(longest));
}

void driver_is_on_for_the_answer_only(NodeBench& bench, CaseJudge& judge) {
  bench.require(&iut::Capabilities::driver_control);
  for (int n = 0; n < bench.volume(5, 100); ++n) {
    bench.clear_observations();
    const std::uint16_t switches = set_random_switches(bench);
    const kernel::Time end = bench.read();
    bench.await_response_window();
    const Transmission answer = expect_answer(bench, judge, switches, end);
    judge.measure("driver on before the start bit", "us",
                  microseconds(answer.characters.front().start - answer.driver_on));
    judge.measure("driver on after the stop bit", "us",
                  microseconds(answer.driver_off - answer.characters.back().busy_until));
    bench.clear_observations();
    const auto data0 = bench.random_octet();
    const auto data1 = bench.random_octet();
    const kernel::Time written = bench.write(data0, data1);
    if (bench.rules().answers_writes) {
      bench.await_response_window();
      expect_write_taken(bench, judge, data0, data1, written);
      bench.clear_observations();
    }
    bench.await_response_window();
    bench.wait(20 * kernel::kMillisecond);
    expect_silence(bench, judge, "drives_without_being_asked", "nobody asked it");
  }
}

void other_clocks_are_understood(NodeBench& bench, CaseJudge& judge) {
  for (const double clock : {1.0, 1.01, 0.99, 1.02, 0.98}) {
    bench.set_clock(clock);
    for (int n = 0; n < bench.volume(4, 50); ++n) {
      bench.clear_observations();
      const auto data0 = static_cast<std::uint8_t>(~bench.valves());
      const auto data1 = bench.random_octet();
      bench.write(data0, data1);
      bench.await_response_window();
      judge.expect(bench.valves() == bench.valves_of(data0, data1), "clock_not_understood", [&] {
        return Mismatch{{fmt::format("a write at {:.2f} times the bit rate is taken", clock)},
                        fmt::format("valves {:04X}h", bench.valves())};
      });
    }
  }
  // What a node makes of five percent is its own affair, as long as it makes nothing wrong of it. Beyond six
  // it cannot know: it takes each bit 6 for bit 7, in all octets alike, and the exclusive or still fits.
  for (const double clock : {1.05, 0.95}) {
    for (int n = 0; n < bench.volume(8, 200); ++n) {
      bench.set_clock(clock);
      bench.clear_observations();
      const std::uint16_t before = bench.valves();
      const auto data0 = bench.random_octet();
      const auto data1 = bench.random_octet();
      bench.write(data0, data1);
      bench.await_response_window();
      const std::uint16_t wanted = bench.valves_of(data0, data1);
      judge.expect(bench.valves() == wanted || bench.valves() == before, "wrong_data_of_wrong_clock", [&] {
        return Mismatch{
            {fmt::format("at {:.2f} times the bit rate: the valves of the write, or none", clock)},
            fmt::format("valves {:04X}h instead of {:04X}h", bench.valves(), wanted)};
      });
    }
  }
  bench.set_clock(1.0);
  expect_serves(bench, judge);
}

void wrong_bit_rates_are_not_understood(NodeBench& bench, CaseJudge& judge) {
  for (const double clock : {2.0, 0.5, 6.0}) {
    for (int n = 0; n < bench.volume(30, 3'334); ++n) {
      bench.set_clock(clock);
      bench.clear_observations();
      const std::uint16_t valves = bench.valves();
      bench.write(static_cast<std::uint8_t>(~valves), bench.random_octet());
      bench.wait(bench.characters(12) + bench.delimiter() + kernel::kMillisecond);
      expect_ignored(bench, judge, "acts_on_wrong_bit_rate",
                     fmt::format("the frame was sent at {} times the bit rate", clock));
    }
  }
  bench.set_clock(1.0);
  expect_serves(bench, judge);
}

void a_read_right_behind_a_write_is_served(NodeBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(5, 200); ++n) {
    bench.clear_observations();
    const auto data0 = static_cast<std::uint8_t>(~bench.valves());
    const auto data1 = bench.random_octet();
    const std::uint16_t switches = set_random_switches(bench);
    bench.write(data0, data1);
    bench.wait(bench.delimiter() + kernel::kMicrosecond);
    const kernel::Time end = bench.read();
    bench.await_response_window();
    expect_valves(bench, judge, bench.valves_of(data0, data1), "write_lost");
    expect_answer(bench, judge, switches, end);
  }
}

void reads_back_to_back_are_all_answered(NodeBench& bench, CaseJudge& judge) {
  const std::uint16_t switches = set_random_switches(bench);
  for (int n = 0; n < bench.volume(450, 100'000); ++n) {
    bench.clear_observations();
    const kernel::Time end = bench.read();
    // Until the answer is over: no longer than a node may take, checked often.
    const kernel::Time latest =
        end + bench.delimiter() + turnaround_time_span(bench.rules()) + bench.characters(6);
    while (bench.now() < latest) {
      bench.wait(bench.characters(3));
      const auto answers = bench.answers();
      if (!answers.empty() && answers.front().driver_off <= bench.now()) break;
    }
    const Transmission answer = expect_answer(bench, judge, switches, end);
    bench.wait(
        std::max(kernel::Duration{}, answer.characters.back().busy_until + bench.delimiter() - bench.now()) +
        kernel::kMicrosecond);
  }
}

void far_nodes_answer_in_time(NodeBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(5, 200); ++n) {
    bench.clear_observations();
    const std::uint16_t switches = set_random_switches(bench);
    const kernel::Time end = bench.read();
    bench.await_response_window();
    const Transmission answer = expect_answer(bench, judge, switches, end);
    // The host waits 1 ms longer than a node may take; that is for the way.
    const kernel::Duration heard = answer.characters.front().start + bench.distance() - end;
    judge.expect_between("response as the host receives it", "us", microseconds(heard),
                         microseconds(bench.delimiter()),
                         microseconds(valve_bus::response_time_out(bench.rules())), "too_late_for_host");
  }
}

}  // namespace

std::vector<NodeCase> node_timing_cases() {
  const judge::Reference own = valve_sources::own("turnaround from 3.5 characters to 2 ms more");
  std::vector<NodeCase> cases;
  cases.push_back({{.id = "valve_bus/node/timing/turn_round_is_within_its_span",
                    .purpose = "RN-18",
                    .requirement = "An answer begins 3.5 characters after the command at the earliest, when "
                                   "the host has let go of the line, and at most 2 ms later.",
                    .reference = own,
                    .stimulus = "Ten thousand reads.",
                    .expected = "Each answer begins within the span.",
                    .tags = {"must", "timing", "long"},
                    .catches = {{"answers_at_once", "answer_too_early"},
                                {"turns_round_a_tenth_early", "answer_too_early"},
                                {"turns_round_a_tenth_late", "answer_too_late"},
                                {"turns_round_late", "answer_too_late"},
                                {"turn_round_drifts", "answer_too_late"}}},
                   turn_round_is_within_its_span});
  cases.push_back({{.id = "valve_bus/node/timing/driver_is_on_for_the_answer_only",
                    .purpose = "RN-19",
                    .requirement = "The driver comes on at least a bit before an answer and is off at most "
                                   "two bits after it; else a node does not drive the line.",
                    .reference = valve_sources::paper("a node that does not send listens"),
                    .stimulus = "Reads and writes.",
                    .expected = "The driver is on around the answers, and at no other time.",
                    .tags = {"must", "timing"},
                    .catches = {{"driver_not_released", "driver_not_released"},
                                {"driver_on_late", "driver_on_late"},
                                {"drives_now_and_then", "drives_without_being_asked"}}},
                   driver_is_on_for_the_answer_only});
  cases.push_back({{.id = "valve_bus/node/timing/other_clocks_are_understood",
                    .purpose = "RN-27",
                    .requirement = "Characters that are sent up to 2 % faster or slower are understood; of "
                                   "clocks 5 % off no wrong data are taken.",
                    .reference = valve_sources::own("2 % of tolerance between two clocks"),
                    .stimulus = "Writes at 0.98 to 1.02 times the bit rate, then at 0.95 and 1.05.",
                    .expected = "The former are taken; of the latter each is taken as it was sent or not.",
                    .tags = {"must", "timing"},
                    .catches = {{"clock_too_slow", "clock_not_understood"}}},
                   other_clocks_are_understood});
  cases.push_back({{.id = "valve_bus/node/timing/wrong_bit_rates_are_not_understood",
                    .purpose = "RN-28",
                    .requirement = "A node does nothing on frames at another bit rate than its own.",
                    .reference = valve_sources::paper("the bit rate of host and node must be equal"),
                    .stimulus = "Ten thousand writes at twice, half and six times the bit rate.",
                    .expected = "No valve moves and no answer; then the node serves.",
                    .tags = {"must", "long"},
                    .catches = {{"follows_any_rate", "acts_on_wrong_bit_rate"}}},
                   wrong_bit_rates_are_not_understood});
  cases.push_back({{.id = "valve_bus/node/timing/read_behind_write_is_served",
                    .purpose = "RN-29",
                    .requirement = "A command that follows a write by a delimiter is served, and so is the "
                                   "write.",
                    .reference = valve_sources::own("a delimiter is enough between two commands"),
                    .stimulus = "A write, a delimiter, a read.",
                    .expected = "The valves move and the read is answered.",
                    .tags = {"must"},
                    .catches = {{"deaf_behind_write", "no_answer"}}},
                   a_read_right_behind_a_write_is_served});
  cases.push_back({{.id = "valve_bus/node/timing/reads_back_to_back_are_all_answered",
                    .purpose = "RN-30",
                    .requirement = "A node answers reads that follow each other as closely as a host can "
                                   "send them, without end.",
                    .reference = valve_sources::derived("one host that polls its nodes in turn"),
                    .stimulus = "A hundred thousand reads, each a delimiter after the answer to the last.",
                    .expected = "Each is answered.",
                    .tags = {"must", "long"},
                    .catches = {{"falls_silent_after_400_reads", "no_answer"}}},
                   reads_back_to_back_are_all_answered});
  cases.push_back(
      {{.id = "valve_bus/node/timing/far_node_answers_in_time",
        .purpose = "RN-38",
        .requirement = "After a repeater of 10 us each way a node still answers in time for the "
                       "host.",
        .reference = own,
        .stimulus = "Reads from 10 us away.",
        .expected = "The host receives the answer within the time that it waits.",
        .tags = {"must", "timing"},
        .catches = {{"turns_round_3_ms_late", "no_answer"}, {"turns_round_late", "answer_too_late"}}},
       far_nodes_answer_in_time,
       {.distance = 10 * kernel::kMicrosecond}});
  return cases;
}

}  // namespace fieldproof::conformance
