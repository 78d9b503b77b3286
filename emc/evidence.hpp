// What a performance criterion rests on, and what a longer run could still show.
//
// Bounds are one-sided, 95 %, by Clopper and Pearson: of the bursts for what one burst brings about, of the
// exchanges whose data differed for wrong data. They take bursts, and exchanges, for independent of each
// other, under conditions as they were in the run; they say nothing about another level or another line.
#pragma once

#include <optional>
#include <string>

#include "emc/immunity.hpp"

namespace fieldproof::emc {

struct Evidence {
  std::string text;  // "446 exchanges rejected in 200 bursts"; empty where nothing was disturbed by bursts
  // The share of bursts that may bring a worse criterion than A, and that may bring C; none: it came.
  std::optional<double> worse_than_a{};
  std::optional<double> c{};
  // The share of exchanges whose data differ that may be accepted wrong; none: it came.
  std::optional<double> d{};
};

Evidence evidence_of(const ImmunityResult& result);

// "a longer run could still show C in up to 1.5 % of bursts ..."; empty for D, and without bursts.
std::string longer_run(const Evidence& evidence);

// How many of the exchanges whose data differed may pass unseen, in words; `exchange` is one of them.
std::string undetected_text(const network::ErrorStatistics& counts, std::string_view exchange);

}  // namespace fieldproof::emc
