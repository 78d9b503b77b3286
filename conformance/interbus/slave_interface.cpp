#include <fmt/format.h>

#include <array>

#include "conformance/interbus/slave_cases.hpp"
#include "conformance/interbus/slave_expect.hpp"

// IS-30 to IS-33 and IS-36: the outgoing interfaces and the control word.
namespace fieldproof::conformance {
namespace {

// One of the two outgoing interfaces, and how it is switched.
struct Interface {
  bool is_branch;
  std::string_view name;
  std::uint16_t on;  // control word: this one on, the other off
  LineView& line;
};

Interface interface_of(SlaveBench& bench, bool is_branch) {
  const interbus::Rules& r = bench.rules();
  return {is_branch, is_branch ? "OUT2" : "OUT1", is_branch ? r.control_remote_off : r.control_local_off,
          is_branch ? bench.branch() : bench.remote()};
}

// ID cycles with or without the neighbour in the ring. Its own interfaces stay off.
void id_cycle_with_neighbour(SlaveBench& bench, std::uint16_t control) {
  const std::array<std::uint16_t, 1> off = {bench.interfaces_off()};
  bench.id_cycle(control, off);
}

// Words for the neighbour's register.
std::vector<std::uint16_t> neighbour_words(SlaveBench& bench, bool is_branch) {
  return std::vector<std::uint16_t>(bench.neighbour_words(is_branch), 0x7E57);
}

// Everything of the last train went out on the interface and came back.
void expect_neighbour_in_ring(SlaveBench& bench, CaseJudge& judge, const Interface& interface,
                              std::string_view reason) {
  const std::size_t arrived = bench.in().data_telegrams().size();
  const std::size_t went = interface.line.data_telegrams().size();
  const std::size_t returned = bench.out().data_telegrams().size();
  judge.expect(went == arrived && returned == arrived, reason, [&] {
    return Mismatch{
        .expected = {fmt::format("{} telegrams go out on {} and come back", arrived, interface.name)},
        .actual = fmt::format("{} went out on {}, {} came back", went, interface.name, returned)};
  });
}

// Nothing of the last train went out on the interface, and the ring is closed in this slave.
void expect_closed_here(SlaveBench& bench, CaseJudge& judge, const Interface& interface,
                        std::string_view reason) {
  judge.expect(interface.line.waves().empty(), reason, [&] {
    return Mismatch{
        .expected = {fmt::format("nothing leaves on {}", interface.name)},
        .actual = fmt::format("{} telegrams left on {}", interface.line.telegrams().size(), interface.name),
        .time = interface.line.waves().front().start};
  });
  const std::size_t arrived = bench.in().data_telegrams().size();
  const std::size_t returned = bench.out().data_telegrams().size();
  judge.expect(arrived == returned, reason, [&] {
    return Mismatch{.expected = {fmt::format("all {} telegrams return from the slave itself", arrived)},
                    .actual = fmt::format("{} returned", returned)};
  });
}

// With one interface on, the neighbour's register leaves in front of the slave's own.
void expect_register_of_neighbour(SlaveBench& bench, CaseJudge& judge, const Interface& interface) {
  std::vector<std::uint16_t> words = bench.random_words();
  const std::vector<std::uint8_t> load = bench.data_load();
  const std::vector<std::uint16_t> behind = neighbour_words(bench, interface.is_branch);
  bench.data_cycle(words, behind);
  expect_neighbour_in_ring(bench, judge, interface, "interface_not_opened");
  expect_outputs(bench, judge, words, "valid_cycle_rejected");
  if (!bench.pics().supports("inputs")) return;
  // The slave's own register leaves after that of the neighbour.
  const CycleOnLine out = cycle_that_left(bench, judge, 0);
  for (std::size_t n = 0; n < load.size(); ++n) {
    judge.expect(out.telegrams[2 * behind.size() + n].data == load[n], "register_content_wrong", [&] {
      return Mismatch{.expected = {fmt::format("{:02X}h, input octet {} of the slave", load[n], n)},
                      .actual = fmt::format("{:02X}h", out.telegrams[2 * behind.size() + n].data)};
    });
  }
}

void switch_on(SlaveBench& bench, CaseJudge& judge, const Interface& interface) {
  bench.id_cycle(interface.on);
  // The cycle that carries the order still runs on the old way to its end.
  expect_closed_here(bench, judge, interface, "interface_switched_inside_cycle");
  id_cycle_with_neighbour(bench, interface.on);
  expect_neighbour_in_ring(bench, judge, interface, "interface_not_opened");
}

void interface_follows_its_control_bit(SlaveBench& bench, CaseJudge& judge, bool is_branch) {
  bench.bring_up();
  const Interface interface = interface_of(bench, is_branch);
  for (unsigned round = 0; round < bench.volume(2U, 10U); ++round) {
    bench.data_cycle(bench.random_words());
    expect_closed_here(bench, judge, interface, "interface_not_closed");
    switch_on(bench, judge, interface);
    bench.set_inputs(bench.random_words());
    expect_register_of_neighbour(bench, judge, interface);
    id_cycle_with_neighbour(bench, bench.interfaces_off());
    expect_neighbour_in_ring(bench, judge, interface, "interface_switched_inside_cycle");
    bench.data_cycle(bench.random_words());
    expect_closed_here(bench, judge, interface, "interface_not_closed");
    expect_answer(bench, judge, 0, bench.data_load());
    bench.terminals().forget_changes();
  }
}

void remote_interface(SlaveBench& bench, CaseJudge& judge) {
  interface_follows_its_control_bit(bench, judge, false);
}
void branch_interface(SlaveBench& bench, CaseJudge& judge) {
  interface_follows_its_control_bit(bench, judge, true);
}

void reserved_bits_are_ignored(SlaveBench& bench, CaseJudge& judge) {
  bench.bring_up();
  const Interface interface = interface_of(bench, false);
  switch_on(bench, judge, interface);
  const interbus::Rules& r = bench.rules();
  const auto known = static_cast<std::uint16_t>(r.control_remote_off | r.control_local_off | r.control_reset |
                                                r.control_acknowledge);
  for (unsigned bit = 0; bit <= 16; ++bit) {
    // Each alone, and all together.
    const auto reserved = static_cast<std::uint16_t>((bit < 16 ? 1U << bit : 0xFFFFU) & ~unsigned{known});
    if (reserved == 0) continue;
    const std::vector<std::uint16_t> words = bench.random_words();
    id_cycle_with_neighbour(bench, interface.on | reserved);
    bench.data_cycle(words, neighbour_words(bench, false));
    expect_neighbour_in_ring(bench, judge, interface, "reserved_control_bit_obeyed");
    expect_outputs(bench, judge, words, "reserved_control_bit_obeyed");
    // The bits with a meaning count beside it.
    const std::string_view ignored = "control_word_with_reserved_bit_ignored";
    id_cycle_with_neighbour(bench, bench.interfaces_off() | reserved);
    bench.data_cycle(bench.random_words());
    expect_closed_here(bench, judge, interface, ignored);
    bench.id_cycle(interface.on | reserved);
    bench.data_cycle(bench.random_words(), neighbour_words(bench, false));
    expect_neighbour_in_ring(bench, judge, interface, ignored);
  }
}

// ---- reset of the outgoing bus ----

void outgoing_bus_is_reset(SlaveBench& bench, CaseJudge& judge) {
  bench.bring_up();
  const Interface interface = interface_of(bench, false);
  switch_on(bench, judge, interface);
  const std::vector<std::uint16_t> words = bench.random_words();
  bench.data_cycle(words, neighbour_words(bench, false));
  expect_outputs(bench, judge, words, "valid_cycle_rejected");
  id_cycle_with_neighbour(bench, static_cast<std::uint16_t>(interface.on | bench.rules().control_reset));
  const kernel::Time silent_from = interface.line.telegrams().empty()
                                       ? bench.now()
                                       : interface.line.end_of(interface.line.telegrams().back());
  // The interface is asked for all the time.
  while (bench.now() + bench.bits(600) < silent_from + bench.rules().silence_limit) {
    bench.status_telegrams(40);
    judge.expect(interface.line.waves().empty(), "downstream_not_silent", [&] {
      return Mismatch{.expected = {fmt::format("nothing leaves on OUT1 for {}",
                                               kernel::describe(bench.rules().silence_limit))},
                      .actual = "status telegrams left",
                      .time = interface.line.waves().front().start};
    });
    bench.id_cycle(interface.on);
    expect_closed_here(bench, judge, interface, "downstream_not_silent");
  }
  const bool holds = bench.pics().text("outputs_while_outgoing_bus_is_reset", "held") == "held";
  expect_outputs(bench, judge, holds ? words : std::vector<std::uint16_t>(bench.words()),
                 "outputs_not_as_declared");
  // The loop ended up to 4 ms before the limit; stations may take a millisecond more.
  bench.silence(8 * kernel::kMillisecond);
  bench.id_cycle(interface.on);
  id_cycle_with_neighbour(bench, interface.on);
  expect_neighbour_in_ring(bench, judge, interface, "interface_not_opened");
}

// ---- the bridge in the plug ----

void bridge_counts_in_id_cycles_only(SlaveBench& bench, CaseJudge& judge) {
  bench.bring_up();
  const Interface interface = interface_of(bench, false);
  const std::string_view reason = "ring_changed_without_id_cycle";
  switch_on(bench, judge, interface);
  for (unsigned round = 0; round < bench.volume(2U, 10U); ++round) {
    bench.set_bridge(false, false);
    bench.data_cycle(bench.random_words(), neighbour_words(bench, false));
    expect_neighbour_in_ring(bench, judge, interface, reason);
    id_cycle_with_neighbour(bench, interface.on);
    expect_neighbour_in_ring(bench, judge, interface, reason);
    bench.data_cycle(bench.random_words());
    expect_closed_here(bench, judge, interface, "bridge_not_followed");
    bench.set_bridge(false, true);
    bench.data_cycle(bench.random_words());
    expect_closed_here(bench, judge, interface, reason);
    bench.id_cycle(interface.on);
    expect_closed_here(bench, judge, interface, reason);
    bench.data_cycle(bench.random_words(), neighbour_words(bench, false));
    expect_neighbour_in_ring(bench, judge, interface, "bridge_not_followed");
  }
}

}  // namespace

std::vector<SlaveCase> slave_interface_cases() {
  const SlaveNeeds remote{.id_code = {}, .remote_neighbour = true, .branch_neighbour = false};
  const SlaveNeeds branch{.id_code = {}, .remote_neighbour = false, .branch_neighbour = true};
  std::vector<SlaveCase> cases;
  cases.push_back(
      {{.id = "interbus/slave/interfaces/remote_interface_follows_its_control_bit",
        .purpose = "IS-30",
        .requirement =
            "The control word of an ID cycle switches the outgoing remote bus (OUT1) at the end of that "
            "cycle. Off, the ring is closed in this slave and has its registers only; on, the station "
            "behind it is in the ring.",
        .reference = sources::from_memory("outgoing remote bus on and off; the coding is this project's"),
        .details = details::answer(),
        .stimulus =
            "ID cycles with OUT1 off, on and off again, data cycles between them; a station of one word is "
            "after OUT1.",
        .expected =
            "Telegrams leave on OUT1 only from the cycle after the one that ordered it, until the end of "
            "the one that ended it; the ring is longer by the neighbour's register in between.",
        .tags = {"must"},
        .catches = {{"remote_interface_stays_open", "interface_not_closed"},
                    {"interface_switches_inside_cycle", "interface_switched_inside_cycle"}},
        .not_applicable = for_remote()},
       remote_interface,
       remote});
  cases.push_back(
      {{.id = "interbus/slave/interfaces/branch_interface_follows_its_control_bit",
        .purpose = "IS-31",
        .requirement =
            "The control word of an ID cycle switches the second outgoing interface (OUT2) at the end of "
            "that cycle: the stations after it are added to the ring or removed.",
        .reference = sources::from_memory("local bus on and off; the coding is this project's"),
        .details = details::answer(),
        .stimulus =
            "ID cycles with OUT2 off, on and off again, data cycles between them; a station of one word is "
            "after OUT2.",
        .expected =
            "Telegrams leave on OUT2 only from the cycle after the one that ordered it, until the end of "
            "the one that ended it; the ring is longer by the neighbour's register in between.",
        .tags = {"must"},
        .catches = {{"branch_interface_stays_open", "interface_not_closed"},
                    {"interface_switches_inside_cycle", "interface_switched_inside_cycle"}},
        .not_applicable = for_item("has_branch", "the slave has no second outgoing interface (OUT2)")},
       branch_interface,
       branch});
  cases.push_back(
      {{.id = "interbus/slave/interfaces/reserved_control_bits_are_ignored",
        .purpose = "IS-32",
        .requirement = "Bits of the control word without a meaning are ignored, and only these.",
        .reference = sources::own("the control word's coding; reserved bits are 0"),
        .stimulus = "ID cycles with each reserved bit of the control word set alone and all of them set, "
                    "OUT1 on, off "
                    "and on again; a data cycle after each.",
        .expected = "OUT1 stays on, is off, is on again, and the data cycles are taken over.",
        .tags = {"must"},
        .catches = {{"reserved_control_bit_closes_remote", "reserved_control_bit_obeyed"},
                    {"ignores_words_with_reserved_bits", "control_word_with_reserved_bit_ignored"}},
        .not_applicable = for_remote()},
       reserved_bits_are_ignored,
       remote});
  cases.push_back(
      {{.id = "interbus/slave/interfaces/reset_bit_silences_the_outgoing_bus",
        .purpose = "IS-33",
        .requirement =
            "The reset bit of the control word makes the outgoing bus silent for at least 25 ms, so that "
            "every station after the slave resets. The slave's own outputs do what it declares.",
        .reference = sources::from_memory("reset of the outgoing bus; the coding is this project's"),
        .stimulus =
            "An ID cycle with the reset bit; for 25 ms status telegrams and ID cycles that ask for OUT1; "
            "then ID cycles again.",
        .expected = "Nothing leaves on OUT1 for 25 ms; outputs as declared; afterwards OUT1 opens again.",
        .tags = {"must", "timing"},
        .catches = {{"ignores_outgoing_reset", "downstream_not_silent"},
                    {"outgoing_reset_clears_outputs", "outputs_not_as_declared"}},
        .not_applicable = for_remote()},
       outgoing_bus_is_reset,
       remote});
  cases.push_back(
      {{.id = "interbus/slave/interfaces/bridge_counts_in_id_cycles_only",
        .purpose = "IS-36",
        .requirement =
            "The bridge in the outgoing plug tells that a next device is there. Opened or closed while "
            "data cycles run, it changes the ring only at the end of the next ID cycle.",
        .reference = sources::from_memory("meaning of the bridge between pins 5 and 9"),
        .stimulus =
            "The bridge at OUT1 is opened, then closed, while data cycles run; an ID cycle after each.",
        .expected =
            "The data cycle after the change runs on the old way; the one after the ID cycle on the new "
            "one.",
        .tags = {"must"},
        .catches = {{"switches_with_the_bridge", "ring_changed_without_id_cycle"},
                    {"ignores_the_bridge", "bridge_not_followed"}},
        .not_applicable = for_remote()},
       bridge_counts_in_id_cycles_only,
       remote});
  return cases;
}

}  // namespace fieldproof::conformance
