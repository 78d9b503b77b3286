#include "conformance/valve_bus/node_scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fieldproof::conformance {
namespace {

// Why what was sent is none: "its check does not fit: 05 00 12 34 00".
std::string why(const NodeScene& scene, const std::string& why_not) {
  return scene.frame.empty() ? why_not : fmt::format("{}: {:02X}", why_not, fmt::join(scene.frame, " "));
}

}  // namespace

NodeScene::NodeScene(NodeBench& bench_, CaseJudge& judge_, unsigned round_) : Scene(bench_, judge_, round_) {
  set_switches(static_cast<std::uint16_t>(bench.random().below(0x10000)));
}

void NodeScene::send(std::vector<std::uint8_t> octets) {
  bench.clear_observations();
  send_next(std::move(octets));
}

void NodeScene::send_next(std::vector<std::uint8_t> octets) {
  frame = std::move(octets);
  end = bench.send(frame);
  bench.await_response_window();
}

void NodeScene::set_switches(std::uint16_t made) {
  switches = made;
  bench.boards().set_input(0, made);
}

std::vector<std::uint8_t> NodeScene::command(unsigned id, unsigned number, unsigned data0,
                                             unsigned data1) const {
  const auto octet = [](unsigned value) { return static_cast<std::uint8_t>(value); };
  const auto octets = octets_of(valve_bus::Command{octet(id), octet(number), octet(data0), octet(data1)});
  return {octets.begin(), octets.end()};
}

std::vector<std::uint8_t> NodeScene::command(unsigned number) {
  const std::uint8_t data0 = bench.random_octet();
  return command(bench.address(), number, data0, bench.random_octet());
}

std::vector<std::uint8_t> NodeScene::moving_write() const {
  const auto octets = bench.telling_write();
  return {octets.begin(), octets.end()};
}

void NodeScene::write_with_wrong_level(std::size_t level) {
  bench.clear_observations();
  frame = moving_write();
  for (std::size_t n = 0; n < frame.size(); ++n) {
    line::Waveform wave;
    wave.rate = bench.rules().bit_rate;
    wave.levels = bench.levels_of(frame[n]);
    if (n == round % frame.size()) wave.levels.flip(level);
    bench.drive(wave);
  }
  bench.await_response_window();
}

namespace node_chart {

NodeStep sent(std::string text, MakeFrame frame) {
  return stimulus(std::move(text),
                  [frame = std::move(frame)](NodeScene& scene) { scene.send(frame(scene)); });
}

NodeStep write() {
  return sent("a write of random data",
              [](NodeScene& scene) { return scene.command(scene.bench.rules().write_command); });
}

NodeStep moving_write() {
  return sent("a write that moves all valves", &NodeScene::moving_write);
}

NodeStep valves_on() {
  return sent("a write that switches some valves on",
              [](NodeScene& scene) { return scene.write(0x5A, 0xA5); });
}

NodeStep read() {
  return sent("a read, with random limit switches",
              [](NodeScene& scene) { return scene.command(scene.bench.rules().read_command); });
}

NodeStep taken() {
  return expected(
      "the valves stand as DATA0 and DATA1 say, at most 2 ms after the delimiter and not before the check, "
      "changing within 1 us; no answer but of a node that answers writes",
      [](NodeScene& scene) {
        expect_write_taken(scene.bench, scene.judge, scene.frame.at(2), scene.frame.at(3), scene.end);
      });
}

NodeStep valves_stand(std::string reason) {
  return expected("the valves stand as the write says", [reason = std::move(reason)](NodeScene& scene) {
    expect_valves(scene.bench, scene.judge, scene.valves(), reason);
  });
}

NodeStep answered() {
  return expected("one answer in time, of three octets with these switches and a right check",
                  [](NodeScene& scene) {
                    scene.answer = expect_answer(scene.bench, scene.judge, scene.switches, scene.end);
                  });
}

NodeStep no_valve_moved(std::string reason, std::string why_not) {
  return expected(fmt::format("no valve moves: {}", why_not),
                  [reason = std::move(reason), why_not](NodeScene& scene) {
                    expect_no_valve_moved(scene.bench, scene.judge, reason, why(scene, why_not));
                  });
}

NodeStep silent(std::string reason, std::string why_not) {
  return expected(fmt::format("no answer: {}", why_not),
                  [reason = std::move(reason), why_not](NodeScene& scene) {
                    expect_silence(scene.bench, scene.judge, reason, why_not);
                  });
}

NodeStep ignored(std::string reason, std::string why_not) {
  return expected(fmt::format("no valve moves and no answer: {}", why_not),
                  [reason = std::move(reason), why_not](NodeScene& scene) {
                    expect_ignored(scene.bench, scene.judge, reason, why(scene, why_not));
                  });
}

NodeStep serves() {
  return expected("then a write and a read are served",
                  [](NodeScene& scene) { expect_serves(scene.bench, scene.judge); });
}

}  // namespace node_chart
}  // namespace fieldproof::conformance
