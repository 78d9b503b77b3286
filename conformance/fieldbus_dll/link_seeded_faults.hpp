#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "harness/line/delimited_frame.hpp"
#include "protocols/fieldbus_dll/line_end.hpp"

// How a station of any profile can be wrong: it takes requests or rules that there are not, or takes apart
// otherwise what arrives.
namespace fieldproof::conformance::link_seeded_faults {

using fieldbus_dll::Arrived;
using fieldbus_dll::Octets;
using fieldbus_dll::Priority;
using kernel::Time;

template <typename Station>
class UnknownRequestsTaken : public Station {
  using Station::Station;
  bool ask(const Octets&, Time) override { return true; }
};

template <typename Station>
class OrdersTaken : public Station {
  using Station::Station;
  bool order_transfer(std::uint8_t, Time) override { return true; }
};

// Of data.
template <typename Station, typename Request>
class AcceptsPriority : public Station {
 public:
  template <typename Configuration>
  AcceptsPriority(const Configuration& configuration, unsigned priority)
      : Station(configuration), priority_(static_cast<Priority>(priority)) {}

 private:
  bool submit(const Request& request, Time now) override {
    return request.priority == priority_ || Station::submit(request, now);
  }
  Priority priority_;
};

template <typename Station>
class ImpossibleRulesTaken : public Station {
  using Station::Station;
  bool are_impossible() const override { return false; }
};

// ---- what arrives ----

template <typename Station>
class BitsCountedOn : public Station {
  using Station::Station;
  std::vector<Arrived> heard_in(const line::Waveform& reception) override {
    constexpr std::size_t kOctet = 16;
    const auto frames = line::delimited_frames_in(reception, this->rules().link.bit_rate);
    for (std::size_t n = 1; n < frames.size(); ++n) {
      const bool is_cut = (frames[n].half_bit - frames[n - 1].half_bit) % kOctet != 0;
      if (frames[n - 1].end == line::FrameEnd::begun_anew && is_cut) return {};
    }
    return Station::heard_in(reception);
  }
};

template <typename Station>
class SilenceFromTheDelimiter : public Station {
  using Station::Station;
  std::vector<Arrived> heard_in(const line::Waveform& reception) override {
    constexpr std::size_t kOctet = 16;
    const auto frames = line::delimited_frames_in(reception, this->rules().link.bit_rate);
    over_ = reception.end();
    if (!frames.empty()) {
      const std::size_t last = frames.back().half_bit + kOctet * (frames.back().octets.size() + 2);
      delimited_ = kernel::level_time(reception.start, static_cast<std::int64_t>(last),
                                      2 * this->rules().link.bit_rate);
    }
    return Station::heard_in(reception);
  }
  Time may_begin() const override {
    const Time since = this->line().silent_since();
    return since == over_ ? std::max(since, delimited_ + this->silence_before_sending())
                          : Station::may_begin();
  }
  Time over_ = kernel::kNever;
  Time delimited_ = kernel::kStart;
};

template <typename Station>
class LastOfATransmission : public Station {
  using Station::Station;
  std::vector<Arrived> heard_in(const line::Waveform& reception) override {
    std::vector<Arrived> all = Station::heard_in(reception);
    if (all.size() > 1) all.erase(all.begin(), all.end() - 1);
    return all;
  }
};

template <typename Station>
class FirstTwoOfATransmission : public Station {
  using Station::Station;
  std::vector<Arrived> heard_in(const line::Waveform& reception) override {
    std::vector<Arrived> all = Station::heard_in(reception);
    if (all.size() > 2) all.erase(all.begin() + 2, all.end());
    return all;
  }
};

// A receiver that samples with its own clock from the first level on.
template <typename Station>
class DoesNotRecoverClock : public Station {
  using Station::Station;
  std::vector<Arrived> heard_in(const line::Waveform& reception) override {
    line::Waveform sampled{reception.start, 2 * this->rules().link.bit_rate, {}};
    for (std::int64_t n = 0;; ++n) {
      const Time middle = kernel::level_time(reception.start, 2 * n + 1, 2 * sampled.rate);
      if (middle >= reception.end()) break;
      sampled.levels.append(reception.at(middle) ? 1 : 0, 1);
    }
    return Station::heard_in(sampled);
  }
};

template <typename Station>
class WantsExactEdges : public Station {
  using Station::Station;
  std::vector<Arrived> heard_in(const line::Waveform& reception) override {
    const double per_half_bit =
        static_cast<double>(reception.rate) / (2.0 * static_cast<double>(this->rules().link.bit_rate));
    for (std::size_t at = 0; at < reception.levels.size();) {
      const std::size_t end = reception.levels.end_of_run(at);
      const double half_bits = static_cast<double>(end - at) / per_half_bit;
      const double off = half_bits - static_cast<double>(static_cast<std::int64_t>(half_bits + 0.5));
      if (off > 0.1 || off < -0.1) return {};
      at = end;
    }
    return Station::heard_in(reception);
  }
};

template <typename Station>
class DeafBehind71Minutes : public Station {
  using Station::Station;
  std::vector<Arrived> heard_in(const line::Waveform& reception) override {
    const bool is_deaf = reception.start - kernel::kStart > (std::int64_t{1} << 32) * kernel::kMicrosecond;
    return is_deaf ? std::vector<Arrived>{} : Station::heard_in(reception);
  }
};

template <typename Station>
class LevelsAreHalfBits : public Station {
  using Station::Station;
  std::vector<Arrived> heard_in(const line::Waveform& reception) override {
    line::Waveform other = reception;
    other.rate = 2 * this->rules().link.bit_rate;
    std::vector<Arrived> all = Station::heard_in(other);
    for (Arrived& one : all) one = {std::move(one.octets), reception.start, reception.end()};
    return all;
  }
};

template <typename Station>
class DeafToLongFrames : public Station {
  using Station::Station;
  std::vector<Arrived> heard_in(const line::Waveform& reception) override {
    std::vector<Arrived> all = Station::heard_in(reception);
    std::erase_if(all, [](const Arrived& one) { return one.octets.size() > 128; });
    return all;
  }
};

}  // namespace fieldproof::conformance::link_seeded_faults
