#include "conformance/fieldbus_dll/ff_las_reasons.hpp"

#include <array>

#include "conformance/fieldbus_dll/link_reasons.hpp"

namespace fieldproof::conformance {
namespace {

constexpr auto kReasonsOfFfLas = link_reasons::with_those_of_the_line(std::array{
    ReasonRule{
        "line_left_silent",
        "The scheduler's link is never silent for V(ST) x 16: when nothing else has time it sends IDLE "
        "after V(ST) x 8 of silence, unless that has no time before an item, which then ends the "
        "silence."},
    ReasonRule{"compelled_late",
               "The item that is due goes before all else, as a CD or as a DT3 of an own buffer: at its "
               "instant, or when the line is free, at most V(MSO) later."},
    ReasonRule{"compelled_early",
               "No item is sent before its instant: `at` after a multiple of `schedule_macrocycle` in link "
               "time."},
    ReasonRule{
        "compelled_wrong",
        "A CD has the address and the priority of the item whose turn it is, and no F; the items come "
        "in their order in each macrocycle, and those whose instants passed before the link was claimed "
        "or taken are left."},
    ReasonRule{
        "not_compelled",
        "In each macrocycle each item of another node is compelled by a CD, at its instant or when the "
        "line is free."},
    ReasonRule{"own_buffer_not_published",
               "An item of the scheduler's own is sent as DT3 when it is due, if the buffer was written by "
               "then; only a buffer that was never written since the supply came is passed over."},
    ReasonRule{
        "own_buffer_wrong",
        "The DT3 of an own item has no F, the priority of the item, the number of all writes modulo 256 "
        "and the octets that were written last."},
    ReasonRule{
        "over_what_is_due",
        "What is begun before an item ends V(MSO) + V(MID) before its instant, an answer to a CT, too; "
        "V(MRD) x V(ST) and a PR belong to a PN, V(MRD) x V(ST) to a TL."},
    ReasonRule{
        "token_over_due",
        "A token ends V(MSO) + V(MID) before the instant of the next item: its duration is cut to that."},
    ReasonRule{
        "token_too_short",
        "A token lasts V(DMDT), `least_token_octets`, at least: where less is left before the next item "
        "there is no PT."},
    ReasonRule{"token_too_long", "A token of a circulation lasts V(DTHT), `token_holding_octets`, at most."},
    ReasonRule{"token_shorter_than_the_time",
               "A token lasts V(DTHT), or all that is left until V(MSO) + V(MID) before the next item where "
               "that is less."},
    ReasonRule{
        "does_not_wait",
        "An answer is awaited until nothing was on the line for V(MRD) x V(ST), a holder until RT, F or "
        "the end of its token; before that the scheduler says nothing, but for a TD to who asks by CT."},
    ReasonRule{"holder_not_stopped",
               "A holder is waited for until the end of its token or V(ST) longer; on a line that is busy "
               "then, the token is taken back when that is over, V(MID) later."},
    ReasonRule{"order_wrong",
               "A circulation passes one token to each live node in the order of addresses; none is passed "
               "over but one that was found during it, which takes part in the next one."},
    ReasonRule{
        "begin_not_marked",
        "The first PT of a circulation has F, also of the first circulation after a claim, a TL or the "
        "supply; those after it go on to higher addresses without F."},
    ReasonRule{
        "no_token",
        "Each live node gets one token in each circulation, until it has missed `misses_until_removal` "
        "in a row; what is not due in the schedule leaves time for that."},
    ReasonRule{"token_for_removed",
               "A PT goes to live nodes only: not to one that has missed `misses_until_removal` tokens in a "
               "row, nor to one that was neither found by a probe nor told as live."},
    ReasonRule{"priority_wrong",
               "All tokens of a circulation have one priority, urgent in the first; a rotation shorter than "
               "V(TTRT) leads to the next lower one, any other to the next higher one, in steps as "
               "`steers_by_three_steps` says."},
    ReasonRule{
        "no_probe",
        "After the tokens of a circulation comes one probe, PN; where there is no node to probe an IDLE "
        "is in its place."},
    ReasonRule{"second_probe",
               "A circulation ends with one probe: while nodes are live, tokens come before the next PN."},
    ReasonRule{"probes_unpolled",
               "Only nodes from `first_node` to `last_node` are probed, without the V(NUN) nodes from V(FUN) "
               "on."},
    ReasonRule{"probes_live_node",
               "A PN goes to no node that is live, and not to the scheduler's own address."},
    ReasonRule{"probes_out_of_order",
               "Probes go in ascending order from `first_node` to `last_node` and on from the beginning, "
               "`first_node` first; where they were outlasts standby, not the supply."},
    ReasonRule{
        "not_activated",
        "A node whose PR has answered its probe gets an activation, a DT1 of normal priority with `01` "
        "from selector 00 to selector 00, before the end of the second circulation after that."},
    ReasonRule{"live_list_not_told",
               "Within two circulations after a node was found or removed the live list is sent to FFFF."},
    ReasonRule{"live_list_wrong",
               "The live list has the bit of each live node, the scheduler's own included, and no other; its "
               "revision is one more for each change and begins with the same number at each supply."},
    ReasonRule{
        "time_not_told",
        "A TD goes before all but items: at once when it has become the scheduler, then whenever 0.9 x "
        "V(TDP) have passed since the begin of the last one that was due; answers to CT do not count."},
    ReasonRule{"time_told_too_often",
               "A TD is sent when it becomes the scheduler, when 0.9 x V(TDP) have passed since the last one "
               "that was due, and to who asks by CT, never else."},
    ReasonRule{"time_wrong",
               "TD has the link time, in 1/32 ms, at the end of its frame: it goes on from the last TD, its "
               "own or another scheduler's, and begins with the same number at each supply."},
    ReasonRule{"time_request_ignored",
               "A CT is answered by a TD V(MID) after it, also under a token, unless that TD has no time "
               "before an item."},
    ReasonRule{"idle_early",
               "Where there are nodes to probe an IDLE is sent only after V(ST) x 8 of silence."},
    ReasonRule{"data_not_sent",
               "In its turn in a circulation, at its own address, a scheduler sends all urgent data of its "
               "user that has time within V(DTHT) and before the next item, before the circulation goes on."},
    ReasonRule{"own_turn_too_long",
               "What a scheduler sends of its user in its turn ends within V(DTHT), as under a token of that "
               "duration."},
    ReasonRule{"sends_other_data",
               "In its turn a scheduler sends what its user submitted, the most urgent first and as it was "
               "submitted, without F, of the priority of the circulation at least; what was lost with the "
               "supply is never sent."},
    ReasonRule{
        "unexpected_dlpdu",
        "A scheduler sends CD, PT, PN, TD, IDLE, a TL that was ordered, a DT3 of an own buffer that is "
        "due, and DT1s: data of its user, activations of nodes that were found and the live list, "
        "nothing else."},
    ReasonRule{"answers_too_early",
               "A link master begins each DLPDU after V(MID), `inter_pdu_delay_octets`, of silence, as the "
               "scheduler and in standby, whatever was on the line before."},
    ReasonRule{
        "not_a_device",
        "In standby a link master that was the scheduler answers as an activated device: a PN for it by "
        "PR, a CD by DT3 with F, or by SR with F where nothing was written or no buffer is there, "
        "within V(MRD) x V(ST)."},
    ReasonRule{
        "two_schedulers",
        "A CD, PT, PN, TD, CL or TL of another scheduler puts a link master in standby at once: it then "
        "says only what a device is asked for, and CL with its own node when the line stays silent."},
    ReasonRule{"claim_early",
               "A link master in standby sends CL only when nothing was on the line for V(ST) x V(TN), V(TN) "
               "being its `node`; whatever is on the line begins that silence anew."},
    ReasonRule{"claim_late",
               "A link master in standby sends CL after V(ST) x V(TN) of silence, V(MICD), "
               "`claim_delay_octets`, later at the latest."},
    ReasonRule{
        "no_claim",
        "A link master in standby claims the link by CL when nothing was on the line for V(ST) x V(TN), "
        "at most V(MICD) later."},
    ReasonRule{
        "not_transferred",
        "An ordered TL names the node of the latest `03 node` and the version of its schedule; it goes "
        "after what is due, TD and what its entity sends, and before the circulation goes on, when it "
        "has time before an item."},
    ReasonRule{"order_refused",
               "A link master takes each `03 node`, in standby, too, where nothing comes of it."},
    ReasonRule{
        "event_wrong",
        "Each event is told once, in its order, with its node: 1 a CD without reply, 2 a missed, 3 a "
        "kept token, 4 found, 5 removed, 6 claimed, 7 taken by TL, 8 heir has sent, 9 heir was silent, "
        "10 left to another."},
    ReasonRule{"data_not_delivered",
               "The user of a link master is given the data of each DT1 for it or for FFFF, once and in the "
               "order in which they came, and nothing of what goes between entities."},
    ReasonRule{
        "told_otherwise",
        "Whatever the user is given was sent to it: each DT1 once, in the order in which it came, with "
        "the addresses, priority and octets as on the line, a published DT3 with its number of writes "
        "likewise."},
    ReasonRule{"data_refused",
               "A submit with at most `most_data` octets of its priority and a write of an own `published` "
               "buffer with at most `most_data_3` octets are taken, in standby, too."},
    ReasonRule{"data_too_long_taken",
               "A submit with more octets than its priority carries and a write of more than `most_data_3` "
               "octets are refused, and nothing of them is kept."},
    ReasonRule{"says_without_supply",
               "A link master sends nothing without supply, and forgets what was submitted, written and "
               "ordered."},
    ReasonRule{"dlpdu_wrong",
               "A DT1 goes from the link master's node: from selector 01 to the address that its user "
               "submitted, or from selector 00, its entity."}});

}  // namespace

std::span<const ReasonRule> ff_las_reasons() {
  return kReasonsOfFfLas;
}

}  // namespace fieldproof::conformance
