#include "conformance/interbus/slave_mutants.hpp"

#include <algorithm>

#include "conformance/interbus/other_codings.hpp"
#include "conformance/interbus/slave_driving_seeded_faults.hpp"
#include "conformance/interbus/slave_frame_seeded_faults.hpp"
#include "conformance/interbus/slave_register_seeded_faults.hpp"
#include "conformance/interbus/slave_supervision_seeded_faults.hpp"

namespace fieldproof::conformance {
namespace {

using interbus::Rules;
using interbus::SlaveConfiguration;
using SlaveRow = SlaveMutants::Row;

SlaveMutants::Make without_control(std::uint16_t Rules::* bit) {
  return [bit](const SlaveConfiguration& configuration) {
    return std::make_unique<slave_seeded_faults::IgnoresControlBit>(configuration, configuration.rules.*bit);
  };
}

std::vector<SlaveRow> slave_check_rows() {
  using namespace slave_seeded_faults;
  return {
      {"crc_preset_zero", "MS1", "presets its frame checks with zeros",
       with_rules<interbus::Slave>([](Rules& rules) { rules.frame_check = "CRC-16/XMODEM"; })},
      {"crc_polynomial_8005", "MS2", "has the polynomial x^16 + x^15 + x^2 + 1",
       with_rules<interbus::Slave>([](Rules& rules) { rules.frame_check = "CRC-16/CMS"; })},
      {"sends_check_of_received_bits", "MS3", "sends the check of what it received, not of what it sent",
       mutant<SendsCheckOfReceivedBits>()},
      {"check_not_reset_between_cycles", "MS22", "goes on with the frame check of the cycle before",
       mutant<CheckNotResetBetweenCycles>()},
      {"compares_first_check_octet_only", "", "compares one half of the check",
       mutant<ComparesFirstCheckOctetOnly>()},
      {"accepts_check_of_zero", "", "takes an octet of zeros in the check for right",
       mutant<AcceptsCheckOfZero>()},
      {"latches_in_spite_of_own_error", "MS5", "takes the words of a cycle that fails its own check",
       mutant<LatchesInSpiteOfOwnError>()},
      {"ignores_upstream_status", "MS6", "takes the words of a cycle that another station marked",
       mutant<IgnoresUpstreamStatus>()},
      {"takes_half_a_status_word", "", "looks at the high octet of the status word only",
       mutant<TakesHalfAStatusWord>()},
      {"does_not_mark_status", "MS7", "lets the status word of a wrong cycle pass unmarked",
       mutant<DoesNotMarkStatus>()},
      {"clears_mark_of_others", "MS8", "sends a clean status word when its own check fits",
       mutant<ClearsMarkOfOthers>()},
      {"expects_the_usual_loopback_word", "", "takes no cycle with another loopback word than A55Ah",
       mutant<ExpectsTheUsualLoopbackWord>()},
      {"loses_every_200th_cycle", "", "does not take the words of each 200th valid cycle",
       mutant<LosesEvery200thCycle>()},
      {"takes_a_cycle_one_telegram_short", "",
       "takes a cycle that is a telegram shorter than register and loopback word",
       mutant<TakesACycleOneTelegramShort>()},
      {"does_not_look_at_the_length", "", "takes a cycle of any length", mutant<DoesNotLookAtTheLength>()},
      {"final_xor_hard_coded", "", "has a final XOR of 0 whatever the setting says",
       with_rules<interbus::Slave>([](Rules& rules) { rules.frame_check = Rules{}.frame_check; })},
      {"locks_up_after_rejected_cycle", "", "takes no cycle any more after a rejected one",
       mutant<LocksUpAfterRejectedCycle>()},
      {"loses_the_cycle_behind_a_rejected_one", "", "does not take the words of the cycle after a wrong one",
       mutant<LosesTheCycleBehindARejectedOne>()},
      {"waits_for_id_cycle_after_rejected_cycle", "",
       "takes no data cycle after a rejected one until an ID cycle",
       mutant<WaitsForIdCycleAfterRejectedCycle>()},
  };
}

std::vector<SlaveRow> slave_telegram_rows() {
  using namespace slave_seeded_faults;
  return {
      {"stop_bit_not_checked", "MS16", "takes telegrams without a stop bit", mutant<StopBitNotChecked>()},
      {"second_missing_stop_takes_the_error_back", "",
       "takes a cycle with two missing stop bits for one without",
       mutant<SecondMissingStopTakesTheErrorBack>()},
      {"forgets_the_missing_stop_of_a_begin", "",
       "takes no notice of the first missing stop bit after a cycle that was broken off",
       mutant<ForgetsTheMissingStopOfABegin>()},
      {"tells_no_missing_stop", "", "does not report a missing stop bit in the next ID cycle",
       mutant<TellsNoMissingStop>()},
      {"does_not_resynchronise", "MS18", "receives nothing after a missing stop bit until it is reset",
       mutant<DoesNotResynchronise>()},
      {"status_telegram_shifts", "MS17", "shifts its register by a status telegram",
       mutant<StatusTelegramShifts>()},
      {"start_bit_not_validated", "MS21", "takes every falling edge for a start bit",
       mutant<StartBitNotValidated>()},
      {"stray_telegram_spoils_next_cycle", "",
       "takes a false telegram for the beginning of the next cycle and rejects that",
       mutant<StrayTelegramSpoilsNextCycle>()},
      {"ignores_select_inside_a_cycle", "", "looks at the SL bit of the first telegram of a cycle only",
       mutant<IgnoresSelectInsideACycle>()},
      {"needs_idle_between_telegrams", "", "misses a start bit right after a stop bit",
       mutant<NeedsIdleBetweenTelegrams>()},
      {"loses_the_rest_of_a_cut_telegram", "",
       "takes the rest of a telegram that comes in two transmissions for idle",
       mutant<LosesTheRestOfACutTelegram>()},
      {"drops_a_cut_telegram", "", "takes a telegram that its transmission cuts for idle",
       mutant<DropsACutTelegram>()},
      {"samples_late", "", "samples three quarters into each bit", mutant<SamplesLate>()},
      {"samples_late_on_the_way_back", "", "does so with what comes back from after its interfaces",
       mutant<SamplesLate>(true)},
      {"takes_glitches_on_the_way_back", "",
       "takes every falling edge for a start bit in what comes back from after its interfaces",
       mutant<TakesGlitchesOnTheWayBack>()},
      {"follows_any_rate", "", "adapts its clock to any bit rate within 10 %", mutant<FollowsAnyRate>()},
      {"clock_too_fast", "", "has a clock that runs 3.5 % fast",
       with_rules<interbus::Slave>([](Rules& rules) { rules.bit_rate += rules.bit_rate * 35 / 1000; })},
      {"delays_four_bits", "", "delays by two bits on each way",
       with_rules<interbus::Slave>(
           [](Rules& rules) { rules.forward_delay_half_bits = rules.return_delay_half_bits = 4; })},
      {"bit_time_in_whole_nanoseconds", "", "has bits of whole nanoseconds",
       with_rules<interbus::Slave>([](Rules& rules) {
         const kernel::Duration bit =
             kernel::levels_duration(1, rules.bit_rate) / kernel::kNanosecond * kernel::kNanosecond;
         const auto shorter = [&](unsigned half_bits) {
           const kernel::Duration delay = static_cast<std::int64_t>(half_bits) * bit / 2;
           return static_cast<unsigned>(2 * delay.count() * rules.bit_rate / kernel::kSecond.count());
         };
         rules.forward_delay_half_bits = shorter(rules.forward_delay_half_bits);
         rules.return_delay_half_bits = shorter(rules.return_delay_half_bits);
       })},
      {"delay_in_32_bits", "", "has delays in 32 bits of picoseconds",
       with_rules<interbus::Slave>([](Rules& rules) {
         const kernel::Duration half = kernel::levels_duration(1, 2 * rules.bit_rate);
         const std::int64_t delay = rules.return_delay_half_bits * half.count() % (std::int64_t{1} << 32);
         rules.return_delay_half_bits = static_cast<unsigned>(delay / half.count());
       })},
      {"a_delay_at_least", "", "delays by half a bit where it should not delay",
       with_rules<interbus::Slave>([](Rules& rules) {
         rules.forward_delay_half_bits = std::max(rules.forward_delay_half_bits, 1U);
       })},
      {"delay_varies", "", "delays every second transmission by one more bit", mutant<DelayVaries>()},
      {"does_not_retime", "", "sends low pulses that are 10 % of a bit too long", mutant<DoesNotRetime>()},
      {"swallows_status_telegrams", "", "does not pass on status telegrams",
       mutant<SwallowsStatusTelegrams>()},
      {"select_bit_in_status_telegrams", "", "passes status telegrams on with another SL bit",
       mutant<SelectBitInStatusTelegrams>()},
      {"falls_silent_after_820_cycles", "", "sends nothing any more after 820 cycles",
       mutant<FallsSilent>(820U)},
      {"sends_data_at_power_up", "", "sends a data telegram 10 ms after power-up",
       mutant<SendsDataAtPowerUp>()},
      {"drives_over_itself", "", "begins a transmission before the one before has left",
       mutant<DrivesOverItself>()},
  };
}

std::vector<SlaveRow> slave_register_rows() {
  using namespace slave_seeded_faults;
  return {
      {"length_code_binary", "MS12", "takes its length code for a binary number of words",
       mutant<LengthCodeBinary>()},
      {"id_register_in_data_cycle", "MS15", "has its ID register in the ring in data cycles too",
       mutant<IdRegisterInDataCycle>()},
      {"id_octets_swapped", "", "sends the low octet of its ID code first", mutant<IdOctetsSwapped>()},
      {"loopback_word_changed_in_id_cycle", "", "changes the last bit of the loopback word in ID cycles",
       mutant<LoopbackWordChangedInIdCycle>()},
      {"loopback_word_of_ones_changed", "", "changes the last bit of a passing word FFFFh",
       mutant<LoopbackWordOfOnesChanged>()},
      {"output_octets_swapped", "MS13", "puts the first octet of a word to the low half of the outputs",
       mutant<OutputOctetsSwapped>()},
      {"input_bit_stuck", "", "always sends one input bit as 1", mutant<InputBitStuck>()},
      {"tears_inputs", "MS14", "samples the two octets of an input word one telegram apart",
       mutant<TearsInputs>()},
      {"tears_between_input_words", "", "samples its input words one telegram apart",
       mutant<TearsBetweenInputWords>()},
      {"loses_input_words_above_16", "", "sends 0 for its input words from the 17th on",
       mutant<LosesInputWordsAbove16>()},
      {"samples_a_telegram_late", "", "samples its inputs at the end of the first telegram",
       mutant<SamplesATelegramLate>()},
      {"samples_with_previous_cycle", "", "samples its inputs at the end of the cycle before",
       mutant<SamplesWithPreviousCycle>()},
      {"latches_at_end_of_data_phase", "MS4", "takes the words before their check has come",
       mutant<LatchesAtEndOfDataPhase>()},
      {"latches_late", "", "changes its outputs 60 us after the cycle",
       mutant<LatchesLate>(60 * kernel::kMicrosecond)},
      {"latches_5_ms_late", "", "changes its outputs 5 ms after the cycle",
       mutant<LatchesLate>(5 * kernel::kMillisecond)},
      {"clears_outputs_on_rejected_cycle", "MS11", "sets its outputs to 0 on every rejected cycle",
       mutant<ClearsOutputsOnRejectedCycle>()},
      {"glitches_outputs_on_rejected_cycle", "", "sets its outputs to 0 for 2 us on every rejected cycle",
       mutant<GlitchesOutputsOnRejectedCycle>()},
      {"outputs_set_at_power_up", "", "has an output set at power-up", mutant<OutputsSetAtPowerUp>()},
      {"outputs_without_identification", "", "takes the words of data cycles without an ID cycle",
       mutant<OutputsWithoutIdentification>()},
  };
}

std::vector<SlaveRow> slave_management_rows() {
  using namespace slave_seeded_faults;
  return {
      {"silence_limit_250_ms", "MS9", "takes silence for a reset only after 250 ms",
       with_rules<interbus::Slave>([](Rules& rules) { rules.silence_limit *= 10; })},
      {"safe_state_500_ms_late", "", "sets its outputs to 0 half a second after a reset",
       mutant<SafeStateLate>()},
      {"silence_limit_20_ms", "", "takes silence for a reset after 20 ms already",
       with_rules<interbus::Slave>([](Rules& rules) { rules.silence_limit = rules.silence_limit * 4 / 5; })},
      {"silence_counts_data_only", "MS10", "does not take status telegrams for a sign of life",
       mutant<SilenceCountsDataOnly>()},
      {"silence_limit_hard_coded", "", "takes silence for a reset after 25 ms whatever the setting says",
       with_rules<interbus::Slave>([](Rules& rules) { rules.silence_limit = Rules{}.silence_limit; })},
      {"obeys_a_marked_id_cycle", "", "takes the orders of an ID cycle that another station has marked",
       mutant<ObeysAMarkedIdCycle>()},
      {"counts_id_cycles_in_8_bits", "", "does not move its outputs after 256 good ID cycles",
       mutant<CountsIdCyclesIn8Bits>()},
      {"counts_errors_in_8_bits", "", "reports no check error after 256 of them",
       mutant<CountsErrorsIn8Bits>()},
      {"without_stop_no_sign_of_life", "", "does not take a telegram without its stop bit for a sign of life",
       mutant<WithoutStopNoSignOfLife>()},
      {"counts_microseconds_in_32_bits", "", "does not see silence any more 71.6 minutes after power-up",
       mutant<CountsMicrosecondsIn32Bits>()},
      {"silence_limit_in_whole_milliseconds", "", "rounds the silence limit down to whole milliseconds",
       with_rules<interbus::Slave>([](Rules& rules) {
         rules.silence_limit = rules.silence_limit / kernel::kMillisecond * kernel::kMillisecond;
       })},
      {"outgoing_reset_a_quarter_short", "",
       "ends the time of control_reset a quarter of the silence tolerance early",
       with_rules<interbus::Slave>(
           [](Rules& rules) { rules.silence_tolerance -= rules.silence_tolerance / 4; })},
      {"kept_alive_by_returns", "", "takes telegrams from its outgoing interfaces for a sign of life",
       mutant<KeptAliveByReturns>()},
      {"reset_ends_outgoing_reset", "", "ends a reset of the outgoing bus when silence resets itself",
       mutant<ResetEndsOutgoingReset>()},
      {"reset_leaves_interfaces_on", "", "leaves its outgoing interfaces on in a reset",
       mutant<ResetLeavesInterfacesOn>()},
      {"keeps_all_without_supply", "", "goes on after the supply was away as if nothing had been",
       mutant<KeepsAllWithoutSupply>()},
      {"ignores_words_with_reserved_bits", "", "ignores a control word with a reserved bit",
       mutant<IgnoresWordsWithReservedBits>()},
      {"remote_interface_stays_open", "", "ignores the order to switch OUT1 off",
       without_control(&Rules::control_remote_off)},
      {"branch_interface_stays_open", "", "ignores the order to switch OUT2 off",
       without_control(&Rules::control_local_off)},
      {"interface_switches_inside_cycle", "MS20", "switches its interfaces before the ID cycle has ended",
       mutant<InterfaceSwitchesInsideCycle>()},
      {"reserved_control_bit_closes_remote", "", "takes a reserved bit of the control word for OUT1 off",
       with_rules<interbus::Slave>([](Rules& rules) { rules.control_remote_off |= 0x0100; })},
      {"ignores_outgoing_reset", "", "ignores the order to reset the outgoing bus",
       without_control(&Rules::control_reset)},
      {"outgoing_reset_clears_outputs", "", "sets its own outputs to 0 when it resets the outgoing bus",
       mutant<OutgoingResetClearsOutputs>()},
      {"switches_with_the_bridge", "", "changes the ring as soon as the bridge in the plug changes",
       mutant<SwitchesWithTheBridge>()},
      {"ignores_the_bridge", "", "takes the next device for present whatever the bridge says",
       mutant<IgnoresTheBridge>()},
      {"peripheral_fault_not_told", "", "keeps a peripheral fault to itself",
       mutant<PeripheralFaultNotTold>()},
      {"peripheral_fault_marks_data_cycles", "", "marks the status word of data cycles at a peripheral fault",
       mutant<PeripheralFaultMarksDataCycles>()},
      {"messages_confused", "", "reports a reconfiguration as a peripheral fault and the reverse",
       with_rules<interbus::Slave>(
           [](Rules& rules) { std::swap(rules.message_reconfiguration, rules.message_peripheral_fault); })},
      {"message_bits_hard_coded", "", "reports by the usual message bits whatever the settings say",
       with_rules<interbus::Slave>([](Rules& rules) {
         rules.message_check_error = Rules{}.message_check_error;
         rules.message_peripheral_fault = Rules{}.message_peripheral_fault;
       })},
      {"tells_errors_of_others", "", "reports a check error when another station has marked the cycle",
       mutant<TellsErrorsOfOthers>()},
      {"message_cleared_by_marked_id_cycle", "", "clears its messages by an ID cycle that is marked",
       mutant<MessageClearedByMarkedIdCycle>()},
      {"message_cleared_by_data_cycle", "", "clears the message of a check error by a good data cycle",
       mutant<MessageClearedByDataCycle>()},
      {"message_never_cleared", "MS19", "keeps the message of a check error after it was read",
       mutant<MessageNeverCleared>()},
      {"message_without_error", "MS19", "sets the message of a check error by each data cycle",
       mutant<MessageWithoutError>()},
      {"tells_no_check_error", "", "does not report check errors in ID cycles", mutant<TellsNoCheckError>()},
  };
}

// Each has one coding as usual, whatever its setting says.
std::vector<SlaveRow> slave_coding_rows() {
  std::vector<SlaveRow> rows;
  for (const OtherCoding& coding : other_codings()) {
    if (coding.does.empty() || std::ranges::find(rows, coding.mutant, &SlaveRow::name) != rows.end())
      continue;
    rows.push_back({coding.mutant, "", coding.does, with_rules<interbus::Slave>(coding.keep)});
  }
  return rows;
}

}  // namespace

const SlaveMutants& slave_mutants() {
  static const SlaveMutants table("slave", {slave_check_rows, slave_telegram_rows, slave_register_rows,
                                            slave_management_rows, slave_coding_rows});
  return table;
}

}  // namespace fieldproof::conformance
