#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cli/protocol_entry.hpp"
#include "conformance/case_devices.hpp"
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
// The same library in a process of its own.
std::string in_own_process(std::string_view uri);

// The library, in this process, in a role.
std::unique_ptr<iut::Device> library_of(const std::string& uri, const iut::RoleName& role);

// Who is called by messages: exec:, unix:, tcp:, and a library in a process of its own.
std::unique_ptr<iut::DevicePool> pool_of(const std::string& uri, const iut::RoleName& role,
                                         const iut::PeerLimits& limits = {});

// What the URI of a serial line says of the station at it, as answers of a PICS of the role of this case;
// nothing for other URIs.
std::optional<judge::Pics> station_on_real_line(const std::string& uri, const std::string& case_id);

// Which of these roles the implementation outside serves, as it says itself. It is started for that.
std::vector<iut::RoleName> served_among(const std::string& uri, std::span<const iut::RoleName> roles);

// Why a role is not played on a serial line, as a sentence.
std::string no_serial_line_for(const Role& role);

// For all roles. Implementations of one URI are kept from case to case, and as many are opened as cases run
// side by side.
conformance::Attach attachments();

}  // namespace fieldproof::cli
