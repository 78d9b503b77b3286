#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "conformance/interbus/master_bench.hpp"
#include "conformance/test_case.hpp"

// Masters that misbehave: each is the reference with one decision overridden or with one number of its rules
// changed. The suite's cases say which of them they catch.
namespace fieldproof::conformance {

const std::vector<Mutant>& master_mutants();

// A mutant master by name, null for an unknown one.
MasterBench::MakeMaster mutant_master(std::string_view name);

// The same, made; throws kernel::Error(usage) with the nearest names for an unknown one.
std::unique_ptr<interbus::MasterDevice> make_master_mutant(
    std::string_view name, const interbus::MasterConfiguration& configuration);

// What makes the master of a URI: "ref" or "mutant:NAME". Throws kernel::Error(usage) for anything else,
// with the nearest names.
MasterBench::MakeMaster make_master(std::string_view uri);

}  // namespace fieldproof::conformance
