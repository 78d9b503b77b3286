#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "conformance/sequence.hpp"
#include "harness/field/field.hpp"
#include "harness/field/settings.hpp"

// Which settings a sequence may begin with, of the Field table of a role; and how chosen ones become those of
// a sequence.
namespace fieldproof::conformance {

// What sequences can do of the range of a setting.
struct SettingBound {
  std::string_view name;
  field::Range range;
};

// Whether a text means the setting of that name: the name, or its beginning and a star, "code_*".
bool means_setting(std::string_view text, std::string_view name);

// Each number, truth, choice and duration of the table, from end to end of its range; `object` is what the
// bench gives when nothing is said. Lists and custom members are the bench's to fill. `fixed`: what the
// tester rests on, names or their beginnings; `bounds`: ranges that are narrower here.
std::vector<SequenceSetting> sequence_settings(const field::AnyTable& table, const void* object,
                                               std::span<const std::string_view> fixed = {},
                                               std::span<const SettingBound> bounds = {});

// Those of the elements of a list of a fixed size, where an element is one number: "targets_0".
std::vector<SequenceSetting> settings_of_elements(const field::AnyTable& table, const void* object,
                                                  std::string_view list);

// The objection of what throws kernel::Error(configuration) for settings that cannot be judged.
SettingsObjection objection_of(std::function<void(const field::Settings&)> expect);
template <typename T>
SettingsObjection objection_of(const field::Table<T>& table, T configuration, void (*expect)(const T&)) {
  return objection_of([&table, configuration, expect](const field::Settings& settings) {
    T given = configuration;
    field::take_settings(table, settings, given);
    expect(given);
  });
}

struct SettingChoice {
  std::size_t which = 0;  // of the vocabulary
  std::int64_t value = 0;
};
// In the order of the vocabulary, each once (the first), none as the bench has it anyway; without the last
// ones as long as the role objects.
field::Settings settings_of(std::span<const SettingChoice> chosen, const SequenceVocabulary& vocabulary);

}  // namespace fieldproof::conformance
