#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "conformance/fieldbus_dll/suite.hpp"
#include "conformance/interbus/suite.hpp"
#include "conformance/valve_bus/suite.hpp"
#include "harness/iut/pool.hpp"
#include "harness/judge/pics.hpp"

// Implementations outside the program, for the suites:
//
//   exec:./program ARGUMENTS     a process
//   unix:/path, tcp:HOST:PORT    who listens there
//   plugin:./library.so          a shared library, in a process of its own; with ?in-process in this one
//   serial:/dev/ttyUSB0?baud=…   a box at a serial line, in wall-clock time
namespace fieldproof::cli {

bool is_attachment(std::string_view uri);

// A library, one that is loaded into this process, and the path of either.
bool is_plugin_uri(std::string_view uri);
bool is_in_process(std::string_view uri);
std::string plugin_path(std::string_view uri);

// The library, in this process, in a role of `roles()`.
std::unique_ptr<iut::Device> library_of(const std::string& uri, const iut::RoleName& role);

// Who is called by messages: exec:, unix:, tcp:, and a library in a process of its own.
std::unique_ptr<iut::DevicePool> pool_of(const std::string& uri, const iut::RoleName& role,
                                         const iut::PeerLimits& limits = {});

// What the URI of a serial line says of the node at it, as answers of a PICS; nothing for other URIs.
std::optional<judge::Pics> node_on_real_line(const std::string& uri);

// Implementations of one URI are kept from case to case, and as many are opened as cases run side by side.
conformance::GivenSlaves::Make attached_slaves();
conformance::GivenMasters::Make attached_masters();
conformance::GivenNodes::Make attached_nodes();
conformance::GivenHosts::Make attached_hosts();
// Of the data link, by role.
conformance::GivenIsaStations::Make attached_isa_stations(const std::string& role);
conformance::GivenFfStations::Make attached_ff_stations(const std::string& role);

}  // namespace fieldproof::cli
