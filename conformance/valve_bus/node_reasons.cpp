#include "conformance/valve_bus/node_reasons.hpp"

#include <array>

namespace fieldproof::conformance {
namespace {

constexpr std::array kReasonsOfNode{
    // Its valves.
    ReasonRule{"moves_without_command",
               "Valves move only by a right write to the node's ID, not before its last stop bit, or off "
               "once loss_limit has passed since power-up or the last right command to it, a read as well. "
               "No other frame moves them."},
    ReasonRule{"valves_wrong",
               "Valves stand as the last right write says, bit 0 of DATA0 the first, DATA1 on the second "
               "board if there is one. All that change do so within 1 us; from power-up and loss_limit on "
               "they are off until a write."},
    ReasonRule{"write_not_taken",
               "Five octets to the node's ID with COMMAND 0 and a right BCC, gaps of up to 1.5 characters, "
               "are taken after 3.5 characters of silence, whatever is sent before or then. loss_limit "
               "without a right command: the valves go off."},
    ReasonRule{"valves_too_late",
               "Valves move at most 2 ms (two characters and two bits where that is longer) after the 3.5 "
               "characters of silence that end a write."},
    ReasonRule{"acts_without_power", "Without supply a node drives nothing and moves no valve."},
    // Whether it answers.
    ReasonRule{"answers_without_command",
               "Only a right read to the node's ID is answered, a write with answers_writes; nothing else, "
               "and nothing where the switches give no ID. A character that is over before the driver goes "
               "on cancels the answer."},
    ReasonRule{"no_answer",
               "Each right read to the node's ID is answered, with answers_writes each write, whatever came "
               "before; only a character that is over before the driver goes on cancels that."},
    ReasonRule{"answered_twice",
               "A command has one response, its driver on without a pause from the first start bit to the "
               "last stop bit; nothing follows it."},
    ReasonRule{"answer_too_early",
               "The first start bit of a response comes at least 3.5 characters after the last stop bit of "
               "the command."},
    ReasonRule{"answer_too_late",
               "The first start bit of a response comes at most 2 ms (two characters and two bits where that "
               "is longer) after the 3.5 characters of silence after the command."},
    // What it answers.
    ReasonRule{"answer_length_wrong",
               "A response has three octets, DATA0, DATA1 and BCC; one that has begun goes on to its end, "
               "whatever others drive into it."},
    ReasonRule{"answer_garbled",
               "Each character has a start bit, the data bits that characters says, with P1 even parity, and "
               "a stop bit of 1, all at bit_rate."},
    ReasonRule{"answer_data_wrong",
               "A response to a read has the limit switches of one instant, the first one in bit 0 of DATA0, "
               "and 0 in DATA1 with one board; one to a write has the octets that the write carried, with "
               "one board, too."},
    ReasonRule{"answer_check_wrong", "The BCC of a response is DATA0 ^ DATA1."},
    ReasonRule{"ninth_bit_wrong", "With P0 the ninth bit of each character is sent as 1."},
    ReasonRule{"gap_in_answer",
               "Inside a response at most 1.5 characters of silence stand between two characters."},
    // How it drives the line.
    ReasonRule{"driver_on_late", "The driver is on at least a bit before the first start bit of a response."},
    ReasonRule{"driver_not_released",
               "The driver is off at most two bits after the last stop bit of a response."},
    ReasonRule{"driver_held",
               "The driver is on for a response only, from a bit or more before its first start bit to at "
               "most two bits after its last stop bit."},
    ReasonRule{"transmissions_overlap",
               "A node begins to drive when what it drove before is over: its characters follow each other."},
    ReasonRule{"station_babbles",
               "A node drives one response for each command to it that is answered, and nothing else: no row "
               "of pulses or characters."},
};

}  // namespace

std::span<const ReasonRule> node_reasons() {
  return kReasonsOfNode;
}

}  // namespace fieldproof::conformance
