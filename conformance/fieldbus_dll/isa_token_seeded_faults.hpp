#pragma once

#include <optional>

#include "conformance/fieldbus_dll/isa_seeded_faults.hpp"
#include "conformance/fieldbus_dll/submission_order.hpp"

// Data link entities that use a token otherwise.
namespace fieldproof::conformance::isa_seeded_faults {

class NoFrameUnderEt : public IsaDle {
  using IsaDle::IsaDle;
  std::optional<Priority> next_to_send(const Queues& from, Priority least) const override {
    if (token() && token()->by.type == IsaType::et) return std::nullopt;
    return IsaDle::next_to_send(from, least);
  }
};

// Says another thing in a DLPDU of one type, octet by octet.
class WritesOtherwise : public IsaDle {
 public:
  WritesOtherwise(const IsaConfiguration& configuration, IsaType type, std::size_t octet, std::uint8_t value)
      : IsaDle(configuration), type_(type), octet_(octet), value_(value) {}

 private:
  Octets written(const IsaDlpdu& dlpdu) const override {
    Octets octets = IsaDle::written(dlpdu);
    if (dlpdu.type == type_) octets[octet_] = value_;
    return octets;
  }
  IsaType type_;
  std::size_t octet_;
  std::uint8_t value_;
};

class SaysTwice : public IsaDle {
 public:
  SaysTwice(const IsaConfiguration& configuration, std::uint8_t code) : IsaDle(configuration), code_(code) {}

 private:
  Time put_on_line(const Octets& octets, Time now) override {
    const Time end = IsaDle::put_on_line(octets, now);
    if ((octets[0] & 0xF0) != code_) return end;
    return IsaDle::put_on_line(octets, end + silence_before_sending());
  }
  std::uint8_t code_;
};

class EtSendsAll : public IsaDle {
  using IsaDle::IsaDle;
  bool is_single(const IsaDlpdu&) const override { return false; }
};

class EsSendsOne : public IsaDle {
  using IsaDle::IsaDle;
  bool is_single(const IsaDlpdu&) const override { return true; }
};

class LosesQueueAtEnd : public IsaDle {
 public:
  LosesQueueAtEnd(const IsaConfiguration& configuration, EndReason reason)
      : IsaDle(configuration), reason_(reason) {}

 private:
  void end_token(EndReason reason, Time now) override {
    if (reason == reason_) queues() = {};
    IsaDle::end_token(reason, now);
  }
  EndReason reason_;
};

class NoEndWhenEmpty : public IsaDle {
  using IsaDle::IsaDle;
  bool returns_token(EndReason reason, Time now) const override {
    return (reason != EndReason::nothing_to_send || token()->is_used) && IsaDle::returns_token(reason, now);
  }
};

class NoEndOfSequence : public IsaDle {
  using IsaDle::IsaDle;
  bool returns_token(EndReason reason, Time now) const override {
    return token()->by.type != IsaType::es && IsaDle::returns_token(reason, now);
  }
};

class EndBehindDuration : public IsaDle {
  using IsaDle::IsaDle;
  bool returns_token(EndReason, Time) const override { return true; }
};

class AnswersBehindRr : public IsaDle {
  using IsaDle::IsaDle;
  Duration silence_before_sending() const override { return octet_times(rules().reply_wait_octets + 1); }
};

class RestsBeforeEnd : public IsaDle {
  using IsaDle::IsaDle;
  Duration silence_before_sending() const override {
    const bool has_done = token() && token()->is_used && queues().empty();
    return has_done ? octet_times(rules().reply_wait_octets + 1) : IsaDle::silence_before_sending();
  }
};

class PriorityInverted : public IsaDle {
  using IsaDle::IsaDle;
  bool may_send(Priority priority, Priority least) const override { return priority <= least; }
};

class PriorityIgnored : public IsaDle {
  using IsaDle::IsaDle;
  bool may_send(Priority, Priority) const override { return true; }
};

class FifoAcrossPriorities : public IsaDle {
  using IsaDle::IsaDle;
  bool submit(const IsaRequest& request, Time now) override {
    const bool is_taken = IsaDle::submit(request, now);
    if (is_taken && request.service != IsaService::reply_data) order_.add(request.priority);
    return is_taken;
  }
  std::optional<Priority> next_to_send(const Queues& from, Priority least) const override {
    return &from == &queues() ? order_.first_of(from) : IsaDle::next_to_send(from, least);
  }
  SubmissionOrder<Queues> order_;
};

class FinishesAPriority : public IsaDle {
  using IsaDle::IsaDle;
  std::optional<Priority> next_to_send(const Queues& from, Priority least) const override {
    if (&from == &queues() && last_ && !from.queue(*last_).empty()) return last_;
    return IsaDle::next_to_send(from, least);
  }
  void send(const IsaRequest& request, Time now) override {
    last_ = request.priority;
    IsaDle::send(request, now);
  }
  void end_token(EndReason reason, Time now) override {
    last_.reset();
    IsaDle::end_token(reason, now);
  }
  std::optional<Priority> last_;
};

class FitIsStrict : public IsaDle {
  using IsaDle::IsaDle;
  bool fits(const IsaRequest& request, Time now) const override {
    return now + needed_for(request) < token()->ends;
  }
};

class FitWithoutEnd : public IsaDle {
  using IsaDle::IsaDle;
  Duration needed_for(const IsaRequest& request) const override {
    return IsaDle::needed_for(request) - silence_before_sending() -
           frame_time(rules().link, fieldbus_dll::octets_on_line(IsaType::ee));
  }
};

class FitsAlways : public IsaDle {
  using IsaDle::IsaDle;
  bool fits(const IsaRequest&, Time) const override { return true; }
  bool returns_token(EndReason, Time) const override { return true; }
};

class DurationFromBeginOfEs : public IsaDle {
  using IsaDle::IsaDle;
  Time token_end(const IsaDlpdu& es, const Place& place) const override {
    return place.begin + octet_times(es.duration);
  }
};

class DurationIgnored : public IsaDle {
  using IsaDle::IsaDle;
  Time token_end(const IsaDlpdu&, const Place&) const override { return kernel::kNever; }
};

class DurationLittleEndian : public IsaDle {
  using IsaDle::IsaDle;
  std::optional<IsaDlpdu> understood(Heard octets) const override {
    auto dlpdu = IsaDle::understood(octets);
    if (dlpdu) dlpdu->duration = static_cast<std::uint16_t>(dlpdu->duration << 8 | dlpdu->duration >> 8);
    return dlpdu;
  }
};

class TakesAnyToken : public IsaDle {
  using IsaDle::IsaDle;
  bool is_meant(const IsaDlpdu& dlpdu) const override {
    return IsaDle::is_meant(dlpdu) || dlpdu.type == IsaType::et || dlpdu.type == IsaType::es;
  }
};

class TimersOf31250 : public IsaDle {
  using IsaDle::IsaDle;
  Duration silence_before_sending() const override {
    return kernel::levels_duration(8 * std::int64_t{rules().link.inter_pdu_delay_octets}, 31'250);
  }
};

}  // namespace fieldproof::conformance::isa_seeded_faults
