#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "conformance/valve_bus/node_scene.hpp"

// When a node answers, how long it holds the line, which clocks it understands.
namespace fieldproof::conformance {
namespace {

double microseconds(kernel::Duration duration) {
  return static_cast<double>(duration.count()) * 1e-6;
}

void turn_round_is_within_its_span(NodeBench& bench, CaseJudge& judge) {
  kernel::Duration shortest = kernel::Duration::max();
  kernel::Duration longest{};
  for (int n = 0; n < bench.volume(20, 10'000); ++n) {
    NodeScene scene(bench, judge, 0);
    scene.send(scene.command(bench.rules().read_command));
    const Transmission answer = expect_answer(bench, judge, scene.switches, scene.end);
    const kernel::Duration turnaround_time = answer.characters.front().start - scene.end;
    // Where an instant is not known exactly, what is certain of it.
    const iut::TimingUncertainty doubt = bench.doubt_of(answer);
    shortest = std::min(shortest, turnaround_time + doubt.later);
    longest = std::max(longest, turnaround_time - doubt.earlier);
  }
  judge.measure("shortest turnaround", "us", microseconds(shortest));
  judge.measure("longest turnaround", "us", microseconds(longest));
}

void measure_driver(NodeScene& scene) {
  scene.bench.require(&iut::Capabilities::driver_control);
  const Transmission& answer = scene.answer;
  scene.judge.measure("driver on before the start bit", "us",
                      microseconds(answer.characters.front().start - answer.driver_on));
  scene.judge.measure("driver on after the stop bit", "us",
                      microseconds(answer.driver_off - answer.characters.back().busy_until));
}

void stay_silent(NodeScene& scene) {
  if (scene.bench.rules().answers_writes) {
    node_chart::taken().run(scene);
    scene.bench.clear_observations();
  }
  scene.bench.wait(20 * kernel::kMillisecond);
}

void write_at(NodeScene& scene, double clock) {
  scene.bench.set_clock(clock);
  scene.send(scene.write(~scene.bench.valves(), scene.bench.random_octet()));
  scene.bench.set_clock(1.0);
}

constexpr std::array kUnderstoodClocks{1.0, 1.01, 0.99, 1.02, 0.98};

// What a node makes of five percent is its own affair, as long as it makes nothing wrong of it. Beyond six
// it cannot know: it takes each bit 6 for bit 7, in all octets alike, and the exclusive or still fits.
void expect_nothing_wrong_taken(NodeScene& scene) {
  const std::uint16_t before = scene.bench.valves();
  write_at(scene, scene.round % 2 == 0 ? 1.05 : 0.95);
  const std::uint16_t after = scene.bench.valves();
  scene.judge.expect(after == scene.valves() || after == before, "wrong_data_of_wrong_clock", [&] {
    return Mismatch{{"the valves of the write, or as they were"},
                    fmt::format("{} instead of {}", valves_text(after), valves_text(scene.valves()))};
  });
}

NodeStep write_at_other_rate(std::string text, double clock) {
  return stimulus(std::move(text), [clock](NodeScene& scene) { write_at(scene, clock); });
}

void write_and_read(NodeScene& scene) {
  NodeBench& bench = scene.bench;
  bench.clear_observations();
  const auto write = scene.write(~bench.valves(), bench.random_octet());
  bench.send(write);
  bench.wait_after_write();
  if (bench.rules().answers_writes) bench.clear_observations();
  scene.send_next(scene.command(bench.rules().read_command));
  expect_valves(bench, scene.judge, bench.valves_of(write[2], write[3]), "write_lost");
}

// What follows a read when it is over, and before anybody can be sure of that: of another node, of its own,
// nothing whole.
void send_in_front_of_the_answer(NodeScene& scene) {
  NodeBench& bench = scene.bench;
  bench.clear_observations();
  scene.end = bench.read();
  bench.wait(bench.delimiter() + bench.bits(1) / 4);
  scene.judge.expect(!bench.has_driven(), "answer_too_early", "nobody is sure yet that the read is over",
                     "the node drives the line");
  const auto& rules = bench.rules();
  const auto other = static_cast<unsigned>(bench.address() ^ 1U);
  const std::array frames{scene.command(other, rules.write_command, 0x12, 0x34),
                          scene.command(other, rules.read_command, 0, 0), scene.moving_write(),
                          std::vector<std::uint8_t>{0x55}};
  scene.send_next(frames.at(scene.round % frames.size()));
}

void expect_read_cancelled(NodeScene& scene) {
  constexpr std::string_view kWhyNot = "something was sent before it had answered";
  if (scene.frame.size() > 1 && scene.frame.front() == scene.bench.address()) {
    node_chart::taken().run(scene);
  } else {
    expect_ignored(scene.bench, scene.judge, "answers_into_a_command", kWhyNot);
  }
}

void read_without_a_pause(NodeScene& scene) {
  NodeBench& bench = scene.bench;
  bench.clear_observations();
  scene.end = bench.read();
  // Until the answer is over: no longer than a node may take, checked often.
  const kernel::Time latest =
      scene.end + bench.delimiter() + turnaround_time_span(bench.rules()) + bench.characters(6);
  while (bench.now() < latest) {
    bench.wait(bench.characters(3));
    const auto answers = bench.answers();
    if (!answers.empty() && answers.front().driver_off <= bench.now()) break;
  }
}

void wait_a_delimiter(NodeScene& scene) {
  const kernel::Duration rest =
      scene.answer.characters.back().busy_until + scene.bench.delimiter() - scene.bench.now();
  scene.bench.wait(std::max(kernel::Duration{}, rest) + kernel::kMicrosecond);
}

// The host waits 1 ms longer than a node may take; that is for the way.
void expect_in_time_for_host(NodeScene& scene) {
  const NodeBench& bench = scene.bench;
  const kernel::Duration arrived = scene.answer.characters.front().start + bench.distance() - scene.end;
  scene.judge.expect_between("response as the host receives it", "us", microseconds(arrived),
                             microseconds(bench.delimiter()),
                             microseconds(valve_bus::response_time_out(bench.rules())), "too_late_for_host");
}

}  // namespace

std::vector<NodeCase> node_timing_cases() {
  const judge::Reference own = valve_sources::own("turnaround from 3.5 characters to 2 ms more");
  using namespace node_chart;
  const NodeStep nothing = ignored("acts_on_wrong_bit_rate", "the bit rate is another one");
  return {
      {{.id = "valve_bus/node/timing/turn_round_is_within_its_span",
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
       turn_round_is_within_its_span},
      on_chart({.id = "valve_bus/node/timing/driver_is_on_for_the_answer_only",
                .purpose = "RN-19",
                .requirement = "The driver comes on at least a bit before an answer and is off at most "
                               "two bits after it; else a node does not drive the line.",
                .reference = valve_sources::paper("a node that does not send listens"),
                .tags = {"must", "timing"},
                .catches = {{"driver_not_released", "driver_not_released"},
                            {"driver_on_late", "driver_on_late"},
                            {"drives_now_and_then", "drives_without_being_asked"}}},
               {{5, 100},
                {read(), answered(),
                 expected("its driver is on at least a bit before it and off at most two bits after it",
                          measure_driver),
                 write(), stimulus("20 ms of silence", stay_silent),
                 silent("drives_without_being_asked", "nobody asked it")}}),
      on_chart({.id = "valve_bus/node/timing/other_clocks_are_understood",
                .purpose = "RN-27",
                .requirement = "Characters that are sent up to 2 % faster or slower are understood; of "
                               "clocks 5 % off no wrong data are taken.",
                .reference = valve_sources::own("2 % of tolerance between two clocks"),
                .tags = {"must", "timing"},
                .catches = {{"clock_too_slow", "clock_not_understood"}}},
               {{20, 400},
                {stimulus("a write at 0.98, 0.99, 1, 1.01 or 1.02 times the bit rate",
                          [](NodeScene& scene) {
                            write_at(scene, kUnderstoodClocks.at(scene.round % kUnderstoodClocks.size()));
                          }),
                 valves_stand("clock_not_understood"),
                 {"a write at 0.95 or 1.05 times the bit rate", "it is taken as it was sent, or not",
                  expect_nothing_wrong_taken},
                 serves()}}),
      on_chart({.id = "valve_bus/node/timing/wrong_bit_rates_are_not_understood",
                .purpose = "RN-28",
                .requirement = "A node does nothing on frames at another bit rate than its own.",
                .reference = valve_sources::paper("the bit rate of host and node must be equal"),
                .tags = {"must", "long"},
                .catches = {{"follows_any_rate", "acts_on_wrong_bit_rate"}}},
               {{30, 3'334},
                {write_at_other_rate("a write at twice the bit rate", 2.0), nothing,
                 write_at_other_rate("a write at half the bit rate", 0.5), nothing,
                 write_at_other_rate("a write at six times the bit rate", 6.0), nothing, serves()}}),
      on_chart({.id = "valve_bus/node/timing/read_behind_write_is_served",
                .purpose = "RN-29",
                .requirement = "A command that follows a write by a delimiter is served, and so is the "
                               "write.",
                .reference = valve_sources::own("a delimiter is enough between two commands"),
                .tags = {"must"},
                .catches = {{"deaf_behind_write", "no_answer"}}},
               {{5, 200},
                {{"a write, a delimiter, a read", "the valves stand as the write says", write_and_read},
                 answered()}}),
      on_chart(
          {.id = "valve_bus/node/timing/what_follows_cancels_an_answer",
           .purpose = "RN-43",
           .requirement = "What is sent after a read, before its answer has begun, cancels this answer, and "
                          "no other.",
           .reference = valve_sources::own("a command before a response has begun cancels it"),
           .tags = {"must", "timing"},
           .catches = {{"answer_not_cancelled", "answers_into_a_command"}}},
          {{8, 80},
           {stimulus(
                "3.5 characters after a read a write or a read for another node, a write for this one, an "
                "octet",
                send_in_front_of_the_answer),
            expected("no answer; of its own a write is taken", expect_read_cancelled), read(), answered(),
            serves()}}),
      on_chart({.id = "valve_bus/node/timing/reads_back_to_back_are_all_answered",
                .purpose = "RN-30",
                .requirement = "A node answers reads that follow each other as closely as a host can "
                               "send them, without end.",
                .reference = valve_sources::derived("one host that polls its nodes in turn"),
                .tags = {"must", "long"},
                .catches = {{"falls_silent_after_400_reads", "no_answer"}}},
               {{1'100, 100'000},
                {stimulus("a read, a delimiter after the answer to the last", read_without_a_pause),
                 answered(), stimulus("a delimiter", wait_a_delimiter)}}),
      on_chart({.id = "valve_bus/node/timing/far_node_answers_in_time",
                .purpose = "RN-38",
                .requirement = "After a repeater of 10 us each way a node still answers in time for the "
                               "host.",
                .reference = own,
                .tags = {"must", "timing"},
                .catches = {{"turns_round_3_ms_late", "no_answer"}, {"turns_round_late", "answer_too_late"}}},
               {{5, 200},
                {stimulus("the tester is 10 us away", [](NodeScene&) {}), read(), answered(),
                 expected("it is at the host within the time that it waits", expect_in_time_for_host)}},
               {.distance = 10 * kernel::kMicrosecond}),
  };
}

}  // namespace fieldproof::conformance
