#pragma once

#include <algorithm>
#include <optional>
#include <utility>

#include "conformance/fieldbus_dll/isa_seeded_faults.hpp"

// Data link entities that take other requests, or other data for what they wait for.
namespace fieldproof::conformance::isa_seeded_faults {

// ---- requests ----

class SubmitsOtherwise : public IsaDle {
 public:
  using Change = void (*)(IsaRequest&, const fieldbus_dll::IsaRules&);
  SubmitsOtherwise(const IsaConfiguration& configuration, Change change)
      : IsaDle(configuration), change_(change) {}

 private:
  bool submit(const IsaRequest& request, Time now) override {
    IsaRequest other = request;
    change_(other, rules());
    return IsaDle::submit(other, now);
  }
  Change change_;
};

class TooLongIsCut : public IsaDle {
  using IsaDle::IsaDle;
  std::optional<IsaDlpdu> understood(Heard octets) const override {
    fieldbus_dll::IsaRules loose = rules();
    loose.link.most_data.fill(300);
    auto dlpdu = fieldbus_dll::isa_dlpdu_of(octets, loose);
    if (dlpdu && (dlpdu->type == IsaType::du || dlpdu->type == IsaType::dt))
      dlpdu->data.resize(std::min(dlpdu->data.size(), most_data(rules().link, dlpdu->priority)));
    return dlpdu;
  }
};

class EmptyDataLeftOut : public IsaDle {
  using IsaDle::IsaDle;
  bool is_delivered(const IsaDlpdu& dlpdu) const override {
    return IsaDle::is_delivered(dlpdu) && !dlpdu.data.empty();
  }
};

// What is urgent and was submitted during a token is not the next under it.
class UrgentWaitsForAToken : public IsaDle {
  using IsaDle::IsaDle;
  bool submit(const IsaRequest& request, Time now) override {
    has_late_ |= token().has_value();
    return IsaDle::submit(request, now);
  }
  std::optional<Priority> next_to_send(const Queues& from, Priority least) const override {
    if (has_late_ && &from == &queues() && !from.queue(Priority::normal).empty() && least <= Priority::normal)
      return Priority::normal;
    return IsaDle::next_to_send(from, least);
  }
  void use_token(Time now) override {
    IsaDle::use_token(now);
    if (!token()) has_late_ = false;
  }
  bool has_late_ = false;
};

// ---- replies ----

class WaitsForDataOf : public IsaDle {
 public:
  WaitsForDataOf(const IsaConfiguration& configuration, Priority least)
      : IsaDle(configuration), least_(least) {}

 private:
  bool waits_for_user(Priority, Time now) override { return IsaDle::waits_for_user(least_, now); }
  Priority least_;
};

class AnythingEndsTheWait : public IsaDle {
  using IsaDle::IsaDle;
  void on_dlpdu(const IsaDlpdu& dlpdu, const Place& place) override {
    waits_ = false;
    IsaDle::on_dlpdu(dlpdu, place);
  }
  bool waits_for_user(Priority least, Time now) override {
    return waits_ = IsaDle::waits_for_user(least, now);
  }
  std::optional<Priority> next_to_send(const Queues& from, Priority least) const override {
    const bool is_any = waits_ && &from != &queues();
    return IsaDle::next_to_send(from, is_any ? Priority::time_available : least);
  }
  bool waits_ = false;
};

class LongestSilenceRefused : public IsaDle {
  using IsaDle::IsaDle;
  bool are_impossible() const override {
    const auto& link = rules().link;
    return IsaDle::are_impossible() ||
           link.inter_pdu_delay_octets == (link.response_delay_slots - 1) * link.slot_time_octets;
  }
};

class ImpossibleOnceOnly : public IsaDle {
  using IsaDle::IsaDle;
  bool are_impossible() const override {
    return IsaDle::are_impossible() && !std::exchange(was_asked_, true);
  }
  mutable bool was_asked_ = false;
};

}  // namespace fieldproof::conformance::isa_seeded_faults
