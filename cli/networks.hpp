// From a call to the network of its protocol that `emc` and `measure` run.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "cli/verbs.hpp"
#include "conformance/planned_network.hpp"

namespace fieldproof::cli {

// The row of the protocol that the call names; a usage error that lists them where it has no network.
const ProtocolEntry& network_entry_of(const Session& session, std::string_view verb);
const ProtocolEntry& network_entry_named(std::string_view protocol, std::string_view verb);

// Whom `--iut` puts into it.
std::vector<conformance::Assignment> network_implementations(const Session& session,
                                                             const ProtocolEntry& entry);
// What the call says of the network that it wants.
conformance::NetworkRequest network_request(const Session& session, const ProtocolEntry& entry);
// The network of the call, with whoever `--iut` puts into it.
std::unique_ptr<conformance::PlannedNetwork> plan_network(const Session& session, const ProtocolEntry& entry);

bool is_no_reference(const conformance::Assignment& one);
// "node@2=exec:./node slave@3=plugin:./x.so", as `--iut` takes it; empty where nobody else plays.
std::string players_of(const std::vector<conformance::Assignment>& implementations);
// "in it: node@2 (exec:./node); whoever is not named is a reference"; empty where nobody else plays.
std::string players_text(const std::vector<conformance::Assignment>& implementations);

}  // namespace fieldproof::cli
