#include "conformance/fieldbus_dll/isa_reasons.hpp"

#include <array>

#include "conformance/fieldbus_dll/link_reasons.hpp"

namespace fieldproof::conformance {
namespace {

constexpr auto kReasonsOfIsaDle = link_reasons::with_those_of_the_line(std::array{
    ReasonRule{
        "answers_too_early",
        "A station begins a DLPDU only after V(MID), `inter_pdu_delay_octets`, of silence, counted from "
        "the end of whatever was on the line last, faulty frames included."},
    ReasonRule{"answers_too_late",
               "Under a token a station goes on as soon as V(MID) of silence has passed: it is never silent "
               "for longer than V(RR), after which its token may be taken back."},
    ReasonRule{
        "speaks_unasked",
        "A station speaks under an ET or ES for it until its EE, and once for a CD for it; another "
        "DLPDU in place of its reply, and an ET, ES or TL of a scheduler, end its token; a lost supply "
        "ends all."},
    ReasonRule{"does_not_wait_for_reply",
               "After its CD a station says nothing until the reply or another DLPDU has come, or V(RR), "
               "`reply_wait_octets` from the end of the CD, is over."},
    ReasonRule{
        "waits_too_long_for_reply",
        "When V(RR) after its CD is over without a reply, a station goes on with its token at once, as "
        "it does after V(MID) otherwise; on a busy line when that is over."},
    ReasonRule{
        "does_not_wait_for_user",
        "Where item 16 + the priority of the CD reads 1, a compelled station waits until V(FD) after "
        "the end of the CD for data of that priority at least, then is silent: an empty DT answers only "
        "where it reads 0."},
    ReasonRule{
        "replies_too_late",
        "A reply begins within V(FD), `reply_forming_octets` after the end of the CD, or is not sent."},
    ReasonRule{"no_reply",
               "A CD for a station that holds no token and awaits no reply is answered by a DT within V(FD), "
               "an empty one where no data is there or being worked out; only a DLPDU that comes before ends "
               "that, no faulty frame."},
    ReasonRule{
        "reply_wrong",
        "A reply is a DT with F to who compelled, with the oldest of the most urgent data submitted by "
        "service 2 of the priority of the CD at least; without any it is empty and has the priority of "
        "the CD."},
    ReasonRule{"longer_than_the_token",
               "All that is sent under an ES, its EE as well, ends within the duration after the end of the "
               "ES; a token whose EE would pass that is returned by silence."},
    ReasonRule{"sends_two_frames", "Under an ET a station sends one frame, then EE with reason 2."},
    ReasonRule{
        "sends_other_data",
        "Under a token go DUs and CDs that were submitted with its priority at least, the oldest of the "
        "most urgent first, each once, as submitted and from the own address. What was lost with the "
        "supply is never sent."},
    ReasonRule{
        "sends_without_time",
        "Under an ES a frame is sent only where V(MID) and an EE after it still end within the "
        "duration, for a CD also V(RR) and the longest DT of its priority; else the token is returned."},
    ReasonRule{
        "data_held_back",
        "An ET is returned unused, and an ES at all, only where nothing of its priority at least waits "
        "or, under an ES, the next frame does not fit. What was submitted until V(MID) has passed "
        "counts; what fits exactly is sent."},
    ReasonRule{"end_wrong",
               "EE has F, goes to who gave the token and has reason 0 where nothing may be sent, 1 where the "
               "next frame has no time, 2 after the single frame of an ET."},
    ReasonRule{"token_not_returned",
               "An ET or ES is returned by EE when its frame is sent, or nothing more may be sent or fits, "
               "unless a scheduler's ET, ES or TL or a DLPDU in place of a reply ended it, or EE would pass "
               "the duration."},
    ReasonRule{"data_refused",
               "A DU or a CD without data to an address of a station, a DU to `everybody` and data for a CD, "
               "whatever their destination, are taken with at most `most_data` octets of their priority."},
    ReasonRule{
        "data_too_long_taken",
        "More octets than the priority carries, a CD with data, and a DU or CD to what is no address of "
        "a station, a CD to `everybody` included, are refused, and nothing of them is kept."},
    ReasonRule{"not_delivered",
               "The user is given each DU for the station or `everybody` and each DT for it, event 0 when "
               "V(RR) is over after its CD, and event 1 when another DLPDU came in place of the reply."},
    ReasonRule{
        "delivered_unasked",
        "The user is given nothing that is for others, faulty or no DLPDU, nothing that came in place "
        "of a reply, and nothing twice; events 0 and 1 come only where a reply to its CD was awaited."},
    ReasonRule{
        "delivered_otherwise",
        "What the user is given is the DLPDU as it was on the line, with priority, addresses and "
        "octets, in the order in which they came; event 0 names who was compelled, event 1 who sent in "
        "place of the reply."},
    ReasonRule{"source_wrong", "Each DLPDU of a station has its own address as the source."}});

}  // namespace

std::span<const ReasonRule> isa_reasons() {
  return kReasonsOfIsaDle;
}

}  // namespace fieldproof::conformance
