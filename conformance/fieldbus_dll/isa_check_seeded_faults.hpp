#pragma once

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "conformance/fieldbus_dll/isa_seeded_faults.hpp"

// Data link entities whose fault shows only in a sequence: each does with any single command what it should.
// They are for `check`; no case of the catalogue names them.
namespace fieldproof::conformance::isa_seeded_faults {

// ---- what comes while something is due ----

class TokenKeptBehindToken : public IsaDle {
  using IsaDle::IsaDle;
  void on_dlpdu(const IsaDlpdu& dlpdu, const Place& place) override {
    const bool is_elsewhere = dlpdu.type == IsaType::et && dlpdu.destination != address();
    if (!is_elsewhere || !token()) IsaDle::on_dlpdu(dlpdu, place);
  }
};

class ReplyKeptBehindToken : public IsaDle {
  using IsaDle::IsaDle;
  void on_dlpdu(const IsaDlpdu& dlpdu, const Place& place) override {
    const bool is_elsewhere = dlpdu.type == IsaType::et && dlpdu.destination != address();
    const bool is_replying = state() == fieldbus_dll::DleState::replying;
    if (!is_elsewhere || !is_replying) IsaDle::on_dlpdu(dlpdu, place);
  }
};

// A DU in between changes nothing about what it does.
class GoesOnBehindData : public IsaDle {
 public:
  GoesOnBehindData(const IsaConfiguration& configuration, fieldbus_dll::DleState state)
      : IsaDle(configuration), state_(state) {}

 private:
  void on_dlpdu(const IsaDlpdu& dlpdu, const Place& place) override {
    if (dlpdu.type != IsaType::du || state() != state_) return IsaDle::on_dlpdu(dlpdu, place);
    if (is_delivered(dlpdu)) deliver(dlpdu, place.end);
  }
  fieldbus_dll::DleState state_;
};

class IsaDeafBehindFault : public IsaDle {
  using IsaDle::IsaDle;
  std::vector<Arrived> heard_in(const line::Waveform& reception) override {
    std::vector<Arrived> all = IsaDle::heard_in(reception);
    if (std::exchange(is_deaf_, all.empty())) all.clear();
    return all;
  }
  bool is_deaf_ = false;
};

// ---- what something leaves behind ----

class IsaNewestFirst : public IsaDle {
  using IsaDle::IsaDle;
  bool submit(const IsaRequest& request, Time now) override {
    if (!IsaDle::submit(request, now)) return false;
    if (request.service == IsaService::reply_data) return true;
    auto& queue = queues().queue(request.priority);
    std::rotate(queue.begin(), queue.end() - 1, queue.end());
    return true;
  }
};

class IsaLeastOfLastToken : public IsaDle {
  using IsaDle::IsaDle;
  void on_dlpdu(const IsaDlpdu& dlpdu, const Place& place) override {
    IsaDlpdu other = dlpdu;
    const bool is_token = dlpdu.type == IsaType::et || dlpdu.type == IsaType::es;
    if (is_token && dlpdu.destination == address()) {
      other.priority = last_.value_or(dlpdu.priority);
      last_ = dlpdu.priority;
    }
    IsaDle::on_dlpdu(other, place);
  }
  std::optional<Priority> last_;
};

class IsaDurationOfLastTokenToo : public IsaDle {
  using IsaDle::IsaDle;
  Time token_end(const IsaDlpdu& es, const Place& place) const override {
    return IsaDle::token_end(es, place) + octet_times(std::exchange(last_, es.duration));
  }
  mutable std::uint16_t last_ = 0;
};

class ReplyRepeated : public IsaDle {
  using IsaDle::IsaDle;
  Octets written(const IsaDlpdu& dlpdu) const override {
    if (dlpdu.type != IsaType::dt) return IsaDle::written(dlpdu);
    IsaDlpdu other = dlpdu;
    if (other.data.empty()) {
      other.data = std::exchange(last_, {});
    } else if (other.priority == Priority::time_available) {
      // Whatever fits a reply of any priority.
      last_ = other.data;
      last_.resize(std::min<std::size_t>(last_.size(), 64));
    }
    return IsaDle::written(other);
  }
  mutable Octets last_;
};

class MissingReplyCostsTheToken : public IsaDle {
  using IsaDle::IsaDle;
  void on_reply_wait_over(Time now) override {
    has_missed_ = true;
    IsaDle::on_reply_wait_over(now);
  }
  void on_dlpdu(const IsaDlpdu& dlpdu, const Place& place) override {
    has_missed_ = false;
    IsaDle::on_dlpdu(dlpdu, place);
  }
  std::optional<Priority> next_to_send(const Queues& from, Priority least) const override {
    const bool is_spent = has_missed_ && &from == &queues();
    return is_spent ? std::nullopt : IsaDle::next_to_send(from, least);
  }
  bool has_missed_ = false;
};

}  // namespace fieldproof::conformance::isa_seeded_faults
