#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "conformance/assigned.hpp"
#include "conformance/test_case.hpp"
#include "harness/iut/device_recording.hpp"
#include "harness/iut/recorded_device.hpp"

// The implementations under test of one run of a case, whatever they are: a station of this program, an
// implementation outside, or what a stored run recorded. Recording and playing back happen here, once for all
// roles.
//
// A role is a `Kind`: the types Device (what the bench wires to), Configuration, Attached (a Device that an
// iut::Device plays) and Served (an iut::Device that a Device plays), and the names protocol and role.
// Without Attached and Served it has stations of the program only.
namespace fieldproof::conformance {

class CaseDevices {
 public:
  // All must outlive it. Loads the recording that the setup names.
  CaseDevices(const TestCase& test_case, const Setup& setup, const Attach& attach);
  CaseDevices(const CaseDevices&) = delete;
  CaseDevices& operator=(const CaseDevices&) = delete;

  IutRequest request(const std::string& uri) const {
    return {uri, test_case_.id, setup_.seed, setup_.limits};
  }
  // The stations are those of a recording.
  bool is_played_back() const { return played_back_.has_value(); }

  // The station for a URI. `make_local` makes the one of this program, where the URI means one.
  template <typename Kind, typename MakeLocal>
  std::unique_ptr<typename Kind::Device> make(const std::string& uri,
                                              const typename Kind::Configuration& configuration,
                                              MakeLocal make_local) {
    expect_playable<Kind>(uri);
    if (Kind::role == test_case_.role())
      configuration_ = std::make_shared<const typename Kind::Configuration>(configuration);
    std::optional<iut::Attachment> attachment = outside({Kind::protocol, Kind::role}, uri);
    if constexpr (requires { typename Kind::Served; }) {
      if (!attachment && setup_.as_device) {
        // It is made of its configuration, and not of the settings that an implementation outside is told.
        const auto served = std::make_shared<typename Kind::Served>(
            [make_local, configuration](const auto&) { return make_local(configuration); });
        attachment.emplace(iut::Attachment{served.get(), served, {}});
      }
    }
    if (!attachment) return make_local(configuration);
    if (setup_.record && !is_played_back()) *attachment = iut::recorded(std::move(*attachment), *recording_);
    return attached_station<Kind>(std::move(*attachment), configuration, test_case_.id, setup_.seed);
  }

  // What was recorded goes to the outcome.
  void keep(Outcome& outcome);
  // Of the last station that was made for the role of the case; null before. Its type is that of the role.
  const void* configuration() const { return configuration_.get(); }

 private:
  std::optional<iut::Attachment> outside(const iut::RoleName& role, const std::string& uri);

  const TestCase& test_case_;
  const Setup& setup_;
  const Attach& attach_;
  std::optional<iut::DeviceRecording> played_back_;
  std::size_t played_back_devices_ = 0;
  std::shared_ptr<iut::DeviceRecording> recording_;
  std::shared_ptr<const void> configuration_;
};

}  // namespace fieldproof::conformance
