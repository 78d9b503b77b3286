#include "conformance/token_bus/station_reasons.hpp"

#include <array>

namespace fieldproof::conformance {
namespace {

constexpr std::array kReasonsOfStation{
    // What it drives, frame by frame.
    ReasonRule{"frame_missing",
               "What is due is sent: set_successor in a window for its address, the response to a request, "
               "data and then the token while it holds it, the next stage of a pass that fails, a claim "
               "after bus_idle_slots or lowest_bus_idle_slots."},
    ReasonRule{"frame_unasked",
               "A station sends only with the token, in a window or contest for its address (when it has "
               "left, in none), to a request when its user gave a response, or to claim a silent bus; "
               "offline, or without supply, it sends nothing."},
    ReasonRule{"frame_other",
               "With the token a station sends class 6, then 4, 2 and 0 while their times last, then a "
               "window that is due, then the token to its successor; each frame has the control, addresses "
               "and data that its state asks for."},
    ReasonRule{"begins_too_early",
               "response_gap_octets of silence come before each transmission, also after slot times that "
               "were waited (second window, contest, claim, noise); what a timer begins is at most an octet "
               "before its instant."},
    ReasonRule{
        "begins_too_late",
        "What answers or follows something begins within a slot time of it, or of the begin of its window; "
        "what a timer begins, such as a claim, at most response_gap_octets and an octet after its instant."},
    // What it draws.
    ReasonRule{"windows_not_drawn",
               "After the first response window each later one comes after max_inter_solicit_count tokens, "
               "the two low bits of that count drawn anew each time."},
    ReasonRule{"last_claim_not_drawn",
               "The last pass of a claim has a length of 0, 2, 4 or 6 slot times by a random pair of bits, "
               "drawn anew for each claim and not taken from the address."},
    // What its user gets, and may give.
    ReasonRule{
        "indication_missing",
        "Data to the station's address or to any group, received whole with the right check and E = 0, are "
        "reported to its user: also a response, a frame that costs the token, or one after a damaged frame."},
    ReasonRule{"indication_unasked",
               "Only data to the station's address or to a group are reported, each frame once; damaged "
               "frames, those too long or with E = 1, and those that end within blanking_symbols are not; "
               "offline nothing is."},
    ReasonRule{"indication_other",
               "The user is given the octets of each data frame as they were on the line, FC, both addresses "
               "and data without the check, in the order in which the frames came."},
    ReasonRule{
        "event_missing",
        "Each event is reported when it happens: joined with the first token, left, sole station, successor "
        "changed, pass failed, unexpected frame, response missing, duplicate address, faulty transmitter."},
    ReasonRule{
        "event_unasked",
        "Only events are reported, each once: sole station not again in each round, a first successor is no "
        "change, and the failure that reaches transmitter_fault_limit is faulty transmitter alone."},
    ReasonRule{"event_other",
               "Events come as they happen, each with whom it is about: joined the sender of the first "
               "token, successor changed the new one, unexpected frame its sender, response missing who was "
               "asked, all others the station itself."},
    ReasonRule{"data_refused",
               "Only a priority above 7, data that fit no frame, a request with response to a group, and "
               "data while the station is offline are refused; all other data are taken and wait."},
    ReasonRule{"data_taken_unasked",
               "Refused are a priority above 7, data that fit no frame of most_octets, a request with "
               "response to a group, and all data while the station is offline, as after a duplicate address "
               "or as faulty transmitter."},
    ReasonRule{"counter_wrong",
               "Each faulty reception since the start counts once, as the first that fits of non-silence, "
               "fragment, too long, E bit error, FCS error; what ends within blanking_symbols counts as "
               "none, and a loss of supply clears all."},
    // How each of its transmissions stands on the line.
    ReasonRule{"frame_malformed",
               "Each transmission is one frame: a preamble of whole octets of ones, a start delimiter, whole "
               "octets, and an end delimiter with I = 0 and E = 0, each symbol as two bits at phy_bit_rate."},
    ReasonRule{"check_wrong",
               "The last four octets of each frame are the FCS, the CRC-32/ISO-HDLC of FC to data, its "
               "lowest octet first."},
    ReasonRule{"preamble_short", "In front of each frame come at least preamble_octets octets of ones."},
    ReasonRule{"source_wrong",
               "The SA of each frame that a station sends is its own address, the lowest octet first, with "
               "as many octets as address_length says."},
    ReasonRule{"transmissions_overlap",
               "A station begins no transmission before its last one is over and response_gap_octets of "
               "silence have passed."},
    ReasonRule{"station_babbles",
               "Each transmission is a whole frame from preamble to end delimiter, and response_gap_octets "
               "of silence come before it; there is no row of shorter ones."},
    ReasonRule{"driver_held",
               "Each transmission is one frame with at most most_octets between its delimiters; after its "
               "end delimiter the station drives nothing for response_gap_octets at least."},
};

}  // namespace

std::span<const ReasonRule> station_reasons() {
  return kReasonsOfStation;
}

}  // namespace fieldproof::conformance
