#pragma once

#include <utility>

#include "conformance/fieldbus_dll/ff_seeded_faults.hpp"

// Link masters that run their schedule, or circulate tokens, otherwise.
namespace fieldproof::conformance::ff_seeded_faults {

// ---- schedule ----

class TokenOverDue : public FfLas {
  using FfLas::FfLas;
  unsigned token_grant(Duration) const override { return rules().token_holding_octets; }
};

class NoAllowanceForPt : public FfLas {
  using FfLas::FfLas;
  unsigned token_grant(Duration left) const override {
    constexpr std::int64_t kPt = 9;
    return FfLas::token_grant(left + kept_free_before_cd() + octet_times(kPt));
  }
};

class CutToTheLeast : public FfLas {
  using FfLas::FfLas;
  unsigned token_grant(Duration left) const override {
    const unsigned grant = FfLas::token_grant(left);
    return grant < rules().token_holding_octets ? std::min(grant, rules().least_token_octets) : grant;
  }
};

class ScheduleInCentiseconds : public FfLas {
  using FfLas::FfLas;
  Time due(const FfScheduleItem& item) const override {
    constexpr Duration kStep = 10 * kernel::kMillisecond;
    const Duration at = FfLas::due(item) - kernel::kStart;
    return kernel::kStart + (at + kStep - kernel::kPicosecond) / kStep * kStep;
  }
};

class ItemSkipped : public FfLas {
  using FfLas::FfLas;
  void advance() override {
    FfLas::advance();
    if (++passed_ == 4) FfLas::advance();
  }
  int passed_ = 0;
};

class AnswerTimeFromBegin : public FfLas {
  using FfLas::FfLas;
  Time answer_awaited_until(const Place& question) const override {
    return question.begin + response_delay(rules().link);
  }
};

class AnswerTimeDoubled : public FfLas {
  using FfLas::FfLas;
  Time answer_awaited_until(const Place& question) const override {
    return question.end + 2 * response_delay(rules().link);
  }
};

class LineLeftSilent : public FfLas {
  using FfLas::FfLas;
  Duration longest_silence() const override { return octet_times(100'000); }
};

class ScheduleNotBegunBehindTl : public FfLas {
  using FfLas::FfLas;
  Time due(const FfScheduleItem&) const override { return kernel::kNever; }
};

// ---- circulation ----

class SaysOtherwise : public FfLas {
 public:
  using Change = void (*)(FfDlpdu&);
  SaysOtherwise(const FfConfiguration& configuration, FfType type, Change change)
      : FfLas(configuration), type_(type), change_(change) {}

 private:
  Octets written(const FfDlpdu& dlpdu) const override {
    FfDlpdu other = dlpdu;
    if (other.type == type_ && is_scheduler()) change_(other);
    return FfLas::written(other);
  }
  FfType type_;
  Change change_;
};

class FirstProbeLeftOut : public FfLas {
  using FfLas::FfLas;
  std::uint8_t next_probe(std::uint8_t last) const override {
    const std::uint8_t next = FfLas::next_probe(last);
    return std::exchange(has_probed_, true) ? next : FfLas::next_probe(next);
  }
  mutable bool has_probed_ = false;
};

class RefusesItsLastInstant : public FfLas {
  using FfLas::FfLas;
  bool start(kernel::Time now) override {
    const auto& [version, macrocycle, items] = configuration().schedule;
    const auto is_last = [&](const fieldbus_dll::FfScheduleItem& item) { return item.at + 1 == macrocycle; };
    return std::ranges::none_of(items, is_last) && FfLas::start(now);
  }
};

class ProbesOtherwise : public FfLas {
 public:
  ProbesOtherwise(const FfConfiguration& configuration, int step, bool live_ones_too)
      : FfLas(configuration), step_(step), live_ones_too_(live_ones_too) {}

 private:
  std::uint8_t next_probe(std::uint8_t last) const override {
    const int first = rules().first_node;
    const int count = rules().last_node - first + 1;
    int node = last;
    for (int n = 0; n < count; ++n) {
      node = first + (node - first + step_ + count) % count;
      if (!is_left_out(static_cast<unsigned>(node))) return static_cast<std::uint8_t>(node);
    }
    return this->node();  // all are live
  }
  bool is_left_out(unsigned node) const {
    const bool is_unpolled =
        node >= rules().first_unpolled && node < rules().first_unpolled + rules().unpolled;
    return is_unpolled || node == this->node() || (live()[node] && !live_ones_too_);
  }
  int step_;
  bool live_ones_too_;
};

class ProbesUnpolled : public FfLas {
  using FfLas::FfLas;
  std::uint8_t next_probe(std::uint8_t last) const override {
    std::uint8_t node = last;
    do {
      node = node == rules().last_node ? rules().first_node : static_cast<std::uint8_t>(node + 1);
    } while (live()[node] && node != last);
    return live()[node] ? this->node() : node;
  }
};

class NoProbeWhenBusy : public FfLas {
  using FfLas::FfLas;
  bool probes_now() const override { return rotation() < octet_times(250); }
};

class SteersTheWrongWay : public FfLas {
  using FfLas::FfLas;
  bool is_too_slow(Duration rotation) const override { return !FfLas::is_too_slow(rotation); }
};

class StepsToTheExtreme : public FfLas {
  using FfLas::FfLas;
  Priority next_priority(Priority, bool is_too_slow) const override {
    return is_too_slow ? Priority::urgent : Priority::time_available;
  }
};

class RotationCountedTwice : public FfLas {
  using FfLas::FfLas;
  Duration rotation_of(Time last, Time now) const override { return 2 * FfLas::rotation_of(last, now); }
};

class StepsBackToTheExtreme : public FfLas {
  using FfLas::FfLas;
  Priority next_priority(Priority now, bool is_too_slow) const override {
    return is_too_slow ? Priority::urgent : FfLas::next_priority(now, is_too_slow);
  }
};

class HolderNeverStopped : public FfLas {
  using FfLas::FfLas;
  Time holder_until(Time, unsigned) const override { return kernel::kNever; }
};

class ReturnOfAnybodyTaken : public FfLas {
  using FfLas::FfLas;
  bool is_from_awaited(const FfDlpdu&) const override { return true; }
};

class TargetIgnored : public FfLas {
  using FfLas::FfLas;
  bool is_too_slow(Duration) const override { return false; }
};

class EqualRotationIsFast : public FfLas {
  using FfLas::FfLas;
  bool is_too_slow(Duration rotation) const override { return rotation > rules().target_rotation; }
};

}  // namespace fieldproof::conformance::ff_seeded_faults
