#include "protocols/fieldbus_dll/isa_settings.hpp"

#include <array>

#include "protocols/fieldbus_dll/rule_tables.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

using field::list;
using field::part;
using field::row;

constexpr field::Range kSpan = field::between({}, 3'600 * kernel::kSecond);
constexpr std::array kTokens{field::Choice{"ET", static_cast<std::int64_t>(IsaType::et)},
                             field::Choice{"ES", static_cast<std::int64_t>(IsaType::es)}};

constexpr auto kItemRows = field::rows<IsaScheduleItem>(
    row<&IsaScheduleItem::at>({field::kTime, kSpan, "after the beginning of the schedule", kSourceOwn}),
    row<&IsaScheduleItem::type>({{},
                                 {},
                                 "the token: ET for one frame, ES for a duration",
                                 kSourceOwn,
                                 judge::Standing::own,
                                 kTokens}),
    row<&IsaScheduleItem::node>({field::kHexadecimal, kOctetRange, "who gets the token", kSourceOwn}),
    row<&IsaScheduleItem::least>(
        {{}, {}, "the least priority that may be sent", kSourceOwn, judge::Standing::own, kPriorities}),
    row<&IsaScheduleItem::duration>(
        {field::kOctets, kOctetDurations, "octet durations of an ES", kSourceOwn}));
constexpr field::Table<IsaScheduleItem> kItems = field::table<IsaScheduleItem>(kItemRows);

constexpr auto kScheduleRows = field::rows<IsaSchedule>(
    row<&IsaSchedule::version>({{}, {0, 0xFFFF}, "of the schedule", kSourceOwn}),
    row<&IsaSchedule::period>(
        {field::kTime, kSpan, "after which it begins anew; 0: it is run once", kSourceOwn}),
    list<&IsaSchedule::items>(kItems, kMostListed,
                              {{}, {}, "tokens in the order of their instants", kSourceOwn}));
constexpr field::Table<IsaSchedule> kSchedule = field::table<IsaSchedule>(kScheduleRows);

constexpr auto kRows = field::rows<IsaConfiguration>(
    part<&IsaConfiguration::rules>(kIsaRulesTable),
    row<&IsaConfiguration::address>({field::kHexadecimal, kOctetRange, "address of the station", kSourceOwn}),
    part<&IsaConfiguration::schedule>(kSchedule, {}, "schedule_"),
    row<&IsaConfiguration::begins_as_scheduler>(
        {{}, {}, "a link master begins as the scheduler", kSourceOwn}));

}  // namespace

constexpr field::Table<IsaConfiguration> kIsaTable = field::table<IsaConfiguration>(kRows);

field::Settings isa_settings(const IsaConfiguration& configuration) {
  return field::settings_of(kIsaTable, configuration);
}

IsaConfiguration isa_configuration_of(const iut::CaseBegin& begin) {
  return field::taken_from(kIsaTable, begin.settings);
}

}  // namespace fieldproof::fieldbus_dll
