#include "conformance/valve_bus/host_reasons.hpp"

#include <array>

namespace fieldproof::conformance {
namespace {

constexpr std::array kReasonsOfHost{
    // What it sends.
    ReasonRule{
        "no_request",
        "Each command 0 or 1 of the PC to an ID of 1 to 99 is sent in its turn. A read, with answers_writes "
        "a write, has 3 attempts until a right response; with verifies_writes a read follows each write."},
    ReasonRule{
        "request_unasked",
        "Commands of the PC are sent once, and again only within 3 attempts without a right response. IDs of "
        "nobody, undefined commands, parts, what did not fit and what was open at power-up are not sent."},
    ReasonRule{"request_wrong",
               "Commands go in the order of the PC with the ID, COMMAND and data that it gave, repetitions "
               "alike, before the next one. With verifies_writes the read carries what was written and is "
               "sent before anything else."},
    ReasonRule{"no_refresh",
               "The last write to each node is sent again when 50 ms have passed since it began, in turns "
               "with other nodes and commands of the PC; a refresh that finds no silent line is due again a "
               "refresh later."},
    ReasonRule{"refresh_period_wrong",
               "From start bit to start bit of the writes to a node are 50 ms, within 10 %, counted anew "
               "from a write with new data; later only where it takes turns."},
    ReasonRule{"command_waits_for_refreshes",
               "Refreshes that are due take turns with commands of the PC: no row of refreshes goes in front "
               "of a command that waits."},
    // When it sends.
    ReasonRule{"time_out_too_short",
               "After a read, with answers_writes a write, without a response nothing is sent before the "
               "time-out: 3.5 characters, and 3 ms or three times a character and a bit where that is longer "
               "(judged from 95 %)."},
    ReasonRule{"time_out_too_long",
               "What nobody answers is repeated when the time-out is over: at most 105 % of it and a "
               "character and four bits after its last stop bit."},
    ReasonRule{"rest_too_short",
               "After the last attempt of a read, with answers_writes of a write, nothing is sent for the "
               "time-out and another 5 % of it (judged from 104 %)."},
    ReasonRule{"write_distance_too_short",
               "Without answers_writes, 3.5 characters and 1 ms of rest follow each write, a refresh as "
               "well, before the next first start bit."},
    ReasonRule{"period_jitters",
               "Reads that wait are sent as soon as each may be: where nodes that are read in turn answer "
               "alike, and nothing is refreshed, all turns last equally long."},
    // What its PC gets.
    ReasonRule{"indication_missing",
               "Each read of the PC brings its response, or error 2, 3 or 6 and then as old what the last "
               "one of that node gave, if any. What fails of a write, is refused, lost or in part is error "
               "0, 1 or 4 to 8."},
    ReasonRule{
        "indication_unasked",
        "Each answered read is reported once, a failed one once as old where there is something old, each "
        "error once. Stray or late frames, right acknowledgements and read backs as written bring nothing."},
    ReasonRule{"indication_wrong",
               "Reports come in the order of commands. A right response from 1.5 characters after its read "
               "up to the time-out is told as new; else error 2 (nothing came to the last attempt) or 3 "
               "(something else), then old data as old."},
    ReasonRule{"error_late",
               "Error 2 is reported when the time-out of the last attempt is over: at most 105 % "
               "of it and a character and four bits after the last stop bit."},
    ReasonRule{"fifo_wrong",
               "Item 3 is the room of the FIFO of 512 octets, less all that wait, also of a part. A command "
               "that does not fit is lost as a whole and sets item 4 to 1 until power-up, which writes them "
               "anew as 512 and 0."},
    ReasonRule{"counters_wrong",
               "Since power-up, 100h, 200h, 300h and 400h + ID count attempts without a response, with a "
               "wrong one, frames after the time-out of a last attempt that nothing answered and before the "
               "next request, and repetitions."},
    // How a frame is made.
    ReasonRule{"frame_length_wrong",
               "Each frame of a host is a command of five octets: ID, COMMAND, DATA0, DATA1 and BCC."},
    ReasonRule{"frame_garbled",
               "Each character has a start bit, the data bits that characters says, with P1 even parity, and "
               "a stop bit of 1, at the bit rate of the DIP switches as they stood at power-up."},
    ReasonRule{"ninth_bit_wrong", "With P0 the ninth bit of each character is sent as 1."},
    ReasonRule{"check_wrong", "The BCC of a command is ID ^ COMMAND ^ DATA0 ^ DATA1."},
    ReasonRule{"gap_in_frame",
               "Inside a frame at most 1.5 characters of silence stand between two characters."},
    ReasonRule{"no_delimiter",
               "At least 3.5 characters of silence stand in front of each frame, after whatever was on the "
               "line last, from the nodes or from the host."},
    // How it drives the line.
    ReasonRule{"driver_on_late", "The driver is on at least a bit before the first start bit of a frame."},
    ReasonRule{"driver_released_early",
               "The driver stays on without a pause until the last stop bit of a frame is over."},
    ReasonRule{"driver_not_released",
               "The driver is off at most two bits after the last stop bit of a frame."},
    ReasonRule{"driver_held",
               "The driver is on for one frame at a time, from a bit or more before its first start bit to "
               "at most two bits after its last stop bit."},
    ReasonRule{"transmissions_overlap",
               "A host begins to drive when what it drove before is over: its characters and its frames "
               "follow each other."},
    ReasonRule{"station_babbles",
               "A host drives whole frames only, each in one piece with 3.5 characters of silence in front: "
               "no row of pulses or characters."},
};

}  // namespace

std::span<const ReasonRule> host_reasons() {
  return kReasonsOfHost;
}

}  // namespace fieldproof::conformance
