#pragma once

#include <vector>

#include "harness/fault/disturbance.hpp"

// What a fault plan can put on a line beside its declared faults:
//
//   "bursts":           { "level": 3, "repetition": "5kHz", "polarity": "+", "profile": "A" }
//   "binary_symmetric": { "flip_probability": 1e-4 }
//   "gilbert_elliott":  { "to_bad": 1e-5, "to_good": 1e-3, "good_flip": 0, "bad_flip": 0.1 }
//   "gilbert_elliott":  { "fitted_to": { "level": 3 } }
//   "flipped_bits":     [ { "transmission": 0, "bits": [5, 6] } ]
//   "flipped_levels":   [ { "transmission": 0, "levels": [5] } ]      (half bits of Manchester code)
//
// Bursts: one generator for all receivers of the disturbance, on from the begin of its window to the end,
// with the tolerances that it draws. The first burst comes anywhere within a burst period, or `first_burst`
// after the begin of the window. `volts` in place of `level` is level X. A profile is a built-in one by its
// name, or an object as in a profile file. Receivers are not declared, so every transmission that is hit
// reaches the receiver with its wrong times in it, and the receiver itself samples.
//
// The textbooks' channels draw for each receiver by itself, and flip bits of the receiver's bit rate, also
// where bursts have divided them. `fitted_to` takes mean burst, mean gap and mean flip rate of these bursts
// for a receiver with the majority of three (see fitted_gilbert_elliott). What arrives at a receiver in the
// window counts from 0 as a transmission: what a rule drops does not, what it repeats does. Positions that do
// not come do nothing.
namespace fieldproof::emc {

const std::vector<fault::DisturbanceKind>& plan_disturbances();

}  // namespace fieldproof::emc
