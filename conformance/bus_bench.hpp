#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "conformance/line_bench.hpp"

// A line bench as it is, for a protocol that needs no more of it than what its IUT has driven.
//
// A `Configuration` has `rules`, these a `bit_rate`.
namespace fieldproof::conformance {

template <typename Device, typename Configuration>
class BusBench : public LineBench, private segment::Tap {
 public:
  using Setting = PlannedSetting<Device, Configuration>;

  // `role` names the place of the IUT: "node".
  BusBench(const std::string& role, const Configuration& configuration, const Setting& setting,
           segment::ContentionRule rule = segment::ContentionRule::noise)
      : LineBench(setting.seed, setting.volume, setting.stresses,
                  LineWatch(kernel::levels_duration(1, configuration.rules.bit_rate)), rule),
        configuration_(configuration),
        device_(setting.make_device(configuration)) {
    attach_iut(*device_, role);
    start_recording(setting, configuration.rules);
    place().tap_driven(*this);
    watch(place());
    install(setting.plan, configuration.rules.bit_rate);
  }

  const Configuration& configuration() const { return configuration_; }
  void begin_stress(const fault::Stress& stress) {
    begin_stress_at(stress, place(), configuration_.rules.bit_rate, now());
  }
  void finish() { device_->end(); }

 protected:
  kernel::Time send(line::Waveform wave) { return drive_to_end(wave); }
  Device& device() { return *device_; }
  // What the IUT has driven since then.
  const std::vector<line::Waveform>& driven() const { return driven_; }
  void clear_driven() { driven_.clear(); }

 private:
  void on_wave(const line::Waveform& wave) override { driven_.push_back(wave); }

  Configuration configuration_;
  std::unique_ptr<Device> device_;
  std::vector<line::Waveform> driven_;
};

}  // namespace fieldproof::conformance
