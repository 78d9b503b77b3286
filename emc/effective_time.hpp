#pragma once

#include <cstdint>
#include <span>

#include "emc/coupling.hpp"
#include "emc/generator.hpp"
#include "emc/random_flips.hpp"
#include "harness/kernel/time.hpp"
#include "harness/line/sampling.hpp"

// The closed forms that bursts on a line are held against: how much of a wrong time a receiver's sampling
// sees, and what flip rates follow for random data.
namespace fieldproof::emc {

// Of all phases of a bit, how long the wrong intervals make the receiver sample the bit wrongly. For one
// interval tau and a single sample it is tau; for the majority of three, D = a sixteenth of a bit apart, it
// is 0 up to D, 2 * (tau - D) up to 2 * D, and tau from there on.
kernel::Duration effective_time(std::span<const Interval> wrong, line::Sampling sampling,
                                std::int64_t bit_rate);

// Flips that a pulse on a busy line causes on average, both levels equally likely: for each level its
// effective time over two bit times.
double flips_per_pulse(const WrongOutput& wrong, line::Sampling sampling, std::int64_t bit_rate);

// The Gilbert-Elliott channel with the mean burst, the mean gap and the mean flip rate of nominal bursts on a
// line. What it does not have: the pitch of the pulses, the length of the burst. Where a burst is shorter
// than a bit, or flips more than once in it, the probability is 1.
GilbertElliott fitted_gilbert_elliott(double flips_per_pulse, Repetition repetition, std::int64_t bit_rate);

}  // namespace fieldproof::emc
