#pragma once

#include <map>
#include <set>

#include "conformance/fieldbus_dll/ff_seeded_faults.hpp"

// Schedulers whose fault shows only in a sequence: whatever a node does once, each answers as it should. They
// are for `check`; no case of the catalogue names them.
namespace fieldproof::conformance::ff_seeded_faults {

// ---- who is live ----

class MissesOfAllCount : public FfLas {
  using FfLas::FfLas;
  bool is_missed_too_often(unsigned) const override { return FfLas::is_missed_too_often(++misses_); }
  void on_token_used(std::uint8_t node) override {
    misses_ = 0;
    FfLas::on_token_used(node);
  }
  mutable unsigned misses_ = 0;
};

class MissesForgivenByOthers : public FfLas {
  using FfLas::FfLas;
  void on_token_used(std::uint8_t) override {
    for (unsigned node = 0; node < live().size(); ++node)
      FfLas::on_token_used(static_cast<std::uint8_t>(node));
  }
};

// Knows who was removed once.
class RemembersRemoved : public FfLas {
 public:
  using FfLas::FfLas;

 protected:
  bool is_missed_too_often(unsigned misses) const override {
    const bool is_so = FfLas::is_missed_too_often(misses);
    if (is_so) removed_.insert(awaited());
    return is_so;
  }
  bool was_removed(std::uint8_t node) const { return removed_.contains(node); }

 private:
  mutable std::set<std::uint8_t> removed_;
};

class MissesSurviveRemoval : public RemembersRemoved {
  using RemembersRemoved::RemembersRemoved;
  bool is_missed_too_often(unsigned misses) const override {
    return RemembersRemoved::is_missed_too_often(misses) || was_removed(awaited());
  }
};

class RemovedNeverFoundAgain : public RemembersRemoved {
  using RemembersRemoved::RemembersRemoved;
  void on_dlpdu(const FfDlpdu& dlpdu, const Place& place) override {
    if (dlpdu.type != FfType::pr || !was_removed(dlpdu.node)) RemembersRemoved::on_dlpdu(dlpdu, place);
  }
};

class ReturningNodeNotActivated : public RemembersRemoved {
  using RemembersRemoved::RemembersRemoved;
  Octets written(const FfDlpdu& dlpdu) const override {
    const bool is_activation = dlpdu.type == FfType::dt1 && dlpdu.data.size() == 1 &&
                               dlpdu.source == fieldbus_dll::address_of(node(), fieldbus_dll::kEntity);
    const bool is_left_out = is_activation && was_removed(fieldbus_dll::node_of(dlpdu.destination));
    return RemembersRemoved::written(is_left_out ? FfDlpdu{.type = FfType::idle} : dlpdu);
  }
};

class OnlyFirstChangeTold : public FfLas {
  using FfLas::FfLas;
  Octets written(const FfDlpdu& dlpdu) const override {
    const bool is_list = dlpdu.type == FfType::dt1 && dlpdu.destination == fieldbus_dll::kEverybody &&
                         dlpdu.source == fieldbus_dll::address_of(node(), fieldbus_dll::kEntity);
    const bool is_left_out = is_list && std::exchange(has_told_, true);
    return FfLas::written(is_left_out ? FfDlpdu{.type = FfType::idle} : dlpdu);
  }
  mutable bool has_told_ = false;
};

// ---- schedule, priority, time, data ----

class UnansweredItemDropped : public FfLas {
  using FfLas::FfLas;
  Octets written(const FfDlpdu& dlpdu) const override {
    if (dlpdu.type != FfType::cd) return FfLas::written(dlpdu);
    if (unanswered_[dlpdu.destination] >= 2) return FfLas::written({.type = FfType::idle});
    ++unanswered_[last_ = dlpdu.destination];
    return FfLas::written(dlpdu);
  }
  void on_dlpdu(const FfDlpdu& dlpdu, const Place& place) override {
    if (dlpdu.type == FfType::dt3 || dlpdu.type == FfType::sr) unanswered_[last_] = 0;
    FfLas::on_dlpdu(dlpdu, place);
  }
  mutable std::map<FfAddress, unsigned> unanswered_;
  mutable FfAddress last_ = 0;
};

class AllAdmittedBehindTwoSlow : public FfLas {
  using FfLas::FfLas;
  Priority next_priority(Priority now, bool is_too_slow) const override {
    const unsigned slow = std::exchange(slow_, is_too_slow ? slow_ + 1 : 0);
    if (!is_too_slow && slow >= 2) return Priority::time_available;
    return FfLas::next_priority(now, is_too_slow);
  }
  mutable unsigned slow_ = 0;
};

class SecondTimeRequestIgnored : public FfLas {
  using FfLas::FfLas;
  void on_dlpdu(const FfDlpdu& dlpdu, const Place& place) override {
    const bool is_second = dlpdu.type == FfType::ct && std::exchange(was_asked_, true);
    if (!is_second) FfLas::on_dlpdu(dlpdu, place);
  }
  bool was_asked_ = false;
};

// ---- what its user is told ----

using fieldbus_dll::FfEventKind;

class EventsOfItself : public FfLas {
  using FfLas::FfLas;
  void tell(FfEventKind kind, std::uint8_t node, Time now) override {
    FfLas::tell(kind, kind == FfEventKind::reply_missing ? this->node() : node, now);
  }
};

class EachEventOnce : public FfLas {
  using FfLas::FfLas;
  void tell(FfEventKind kind, std::uint8_t node, Time now) override {
    if (told_.insert(kind).second) FfLas::tell(kind, node, now);
  }
  std::set<FfEventKind> told_;
};

// It waits for the end of the token, or for silence.
class DataReturnNoToken : public FfLas {
  using FfLas::FfLas;
  bool is_from_awaited(const FfDlpdu& dlpdu) const override {
    return dlpdu.type != FfType::dt1 && FfLas::is_from_awaited(dlpdu);
  }
};

}  // namespace fieldproof::conformance::ff_seeded_faults
