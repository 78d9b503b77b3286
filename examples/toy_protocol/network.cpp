// A master and three responders, for `emc`; who plays the responders is the call's to say.
#include <array>

#include <harness/network/polled_bus.hpp>

#include "poll.hpp"

namespace poll {
namespace {

constexpr std::size_t kResponders = 3;
constexpr kernel::Duration kSlot = 10 * kernel::kMillisecond;

std::uint8_t address_of(std::size_t n) {
  return static_cast<std::uint8_t>(n + 1);
}

class PollNetwork final : public network::PolledBus {
 public:
  PollNetwork(std::uint64_t seed, const conformance::Seats<ResponderRole>& seats)
      : PolledBus({.name = "a master and three responders",
                   .bit_rate = Rules{}.bit_rate,
                   .slot = kSlot,
                   .bits = 8,
                   .frames = {{"request", "", 16, kSlot}, {"answer", "", 16, kSlot}}},
                  seed) {
    for (std::size_t n = 0; n < kResponders; ++n) {
      const Configuration configuration{.rules = {}, .address = address_of(n)};
      std::unique_ptr<Device> device = seats.make(n + 1, configuration, seed, mutants());
      if (device == nullptr) device = std::make_unique<Responder>(configuration);
      segment::Port& line = add("responder@" + std::to_string(n + 1), *device, kernel::kMicrosecond);
      device->wire(line, [this, n](kernel::Time now) { return static_cast<std::uint8_t>(source(n, now)); });
      devices_.push_back(std::move(device));
    }
  }

 private:
  line::Waveform request(std::size_t n, kernel::Time now) override {
    return uart_.wave_of(request_to(address_of(n)), now);
  }
  std::optional<std::uint16_t> word_in(std::size_t n, const line::Waveform& answer) override {
    return value_in(address_of(n), uart_.octets_in(answer));
  }

  line::OctetLine uart_{Rules{}.bit_rate};
  std::vector<std::unique_ptr<Device>> devices_;
};

class PlannedPoll final : public conformance::PlannedNetwork {
 public:
  explicit PlannedPoll(const conformance::NetworkRequest& request) : seats_(request, kResponders) {
    static constexpr std::array<std::string_view, 1> kRoles{"responder"};
    conformance::expect_roles(request, kRoles);
    if (request.file.empty()) return;
    throw kernel::Error(kernel::ErrorKind::usage,
                        "there is one network of this protocol; leave out the file");
  }

  std::string name() const override { return "a master and three responders"; }
  std::string default_profile() const override { return "A"; }
  std::string_view exchange() const override { return "slot"; }
  std::unique_ptr<network::Network> make(std::uint64_t seed) const override {
    return std::make_unique<PollNetwork>(seed, seats_);
  }

 private:
  conformance::Seats<ResponderRole> seats_;
};

}  // namespace

std::unique_ptr<conformance::PlannedNetwork> plan(const conformance::NetworkRequest& request) {
  return std::make_unique<PlannedPoll>(request);
}

}  // namespace poll
