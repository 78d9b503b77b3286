#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "conformance/case_bench.hpp"
#include "harness/segment/medium.hpp"

// The bench of one station on a shared line: the implementation under test (IUT) at its place, and the lower
// tester in the place of all others. A protocol's bench adds the upper side and what the tester can send and
// expect.
namespace fieldproof::conformance {

class LineBench : public CaseBench, private segment::Station {
 protected:
  // A bit on the line lasts as its rate says; levels of a plan are counted at it.
  LineBench(std::uint64_t seed, Volume volume, std::span<const fault::Stress> stresses, LineWatch line_watch,
            segment::ContentionRule rule = segment::ContentionRule::noise)
      : CaseBench(seed, volume, stresses, std::move(line_watch)),
        line_(segment(), "line", rule, random()),
        tester_seat_(segment().attach(*this, "tester")) {}
  ~LineBench() override = default;

  // `role` names the place: "node".
  void attach_iut(segment::Station& station, const std::string& role, kernel::Duration distance = {},
                  bool receives_own_echo = false) {
    seat_ = segment().attach(station, role);
    tester_ = &line_.attach("tester/in", tester_seat_, 0, {});
    place_name_ = role + "/in";
    place_ = &line_.attach(place_name_, seat_, 0, distance, receives_own_echo);
  }
  // Declared faults at the place of the IUT; `observations` are those that the bench makes besides the line.
  void install(const fault::Plan& plan, std::int64_t bit_rate, std::vector<std::string> observations = {}) {
    observations.emplace_back(segment::kContention);
    for (std::string& name : observations_of_the_watch()) observations.push_back(std::move(name));
    if (fault::InstalledPlan* const made =
            make_plan(plan, fault::names_of_transmissions({place_name_}, std::move(observations))))
      place_->set_channel(made->channel_for({place_name_, place_->trace_channel(), bit_rate}));
  }
  // The IUT was given something from outside of the line.
  void refresh_iut() { segment().refresh(seat_); }
  // A bench that does something at an instant by itself (`next_time`) has another one now.
  void refresh_tester() { segment().refresh(tester_seat_); }

  segment::MediumPort& place() { return *place_; }
  segment::MediumPort& tester() { return *tester_; }
  // The tester drives it, and runs until it is over. Gives that instant.
  kernel::Time drive_to_end(line::Waveform& wave) {
    const kernel::Time end = wave.end();
    tester_->drive(wave);
    if (end > now()) segment().run_until(end);
    return end;
  }
  // In steps until it is seen, or to the limit. Where nothing fires for several steps they are one: a silence
  // of seconds on a fast line has millions.
  template <typename IsSeen>
  void run_in_steps(kernel::Time limit, kernel::Duration step, IsSeen is_seen) {
    while (!is_seen() && now() < limit) {
      const kernel::Duration idle = std::min(limit, segment().scheduler().next()) - now();
      const auto steps = std::max<std::int64_t>(1, (idle + step - kernel::kPicosecond) / step);
      segment().run_until(std::min(limit, now() + steps * step));
    }
  }

 private:
  void receive(segment::PortIndex, const line::Waveform&) override {}
  void on_time(kernel::Time) override {}
  kernel::Time next_time() const override { return kernel::kNever; }

  segment::Medium line_;
  std::size_t tester_seat_;
  std::size_t seat_ = 0;
  segment::MediumPort* tester_ = nullptr;
  segment::MediumPort* place_ = nullptr;  // of the IUT
  std::string place_name_;
};

}  // namespace fieldproof::conformance
