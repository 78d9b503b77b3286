#include "conformance/interbus/master_side_notes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "conformance/interbus/master_side.hpp"
#include "protocols/interbus/master.hpp"

// What a side notes of a cycle and of a state, and the same in words: in the order in which it is pushed.
namespace fieldproof::conformance {

using interbus::MasterState;
using interbus::MasterStatus;
using interbus::SeenCycle;

void MasterSide::add_images(Values& values) const {
  const bool is_held =
      !bench_.may_answer("outputs_after_bus_stop", "zero") && bench_.status().state == MasterState::bus_stop;
  for (unsigned word = 0; word < bench_.ring().word_count() && is_ring_right_; ++word)
    values.push_back(is_held ? 0 : bench_.master().output(word));
}

void MasterSide::note_cycle() {
  const SeenCycle& sent = bench_.ring().last_cycle();
  const kernel::Time when = sent.start;
  Values cycle{sent.is_id_cycle ? 1 : 0, static_cast<std::int64_t>(sent.transfer_octets), cycle_times()};
  // Of an ID cycle the acknowledgement is compared, no more: how interfaces are switched is the
  // recognition's.
  const std::size_t words = sent.transfer_octets / 2;
  cycle.push_back(sent.is_id_cycle ? 0 : static_cast<std::int64_t>(words));
  for (std::size_t n = 0; n < words && !sent.is_id_cycle; ++n) cycle.push_back(sent.word(2 * n).value_or(0));
  constexpr std::size_t kCheckAndStatus = 4;
  for (std::size_t n = sent.transfer_octets + kCheckAndStatus; n < sent.octets.size(); ++n)
    cycle.push_back(sent.octets[n]);
  cycles_.push_back({cycle, when});
  const std::vector<std::uint16_t> held = bench_.inputs();
  Values inputs{bench_.finished().is_accepted ? 1 : 0};
  inputs.insert(inputs.end(), held.begin(), held.end());
  inputs_.push_back({inputs, when});
  const MasterStatus status = bench_.status();
  const bool is_in_run = status.state == MasterState::run;
  Values report{is_in_run ? 1 : 0, is_in_run && status.quality_bit ? 1 : 0};
  if (is_in_run) {
    for (const std::vector<int>* stations : {&status.peripheral_faults, &status.reconfigurations}) {
      report.push_back(static_cast<std::int64_t>(stations->size()));
      report.insert(report.end(), stations->begin(), stations->end());
    }
    report.push_back(status.consecutive_bad);
    report.push_back(status.has_fault_location ? 1 : 0);
    report.push_back(status.has_fault_location ? status.fault_location.from : 0);
    report.push_back(status.has_fault_location ? status.fault_location.to : 0);
  }
  add_images(report);
  reports_.push_back({report, when});
}

void MasterSide::note_state(bool is_located) {
  constexpr auto bit_of = [](MasterState one) { return std::uint64_t{1} << static_cast<unsigned>(one); };
  // Whether the first cycles are driven in the state before is the master's choice, and a fault may be found
  // by one; so is at which of its stations a ring is refused.
  constexpr std::uint64_t kOfChoice =
      bit_of(MasterState::ready) | bit_of(MasterState::bus_stop) | bit_of(MasterState::locating);
  const MasterStatus status = bench_.status();
  const bool is_refused = !status.configuration_error.empty();
  const std::uint64_t left_out = kOfChoice | (is_refused ? bit_of(MasterState::identification) : 0);
  Values state{static_cast<std::int64_t>(status.state), is_refused ? 1 : 0,
               static_cast<std::int64_t>(std::exchange(states_seen_, 0) & ~left_out)};
  const bool is_in_run = status.state == MasterState::run;
  state.push_back(is_in_run ? static_cast<std::int64_t>(status.stations.size()) : 0);
  for (std::size_t n = 0; is_in_run && n < status.stations.size(); ++n) {
    const interbus::FoundStation& one = status.stations[n];
    state.insert(state.end(), {one.id_code, one.words, one.before, one.on_branch ? 1 : 0});
  }
  state.push_back(is_located ? 1 : 0);
  if (is_located) {
    state.insert(state.end(),
                 {status.has_fault_location ? 1 : 0, status.fault_location.from, status.fault_location.to});
  }
  if (!is_in_run) add_images(state);
  states_.push_back({state, bench_.now()});
}

// ---- in words ----

namespace {

using Noted = std::span<const std::int64_t>;

std::int64_t take(Noted& values) {
  if (values.empty()) return 0;
  const std::int64_t first = values.front();
  values = values.subspan(1);
  return first;
}

// A list with its number in front.
Noted take_list(Noted& values, std::size_t size_of_one = 1) {
  const std::size_t count = static_cast<std::size_t>(take(values)) * size_of_one;
  const Noted list = values.first(std::min(count, values.size()));
  values = values.subspan(list.size());
  return list;
}

std::string stations_text(std::string_view what, Noted& values) {
  const Noted stations = take_list(values);
  return stations.empty() ? fmt::format("no {}", what)
                          : fmt::format("{} of station {}", what, fmt::join(stations, ", "));
}

std::string place_text(std::string_view name, Noted& values) {
  const bool is_there = take(values) != 0;
  const std::int64_t from = take(values);
  const std::int64_t to = take(values);
  if (!is_there) return fmt::format("no {}", name);
  return fmt::format("{} from {} to {}", name, from < 0 ? "the output" : fmt::format("station {}", from),
                     to < 0 ? "the input" : fmt::format("station {}", to));
}

std::string words_text(std::string_view name, Noted words) {
  if (words.empty()) return fmt::format("no {} words", name);
  return fmt::format("{} words {:04X}h", name, fmt::join(words, "h "));
}

}  // namespace

std::string master_cycle_text(Noted values) {
  const bool is_id_cycle = take(values) != 0;
  const std::int64_t octets = take(values);
  const std::int64_t times = take(values);
  const std::string after =
      times < 0 ? "no whole number of cycle times" : fmt::format("{} cycle times", times);
  std::string text = fmt::format("{} cycle of {} octets, {} after the one before",
                                 is_id_cycle ? "ID" : "data", octets, after);
  const Noted words = take_list(values);
  if (!is_id_cycle) text += fmt::format(", words as sent {:04X}h", fmt::join(words, "h "));
  if (!values.empty()) text += fmt::format(", end telegrams {:02X}h", fmt::join(values, "h "));
  return text;
}

std::string master_inputs_text(Noted values) {
  const bool is_accepted = take(values) != 0;
  return fmt::format("{}, {}", is_accepted ? "accepted" : "rejected", words_text("input", values));
}

std::string master_report_text(Noted values) {
  const bool is_in_run = take(values) != 0;
  const std::int64_t quality_bit = take(values);
  if (!is_in_run) return fmt::format("not in run, {}", words_text("output", values));
  std::string text = fmt::format("run, quality bit {}", quality_bit);
  text += fmt::format(", {}", stations_text("peripheral fault", values));
  text += fmt::format(", {}", stations_text("request for a reconfiguration", values));
  text += fmt::format(", {} bad cycles in a row", take(values));
  text += fmt::format(", {}", place_text("place of the last fault", values));
  return text + fmt::format(", {}", words_text("output", values));
}

std::string master_state_text(Noted values) {
  std::string text{interbus::name(static_cast<interbus::MasterState>(take(values)))};
  if (take(values) != 0) text += ", configuration refused";
  const std::int64_t states = take(values);
  for (unsigned n = 0; n < 6; ++n) {
    if ((states >> n & 1) != 0)
      text += fmt::format(", cycles in {}", interbus::name(static_cast<interbus::MasterState>(n)));
  }
  constexpr std::size_t kOfStation = 4;
  Noted stations = take_list(values, kOfStation);
  for (std::size_t n = 0; !stations.empty(); ++n) {
    const std::int64_t code = take(stations);
    const std::int64_t words = take(stations);
    const std::int64_t before = take(stations);
    const bool on_branch = take(stations) != 0;
    text += fmt::format(", station {} {:04X}h of {} words on {} of {}", n, code, words,
                        on_branch ? "OUT2" : "OUT1",
                        before < 0 ? "the master" : fmt::format("station {}", before));
  }
  if (take(values) != 0) text += fmt::format(", {}", place_text("place of the fault", values));
  if (!values.empty()) text += fmt::format(", {}", words_text("output", values));
  return text;
}

}  // namespace fieldproof::conformance
