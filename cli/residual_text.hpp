// What `fieldproof residual` found, as a table for a person and as JSON
// (reports/schema/residual.schema.json).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "emc/residual/residual_error.hpp"
#include "emc/residual/residual_simulation.hpp"
#include "emc/residual/weight_distribution.hpp"
#include "harness/line/frame_check.hpp"

namespace fieldproof::cli {

struct ResidualPoint {
  double ber = 0;
  double probability = 0;
  double share_of_corrupted = 0;
  std::optional<double> proper_bound;  // none where no code word but zero exists
  double rate_per_hour = 0;
  std::optional<emc::CountedErrors> counted;
  std::optional<emc::SampledErrors> sampled;
};

struct Residual {
  const line::FrameCheckParameters* check = nullptr;
  unsigned bits = 0;
  std::optional<unsigned> hamming_distance;
  std::vector<emc::BigCount> words;  // by weight, from 0 on
  emc::WorstError worst;
  emc::WorstError worst_of_usual;  // up to kUsualBer
  std::uint64_t messages_per_hour = 0;
  std::uint64_t receivers = 0;
  std::uint64_t seed = 0;
  std::vector<ResidualPoint> points;
};

// The bit-error rate that safety is computed with unless a better one is proven.
constexpr double kUsualBer = 1e-2;

std::string residual_text(const Residual& residual);
std::string residual_json(const Residual& residual);

}  // namespace fieldproof::cli
