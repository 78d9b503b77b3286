#include <fmt/format.h>

#include <array>

#include "conformance/interbus/slave_scene.hpp"

// IS-30 to IS-33 and IS-36: the outgoing interfaces and the control word.
namespace fieldproof::conformance {
namespace {

using namespace slave_chart;

// One of the two outgoing interfaces, after which a station of one word is.
struct Outgoing {
  bool is_branch;
  std::string_view name;
  RuleBits on;  // control word: this one on, the other off
  LineView& (SlaveBench::*line)();
};

constexpr Outgoing kOut1{false, "OUT1", &interbus::Rules::control_local_off, &SlaveBench::remote};
constexpr Outgoing kOut2{true, "OUT2", &interbus::Rules::control_remote_off, &SlaveBench::branch};

// A cycle that a step sends; `is_longer`: with the words of the station in the ring.
struct Sent {
  std::string text;
  std::function<void(SlaveScene&, bool is_longer, bool is_branch)> send;
};

Sent data() {
  return {"a data cycle", [](SlaveScene& scene, bool is_longer, bool is_branch) {
            SlaveBench& bench = scene.bench;
            bench.set_inputs(bench.random_words());
            scene.words = bench.random_words();
            bench.data_cycle(scene.words, std::vector<std::uint16_t>(
                                              is_longer ? bench.neighbour_words(is_branch) : 0, 0x7E57));
          }};
}

using Control = std::function<std::uint16_t(const SlaveScene&)>;

Control on(const Outgoing& out) {
  return [bits = out.on](const SlaveScene& scene) { return scene.bench.rules().*bits; };
}
std::uint16_t off(const SlaveScene& scene) {
  return scene.bench.interfaces_off();
}

// The interfaces of the station stay off.
Sent id(const std::string& that, Control control) {
  return {"an ID cycle " + that, [control = std::move(control)](SlaveScene& scene, bool is_longer, bool) {
            const std::array<std::uint16_t, 1> station = {scene.bench.interfaces_off()};
            scene.bench.id_cycle(control(scene), std::span(station).first(is_longer ? 1 : 0));
          }};
}

void expect_through(SlaveScene& scene, const Outgoing& out, std::string_view reason) {
  const std::size_t arrived = scene.bench.in().data_telegrams().size();
  const std::size_t went = (scene.bench.*out.line)().data_telegrams().size();
  const std::size_t returned = scene.bench.out().data_telegrams().size();
  scene.judge.expect(went == arrived && returned == arrived, reason,
                     fmt::format("{} telegrams go out on {} and come back", arrived, out.name),
                     fmt::format("{} went out on {}, {} came back", went, out.name, returned));
}

void expect_closed(SlaveScene& scene, const Outgoing& out, std::string_view reason) {
  LineView& line = (scene.bench.*out.line)();
  scene.judge.expect(line.waves().empty(), reason, [&] {
    return Mismatch{.expected = {fmt::format("nothing leaves on {}", out.name)},
                    .actual = fmt::format("{} telegrams left on {}", line.telegrams().size(), out.name),
                    .time = line.waves().front().start};
  });
  const std::size_t arrived = scene.bench.in().data_telegrams().size();
  const std::size_t returned = scene.bench.out().data_telegrams().size();
  scene.judge.expect(arrived == returned, reason,
                     fmt::format("all {} telegrams return from the slave itself", arrived),
                     fmt::format("{} returned", returned));
}

// The whole cycle goes out and comes back; or nothing goes out, and the ring is closed in this slave.
SlaveStep through(const Outgoing& out, Sent cycle, std::string reason) {
  return {std::move(cycle.text), fmt::format("it goes out on {} and comes back", out.name),
          [out, send = std::move(cycle.send), reason = std::move(reason)](SlaveScene& scene) {
            send(scene, true, out.is_branch);
            expect_through(scene, out, reason);
          }};
}
SlaveStep closed(const Outgoing& out, Sent cycle, std::string reason) {
  return {std::move(cycle.text),
          fmt::format("nothing leaves on {}, it returns from the slave itself", out.name),
          [out, send = std::move(cycle.send), reason = std::move(reason)](SlaveScene& scene) {
            send(scene, false, out.is_branch);
            expect_closed(scene, out, reason);
          }};
}
// Judged by what comes after it.
SlaveStep sent(Sent cycle, bool is_longer) {
  return stimulus<SlaveScene>(
      std::move(cycle.text),
      [send = std::move(cycle.send), is_longer](SlaveScene& scene) { send(scene, is_longer, false); });
}

// The cycle that carries the order still runs on the old way to its end.
SlaveStep ordered_on(const Outgoing& out) {
  return closed(out, id(fmt::format("that switches {} on", out.name), on(out)),
                "interface_switched_inside_cycle");
}
SlaveStep left_on(const Outgoing& out) {
  return through(out, id("that leaves it on", on(out)), "interface_not_opened");
}

SlaveStep register_after_that_of_the_station(bool is_branch) {
  return expected<SlaveScene>(
      "the slave's own register leaves after that of the station", [is_branch](SlaveScene& scene) {
        SlaveBench& bench = scene.bench;
        if (!bench.pics().supports("inputs")) return;
        const std::vector<std::uint8_t> load = bench.data_load();
        const CycleOnLine out = cycle_that_left(bench, scene.judge, 0);
        for (std::size_t n = 0; n < load.size(); ++n) {
          const std::uint8_t seen = out.telegrams[2 * bench.neighbour_words(is_branch) + n].data;
          scene.judge.expect(seen == load[n], "register_content_wrong",
                             fmt::format("{:02X}h, input octet {} of the slave", load[n], n),
                             fmt::format("{:02X}h", seen));
        }
      });
}

SlaveChart control_bit_chart(const Outgoing& out) {
  return {.rounds = {2, 10},
          .steps = {closed(out, data(), "interface_not_closed"), ordered_on(out), left_on(out),
                    through(out, data(), "interface_not_opened"), shown(),
                    register_after_that_of_the_station(out.is_branch),
                    through(out, id("that switches it off", off), "interface_switched_inside_cycle"),
                    closed(out, data(), "interface_not_closed"), answered()},
          .first = {identified(fmt::format("the slave, and after {} is a station of one word", out.name))}};
}

// Each bit without a meaning alone, and all together.
std::vector<std::uint16_t> reserved_bits(const interbus::Rules& r) {
  const unsigned known =
      unsigned{r.control_remote_off} | r.control_local_off | r.control_reset | r.control_acknowledge;
  std::vector<std::uint16_t> all;
  for (unsigned bit = 0; bit <= 16; ++bit) {
    const auto reserved = static_cast<std::uint16_t>((bit < 16 ? 1U << bit : 0xFFFFU) & ~known);
    if (reserved != 0) all.push_back(reserved);
  }
  return all;
}

Control with_reserved(Control control) {
  return [control = std::move(control)](const SlaveScene& scene) {
    const auto all = reserved_bits(scene.bench.rules());
    return static_cast<std::uint16_t>(control(scene) | all[scene.round % all.size()]);
  };
}

SlaveChart reserved_bits_chart() {
  const std::string obeyed = "reserved_control_bit_obeyed";
  const std::string ignored = "control_word_with_reserved_bit_ignored";
  return {
      .steps = {sent(id("with it and OUT1 on", with_reserved(on(kOut1))), true),
                through(kOut1, data(), obeyed), shown(obeyed),
                sent(id("with it and OUT1 off", with_reserved(off)), true), closed(kOut1, data(), ignored),
                sent(id("with it and OUT1 on", with_reserved(on(kOut1))), false),
                through(kOut1, data(), ignored)},
      .first = {identified(), ordered_on(kOut1), left_on(kOut1)},
      .walk = {"each reserved bit of the control word and all of them",
               [](SlaveScene& scene) { return reserved_bits(scene.bench.rules()).size(); }}};
}

void silent_for_the_limit(SlaveScene& scene) {
  SlaveBench& bench = scene.bench;
  LineView& out1 = bench.remote();
  const kernel::Time from = out1.telegrams().empty() ? bench.now() : out1.end_of(out1.telegrams().back());
  while (bench.now() + bench.bits(600) < from + bench.rules().silence_limit) {
    bench.status_telegrams(40);
    scene.judge.expect(out1.waves().empty(), "downstream_not_silent", [&] {
      return Mismatch{.expected = {fmt::format("nothing leaves on OUT1 for {}",
                                               kernel::describe(bench.rules().silence_limit))},
                      .actual = "status telegrams left",
                      .time = out1.waves().front().start};
    });
    bench.id_cycle(bench.rules().*kOut1.on);
    expect_closed(scene, kOut1, "downstream_not_silent");
  }
}

SlaveChart reset_chart() {
  const Control reset = [](const SlaveScene& scene) {
    return static_cast<std::uint16_t>(scene.bench.rules().*kOut1.on | scene.bench.rules().control_reset);
  };
  const auto outputs_as_declared = expected<SlaveScene>("the outputs are as declared", [](SlaveScene& scene) {
    if (scene.bench.pics().text("outputs_while_outgoing_bus_is_reset", "held") != "held")
      scene.words.assign(scene.bench.words(), 0);
    expect_outputs(scene.bench, scene.judge, scene.words, "outputs_not_as_declared");
  });
  return {
      .steps = {identified(),
                ordered_on(kOut1),
                left_on(kOut1),
                through(kOut1, data(), "interface_not_opened"),
                shown(),
                sent(id("with the reset bit", reset), true),
                {"for 25 ms status telegrams and ID cycles that ask for OUT1", "nothing leaves on OUT1",
                 silent_for_the_limit},
                outputs_as_declared,
                // The ID cycles ended up to 4 ms before the limit; stations may take a millisecond more.
                silence("8 ms of silence", [](const interbus::Rules&) { return 8 * kernel::kMillisecond; }),
                sent(id("that switches OUT1 on", on(kOut1)), false),
                left_on(kOut1)}};
}

SlaveChart bridge_chart() {
  const auto bridge = [](std::string text, bool is_there) {
    return stimulus<SlaveScene>(std::move(text),
                                [is_there](SlaveScene& scene) { scene.bench.set_bridge(false, is_there); });
  };
  const std::string changed = "ring_changed_without_id_cycle";
  const Sent id_cycle = id("with OUT1 on", on(kOut1));
  return {.rounds = {2, 10},
          .steps = {bridge("the bridge at OUT1 is opened", false), through(kOut1, data(), changed),
                    through(kOut1, id_cycle, changed), closed(kOut1, data(), "bridge_not_followed"),
                    bridge("the bridge is closed", true), closed(kOut1, data(), changed),
                    closed(kOut1, id_cycle, changed), through(kOut1, data(), "bridge_not_followed")},
          .first = {identified(), ordered_on(kOut1), left_on(kOut1)}};
}

const SlaveNeeds kStationAfterOut1{.id_code = {}, .remote_neighbour = true, .branch_neighbour = false};

std::vector<SlaveCase> cases_of_control_bits() {
  return {slave_case("interfaces/remote_interface_follows_its_control_bit", "IS-30",
                     "The control word of an ID cycle switches the outgoing remote bus (OUT1) at the end of "
                     "that cycle. Off, the ring is closed in this slave and has its registers only; on, the "
                     "station behind it is in the ring.",
                     sources::from_memory("outgoing remote bus on and off; the coding is this project's"),
                     {{"remote_interface_stays_open", "interface_not_closed"},
                      {"interface_switches_inside_cycle", "interface_switched_inside_cycle"}},
                     control_bit_chart(kOut1),
                     {.details = details::answer(), .only_for = for_remote(), .needs = kStationAfterOut1}),
          slave_case("interfaces/branch_interface_follows_its_control_bit", "IS-31",
                     "The control word of an ID cycle switches the second outgoing interface (OUT2) at the "
                     "end of that cycle: the stations after it are added to the ring or removed.",
                     sources::from_memory("local bus on and off; the coding is this project's"),
                     {{"branch_interface_stays_open", "interface_not_closed"},
                      {"interface_switches_inside_cycle", "interface_switched_inside_cycle"}},
                     control_bit_chart(kOut2),
                     {.details = details::answer(),
                      .only_for = for_item("has_branch", "the slave has no second outgoing interface (OUT2)"),
                      .needs = {.id_code = {}, .remote_neighbour = false, .branch_neighbour = true}}),
          slave_case("interfaces/reserved_control_bits_are_ignored", "IS-32",
                     "Bits of the control word without a meaning are ignored, and only these.",
                     sources::own("the control word's coding; reserved bits are 0"),
                     {{"reserved_control_bit_closes_remote", "reserved_control_bit_obeyed"},
                      {"ignores_words_with_reserved_bits", "control_word_with_reserved_bit_ignored"}},
                     reserved_bits_chart(), {.only_for = for_remote(), .needs = kStationAfterOut1})};
}

}  // namespace

std::vector<SlaveCase> slave_interface_cases() {
  return joined(
      {cases_of_control_bits(),
       {slave_case("interfaces/reset_bit_silences_the_outgoing_bus", "IS-33",
                   "The reset bit of the control word makes the outgoing bus silent for at least 25 ms, so "
                   "that every station after the slave resets. The slave's own outputs do what it declares.",
                   sources::from_memory("reset of the outgoing bus; the coding is this project's"),
                   {{"ignores_outgoing_reset", "downstream_not_silent"},
                    {"outgoing_reset_clears_outputs", "outputs_not_as_declared"}},
                   reset_chart(), {.tags = {"timing"}, .only_for = for_remote(), .needs = kStationAfterOut1}),
        slave_case("interfaces/bridge_counts_in_id_cycles_only", "IS-36",
                   "The bridge in the outgoing plug tells that a next device is there. Opened or closed "
                   "while data cycles run, it changes the ring only at the end of the next ID cycle.",
                   sources::from_memory("meaning of the bridge between pins 5 and 9"),
                   {{"switches_with_the_bridge", "ring_changed_without_id_cycle"},
                    {"ignores_the_bridge", "bridge_not_followed"}},
                   bridge_chart(), {.only_for = for_remote(), .needs = kStationAfterOut1})}});
}

}  // namespace fieldproof::conformance
