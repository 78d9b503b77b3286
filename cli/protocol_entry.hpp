// What the program knows of a protocol: one row. Every verb asks these rows, so it works for every protocol
// and role, or says in one sentence why it does not. A program of one's own gives rows of its own to
// run_program.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "conformance/planned_network.hpp"
#include "conformance/suite.hpp"
#include "harness/config/document.hpp"
#include "harness/field/named_table.hpp"
#include "harness/iut/plugin.hpp"
#include "harness/iut/serial_line.hpp"
#include "harness/iut/uart_line.hpp"
#include "harness/judge/pics.hpp"

namespace fieldproof::cli {

// A role that an implementation outside can take, and the built-in station of it that can be served
// (`fieldproof station`).
struct Role {
  std::string_view protocol;
  std::string_view name;
  iut::UnitOffer units;  // what an implementation outside may receive and send
  // The station of `ref` or `mutant:NAME` as an implementation. Throws kernel::Error(usage) for a mutant
  // that is not there.
  std::unique_ptr<iut::Device> (*serve)(const std::string& uri);
  // An implementation outside as one of levels; the begin is that of its case.
  std::unique_ptr<iut::Device> (*in_levels)(iut::Attachment, const iut::CaseBegin&);
  // The same station, but it receives and sends telegrams; null where the role has none.
  std::unique_ptr<iut::Device> (*in_telegrams)(std::unique_ptr<iut::Device>) = nullptr;
  // How its characters go over a serial line; null: it has no line that carries characters of a UART.
  iut::MakeUartLine uart = nullptr;
  // What the URI of a serial line says of a station of the role at it, as answers of a PICS. Throws
  // kernel::Error(usage) for what no station of the role is.
  judge::Pics (*on_line)(const std::string& uri, const iut::SerialSettings& settings) = nullptr;
  // The items that a station of the role reads.
  std::span<const iut::Item> inputs{};
  // What a station without an upper channel is told, from the answers of a PICS; null: it cannot play alone.
  iut::CaseBegin (*alone)(const judge::Pics&) = nullptr;

  std::string path() const { return std::string(protocol) + "/" + std::string(name); }
};

// What `plan` prints and stores of a network file, and whether all that the file asks for is proven; open:
// too little is known to say so, or that nothing meets it.
struct Planned {
  std::string text;
  std::string json;
  bool is_proven = false;
  bool is_open = false;
};

// Finds what keeps the bounds of a network file of its kind.
struct Planner {
  std::string_view file{};  // the schema of such a file: "token_network"
  std::string_view key{};   // of the root, that no file of another planner has
  Planned (*plan)(const config::Document& network, std::uint64_t seed) = nullptr;
};

// A way for a frame to arrive wrong at one receiver and to pass, where each bit flips with the same chance.
struct UndetectedPart {
  std::string name;  // "code_word"
  double probability = 0;
};

// What passes the checks of a network where each bit flips with the same chance, in closed form.
struct UndetectedTheory {
  std::vector<UndetectedPart> (*parts)(const std::string& network_file, double flip_probability) = nullptr;
  std::string_view caveat{};  // what it rests on
};

struct ProtocolEntry {
  std::string_view name;
  std::span<const Role> roles{};
  std::unique_ptr<conformance::Suite> (*suite)(conformance::SuiteGiven given) = nullptr;
  // What `emc` and `measure` run; without a plan there is nothing.
  conformance::NetworkRow network{};
  UndetectedTheory undetected{};  // without parts none is prepared
  Planner planner{};              // without a function there is nothing to plan
  // JSON Schemas of files that no suite knows.
  std::vector<field::NamedSchema> (*schemas)() = nullptr;
};

// The rows of this process. They must outlive it; set once, by run_program or by a test.
void use_protocols(std::span<const ProtocolEntry> protocols);
std::span<const ProtocolEntry> protocols();

using Suites = std::vector<std::unique_ptr<conformance::Suite>>;
Suites make_suites(const conformance::Disturbances& disturbances);

std::vector<const Role*> roles();
// Of "PROTOCOL/ROLE"; null for a path that is none.
const Role* find_role(const std::string& path);
// Throws kernel::Error(usage) with the known ones for a path that is none.
const Role& role_named(const std::string& path);

}  // namespace fieldproof::cli
