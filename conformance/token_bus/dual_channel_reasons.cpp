#include "conformance/token_bus/dual_channel_reasons.hpp"

#include <array>

namespace fieldproof::conformance {
namespace {

constexpr std::array kReasonsOfDualChannel{
    // Towards the channels.
    ReasonRule{"request_other",
               "Each symbol and each command of the MAC goes to both channels as it is, whatever is known of "
               "them, and nothing else does; a loss of supply takes what was on its way."},
    ReasonRule{"sent_too_late",
               "Each symbol and each command of the MAC goes to both channels within delay_symbols."},
    ReasonRule{"channels_apart", "A request begins on both channels at most skew_symbols apart."},
    // Towards the MAC.
    ReasonRule{"indication_other",
               "Of a transmission one channel is indicated, from start delimiter to end: the preferred one "
               "if its delimiter comes at most skew_symbols after the other's, else the other one. Outside "
               "of transmissions it is the preferred one."},
    ReasonRule{"indicated_too_late",
               "A symbol is indicated within delay_symbols + skew_symbols + 8 MAC symbols, in a transmission "
               "and outside of one."},
    ReasonRule{"indicated_at_another_rate",
               "Each symbol is indicated for as long as it lasted on its channel, whatever the clock of that "
               "channel."},
    // Towards the management.
    ReasonRule{"report_other",
               "Reported are no start delimiter, or bad_signal on it alone, within a slot time after the "
               "other channel's, and errors_in_a_row spoiled on it alone; no further fault until "
               "clean_in_a_row were clean, which is reported, too."},
    ReasonRule{"reported_too_late",
               "A fault, or that a channel is clean again, is reported within the delay of an indication "
               "after what it follows from: delay_symbols + skew_symbols + 8."},
    // Of each side.
    ReasonRule{
        "transmissions_overlap",
        "Each level of a port is driven once: a piece begins when the one before has ended, or later."},
    ReasonRule{
        "station_babbles",
        "What is driven on a port are units of four levels, one MAC symbol each, one after the other."},
};

}  // namespace

std::span<const ReasonRule> dual_channel_reasons() {
  return kReasonsOfDualChannel;
}

}  // namespace fieldproof::conformance
