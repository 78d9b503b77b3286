#pragma once

#include <nlohmann/json_fwd.hpp>

#include "emc/generator.hpp"
#include "emc/profile.hpp"
#include "harness/config/document.hpp"

// Bursts as files say them: { "level": 3, "repetition": "5kHz", "polarity": "+", "profile": "A" }, in plans
// of faults and in stored tests.
namespace fieldproof::emc {

struct PlannedBursts {
  BurstSettings settings;
  Profile profile = Profile::named("A");
};

PlannedBursts read_bursts(const config::Value& value);
// Without what is as it would be anyway.
nlohmann::ordered_json json_of(const PlannedBursts& bursts);

}  // namespace fieldproof::emc
