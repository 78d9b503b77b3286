#include "conformance/interbus/declarations.hpp"

#include <fmt/format.h>

#include <array>

#include "harness/field/pics.hpp"
#include "harness/kernel/error.hpp"
#include "protocols/interbus/cycle_fields.hpp"
#include "protocols/interbus/network.hpp"
#include "protocols/interbus/slave_settings.hpp"

namespace fieldproof::conformance {
namespace {

using field::Choice;
using field::row;
using interbus::SlaveConfiguration;
using judge::Standing;

constexpr std::string_view kStation = "what the station has";

constexpr auto kDeclared =
    field::kNames<&SlaveConfiguration::id_code, &SlaveConfiguration::words, &SlaveConfiguration::has_branch>;
constexpr std::array kWhileReset{Choice{"held", 0}, Choice{"cleared", 1}};

constexpr auto kSlaveRows = field::rows<SlaveDeclaration>(
    field::part<&SlaveDeclaration::configuration>(interbus::kSlaveTable, kDeclared),
    row<&SlaveDeclaration::inputs>({{}, {}, "the slave has process data inputs", kStation}),
    row<&SlaveDeclaration::outputs>({{}, {}, "the slave has process data outputs", kStation}),
    row<&SlaveDeclaration::remote_interface>(
        {{}, {}, "there is an outgoing remote bus interface (OUT1)", kStation}),
    row<&SlaveDeclaration::reconfiguration_button>(
        {{}, {}, "a reconfiguration can be asked for at the station", kStation}),
    row<&SlaveDeclaration::peripheral_fault_input>(
        {{}, {}, "a peripheral fault can be reported to the station", kStation}),
    row<&SlaveDeclaration::any_length_code>(
        {{}, {}, "the station can be built with any register length", kStation}),
    row<&SlaveDeclaration::other_settings>(
        {{}, {}, "the station can be given another silence limit, frame check and message bits", kStation}),
    row<&SlaveDeclaration::outputs_while_outgoing_bus_is_reset>(
        {{},
         {},
         "what the outputs do while an outgoing bus is reset",
         kStation,
         Standing::own,
         kWhileReset}));
constexpr auto kSlave = field::table<SlaveDeclaration>(kSlaveRows);

constexpr std::array kBelowMinimum{Choice{"clipped", 0}, Choice{"refused", 1}};
constexpr std::array kAfterBusStop{Choice{"zero", 0}, Choice{"held", 1}};
constexpr std::array kAfterStop{Choice{"silent", 0}, Choice{"status_telegrams", 1}};

constexpr auto kMasterRows = field::rows<MasterDeclaration>(
    row<&MasterDeclaration::request_below_minimum>(
        {{},
         {},
         "what a master makes of a requested cycle time below the minimum",
         kStation,
         Standing::own,
         kBelowMinimum}),
    row<&MasterDeclaration::outputs_after_bus_stop>({{},
                                                     {},
                                                     "what the outputs of a master do when its ring is cut",
                                                     kStation,
                                                     Standing::own,
                                                     kAfterBusStop}),
    row<&MasterDeclaration::line_after_stop>({{},
                                              {},
                                              "what a master drives after it was stopped by command",
                                              kStation,
                                              Standing::own,
                                              kAfterStop}));
constexpr auto kMaster = field::table<MasterDeclaration>(kMasterRows);

constexpr std::string_view kIdCode = "id_code";
constexpr std::string_view kWords = "words";
constexpr unsigned kPlaceOfLengthCode = 8;
constexpr unsigned kLastLengthCode = 0x1F;
constexpr std::uint16_t kBothDirections = 0x03;

[[noreturn]] void refuse(const std::string& sentence) {
  throw kernel::Error(kernel::ErrorKind::configuration, "the PICS: " + sentence);
}

unsigned length_code(std::uint16_t id_code) {
  return id_code >> kPlaceOfLengthCode & kLastLengthCode;
}

std::uint16_t id_code_for(unsigned words, const interbus::Rules& rules) {
  const auto code = interbus::length_code_of(words, rules);
  if (!code) {
    refuse(
        fmt::format("no length code says {} words; declare the \"id_code\", too, with an undefined length "
                    "code in its bits 8 to 12",
                    words));
  }
  return static_cast<std::uint16_t>(*code << kPlaceOfLengthCode | kBothDirections);
}

}  // namespace

void expect_time_for_silences(const interbus::Rules& rules) {
  constexpr std::int64_t kTelegrams = 20;
  const std::int64_t silent_bits =
      kTelegrams * line::kDataTelegramLevels +
      std::max<std::int64_t>(rules.status_pitch_bits, rules.telegram_gap_millibits / 1'000) +
      rules.forward_delay_half_bits + rules.return_delay_half_bits;
  const kernel::Duration silent = kernel::levels_duration(silent_bits, rules.bit_rate);
  if (rules.silence_limit - rules.silence_tolerance > silent) return;
  throw kernel::Error(
      kernel::ErrorKind::configuration,
      fmt::format("\"silence_limit\" is {} with a tolerance of {}, and a line is silent for {} between and "
                  "after telegrams",
                  kernel::describe(rules.silence_limit), kernel::describe(rules.silence_tolerance),
                  kernel::describe(silent)));
}

std::vector<judge::PicsItem> slave_pics_items() {
  return field::pics_items_of(kSlave);
}

judge::Pics declared_slave(const SlaveConfiguration& configuration) {
  const bool has_words = configuration.words > 0;
  return field::declared_by(kSlave, {.configuration = configuration,
                                     .inputs = has_words && interbus::has_inputs(configuration.id_code),
                                     .outputs = has_words && interbus::has_outputs(configuration.id_code),
                                     .remote_interface = !configuration.is_local});
}

void declare_station(interbus::StationDescription& station, const judge::Pics& pics,
                     const interbus::Rules& rules) {
  const bool has_words = pics.items().contains(kWords);
  const auto words = static_cast<unsigned>(pics.number(kWords, 0));
  if (pics.items().contains(kIdCode)) {
    station.id_code = static_cast<std::uint16_t>(pics.number(kIdCode, 0));
  } else if (has_words) {
    station.id_code = id_code_for(words, rules);
  }
  const auto coded = interbus::words_of_id_code(station.id_code, rules);
  if (has_words && coded && *coded != words) {
    refuse(fmt::format("{} words; the length code {:02X}h of its ID code {:04X}h says {}", words,
                       length_code(station.id_code), station.id_code, *coded));
  }
  if (!has_words && !coded) {
    refuse(fmt::format(
        "the length code {:02X}h of the ID code {:04X}h is not defined; declare the \"words\", too",
        length_code(station.id_code), station.id_code));
  }
  station.words = coded.value_or(words);
  for (const std::string_view data : {"inputs", "outputs"}) {
    if (station.words == 0 && pics.supports(data))
      refuse(fmt::format("a register of 0 words has no {}; declare \"{}\": false, or \"words\"", data, data));
  }
  station.has_branch = pics.supports("has_branch");
}

void expect_as_declared(const interbus::RingPlace& place, const judge::Pics& pics) {
  const std::int64_t id_code = place.station->id_code;
  if (const auto declared = pics.number(kIdCode, id_code); declared != id_code)
    refuse(fmt::format("the ID code {:04X}h; station \"{}\" of the network has {:04X}h", declared,
                       place.station->name, id_code));
  if (const auto declared = pics.number(kWords, place.words); declared != std::int64_t{place.words})
    refuse(fmt::format("{} words; station \"{}\" of the network has {}", declared, place.station->name,
                       place.words));
}

std::vector<judge::PicsItem> master_pics_items() {
  return field::pics_items_of(kMaster);
}

judge::Pics declared_master() {
  return field::declared_by(kMaster, MasterDeclaration{});
}

}  // namespace fieldproof::conformance
