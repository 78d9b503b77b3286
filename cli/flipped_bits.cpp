#include "cli/flipped_bits.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <tuple>
#include <utility>

#include <nlohmann/json.hpp>

#include "harness/line/sampling.hpp"

namespace fieldproof::cli {
namespace {

using nlohmann::ordered_json;

// The line as one receiver has it, from a few waveforms; idle outside.
bool level_at(const line::Waveforms& waves, std::size_t first, kernel::Time time) {
  for (std::size_t n = first; n < waves.size(); ++n) {
    if (!waves[n].at(time)) return false;
  }
  return true;
}

// Writes down what another channel does.
class WatchedChannel final : public fault::Channel {
 public:
  WatchedChannel(std::unique_ptr<fault::Channel> channel, std::string receiver, kernel::Time from,
                 std::int64_t bit_rate, std::shared_ptr<FlippedBits> struck)
      : channel_(std::move(channel)),
        receiver_(std::move(receiver)),
        from_(from),
        bit_rate_(bit_rate),
        struck_(std::move(struck)) {}

  bool pass(const line::Waveform& sent, line::Waveforms& arrivals) override {
    const std::size_t first = arrivals.size();
    const bool is_changed = channel_->pass(sent, arrivals);
    if (is_changed) note(sent, arrivals, first);
    ++passed_;
    return is_changed;
  }

 private:
  void note(const line::Waveform& sent, const line::Waveforms& arrivals, std::size_t first) {
    const bool is_level = sent.rate > bit_rate_ && sent.rate % bit_rate_ == 0;
    const std::int64_t rate = is_level ? sent.rate : bit_rate_;
    constexpr std::array kSamples{7U, 8U, 9U};
    const std::span<const unsigned> samples = std::span(kSamples).subspan(is_level ? 1 : 0, is_level ? 1 : 3);
    for (unsigned bit = 0; middle_of(sent, bit, 8, rate) < sent.end(); ++bit) {
      int others = 0;
      for (const unsigned sixteenth : samples) {
        const kernel::Time time = middle_of(sent, bit, sixteenth, rate);
        others += level_at(arrivals, first, time) == sent.at(time) ? -1 : 1;
      }
      if (others > 0) struck_->push_back({receiver_, from_, passed_, bit, is_level});
    }
  }
  static kernel::Time middle_of(const line::Waveform& sent, unsigned bit, unsigned sixteenth,
                                std::int64_t rate) {
    return line::Sampling::instant(sent.start, bit, sixteenth, rate);
  }

  std::unique_ptr<fault::Channel> channel_;
  std::string receiver_;
  kernel::Time from_;
  std::int64_t bit_rate_;
  std::shared_ptr<FlippedBits> struck_;
  std::uint64_t passed_ = 0;
};

// One disturbance for each that struck, with the bits of each transmission together.
ordered_json disturbances_of(std::span<const StruckBit> struck) {
  using Bits = std::map<std::uint64_t, std::vector<std::uint64_t>>;
  std::map<std::tuple<kernel::Time, std::string, bool>, Bits> all;
  for (const StruckBit& one : struck)
    all[{one.from, one.receiver, one.is_level}][one.transmission].push_back(one.bit);
  ordered_json disturbances = ordered_json::array();
  for (const auto& [place, transmissions] : all) {
    ordered_json list = ordered_json::array();
    for (const auto& [transmission, bits] : transmissions) {
      list.push_back({{"transmission", transmission}, {std::get<bool>(place) ? "levels" : "bits", bits}});
    }
    const auto& [from, receiver, is_level] = place;
    ordered_json& one = disturbances.emplace_back(ordered_json{{"receiver", receiver}});
    if (from != kernel::kStart) one["from"] = kernel::describe(from - kernel::kStart);
    one[is_level ? "flipped_levels" : "flipped_bits"] = std::move(list);
  }
  return disturbances;
}

std::unique_ptr<fault::Channel> watched_at(const fault::StressPlace& place,
                                           std::unique_ptr<fault::Channel> channel,
                                           const std::shared_ptr<FlippedBits>& struck) {
  return std::make_unique<WatchedChannel>(std::move(channel), place.trace.channel_name(place.channel),
                                          place.from, place.bit_rate, struck);
}

using MakeChannel = decltype(fault::Stress::make_channel);

// `change` makes another MakeChannel of each.
template <typename Change>
void change_stresses(conformance::Disturbances& all, Change change) {
  for (fault::Stress& stress : all.stresses) stress.make_channel = change(stress.make_channel);
  for (auto& [bit_rate, stresses] : all.link_stresses) {
    for (fault::Stress& stress : stresses) stress.make_channel = change(stress.make_channel);
  }
}

}  // namespace

conformance::Disturbances watched(conformance::Disturbances all, const std::shared_ptr<FlippedBits>& struck) {
  change_stresses(all, [&struck](const MakeChannel& make) {
    return [make, struck](const fault::StressPlace& place) { return watched_at(place, make(place), struck); };
  });
  for (fault::DisturbanceKind& kind : all.of_plans) {
    kind.read = [read = kind.read, struck](const config::Value& value) {
      fault::DisturbanceModel model = read(value);
      model.make_channel = [make = model.make_channel, struck](const fault::StressPlace& place) {
        return watched_at(place, make(place), struck);
      };
      return model;
    };
  }
  return all;
}

std::unique_ptr<fault::Channel> watched(std::unique_ptr<fault::Channel> channel, std::string receiver,
                                        std::int64_t bit_rate, const std::shared_ptr<FlippedBits>& struck) {
  return std::make_unique<WatchedChannel>(std::move(channel), std::move(receiver), kernel::kStart, bit_rate,
                                          struck);
}

conformance::Disturbances without_stresses(conformance::Disturbances all) {
  change_stresses(all, [](const MakeChannel&) { return [](const fault::StressPlace&) { return nullptr; }; });
  return all;
}

std::string plan_of(std::span<const StruckBit> struck, const std::string& plan) {
  ordered_json json = ordered_json::object();
  // Whoever ran the plan has read it: comments are all that it may have beyond JSON.
  if (!plan.empty()) json = ordered_json::parse(plan, nullptr, true, true);
  json["disturbances"] = disturbances_of(struck);
  return json.dump(2) + "\n";
}

}  // namespace fieldproof::cli
