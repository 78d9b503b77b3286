// The installations that `fieldproof emc` and `fieldproof measure` run, one row for each protocol, with
// whoever
// `--iut` puts into them: the rest are references.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cli/verbs.hpp"
#include "harness/kernel/time.hpp"
#include "harness/network/network.hpp"

namespace fieldproof::cli {

// A way for a frame to arrive wrong at one receiver and to pass, where each bit flips with the same chance.
struct UndetectedPart {
  std::string name;  // "code_word"
  double probability = 0;
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
  // Empty where no theory is prepared.
  virtual std::vector<UndetectedPart> undetected(double /*flip_probability*/) const { return {}; }
  // What that theory rests on.
  virtual std::vector<std::string> undetected_caveats() const { return {}; }
};

struct NetworkRow {
  std::string_view protocol;
  // What is simulated where no file says otherwise, in the first line of the output.
  std::string_view own_network;
  std::unique_ptr<PlannedNetwork> (*plan)(const Session& session);
};

// The row of the protocol that the call names; else a usage error that lists them.
const NetworkRow& network_row_of(const Session& session, std::string_view verb);

}  // namespace fieldproof::cli
