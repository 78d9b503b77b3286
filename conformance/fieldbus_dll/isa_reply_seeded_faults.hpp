#pragma once

#include <optional>

#include "conformance/fieldbus_dll/isa_seeded_faults.hpp"

// Data link entities that compel, reply or deliver otherwise.
namespace fieldproof::conformance::isa_seeded_faults {

// VC(RR) is stopped by the end of a reply, not by its begin.
class RrRunsThroughReply : public IsaDle {
  using IsaDle::IsaDle;
  bool lets_a_reply_end() const override { return false; }
  Time may_begin() const override {
    return has_given_up_ ? line().driven_until() + silence_before_sending() : IsaDle::may_begin();
  }
  void on_reply_wait_over(Time now) override {
    has_given_up_ = true;
    IsaDle::on_reply_wait_over(now);
  }
  void end_token(EndReason reason, Time now) override {
    has_given_up_ = false;
    IsaDle::end_token(reason, now);
  }
  bool has_given_up_ = false;
};

// The token is gone with the reply, or with one that did not come.
class LosesTokenByReply : public IsaDle {
 public:
  LosesTokenByReply(const IsaConfiguration& configuration, bool by_a_missing_one)
      : IsaDle(configuration), by_a_missing_one_(by_a_missing_one) {}

 private:
  void on_reply_wait_over(Time now) override {
    is_missing_ = true;
    IsaDle::on_reply_wait_over(now);
    is_missing_ = false;
  }
  void resume(Time now) override {
    if (is_missing_ == by_a_missing_one_) drop_token();
    IsaDle::resume(now);
  }
  bool by_a_missing_one_;
  bool is_missing_ = false;
};

class AnswersWhileWaiting : public IsaDle {
  using IsaDle::IsaDle;
  void on_dlpdu(const IsaDlpdu& dlpdu, const Place& place) override {
    if (dlpdu.type == IsaType::cd && is_meant(dlpdu)) {
      begin_reply(dlpdu, place.end);
    } else {
      IsaDle::on_dlpdu(dlpdu, place);
    }
  }
};

class LateReplyLost : public IsaDle {
  using IsaDle::IsaDle;
  void on_time(Time now) override {
    const bool was_replying = state() == fieldbus_dll::DleState::replying;
    IsaDle::on_time(now);
    const bool has_given_up = state() == fieldbus_dll::DleState::idle && !line().is_driving(now);
    if (was_replying && has_given_up) loses_next_ = true;
  }
  bool submit(const IsaRequest& request, Time now) override {
    const bool is_lost = loses_next_ && request.service == IsaService::reply_data;
    if (is_lost) loses_next_ = false;
    return is_lost || IsaDle::submit(request, now);
  }
  bool loses_next_ = false;
};

class DoesNotWaitForUser : public IsaDle {
  using IsaDle::IsaDle;
  bool waits_for_user(Priority, Time) override { return false; }
};

class NoDataNoReply : public IsaDle {
  using IsaDle::IsaDle;
  Time put_on_line(const Octets& octets, Time now) override {
    constexpr std::size_t kEmpty = 3;
    const bool is_empty_reply = (octets[0] & 0xF0) == rules().codes.dt && octets.size() == kEmpty;
    return is_empty_reply ? now : IsaDle::put_on_line(octets, now);
  }
};

class ReplyNotFinal : public IsaDle {
  using IsaDle::IsaDle;
  Octets written(const IsaDlpdu& dlpdu) const override {
    IsaDlpdu other = dlpdu;
    other.is_final = false;
    return IsaDle::written(other);
  }
};

class ReplyIgnoresPriority : public IsaDle {
  using IsaDle::IsaDle;
  std::optional<Priority> next_to_send(const Queues& from, Priority least) const override {
    return IsaDle::next_to_send(from, &from == &queues() ? least : Priority::time_available);
  }
};

class UrgentAsLongAsNormal : public IsaDle {
  using IsaDle::IsaDle;
  bool is_too_long(const IsaRequest& request) const override {
    IsaRequest other = request;
    if (other.priority == Priority::urgent) other.priority = Priority::normal;
    return IsaDle::is_too_long(other);
  }
};

class OneOctetLess : public IsaDle {
  using IsaDle::IsaDle;
  bool is_too_long(const IsaRequest& request) const override {
    return request.data.size() >= most_data(rules().link, request.priority);
  }
};

// Reads data with something changed.
class TellsOtherwise : public IsaDle {
 public:
  using Change = void (*)(IsaDlpdu&);
  TellsOtherwise(const IsaConfiguration& configuration, Change change)
      : IsaDle(configuration), change_(change) {}

 private:
  std::optional<IsaDlpdu> understood(Heard octets) const override {
    auto dlpdu = IsaDle::understood(octets);
    if (dlpdu && (dlpdu->type == IsaType::du || dlpdu->type == IsaType::dt)) change_(*dlpdu);
    return dlpdu;
  }
  Change change_;
};

class BroadcastNotDelivered : public IsaDle {
  using IsaDle::IsaDle;
  bool is_delivered(const IsaDlpdu& dlpdu) const override {
    return IsaDle::is_delivered(dlpdu) && is_meant(dlpdu);
  }
};

class OthersDataDelivered : public IsaDle {
  using IsaDle::IsaDle;
  bool is_delivered(const IsaDlpdu& dlpdu) const override {
    return dlpdu.type == IsaType::dt || dlpdu.type == IsaType::du;
  }
};

class DtToEverybodyDelivered : public IsaDle {
  using IsaDle::IsaDle;
  std::optional<IsaDlpdu> understood(Heard octets) const override {
    if (octets.size() < 2 || octets[1] != rules().everybody) return IsaDle::understood(octets);
    Octets other(octets.begin(), octets.end());
    other[1] = address();
    return IsaDle::understood(other);
  }
};

class BroadcastAnswered : public IsaDle {
  using IsaDle::IsaDle;
  void on_dlpdu(const IsaDlpdu& dlpdu, const Place& place) override {
    IsaDle::on_dlpdu(dlpdu, place);
    if (dlpdu.type != IsaType::du || dlpdu.destination != rules().everybody) return;
    IsaDlpdu answer;
    answer.type = IsaType::dt;
    answer.is_final = true;
    answer.destination = dlpdu.source;
    answer.source = address();
    transmit(answer, place.end + silence_before_sending());
  }
};

// ---- timers ----

// V(FD) and V(RR) so many half bits longer.
class ShiftsTimers : public IsaDle {
 public:
  ShiftsTimers(const IsaConfiguration& configuration, int forming, int wait)
      : IsaDle(configuration), forming_(forming), wait_(wait) {}

 private:
  Duration reply_forming() const override { return IsaDle::reply_forming() + octet_times(forming_) / 16; }
  Duration reply_wait() const override { return IsaDle::reply_wait() + octet_times(wait_) / 16; }
  int forming_;
  int wait_;
};

class IsaNoDlpduIsTakenForOne : public IsaDle {
  using IsaDle::IsaDle;
  std::optional<IsaDlpdu> understood(Heard octets) const override {
    constexpr std::uint8_t kOther = 0x22;
    return IsaDle::understood(octets).value_or(IsaDlpdu{.destination = kOther, .source = kOther});
  }
};

}  // namespace fieldproof::conformance::isa_seeded_faults
