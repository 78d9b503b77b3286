#include "protocols/fieldbus_dll/ff_settings.hpp"

#include <array>

#include "protocols/fieldbus_dll/rule_tables.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

using field::list;
using field::part;
using field::row;

constexpr field::Unit kTicks{"ms", 32};
constexpr field::Range kAddresses{0, 0xFFFF'FFFF};
constexpr field::Range kTickRange{0, 0xFFFF'FFFF};

constexpr auto kItemRows = field::rows<FfScheduleItem>(
    row<&FfScheduleItem::at>({kTicks, kTickRange, "after the beginning of the macrocycle", kSourceOwn}),
    row<&FfScheduleItem::address>(
        {field::kHexadecimal, kAddresses, "the publisher that is compelled", kSourceOwn}),
    row<&FfScheduleItem::priority>({{}, {}, "of the CD", kSourceOwn, judge::Standing::own, kPriorities}));
constexpr field::Table<FfScheduleItem> kItems = field::table<FfScheduleItem>(kItemRows);

constexpr auto kScheduleRows = field::rows<FfSchedule>(
    row<&FfSchedule::version>({{}, {0, 0xFFFF}, "of the schedule", kSourceOwn}),
    row<&FfSchedule::macrocycle>(
        {kTicks, {1, 0xFFFF'FFFF}, "begins whenever link time is a multiple of it", kSourceOwn}),
    list<&FfSchedule::items>(kItems, kMostListed,
                             {{}, {}, "items in the order of their instants", kSourceOwn}));
constexpr field::Table<FfSchedule> kSchedule = field::table<FfSchedule>(kScheduleRows);

constexpr std::array kAddressRow{field::item<FfAddress>(
    {field::kHexadecimal, kAddresses, "an address: link << 16 | node << 8 | selector", kSourceOwn})};
constexpr field::Table<FfAddress> kAddress = field::table<FfAddress>(kAddressRow);
constexpr std::array kNodeRow{
    field::item<std::uint8_t>({field::kHexadecimal, kOctetRange, "a node", kSourceOwn})};
constexpr field::Table<std::uint8_t> kNode = field::table<std::uint8_t>(kNodeRow);

constexpr auto kRows = field::rows<FfConfiguration>(
    part<&FfConfiguration::rules>(kFfRulesTable),
    row<&FfConfiguration::node>({field::kHexadecimal, kOctetRange, "address of the station", kSourceOwn}),
    row<&FfConfiguration::supports_long_addresses>({{}, {}, "the station takes long addresses", kSourceOwn}),
    list<&FfConfiguration::published>(kAddress, kMostListed, {{}, {}, "buffers of this station", kSourceOwn}),
    list<&FfConfiguration::subscribed>(kAddress, kMostListed, {{}, {}, "buffers of others", kSourceOwn}),
    part<&FfConfiguration::schedule>(kSchedule, {}, "schedule_"),
    list<&FfConfiguration::live>(kNode, kMostListed,
                                 {{}, {}, "nodes that a link master knows when it begins", kSourceOwn}),
    row<&FfConfiguration::begins_as_scheduler>({{}, {}, "a link master begins as the LAS", kSourceOwn}));

}  // namespace

constexpr field::Table<FfConfiguration> kFfTable = field::table<FfConfiguration>(kRows);

field::Settings ff_settings(const FfConfiguration& configuration) {
  return field::settings_of(kFfTable, configuration);
}

FfConfiguration ff_configuration_of(const iut::CaseBegin& begin) {
  return field::taken_from(kFfTable, begin.settings);
}

}  // namespace fieldproof::fieldbus_dll
