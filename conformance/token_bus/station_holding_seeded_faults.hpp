#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "conformance/token_bus/station_seeded_faults.hpp"

// Stations of the token bus that hold the token, or recover from a failure, otherwise.
namespace fieldproof::conformance::token_seeded_faults {

// ---- failure ----

class StagesOtherwise : public TokenStation {
 public:
  StagesOtherwise(const StationConfiguration& configuration, unsigned tokens, unsigned who_follows,
                  bool asks_any)
      : TokenStation(configuration), tokens_(tokens), who_follows_(who_follows), asks_any_(asks_any) {}

 private:
  PassStage stage_after(unsigned attempts) const override {
    if (attempts < tokens_) return PassStage::token;
    if (attempts < tokens_ + who_follows_) return PassStage::who_follows;
    return attempts == tokens_ + who_follows_ && asks_any_ ? PassStage::solicit_any : PassStage::failed;
  }
  unsigned tokens_;
  unsigned who_follows_;
  bool asks_any_;
};

class NoiseAfterTokenOtherwise : public TokenStation {
 public:
  NoiseAfterTokenOtherwise(const StationConfiguration& configuration, bool is_success)
      : TokenStation(configuration), is_success_(is_success) {}

 private:
  NoiseAfterToken noise_after_token() const override {
    return is_success_ ? NoiseAfterToken::success : NoiseAfterToken::failure;
  }
  bool is_success_;
};

class UnexpectedFramesIgnored : public TokenStation {
  using TokenStation::TokenStation;
  bool drops_token_on(const Frame&) const override { return false; }
};

class RepeatsOtherwise : public TokenStation {
 public:
  RepeatsOtherwise(const StationConfiguration& configuration, int more)
      : TokenStation(configuration), more_(more) {}

 private:
  unsigned request_repetitions() const override {
    return static_cast<unsigned>(std::max(0, static_cast<int>(TokenStation::request_repetitions()) + more_));
  }
  int more_;
};

class ResponseNotTaken : public TokenStation {
  using TokenStation::TokenStation;
  std::vector<Reception> received(const line::Waveform& wave) const override {
    if (state() == AccessState::await_ifm_response) return {};
    return TokenStation::received(wave);
  }
};

class DuplicateIgnored : public TokenStation {
  using TokenStation::TokenStation;
  bool is_duplicate(const Frame&) const override { return false; }
};

// ---- holding ----

class DataLost : public TokenStation {
  using TokenStation::TokenStation;
  bool submit(const token_bus::DataRequest& request, Time now) override {
    return request.data.size() < 1'000 ? TokenStation::submit(request, now) : true;
  }
};

class FrameCutAtExpiry : public TokenStation {
  using TokenStation::TokenStation;
  line::Levels written(const Frame& frame, Time begin) const override {
    const line::Levels levels = TokenStation::written(frame, begin);
    if (frame.kind != FrameKind::data || begin >= hold_until()) return levels;
    const auto left = kernel::levels_within(hold_until() - begin, 2 * rules().phy_bit_rate);
    return levels.slice(0, std::min(levels.size(), static_cast<std::size_t>(left)));
  }
};

class ServedWithoutTime : public TokenStation {
  using TokenStation::TokenStation;
  bool may_begin(unsigned place, Time begin) const override {
    return place > 0 || TokenStation::may_begin(place, begin);
  }
};

class PrioritiesIgnored : public TokenStation {
  using TokenStation::TokenStation;
  bool submit(const token_bus::DataRequest& request, Time now) override {
    token_bus::DataRequest other = request;
    other.priority = 6;
    return TokenStation::submit(other, now);
  }
};

class TimersBeginWithTheToken : public TokenStation {
  using TokenStation::TokenStation;
  void on_token_taken(Time now) override {
    for (unsigned place = 1; place < left_.size(); ++place) {
      left_.at(place) = residual(place, now);
      reload(place, now);
    }
  }
  Duration hold_time(unsigned place, Time now) override {
    return place == 0 ? TokenStation::hold_time(place, now) : left_.at(place);
  }
  std::array<Duration, token_bus::kAccessClasses> left_{};
};

class HoldOtherwise : public TokenStation {
 public:
  HoldOtherwise(const StationConfiguration& configuration, int percent)
      : TokenStation(configuration), percent_(percent) {}

 private:
  Duration hold_time(unsigned place, Time now) override {
    const Duration right = TokenStation::hold_time(place, now);
    return place == 0 ? right * percent_ / 100 : right;
  }
  int percent_;
};

}  // namespace fieldproof::conformance::token_seeded_faults
