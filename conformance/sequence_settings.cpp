#include "conformance/sequence_settings.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "harness/field/boundaries.hpp"
#include "harness/field/walk.hpp"
#include "harness/kernel/check.hpp"
#include "harness/kernel/error.hpp"
#include "harness/kernel/time.hpp"

namespace fieldproof::conformance {
bool means_setting(std::string_view text, std::string_view name) {
  return text.ends_with('*') ? name.starts_with(text.substr(0, text.size() - 1)) : name == text;
}

namespace {

bool is_one_of(std::span<const std::string_view> names, std::string_view name) {
  return std::ranges::any_of(names, [&](std::string_view one) { return means_setting(one, name); });
}

// A little more than 16 bits of microseconds hold, 32 of nanoseconds, 16 of milliseconds, 32 of microseconds.
constexpr std::array<std::int64_t, 4> kBeyondTimers{
    65'537 * kernel::kMicrosecond.count(), 4'294'968 * kernel::kMicrosecond.count(),
    65'537 * kernel::kMillisecond.count(), 4'294'968 * kernel::kMillisecond.count()};

SequenceSetting setting_of(const field::Leaf& leaf, std::span<const SettingBound> bounds) {
  field::Row row = leaf.row;
  const auto bound = std::ranges::find(bounds, leaf.name, &SettingBound::name);
  if (bound != bounds.end()) row.about.range = bound->range;
  SequenceSetting setting{.name = leaf.name,
                          .row = &leaf.row,
                          .least = row.about.range.least,
                          .most = row.about.range.most,
                          .simple = leaf.number(),
                          .likely = field::boundaries_of(row, leaf.object).inside,
                          .is_likely_only = leaf.row.kind == field::Kind::choice};
  for (const std::int64_t time : kBeyondTimers) {
    const bool is_duration = leaf.row.kind == field::Kind::duration;
    if (is_duration && time > setting.least && time < setting.most) setting.likely.push_back(time);
  }
  std::erase(setting.likely, setting.simple);
  return setting;
}

}  // namespace

std::vector<SequenceSetting> sequence_settings(const field::AnyTable& table, const void* object,
                                               std::span<const std::string_view> fixed,
                                               std::span<const SettingBound> bounds) {
  std::vector<SequenceSetting> all;
  field::walk(table, object, [&](const field::Leaf& leaf) {
    const field::Kind kind = leaf.row.kind;
    const bool is_filled = kind == field::Kind::list || kind == field::Kind::custom;
    if (is_filled || is_one_of(fixed, leaf.name)) return;
    SequenceSetting setting = setting_of(leaf, bounds);
    if (setting.least < setting.most) all.push_back(std::move(setting));
  });
  return all;
}

std::vector<SequenceSetting> settings_of_elements(const field::AnyTable& table, const void* object,
                                                  std::string_view list) {
  std::vector<SequenceSetting> all;
  field::walk(table, object, [&](const field::Leaf& leaf) {
    if (leaf.name != list) return;
    const field::List& of = leaf.row.list;
    FIELDPROOF_CHECK(of.is_of_fixed_size && field::is_plain(*of.element), "an element is one number");
    const field::Row& row = of.element->rows.front();
    const void* const items = leaf.row.member(leaf.object);
    for (std::size_t n = 0; n < of.size(items); ++n) {
      const void* const item = of.at(items, n);
      SequenceSetting setting{.name = field::element_name(leaf, n, row.name),
                              .row = &row,
                              .least = row.about.range.least,
                              .most = row.about.range.most,
                              .simple = row.get(item),
                              .likely = field::boundaries_of(row, item).inside};
      std::erase(setting.likely, setting.simple);
      all.push_back(std::move(setting));
    }
  });
  return all;
}

SettingsObjection objection_of(std::function<void(const field::Settings&)> expect) {
  return [expect = std::move(expect)](const field::Settings& settings) -> std::optional<std::string> {
    try {
      expect(settings);
    } catch (const kernel::Error& error) {
      if (error.kind() != kernel::ErrorKind::configuration) throw;
      return error.what();
    }
    return std::nullopt;
  };
}

field::Settings settings_of(std::span<const SettingChoice> chosen, const SequenceVocabulary& vocabulary) {
  for (std::size_t count = chosen.size(); count > 0; --count) {
    field::Settings settings;
    for (std::size_t which = 0; which < vocabulary.settings.size(); ++which) {
      const auto first = std::ranges::find(chosen.first(count), which, &SettingChoice::which);
      const SequenceSetting& setting = vocabulary.settings[which];
      if (first != chosen.first(count).end() && first->value != setting.simple)
        settings.emplace_back(setting.name, first->value);
    }
    if (!vocabulary.objection_to(settings)) return settings;
  }
  return {};
}

}  // namespace fieldproof::conformance
