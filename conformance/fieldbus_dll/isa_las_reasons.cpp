#include "conformance/fieldbus_dll/isa_las_reasons.hpp"

#include <array>

#include "conformance/fieldbus_dll/link_reasons.hpp"

namespace fieldproof::conformance {
namespace {

constexpr auto kReasonsOfIsaLas = link_reasons::with_those_of_the_line(std::array{
    ReasonRule{
        "line_left_silent",
        "On a free link a scheduler begins within V(ST) an ordered TL, the item that is due or data of "
        "its user that fit before it; made scheduler by a TL it says something within V(RR), else an "
        "empty DU to everybody."},
    ReasonRule{
        "delegation_early",
        "A token is sent within V(ST) of the `at` of its item, or of the instant at which the link is "
        "free; the schedule begins with the supply or a TL for it, and anew `schedule_period` after it "
        "began."},
    ReasonRule{
        "delegation_wrong",
        "Beside data, CDs and TL a scheduler sends the tokens of its schedule, none left out, in their "
        "order from the first item after supply or a TL: ET or ES with node, least priority and "
        "duration of the item, own source."},
    ReasonRule{
        "talks_into_token",
        "While a token is out the scheduler only replies, until its holder's EE, V(RR) of silence after "
        "an ET, twice that after the holder's CD, V(RR) after an ES that is not used, else its duration "
        "+ `supervision_margin_octets`."},
    ReasonRule{"talks_into_transfer",
               "After its TL a scheduler says nothing for V(RR), or until the heir has sent a DLPDU; what "
               "others send is no sign of the heir, and on a busy line it waits until that is over."},
    ReasonRule{"talks_into_reply",
               "After a CD of its own a scheduler says nothing until the reply or another DLPDU has come, or "
               "V(RR) is over."},
    ReasonRule{"answers_too_early",
               "A link master begins each DLPDU after V(MID), `inter_pdu_delay_octets`, of silence, which "
               "counts from its supply at the soonest, whatever was on the line before."},
    ReasonRule{
        "speaks_unasked",
        "A link master is in standby once the heir of its TL has shown itself, or an ET, ES or TL of a "
        "lower address has come: it then says only what a basic station is asked for, until a TL for it."},
    ReasonRule{
        "no_reply",
        "A CD for a link master, also while its token is out or in standby, is answered by a DT within "
        "V(FD), `reply_forming_octets` after its end, unless it came in place of a reply; where no data "
        "is there the DT is empty."},
    ReasonRule{
        "reply_wrong",
        "A reply is a DT with F to who compelled, with the oldest of the most urgent data submitted by "
        "service 2 of the priority of the CD at least; without any it is empty and has the priority of "
        "the CD."},
    ReasonRule{
        "sends_other_data",
        "On a free link a scheduler sends its user's DUs and CDs as submitted, the oldest of the most "
        "urgent first, each once; an empty DU to everybody only after a TL for it, as its first. A lost "
        "supply takes all of it away."},
    ReasonRule{
        "own_data_over_due",
        "Data of its user ends when the next item is due at the latest, with V(MID) and an EE after it, "
        "a CD also with V(RR) and the longest DT of its priority; what does not fit waits, and so does "
        "all that comes after it."},
    ReasonRule{"transfer_unasked",
               "A TL is sent once for `03 node`, the latest of them; orders taken in standby, and those open "
               "when it leaves the link or loses its supply, lead to none."},
    ReasonRule{
        "transfer_wrong",
        "A TL goes to the node of the latest `03 node`, from the own address, with `schedule_version`, "
        "high octet first."},
    ReasonRule{
        "no_transfer",
        "An ordered TL comes first as soon as the link is free: no token out, no other TL, no reply to "
        "its own CD awaited."},
    ReasonRule{
        "order_refused",
        "A link master takes each `03 node`, in standby, too, where nothing comes of it, then or later."},
    ReasonRule{"order_without_node_taken",
               "`03` without a node is shorter than its row: it is refused, and nothing of it is kept."},
    ReasonRule{
        "data_refused",
        "Data, CDs and data for a CD with at most `most_data` octets of their priority are taken, while "
        "it is the scheduler and in standby."},
    ReasonRule{"data_too_long_taken",
               "Data with more octets than its priority carries is refused, and nothing of it is kept."},
    ReasonRule{"not_delivered",
               "The user is given each DU for the station or everybody, each DT for it, and events 0 to 8 as "
               "they happen: no reply, DLPDU in its place, token reclaimed, overrun, second scheduler, left, "
               "TL failed, done, link taken."},
    ReasonRule{"delivered_unasked",
               "The user is given nothing that is for others, faulty, no DLPDU or in place of a reply, and "
               "each event once: none where a token came back in time, in particular by an EE of its holder, "
               "whatever its destination and reason."},
    ReasonRule{"delivered_otherwise",
               "Data is given as it was on the line, and events with their node in the order in which they "
               "happen; event 2 where nothing came for V(RR) from who had the token, 3 where an ET was used "
               "twice or VC(UC) was over."},
    ReasonRule{
        "told_otherwise",
        "Whatever data the user is given was sent to it: each DU and DT once, in the order in which it "
        "came, with priority, addresses and octets as on the line."},
    ReasonRule{"says_without_supply",
               "A link master sends nothing without supply, and forgets what was submitted and ordered."},
    ReasonRule{"preamble_wrong", link_reasons::kPreamble},
    ReasonRule{"source_wrong", "Each DLPDU of a link master has its own address as the source."}});

}  // namespace

std::span<const ReasonRule> isa_las_reasons() {
  return kReasonsOfIsaLas;
}

}  // namespace fieldproof::conformance
