#include "conformance/fieldbus_dll/ff_reasons.hpp"

#include <array>

#include "conformance/fieldbus_dll/link_reasons.hpp"

namespace fieldproof::conformance {
namespace {

constexpr auto kReasonsOfFfDevice = link_reasons::with_those_of_the_line(std::array{
    ReasonRule{
        "answers_too_early",
        "A device begins a DLPDU only after V(MID), `inter_pdu_delay_octets`, of silence, counted from "
        "the end of whatever was on the line last, faulty frames included."},
    ReasonRule{"answers_too_late",
               "PR, DT3 and SR begin within V(MRD) x V(ST) after what they answer, else never; under a token "
               "each DLPDU begins as soon as V(MID) of silence has passed."},
    ReasonRule{"speaks_unasked",
               "A device says one PR to a PN, one DT3 or SR to a CD, and uses a PT of its node; any DLPDU in "
               "between ends that answer, one of a scheduler the token. Before its activation, as after each "
               "supply, it answers PNs only."},
    ReasonRule{
        "dlpdu_wrong",
        "A PN is answered by PR with the own node, a CD for a buffer never written since the supply "
        "came by SR with F and 1, for another address of the node by SR with F and 0; DT1s go from the "
        "own node to where the user submitted."},
    ReasonRule{
        "published_wrong",
        "A CD for a written buffer is answered by DT3 with F, the priority of the CD, `writes` modulo "
        "256 since the supply came and the octets of that write, whole; a write before the reply begins "
        "may be in it or in the next one."},
    ReasonRule{
        "longer_than_the_token",
        "Each DT1, and RT as well, ends within the duration after the end of the PT; what does not fit "
        "waits for another token, and where not even RT fits the token ends in silence."},
    ReasonRule{"unexpected_dlpdu", "Under a token a device sends nothing but DT1s and RT."},
    ReasonRule{"sends_other_data",
               "Under a PT go DT1s of its priority at least, the urgent ones first and those of one priority "
               "in their order, each once, to the address submitted, from selector 01 of the node. What was "
               "lost with the supply is never sent."},
    ReasonRule{"returned_with_data",
               "With `returns_with_last_data` 0 no DT1 has F: an RT after the last one returns the token."},
    ReasonRule{
        "data_held_back",
        "A token is returned only when nothing of its priority at least waits or the next DT1 does not "
        "end within its duration; what is submitted until V(MID) of silence has passed goes under this "
        "token, too."},
    ReasonRule{"last_without_final",
               "With `returns_with_last_data` 1 the DT1 after which nothing of the token's priority at least "
               "is there, or nothing more fits within its duration, has F and so returns the token."},
    ReasonRule{"no_answer",
               "A PN for its node, activated or not, and once activated a CD for any address of its node are "
               "answered within V(MRD) x V(ST); only a DLPDU that comes before ends the wait, a faulty frame "
               "does not."},
    ReasonRule{
        "token_not_returned",
        "An activated device returns its token by F in the last DT1, or by RT, as soon as nothing more "
        "may be sent or fits, unless a DLPDU of a scheduler ended it or not even RT fits within the "
        "duration."},
    ReasonRule{
        "data_refused",
        "A submit of priority 1 to 3 with at most `most_data` of that priority, whatever its "
        "destination, and a write of a `published` buffer with at most `most_data_3` octets are taken, "
        "activated or not."},
    ReasonRule{"data_too_long_taken",
               "A submit with more octets than its priority carries or another priority than 1 to 3, a write "
               "of more than `most_data_3` octets or of a buffer that is not `published` are refused, and "
               "nothing of them is kept."},
    ReasonRule{"unknown_request_taken",
               "A request that is not in the table of the user's octets is refused within the call; a basic "
               "device refuses `03`, too."},
    ReasonRule{"frame_length_wrong", link_reasons::kPreamble},
    ReasonRule{
        "not_delivered",
        "The user is given each DT1 for its node or FFFF, but those between entities, and each DT3 of a "
        "`subscribed` address, also before activation, event 0 at the first activation; DT1s with long "
        "addresses if supported."},
    ReasonRule{
        "delivered_unasked",
        "The user is given nothing that is for other nodes, not `subscribed`, between entities, faulty "
        "or no DLPDU, no DT1 with long addresses where `supports_long_addresses` is 0, nothing twice, "
        "and event 0 once for a supply."},
    ReasonRule{
        "delivered_otherwise",
        "What the user is given is the DLPDU as it was on the line: its priority, addresses, number of "
        "writes and octets, in the order in which they came, with event 0 where the activation came."},
    ReasonRule{
        "told_otherwise",
        "Whatever the user is given was sent to it: each DT1 and each published DT3 once, in the order "
        "in which it came, with the addresses, priority or number of writes, and octets as on the line."}});

}  // namespace

std::span<const ReasonRule> ff_reasons() {
  return kReasonsOfFfDevice;
}

}  // namespace fieldproof::conformance
