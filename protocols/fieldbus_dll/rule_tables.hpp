#pragma once

#include "harness/field/field.hpp"
#include "protocols/fieldbus_dll/ff_rules.hpp"
#include "protocols/fieldbus_dll/isa_rules.hpp"

// Every number of the link and of both profiles with its unit, range, source and standing.
namespace fieldproof::fieldbus_dll {

extern const field::Table<LinkRules> kLinkRulesTable;
extern const field::Table<FfRules> kFfRulesTable;
extern const field::Table<IsaRules> kIsaRulesTable;

inline constexpr std::string_view kSourceVendors =
    "vendors' tables of link parameters: inside of their range";
inline constexpr std::string_view kSourceMemory = "IEC 61158, from memory";
inline constexpr std::string_view kSourceOwn = "this project's choice";

inline constexpr field::Range kOctetRange{0, 0xFF};
inline constexpr field::Range kOctetDurations{0, 65'535};
inline constexpr std::size_t kMostListed = 1'000;

inline constexpr std::array kPriorities{
    field::Choice{"time-available", static_cast<std::int64_t>(Priority::time_available)},
    field::Choice{"normal", static_cast<std::int64_t>(Priority::normal)},
    field::Choice{"urgent", static_cast<std::int64_t>(Priority::urgent)}};

}  // namespace fieldproof::fieldbus_dll
