#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "harness/config/document.hpp"
#include "harness/fault/plan.hpp"
#include "harness/line/telegram.hpp"

// Fault plans as JSON files (plan.schema.json describes them; comments are allowed). Reading is strict: what
// is wrong throws kernel::Error(configuration) with file, line, JSON pointer and what would be right.
//
//   { "rules": [ { "name": "third data cycle, FCS of slave 2",
//                  "when": { "receiver": "slave@2/in", "frame": "data_cycle", "frame_number": 3,
//                            "field": "fcs", "bit": 0 },
//                  "effect": { "flip": {} },
//                  "times": 1 } ],
//     "disturbances": [ { "receiver": "master/in", "from": "100 ms",
//                         "bursts": { "level": 3, "repetition": "5kHz" } } ] }
//
// The canonical text of a plan has every member in one order and no member that is as it would be anyway; two
// plans that say the same in the same order have the same text and the same hash, however their files were
// written. Reading the canonical text gives the plan again.
namespace fieldproof::fault {

inline constexpr std::size_t kMostDisturbances = 2'000;  // of a plan

struct PlanReading {
  // How an inserted telegram is written as levels; without it a plan that inserts one is refused.
  const line::TelegramCode* telegrams = nullptr;
  // What a disturbance can be; a plan that names another one is refused.
  std::span<const DisturbanceKind> disturbances{};
};

// The value is the whole plan: the root of a file, or a member of a larger one.
Plan read_plan(const config::Value& value, const PlanReading& reading = {});
Plan load_plan(const std::filesystem::path& path, const PlanReading& reading = {});

// Windows that begin before the start of a run have no form in a file; only tests write such rules.
std::string canonical_text(const Plan& plan);
std::uint64_t hash_of(const Plan& plan);

}  // namespace fieldproof::fault
