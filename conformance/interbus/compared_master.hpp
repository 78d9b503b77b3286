#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "conformance/interbus/master_cases.hpp"
#include "conformance/interbus/master_vocabulary.hpp"
#include "conformance/sequence_settings.hpp"

// Cases `interbus/master/compared/...`: families of sequences that a master and the reference get side by
// side.
namespace fieldproof::conformance::compared_master {

using MasterCommands = std::vector<SequenceCommand>;
using MasterFamily = std::vector<MasterCommands> (*)();
using ChangeRules = void (*)(interbus::Rules&);

// The vocabulary of `check`, without settings.
const SequenceVocabulary& words_of_master();
// A command with usual numbers but those given; a hand-made one may have numbers that are never drawn.
SequenceCommand order(MasterWord word, GivenNumbers given = {});
SequenceCommand cycles(std::int64_t count);
// Power on this ring, which is expected; its first and last words are copied.
SequenceCommand ring(std::int64_t number);

using MasterFamilies = std::vector<SequenceFamily<MasterBench>>;
// All of a family, each between what shows its effect; in a quick run so many of it, others with each seed.
MasterFamilies each_beside(MasterFamily family, std::size_t quick, ChangeRules change_rules = nullptr);
MasterCase compared(std::string_view id, std::string stimulus, std::vector<MustCatch> catches,
                    MasterFamilies families);

}  // namespace fieldproof::conformance::compared_master
