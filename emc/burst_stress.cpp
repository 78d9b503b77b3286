#include "emc/burst_stress.hpp"

#include <fmt/format.h>

#include <array>
#include <string>
#include <utility>

#include "emc/burst_channel.hpp"

namespace fieldproof::emc {
namespace {

using SharedResponse = kernel::ComputedOnce<LineResponse>;

std::unique_ptr<BurstChannel> channel_at(const fault::StressPlace& place, BurstSchedule schedule,
                                         WrongOutput wrong) {
  return std::make_unique<BurstChannel>(std::move(schedule), std::move(wrong),
                                        BurstReceiver{place.bit_rate, nullptr, line::Sampling{}, true, false},
                                        place.trace, place.channel);
}

// One burst, with the tolerances of a run.
BurstSchedule burst_at(kernel::Time from, BurstSettings settings, const kernel::Random& random) {
  settings.on = from;
  settings.off = from + BurstSchedule(settings, random).timing().period / 2;
  settings.first_burst = kernel::Duration::zero();
  return {settings, random};
}

// The longest burst that the tolerances allow, and the pitch after its last pulse.
kernel::Duration longest_burst(Repetition repetition) {
  return repetition == Repetition::khz_100 ? kernel::kMillisecond : 20 * kernel::kMillisecond;
}

fault::Stress stress(const std::shared_ptr<SharedResponse>& response, const BurstSettings& settings,
                     const std::string& profile) {
  const auto make_channel = [response, settings](const fault::StressPlace& place) {
    return channel_at(place, burst_at(place.from, settings, place.random),
                      response->get().wrong_output(settings.level.open_circuit_volts(), settings.polarity));
  };
  return {fmt::format("a burst of {}, {}, level {}, profile {}", text_of(settings.repetition),
                      text_of(settings.polarity), settings.level.text(), profile),
          longest_burst(settings.repetition), make_channel};
}

}  // namespace

std::shared_ptr<kernel::ComputedOnce<WrongOutput>> wrong_output_of(const Profile& profile,
                                                                   const BurstSettings& settings) {
  return std::make_shared<kernel::ComputedOnce<WrongOutput>>([coupling = profile.coupling, settings] {
    return LineResponse(coupling).wrong_output(settings.level.open_circuit_volts(), settings.polarity);
  });
}

MakeBursts lasting_bursts(const Profile& profile, const BurstSettings& settings) {
  return [wrong = wrong_output_of(profile, settings), settings](const fault::StressPlace& place) {
    BurstSettings here = settings;
    here.on = place.from;
    return channel_at(place, BurstSchedule(here, place.random), wrong->get());
  };
}

std::vector<fault::Stress> burst_stresses(const Profile& profile, std::span<const Level> levels) {
  const auto response =
      std::make_shared<SharedResponse>([coupling = profile.coupling] { return LineResponse(coupling); });
  std::vector<fault::Stress> stresses;
  for (const Level& level : levels) {
    for (const Repetition repetition : {Repetition::khz_5, Repetition::khz_100}) {
      for (const Polarity polarity : {Polarity::positive, Polarity::negative}) {
        BurstSettings settings;
        settings.level = level;
        settings.repetition = repetition;
        settings.polarity = polarity;
        stresses.push_back(stress(response, settings, profile.name));
      }
    }
  }
  return stresses;
}

namespace {

std::vector<fault::Stress> two_highest_levels(const std::string& profile) {
  return burst_stresses(Profile::named(profile), std::array{Level::standard(PortKind::signal, 4),
                                                            Level::standard(PortKind::signal, 3)});
}

}  // namespace

std::vector<fault::Stress> catalogue_stresses() {
  return two_highest_levels("A");
}

std::map<std::int64_t, std::vector<fault::Stress>> catalogue_link_stresses() {
  return {{31'250, two_highest_levels("E2")}, {1'000'000, two_highest_levels("F")}};
}

}  // namespace fieldproof::emc
