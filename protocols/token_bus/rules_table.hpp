#pragma once

#include "harness/field/field.hpp"
#include "protocols/token_bus/rules.hpp"

// Every number of the token bus with its unit, range, source and standing.
namespace fieldproof::token_bus {

extern const field::Table<Rules> kRulesTable;
// Of these, the ones that a file of a ring may give.
extern const field::Table<Rules> kRulesInARingFile;

inline constexpr std::string_view kSourcePaper =
    "Lee, Moon, Moon, Kwon, Lee and Park, token bus on IEEE 802.3";
inline constexpr std::string_view kSourceStandard = "IEEE 802.4";
inline constexpr std::string_view kSourceMemory = "IEEE 802.4, from memory";
inline constexpr std::string_view kSourceController = "MC68824 token bus controller, user's manual";
inline constexpr std::string_view kSourceMib = "RFC 1230, IEEE 802.4 token bus MIB";
inline constexpr std::string_view kSourceOwn = "this project's choice";

}  // namespace fieldproof::token_bus
