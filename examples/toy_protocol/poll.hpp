// A protocol of few lines: a master polls responders on one line, in characters 8n1.
//
//   request   address, check
//   answer    value, check
//
// The check is the exclusive or of address, value and 5Ah. A request whose check fits, for the responder's
// own address, is answered within 2 ms; nothing else is. What comes in one transmission is a frame.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <conformance/mutant_table.hpp>
#include <conformance/planned_network.hpp>
#include <conformance/suite.hpp>
#include <harness/line/octet_line.hpp>
#include <harness/segment/station.hpp>
#include <harness/trace/octet_dissector.hpp>

namespace poll {

using namespace fieldproof;

struct Rules {
  std::int64_t bit_rate = 19'200;
  kernel::Duration turnaround_time = kernel::kMillisecond;
};

struct Configuration {
  Rules rules;
  std::uint8_t address = 7;
};

using Octets = std::vector<std::uint8_t>;

Octets request_to(std::uint8_t address);
Octets answer_of(std::uint8_t address, std::uint8_t value);
// The value of an answer that came whole, with a check that fits.
std::optional<std::uint8_t> value_in(std::uint8_t address, const std::optional<Octets>& octets);

class Device : public segment::Station {
 public:
  using Value = std::function<std::uint8_t(kernel::Time)>;
  virtual void wire(segment::Port& line, Value value) = 0;
};

// The reference.
class Responder : public Device {
 public:
  explicit Responder(const Configuration& configuration)
      : configuration_(configuration), uart_(configuration.rules.bit_rate) {}

  void wire(segment::Port& line, Value value) override;
  void receive(segment::PortIndex, const line::Waveform& wave) override;
  void on_time(kernel::Time now) override;
  kernel::Time next_time() const override { return answers_at_; }

 protected:
  // Two octets.
  virtual bool is_for_me(const Octets& request) const { return request[0] == configuration_.address; }
  virtual bool is_right(const Octets& request) const { return request == request_to(request[0]); }

 private:
  Configuration configuration_;
  line::OctetLine uart_;
  segment::Port* line_ = nullptr;
  Value value_;
  kernel::Time answers_at_ = kernel::kNever;
};

// The role: stations of the program only, so nothing is said of how one outside is called.
struct ResponderRole {
  using Device = poll::Device;
  using Configuration = poll::Configuration;
  static constexpr const char* protocol = "poll";
  static constexpr const char* role = "responder";
};

using Mutants = conformance::DeviceMutants<Device, Configuration>;
const Mutants& mutants();

// What a row of the program joins.
std::unique_ptr<conformance::Suite> suite(conformance::SuiteGiven given);
std::unique_ptr<conformance::PlannedNetwork> plan(const conformance::NetworkRequest& request);

}  // namespace poll
