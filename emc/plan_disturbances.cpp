#include "emc/plan_disturbances.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "emc/burst_stress.hpp"
#include "emc/effective_time.hpp"
#include "emc/planned_bursts.hpp"
#include "emc/random_flips.hpp"

namespace fieldproof::emc {
namespace {

using config::ObjectReader;
using config::Value;
using fault::DisturbanceModel;
using Json = nlohmann::ordered_json;

// ---- bursts ----

DisturbanceModel read_burst_model(const Value& value) {
  const PlannedBursts bursts = read_bursts(value);
  return {"bursts", json_of(bursts).dump(), lasting_bursts(bursts.profile, bursts.settings),
          caveats_of(bursts.profile)};
}

// ---- channels that flip bits ----

// A channel that flips bits, whatever the levels of a transmission are (after bursts they are parts of
// bits), and tells the trace which.
class BitFlips final : public fault::Channel {
 public:
  enum class Unit { bit, level };  // level: as the sender drives them
  BitFlips(const fault::StressPlace& place, std::unique_ptr<fault::Channel> flips, Unit unit = Unit::bit)
      : unit_(unit),
        bit_rate_(place.bit_rate),
        trace_(place.trace),
        place_(place.channel),
        flips_(std::move(flips)) {}

  bool pass(const line::Waveform& sent, line::Waveforms& arrivals) override {
    const bool is_finer = unit_ == Unit::bit && sent.rate > bit_rate_ && sent.rate % bit_rate_ == 0;
    const auto levels = static_cast<std::size_t>(is_finer ? sent.rate / bit_rate_ : 1);
    bits_.start = sent.start;
    bits_.rate = is_finer ? bit_rate_ : sent.rate;
    bits_.levels.clear();
    bits_.levels.append_idle((sent.levels.size() + levels - 1) / levels);
    flipped_.clear();
    if (!flips_->pass(bits_, flipped_)) return false;
    invert(arrivals.add(sent).levels, levels);
    return true;
  }

 private:
  // Where a bit is flipped the idle line is low.
  void invert(line::Levels& arrival, std::size_t levels_per_bit) {
    const line::Levels& bits = flipped_.front().levels;
    for (std::size_t word = 0; word < bits.word_count(); ++word) {
      for (std::uint64_t flipped = ~bits.words()[word]; flipped != 0; flipped &= flipped - 1) {
        const std::size_t bit = 64 * word + static_cast<std::size_t>(std::countr_zero(flipped));
        arrival.invert(bit * levels_per_bit, std::min(arrival.size(), (bit + 1) * levels_per_bit));
        trace_.fault(place_, bits_.time_of(bit), unit_ == Unit::bit ? "flipped bit" : "flipped level");
      }
    }
  }

