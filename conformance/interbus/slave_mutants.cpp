#include "conformance/interbus/slave_mutants.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <functional>
#include <string>
#include <utility>

#include "conformance/interbus/slave_driving_seeded_faults.hpp"
#include "conformance/interbus/slave_frame_seeded_faults.hpp"
#include "conformance/interbus/slave_register_seeded_faults.hpp"
#include "conformance/interbus/slave_supervision_seeded_faults.hpp"
#include "harness/config/nearest.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::conformance {
namespace {

using interbus::Rules;
using interbus::SlaveConfiguration;
using interbus::SlaveDevice;

using Make = std::function<std::unique_ptr<SlaveDevice>(const SlaveConfiguration&)>;

template <typename Mutant>
std::unique_ptr<SlaveDevice> make(const SlaveConfiguration& configuration) {
  return std::make_unique<Mutant>(configuration);
}

// The reference under rules with one number changed.
template <typename Change>
Make with_rules(Change change) {
  return [change](const SlaveConfiguration& configuration) {
    SlaveConfiguration changed = configuration;
    change(changed.rules);
    return std::make_unique<interbus::Slave>(changed);
  };
}

Make latching_late(kernel::Duration lateness) {
  return [lateness](const SlaveConfiguration& configuration) {
    return std::make_unique<slave_seeded_faults::LatchesLate>(configuration, lateness);
  };
}

Make falling_silent(unsigned cycles) {
  return [cycles](const SlaveConfiguration& configuration) {
    return std::make_unique<slave_seeded_faults::FallsSilent>(configuration, cycles);
  };
}

Make without_control(std::uint16_t Rules::* bit) {
  return [bit](const SlaveConfiguration& configuration) {
    return std::make_unique<slave_seeded_faults::IgnoresControlBit>(configuration, configuration.rules.*bit);
  };
}

struct Row {
  std::string_view name;
  std::string_view label;
  std::string_view description;
  Make make_slave;
};

std::vector<Row> check_rows() {
  using namespace slave_seeded_faults;
  return {
      {"crc_preset_zero", "MS1", "presets its frame checks with zeros",
       with_rules([](Rules& rules) { rules.frame_check = "CRC-16/XMODEM"; })},
      {"crc_polynomial_8005", "MS2", "has the polynomial x^16 + x^15 + x^2 + 1",
       with_rules([](Rules& rules) { rules.frame_check = "CRC-16/CMS"; })},
      {"sends_check_of_received_bits", "MS3", "sends the check of what it received, not of what it sent",
       make<SendsCheckOfReceivedBits>},
      {"check_not_reset_between_cycles", "MS22", "goes on with the frame check of the cycle before",
       make<CheckNotResetBetweenCycles>},
      {"compares_first_check_octet_only", "", "compares one half of the check",
       make<ComparesFirstCheckOctetOnly>},
      {"accepts_check_of_zero", "", "takes an octet of zeros in the check for right",
       make<AcceptsCheckOfZero>},
      {"latches_in_spite_of_own_error", "MS5", "takes the words of a cycle that fails its own check",
       make<LatchesInSpiteOfOwnError>},
      {"ignores_upstream_status", "MS6", "takes the words of a cycle that another station marked",
       make<IgnoresUpstreamStatus>},
      {"does_not_mark_status", "MS7", "lets the status word of a wrong cycle pass unmarked",
       make<DoesNotMarkStatus>},
      {"clears_mark_of_others", "MS8", "sends a clean status word when its own check fits",
       make<ClearsMarkOfOthers>},
      {"expects_the_usual_loopback_word", "", "takes no cycle with another loopback word than A55Ah",
       make<ExpectsTheUsualLoopbackWord>},
      {"loses_every_200th_cycle", "", "does not take the words of each 200th valid cycle",
       make<LosesEvery200thCycle>},
      {"takes_a_cycle_one_telegram_short", "",
       "takes a cycle that is a telegram shorter than register and loopback word",
       make<TakesACycleOneTelegramShort>},
      {"does_not_look_at_the_length", "", "takes a cycle of any length", make<DoesNotLookAtTheLength>},
      {"final_xor_hard_coded", "", "has a final XOR of 0 whatever the setting says",
       with_rules([](Rules& rules) { rules.frame_check = Rules{}.frame_check; })},
      {"locks_up_after_rejected_cycle", "", "takes no cycle any more after a rejected one",
       make<LocksUpAfterRejectedCycle>},
      {"loses_the_cycle_behind_a_rejected_one", "", "does not take the words of the cycle after a wrong one",
       make<LosesTheCycleBehindARejectedOne>},
      {"waits_for_id_cycle_after_rejected_cycle", "",
       "takes no data cycle after a rejected one until an ID cycle", make<WaitsForIdCycleAfterRejectedCycle>},
  };
}

std::vector<Row> telegram_rows() {
  using namespace slave_seeded_faults;
  return {
      {"stop_bit_not_checked", "MS16", "takes telegrams without a stop bit", make<StopBitNotChecked>},
      {"tells_no_missing_stop", "", "does not report a missing stop bit in the next ID cycle",
       make<TellsNoMissingStop>},
      {"does_not_resynchronise", "MS18", "receives nothing after a missing stop bit until it is reset",
       make<DoesNotResynchronise>},
      {"status_telegram_shifts", "MS17", "shifts its register by a status telegram",
       make<StatusTelegramShifts>},
      {"start_bit_not_validated", "MS21", "takes every falling edge for a start bit",
       make<StartBitNotValidated>},
      {"stray_telegram_spoils_next_cycle", "",
       "takes a false telegram for the beginning of the next cycle and rejects that",
       make<StrayTelegramSpoilsNextCycle>},
      {"ignores_select_inside_a_cycle", "", "looks at the SL bit of the first telegram of a cycle only",
       make<IgnoresSelectInsideACycle>},
      {"needs_idle_between_telegrams", "", "misses a start bit right after a stop bit",
       make<NeedsIdleBetweenTelegrams>},
      {"follows_any_rate", "", "adapts its clock to any bit rate within 10 %", make<FollowsAnyRate>},
      {"clock_too_fast", "", "has a clock that runs 3.5 % fast",
       with_rules([](Rules& rules) { rules.bit_rate += rules.bit_rate * 35 / 1000; })},
      {"delays_four_bits", "", "delays by two bits on each way",
       with_rules([](Rules& rules) { rules.forward_delay_half_bits = rules.return_delay_half_bits = 4; })},
      {"delay_varies", "", "delays every second transmission by one more bit", make<DelayVaries>},
      {"does_not_retime", "", "sends low pulses that are 10 % of a bit too long", make<DoesNotRetime>},
      {"swallows_status_telegrams", "", "does not pass on status telegrams", make<SwallowsStatusTelegrams>},
      {"select_bit_in_status_telegrams", "", "passes status telegrams on with another SL bit",
       make<SelectBitInStatusTelegrams>},
      {"falls_silent_after_820_cycles", "", "sends nothing any more after 820 cycles", falling_silent(820)},
      {"sends_data_at_power_up", "", "sends a data telegram 10 ms after power-up", make<SendsDataAtPowerUp>},
      {"drives_over_itself", "", "begins a transmission before the one before has left",
       make<DrivesOverItself>},
  };
}

std::vector<Row> register_rows() {
  using namespace slave_seeded_faults;
  return {
      {"length_code_binary", "MS12", "takes its length code for a binary number of words",
       make<LengthCodeBinary>},
      {"id_register_in_data_cycle", "MS15", "has its ID register in the ring in data cycles too",
       make<IdRegisterInDataCycle>},
      {"id_octets_swapped", "", "sends the low octet of its ID code first", make<IdOctetsSwapped>},
      {"loopback_word_changed_in_id_cycle", "", "changes the last bit of the loopback word in ID cycles",
       make<LoopbackWordChangedInIdCycle>},
      {"loopback_word_of_ones_changed", "", "changes the last bit of a passing word FFFFh",
       make<LoopbackWordOfOnesChanged>},
      {"output_octets_swapped", "MS13", "puts the first octet of a word to the low half of the outputs",
       make<OutputOctetsSwapped>},
      {"input_bit_stuck", "", "always sends one input bit as 1", make<InputBitStuck>},
      {"tears_inputs", "MS14", "samples the two octets of an input word one telegram apart",
       make<TearsInputs>},
      {"tears_between_input_words", "", "samples its input words one telegram apart",
       make<TearsBetweenInputWords>},
      {"loses_input_words_above_16", "", "sends 0 for its input words from the 17th on",
       make<LosesInputWordsAbove16>},
      {"samples_with_previous_cycle", "", "samples its inputs at the end of the cycle before",
       make<SamplesWithPreviousCycle>},
      {"latches_at_end_of_data_phase", "MS4", "takes the words before their check has come",
       make<LatchesAtEndOfDataPhase>},
      {"latches_late", "", "changes its outputs 60 us after the cycle",
       latching_late(60 * kernel::kMicrosecond)},
      {"latches_5_ms_late", "", "changes its outputs 5 ms after the cycle",
       latching_late(5 * kernel::kMillisecond)},
      {"clears_outputs_on_rejected_cycle", "MS11", "sets its outputs to 0 on every rejected cycle",
       make<ClearsOutputsOnRejectedCycle>},
      {"glitches_outputs_on_rejected_cycle", "", "sets its outputs to 0 for 2 us on every rejected cycle",
       make<GlitchesOutputsOnRejectedCycle>},
      {"outputs_set_at_power_up", "", "has an output set at power-up", make<OutputsSetAtPowerUp>},
      {"outputs_without_identification", "", "takes the words of data cycles without an ID cycle",
       make<OutputsWithoutIdentification>},
  };
}

std::vector<Row> management_rows() {
  using namespace slave_seeded_faults;
  return {
      {"silence_limit_250_ms", "MS9", "takes silence for a reset only after 250 ms",
       with_rules([](Rules& rules) { rules.silence_limit *= 10; })},
      {"safe_state_500_ms_late", "", "sets its outputs to 0 half a second after a reset",
       make<SafeStateLate>},
      {"silence_limit_20_ms", "", "takes silence for a reset after 20 ms already",
       with_rules([](Rules& rules) { rules.silence_limit = rules.silence_limit * 4 / 5; })},
      {"silence_counts_data_only", "MS10", "does not take status telegrams for a sign of life",
       make<SilenceCountsDataOnly>},
      {"silence_limit_hard_coded", "", "takes silence for a reset after 25 ms whatever the setting says",
       with_rules([](Rules& rules) { rules.silence_limit = Rules{}.silence_limit; })},
      {"kept_alive_by_returns", "", "takes telegrams from its outgoing interfaces for a sign of life",
       make<KeptAliveByReturns>},
      {"reset_leaves_interfaces_on", "", "leaves its outgoing interfaces on in a reset",
       make<ResetLeavesInterfacesOn>},
      {"ignores_words_with_reserved_bits", "", "ignores a control word with a reserved bit",
       make<IgnoresWordsWithReservedBits>},
      {"remote_interface_stays_open", "", "ignores the order to switch OUT1 off",
       without_control(&Rules::control_remote_off)},
      {"branch_interface_stays_open", "", "ignores the order to switch OUT2 off",
       without_control(&Rules::control_local_off)},
      {"interface_switches_inside_cycle", "MS20", "switches its interfaces before the ID cycle has ended",
       make<InterfaceSwitchesInsideCycle>},
      {"reserved_control_bit_closes_remote", "", "takes a reserved bit of the control word for OUT1 off",
       with_rules([](Rules& rules) { rules.control_remote_off |= 0x0100; })},
      {"ignores_outgoing_reset", "", "ignores the order to reset the outgoing bus",
       without_control(&Rules::control_reset)},
      {"outgoing_reset_clears_outputs", "", "sets its own outputs to 0 when it resets the outgoing bus",
       make<OutgoingResetClearsOutputs>},
      {"switches_with_the_bridge", "", "changes the ring as soon as the bridge in the plug changes",
       make<SwitchesWithTheBridge>},
      {"ignores_the_bridge", "", "takes the next device for present whatever the bridge says",
       make<IgnoresTheBridge>},
      {"peripheral_fault_not_told", "", "keeps a peripheral fault to itself", make<PeripheralFaultNotTold>},
      {"peripheral_fault_marks_data_cycles", "", "marks the status word of data cycles at a peripheral fault",
       make<PeripheralFaultMarksDataCycles>},
      {"messages_confused", "", "reports a reconfiguration as a peripheral fault and the reverse",
       with_rules(
           [](Rules& rules) { std::swap(rules.message_reconfiguration, rules.message_peripheral_fault); })},
      {"message_bits_hard_coded", "", "reports by the usual message bits whatever the settings say",
       with_rules([](Rules& rules) {
         rules.message_check_error = Rules{}.message_check_error;
         rules.message_peripheral_fault = Rules{}.message_peripheral_fault;
       })},
      {"tells_errors_of_others", "", "reports a check error when another station has marked the cycle",
       make<TellsErrorsOfOthers>},
      {"message_cleared_by_marked_id_cycle", "", "clears its messages by an ID cycle that is marked",
       make<MessageClearedByMarkedIdCycle>},
      {"message_cleared_by_data_cycle", "", "clears the message of a check error by a good data cycle",
       make<MessageClearedByDataCycle>},
      {"message_never_cleared", "MS19", "keeps the message of a check error after it was read",
       make<MessageNeverCleared>},
      {"message_without_error", "MS19", "sets the message of a check error by each data cycle",
       make<MessageWithoutError>},
      {"tells_no_check_error", "", "does not report check errors in ID cycles", make<TellsNoCheckError>},
  };
}

const std::vector<Row>& rows() {
  static const std::vector<Row> table = [] {
    std::vector<Row> all;
    for (auto group : {check_rows, telegram_rows, register_rows, management_rows}) {
      for (Row& row : group()) all.push_back(std::move(row));
    }
    return all;
  }();
  return table;
}

}  // namespace

const std::vector<Mutant>& slave_mutants() {
  static const std::vector<Mutant> mutants = [] {
    std::vector<Mutant> all;
    for (const Row& row : rows())
      all.push_back({std::string(row.name), std::string(row.label), "slave", std::string(row.description)});
    return all;
  }();
  return mutants;
}

std::unique_ptr<SlaveDevice> make_slave_mutant(std::string_view name,
                                               const SlaveConfiguration& configuration) {
  std::vector<std::string_view> names;
  for (const Row& row : rows()) {
    if (row.name == name) return row.make_slave(configuration);
    names.push_back(row.name);
  }
  throw kernel::Error(kernel::ErrorKind::usage,
                      fmt::format("there is no mutant slave \"{}\"; near are {}", name,
                                  fmt::join(config::nearest(name, names, 3), ", ")));
}

}  // namespace fieldproof::conformance
