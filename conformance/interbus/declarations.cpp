#include "conformance/interbus/declarations.hpp"

#include <array>

#include "harness/field/pics.hpp"
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

}  // namespace

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

std::vector<judge::PicsItem> master_pics_items() {
  return field::pics_items_of(kMaster);
}

}  // namespace fieldproof::conformance