  Unit unit_;
  std::int64_t bit_rate_;
  trace::Trace& trace_;
  trace::Channel place_;
  std::unique_ptr<fault::Channel> flips_;
  line::Waveform bits_;
  line::Waveforms flipped_;
};

// Each receiver draws for itself.
kernel::Random random_of(const fault::StressPlace& place) {
  return place.random.split(place.trace.channel_name(place.channel));
}

DisturbanceModel read_binary_symmetric(const Value& value) {
  const double flips = config::read_object(
      value, [](ObjectReader& object) { return object.required("flip_probability").as_number(0, 1); });
  return {
      "binary_symmetric", Json{{"flip_probability", flips}}.dump(), [flips](const fault::StressPlace& place) {
        return std::make_unique<BitFlips>(place, std::make_unique<BernoulliChannel>(flips, random_of(place)));
      }};
}

// ---- Gilbert and Elliott ----

GilbertElliott read_parameters(ObjectReader& object) {
  GilbertElliott parameters;
  parameters.to_bad = object.required("to_bad").as_number(0, 1);
  parameters.to_good = object.required("to_good").as_number(0, 1);
  if (const auto flip = object.optional("good_flip")) parameters.good_flip = flip->as_number(0, 1);
  if (const auto flip = object.optional("bad_flip")) parameters.bad_flip = flip->as_number(0, 1);
  if (parameters.to_bad + parameters.to_good == 0) {
    config::fail(object.value(),
                 "neither state is ever left; write \"binary_symmetric\" for a channel of one state");
  }
  return parameters;
}

DisturbanceModel model_of(const GilbertElliott& parameters) {
  const GilbertElliott usual;
  Json json{{"to_bad", parameters.to_bad}, {"to_good", parameters.to_good}};
  if (parameters.good_flip != usual.good_flip) json["good_flip"] = parameters.good_flip;
  if (parameters.bad_flip != usual.bad_flip) json["bad_flip"] = parameters.bad_flip;
  return {"gilbert_elliott", json.dump(), [parameters](const fault::StressPlace& place) {
            return std::make_unique<BitFlips>(
                place, std::make_unique<GilbertElliottChannel>(parameters, random_of(place)));
          }};
}

DisturbanceModel fitted_model(const PlannedBursts& bursts) {
  return {
      "gilbert_elliott", Json{{"fitted_to", json_of(bursts)}}.dump(),
      [bursts, wrong = wrong_output_of(bursts.profile, bursts.settings)](const fault::StressPlace& place) {
        const double flips = flips_per_pulse(wrong->get(), {}, place.bit_rate);
        const GilbertElliott fitted =
            fitted_gilbert_elliott(flips, bursts.settings.repetition, place.bit_rate);
        return std::make_unique<BitFlips>(place,
                                          std::make_unique<GilbertElliottChannel>(fitted, random_of(place)));
      },
      caveats_of(bursts.profile)};
}

DisturbanceModel read_gilbert_elliott(const Value& value) {
  return config::read_object(value, [](ObjectReader& object) {
    const auto fitted_to = object.optional("fitted_to");
    if (!fitted_to) return model_of(read_parameters(object));
    const PlannedBursts bursts = read_bursts(*fitted_to);
    if (bursts.settings.first_burst) {
      config::fail(*fitted_to, "the states come by chance and not at a time; leave out \"first_burst\"");
    }
    return fitted_model(bursts);
  });
}

// ---- lists of bits ----

constexpr std::size_t kMostListedBits = 10'000;  // of a list
constexpr std::uint64_t kLastBit = 100'000;

using Position = BitListChannel::Position;

std::vector<Position> read_positions(const Value& value, std::string_view unit) {
  std::vector<Position> positions;
  for (const Value& element : value.as_array(1, kMostListedBits)) {
    config::read_object(element, [&](ObjectReader& object) {
      const auto transmission = object.required("transmission").as_integer<std::uint64_t>();
      for (const Value& bit : object.required(unit).as_array(1, kMostListedBits)) {
        positions.push_back({transmission, bit.as_integer<std::uint64_t>(0, kLastBit)});
        if (positions.size() > kMostListedBits)
          config::fail(bit, "these are too many bits; 10000 make a list");
      }
    });
  }
  std::ranges::sort(positions);
  if (const auto twice = std::ranges::adjacent_find(positions); twice != positions.end()) {
    config::fail(value, "a bit is named twice, which leaves it as it is; leave both out");
  }
  return positions;
}

Json json_of(const std::vector<Position>& positions, std::string_view unit) {
  Json json = Json::array();
  for (auto at = positions.begin(); at != positions.end();) {
    Json bits = Json::array();
    const std::uint64_t transmission = at->transmission;
    for (; at != positions.end() && at->transmission == transmission; ++at) bits.push_back(at->bit);
    json.push_back({{"transmission", transmission}, {std::string(unit), std::move(bits)}});
  }
  return json;
}

DisturbanceModel read_flipped_bits(const Value& value) {
  const auto positions = std::make_shared<const std::vector<Position>>(read_positions(value, "bits"));
  return {"flipped_bits", json_of(*positions, "bits").dump(), [positions](const fault::StressPlace& place) {
            return std::make_unique<BitFlips>(place, std::make_unique<BitListChannel>(positions));
          }};
}

DisturbanceModel read_flipped_levels(const Value& value) {
  const auto positions = std::make_shared<const std::vector<Position>>(read_positions(value, "levels"));
  return {"flipped_levels", json_of(*positions, "levels").dump(),
          [positions](const fault::StressPlace& place) {
            return std::make_unique<BitFlips>(place, std::make_unique<BitListChannel>(positions),
                                              BitFlips::Unit::level);
          }};
}

}  // namespace

const std::vector<fault::DisturbanceKind>& plan_disturbances() {
  static const std::vector<fault::DisturbanceKind> kinds{{"bursts", read_burst_model},
                                                         {"binary_symmetric", read_binary_symmetric},
                                                         {"gilbert_elliott", read_gilbert_elliott},
                                                         {"flipped_bits", read_flipped_bits},
                                                         {"flipped_levels", read_flipped_levels}};
  return kinds;
}

}  // namespace fieldproof::emc
