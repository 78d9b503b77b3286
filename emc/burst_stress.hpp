#pragma once

#include <memory>
#include <span>
#include <vector>

#include "emc/generator.hpp"
#include "emc/profile.hpp"
#include "harness/fault/stress.hpp"

// Single bursts of IEC 61000-4-4 as stresses for test cases: each channel has one burst, that begins where
// the case wants it, with the tolerances of a run of its own. Receivers are not declared, so every
// transmission that is hit reaches the receiver with its wrong times at the fine rate, and the receiver
// itself samples.
//
// The response of the line is computed when the first channel is made.
namespace fieldproof::emc {

std::vector<fault::Stress> burst_stresses(const Profile& profile, std::span<const Level> levels);

// What the catalogue of test cases uses: profile A, in which a receiver is hit, at the two highest levels of
// a signal port, 5 and 100 kHz, both polarities.
std::vector<fault::Stress> catalogue_stresses();

}  // namespace fieldproof::emc
