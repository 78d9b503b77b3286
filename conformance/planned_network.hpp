#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "conformance/assigned.hpp"
#include "conformance/mutant_table.hpp"
#include "harness/kernel/error.hpp"
#include "harness/network/network.hpp"

// The installations that `emc` and `measure` run, with whoever a call puts into them: the rest are
// references.
namespace fieldproof::conformance {

// What a call says about the network that it wants.
struct NetworkRequest {
  std::string file{};  // empty: the protocol's own
  std::vector<Assignment> implementations{};
  iut::PeerLimits limits{};
  Attach attach{};
  std::size_t latch = 0;  // which model of latching, where its stations have several
};

// A network and who plays in it. Made once; each run gets a network of its own, also on several threads.
class PlannedNetwork {
 public:
  PlannedNetwork() = default;
  PlannedNetwork(const PlannedNetwork&) = delete;
  PlannedNetwork& operator=(const PlannedNetwork&) = delete;
  virtual ~PlannedNetwork() = default;

  virtual std::string name() const = 0;
  // What its cables and receivers are like where nothing is said: the name of a profile.
  virtual std::string default_profile() const = 0;
  virtual std::unique_ptr<network::Network> make(std::uint64_t seed) const = 0;
  // What an exchange is called: "cycle".
  virtual std::string_view exchange() const = 0;
};

// How a protocol plans its networks.
struct NetworkRow {
  // What is simulated where no file says otherwise, in the first line of the output.
  std::string_view own_network{};
  // Throws kernel::Error(usage) for a request that cannot be served.
  std::unique_ptr<PlannedNetwork> (*plan)(const NetworkRequest& request) = nullptr;
  bool has_latch_models = false;
};

// Throws for an implementation that has no place in a network of these roles.
void expect_roles(const NetworkRequest& request, std::span<const std::string_view> roles);
// Throws for a position that the network does not have.
void expect_place(const Assignment& assignment, std::string_view role, std::size_t position,
                  std::size_t places);
// What an implementation outside is told in the place of a case.
std::string network_case_id(const iut::RoleName& role);
// The attachment of who plays in virtual time; throws for anybody else.
iut::Attachment attached_to_network(const NetworkRequest& request, const iut::RoleName& role,
                                    const std::string& uri, const std::string& case_id, std::uint64_t seed);

// Whom a call puts where, of one role.
template <typename Kind>
class Seats {
 public:
  using Configuration = typename Kind::Configuration;
  using Mutants = DeviceMutants<typename Kind::Device, Configuration>;

  Seats(const NetworkRequest& request, std::size_t places)
      : request_(request), case_id_(network_case_id({Kind::protocol, Kind::role})) {
    for (const Assignment& one : request.implementations) {
      if (one.role != Kind::role) continue;
      const auto position = static_cast<std::size_t>(std::max(one.position, 1));
      expect_place(one, Kind::role, position, places);
      if (one.uri != kReferenceUri) uris_[position] = one.uri;
    }
  }

  bool is_empty() const { return uris_.empty(); }

  // Null where a reference plays.
  std::unique_ptr<typename Kind::Device> make(std::size_t position, const Configuration& configuration,
                                              std::uint64_t seed, const Mutants& mutants) const {
    const auto at = uris_.find(position);
    if (at == uris_.end()) return nullptr;
    const std::string& uri = at->second;
    if (uri.starts_with(kMutantUri)) return mutants.make(mutant_of(uri, "station"), configuration);
    expect_playable<Kind>(uri);
    return attached_station<Kind>(
        attached_to_network(request_, {Kind::protocol, Kind::role}, uri, case_id_, seed), configuration,
        case_id_, seed);
  }

 private:
  NetworkRequest request_;
  std::string case_id_;                      // that an implementation outside is given
  std::map<std::size_t, std::string> uris_;  // by position
};

}  // namespace fieldproof::conformance
