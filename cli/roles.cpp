#include "cli/roles.hpp"

#include <array>

#include "conformance/assigned.hpp"
#include "conformance/fieldbus_dll/ff_mutants.hpp"
#include "conformance/fieldbus_dll/isa_mutants.hpp"
#include "conformance/interbus/master_mutants.hpp"
#include "conformance/interbus/slave_mutants.hpp"
#include "conformance/valve_bus/host_mutants.hpp"
#include "conformance/valve_bus/node_mutants.hpp"
#include "protocols/fieldbus_dll/attached_ff_device.hpp"
#include "protocols/fieldbus_dll/attached_isa_device.hpp"
#include "protocols/fieldbus_dll/ff_las.hpp"
#include "protocols/fieldbus_dll/isa_las.hpp"
#include "protocols/interbus/attached_master.hpp"
#include "protocols/interbus/attached_slave.hpp"
#include "protocols/interbus/master.hpp"
#include "protocols/interbus/slave.hpp"
#include "protocols/valve_bus/attached_host.hpp"
#include "protocols/valve_bus/attached_node.hpp"
#include "protocols/valve_bus/host.hpp"
#include "protocols/valve_bus/node.hpp"

namespace fieldproof::cli {
namespace {

// `make_mutant` gives the station of a mutant by its name.
template <typename Served, typename Reference, auto make_mutant>
std::unique_ptr<iut::Device> serve(const std::string& uri) {
  const bool is_reference = uri == conformance::kReferenceUri;
  const std::string name = is_reference ? "" : conformance::mutant_of(uri, "built-in station");
  if (!is_reference) make_mutant(name, {});  // while it is the caller's mistake
  return std::make_unique<Served>([is_reference, name](const auto& configuration) {
    return is_reference ? std::make_unique<Reference>(configuration) : make_mutant(name, configuration);
  });
}

constexpr const char kIsaDle[] = "isa_dle";
constexpr const char kIsaLas[] = "isa_las";
constexpr const char kFfDevice[] = "ff_device";
constexpr const char kFfLas[] = "ff_las";

// Mutants of the data link stand in one table for both roles of a profile.
template <const char* role>
std::unique_ptr<fieldbus_dll::IsaDevice> isa_mutant_of(const std::string& name,
                                                       const fieldbus_dll::IsaConfiguration& of) {
  return conformance::make_isa_mutant(role, name, of);
}
template <const char* role>
std::unique_ptr<fieldbus_dll::FfDevice> ff_mutant_of(const std::string& name,
                                                     const fieldbus_dll::FfConfiguration& of) {
  return conformance::make_ff_mutant(role, name, of);
}

constexpr std::array kRoles{
    Role{"interbus", "slave", iut::UnitOffer::in_its_unit,
         &serve<interbus::ServedSlave, interbus::Slave, &conformance::make_slave_mutant>, 3},
    Role{"interbus", "master", iut::UnitOffer::in_characters_too,
         &serve<interbus::ServedMaster, interbus::Master, &conformance::make_master_mutant>, 1},
    Role{"valve_bus", "node", iut::UnitOffer::in_its_unit,
         &serve<valve_bus::ServedNode, valve_bus::Node, &conformance::make_node_mutant>},
    Role{"valve_bus", "host", iut::UnitOffer::in_characters_too,
         &serve<valve_bus::ServedHost, valve_bus::Host, &conformance::make_host_mutant>},
    Role{"fieldbus_dll", kIsaDle, iut::UnitOffer::in_characters_too,
         &serve<fieldbus_dll::ServedIsaDevice, fieldbus_dll::IsaDle, &isa_mutant_of<kIsaDle>>},
    Role{"fieldbus_dll", kIsaLas, iut::UnitOffer::in_characters_too,
         &serve<fieldbus_dll::ServedIsaDevice, fieldbus_dll::IsaLas, &isa_mutant_of<kIsaLas>>},
    Role{"fieldbus_dll", kFfDevice, iut::UnitOffer::in_characters_too,
         &serve<fieldbus_dll::ServedFfDevice, fieldbus_dll::FfStation, &ff_mutant_of<kFfDevice>>},
    Role{"fieldbus_dll", kFfLas, iut::UnitOffer::in_characters_too,
         &serve<fieldbus_dll::ServedFfDevice, fieldbus_dll::FfLas, &ff_mutant_of<kFfLas>>},
};

}  // namespace

std::span<const Role> roles() {
  return kRoles;
}

}  // namespace fieldproof::cli
