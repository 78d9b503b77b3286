#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "emc/coupling.hpp"
#include "emc/generator.hpp"
#include "emc/profile.hpp"
#include "harness/fault/stress.hpp"
#include "harness/kernel/computed_once.hpp"

// Bursts of IEC 61000-4-4 at receivers that are not declared: every transmission that is hit reaches the
// receiver with its wrong times at the fine rate, and the receiver itself samples. As stresses for test cases
// each channel has one burst, that begins where the case wants it, with the tolerances of a run of its own.
//
// The response of the line is computed when the first channel is made.
namespace fieldproof::emc {

// When the output of a receiver is wrong under these bursts: the same at all receivers.
std::shared_ptr<kernel::ComputedOnce<WrongOutput>> wrong_output_of(const Profile& profile,
                                                                   const BurstSettings& settings);

using MakeBursts = std::function<std::unique_ptr<fault::Channel>(const fault::StressPlace&)>;

// The bursts of a generator that runs from the begin of a place on. At receivers with equal streams they are
// those of one generator.
MakeBursts lasting_bursts(const Profile& profile, const BurstSettings& settings);

std::vector<fault::Stress> burst_stresses(const Profile& profile, std::span<const Level> levels);

// What the catalogue of test cases uses: profile A, in which a receiver is hit, at the two highest levels of
// a signal port, 5 and 100 kHz, both polarities.
std::vector<fault::Stress> catalogue_stresses();

// The same for lines of IEC 61158-2, by their bit rates: profile E2, in which the weakest signal of 31.25
// kbit/s is hit, and F for 1 Mbit/s.
std::map<std::int64_t, std::vector<fault::Stress>> catalogue_link_stresses();

}  // namespace fieldproof::emc
