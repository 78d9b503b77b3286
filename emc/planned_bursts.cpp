#include "emc/planned_bursts.hpp"

#include <nlohmann/json.hpp>

namespace fieldproof::emc {
namespace {

using config::ObjectReader;
using config::Value;
using Json = nlohmann::ordered_json;

Level read_level(ObjectReader& object) {
  const auto level = object.optional("level");
  const auto volts = object.optional("volts");
  if (level.has_value() == volts.has_value()) {
    config::fail(object.value(),
                 "how strong the bursts are is not clear; write either \"level\" or \"volts\"");
  }
  if (volts) return Level::free(volts->as_number(Level::kLeastVolts, Level::kMostVolts));
  return Level::standard(PortKind::signal, level->as_integer<unsigned>(1, 4));
}

Profile read_profile(const Value& value) {
  return value.is_string() ? Profile::named(value) : Profile::read(value);
}

}  // namespace

PlannedBursts read_bursts(const Value& value) {
  return config::read_object(value, [](ObjectReader& object) {
    PlannedBursts bursts;
    bursts.settings.level = read_level(object);
    if (const auto repetition = object.optional("repetition")) {
      bursts.settings.repetition = repetition->as_choice<Repetition>(
          {{word_of(Repetition::khz_5), Repetition::khz_5},
           {word_of(Repetition::khz_100), Repetition::khz_100},
           {word_of(Repetition::khz_2_5_edition_1), Repetition::khz_2_5_edition_1},
           {text_of(Repetition::khz_5), Repetition::khz_5},
           {text_of(Repetition::khz_100), Repetition::khz_100},
           {text_of(Repetition::khz_2_5_edition_1), Repetition::khz_2_5_edition_1}});
    }
    if (const auto polarity = object.optional("polarity")) {
      bursts.settings.polarity =
          polarity->as_choice<Polarity>({{word_of(Polarity::positive), Polarity::positive},
                                         {word_of(Polarity::negative), Polarity::negative}});
    }
    if (const auto first = object.optional("first_burst")) {
      bursts.settings.first_burst = first->as_duration({}, kernel::kSecond);
    }
    if (const auto profile = object.optional("profile")) bursts.profile = read_profile(*profile);
    return bursts;
  });
}

Json json_of(const PlannedBursts& bursts) {
  const BurstSettings usual;
  Json json = Json::object();
  if (const unsigned number = bursts.settings.level.number(); number != 0) {
    json["level"] = number;
  } else {
    json["volts"] = bursts.settings.level.open_circuit_volts();
  }
  if (bursts.settings.repetition != usual.repetition) {
    json["repetition"] = word_of(bursts.settings.repetition);
  }
  if (bursts.settings.polarity != usual.polarity) json["polarity"] = word_of(bursts.settings.polarity);
  if (bursts.settings.first_burst) json["first_burst"] = kernel::describe(*bursts.settings.first_burst);
  if (bursts.profile.name != "A") json["profile"] = Json::parse(json_text(bursts.profile));
  return json;
}

}  // namespace fieldproof::emc
