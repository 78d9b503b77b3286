#pragma once

#include <optional>

#include "conformance/fieldbus_dll/ff_seeded_faults.hpp"
#include "conformance/fieldbus_dll/submission_order.hpp"

// Basic devices that use their tokens otherwise.
namespace fieldproof::conformance::ff_seeded_faults {

// ---- tokens ----

class FfPriorityInverted : public FfStation {
  using FfStation::FfStation;
  bool may_send(Priority priority, Priority least) const override { return priority <= least; }
};

class FfPriorityIgnored : public FfStation {
  using FfStation::FfStation;
  bool may_send(Priority, Priority) const override { return true; }
};

class FfFifoAcrossPriorities : public FfStation {
  using FfStation::FfStation;
  bool submit(const FfRequest& request, Time now) override {
    const bool is_taken = FfStation::submit(request, now);
    if (is_taken) order_.add(request.priority);
    return is_taken;
  }
  std::optional<Priority> next_to_send(const Queues& from, Priority) const override {
    return order_.first_of(from);
  }
  SubmissionOrder<Queues> order_;
};

class OneFrameAToken : public FfStation {
  using FfStation::FfStation;
  std::optional<Priority> next_to_send(const Queues& from, Priority least) const override {
    if (token() && token()->ends == used_) return std::nullopt;
    return FfStation::next_to_send(from, least);
  }
  Time put_on_line(const Octets& octets, Time now) override {
    if (token()) used_ = token()->ends;
    return FfStation::put_on_line(octets, now);
  }
  Octets written(const FfDlpdu& dlpdu) const override {
    FfDlpdu other = dlpdu;
    if (dlpdu.type == FfType::dt1) other.is_final = true;
    return FfStation::written(other);
  }
  void use_token(Time now) override {
    FfStation::use_token(now);
    if (token() && token()->ends == used_) {
      drop_token();
      enter(fieldbus_dll::FfState::idle);
    }
  }
  Time used_ = kernel::kNever;
};

class NoReturnWhenEmpty : public FfStation {
  using FfStation::FfStation;
  bool returns_by_rt(bool) const override { return false; }
};

class ReturnsTwice : public FfStation {
  using FfStation::FfStation;
  bool returns_by_rt(bool) const override { return true; }
};

class NeverFinal : public FfStation {
  using FfStation::FfStation;
  Octets written(const FfDlpdu& dlpdu) const override {
    FfDlpdu other = dlpdu;
    other.is_final = false;
    return FfStation::written(other);
  }
};

class QueueLostWithToken : public FfStation {
  using FfStation::FfStation;
  void use_token(Time now) override {
    FfStation::use_token(now);
    if (!token()) queues() = {};
  }
};

// The duration of a token times this many bits.
class DurationTimes : public FfStation {
 public:
  DurationTimes(const FfConfiguration& configuration, int bits) : FfStation(configuration), bits_(bits) {}

 private:
  Time token_end(const FfDlpdu& pt, const Place& place) const override {
    return place.end + octet_times(std::int64_t{pt.duration} * bits_) / 8;
  }
  int bits_;
};

// What it takes the duration of a token for.
class DurationReadAs : public FfStation {
 public:
  using Read = std::int64_t (*)(std::uint16_t);
  DurationReadAs(const FfConfiguration& configuration, Read read) : FfStation(configuration), read_(read) {}

 private:
  Time token_end(const FfDlpdu& pt, const Place& place) const override {
    return place.end + octet_times(read_(pt.duration));
  }
  Read read_;
};

class FfDurationIgnored : public FfStation {
  using FfStation::FfStation;
  Time token_end(const FfDlpdu&, const Place&) const override { return kernel::kNever; }
};

class DurationFromBeginOfPt : public FfStation {
  using FfStation::FfStation;
  Time token_end(const FfDlpdu& pt, const Place& place) const override {
    return place.begin + octet_times(pt.duration);
  }
};

class FfFitIsStrict : public FfStation {
  using FfStation::FfStation;
  bool fits(const FfDlpdu& dlpdu, Time begin) const override {
    return begin + needed_for(dlpdu) < token()->ends;
  }
};

class OverheadNotCharged : public FfStation {
  using FfStation::FfStation;
  Duration needed_for(const FfDlpdu& dlpdu) const override {
    return FfStation::needed_for(dlpdu) - octet_times(octets_around(rules().link));
  }
};

class FfUrgentAsLongAsNormal : public FfStation {
  using FfStation::FfStation;
  bool is_too_long(Priority priority, std::size_t octets) const override {
    return FfStation::is_too_long(priority == Priority::urgent ? Priority::normal : priority, octets);
  }
};

}  // namespace fieldproof::conformance::ff_seeded_faults
