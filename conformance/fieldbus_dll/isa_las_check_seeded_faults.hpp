#pragma once

#include <utility>

#include "conformance/fieldbus_dll/isa_seeded_faults.hpp"

// Link masters whose fault shows only in a sequence: each does with any single command what it should. They
// are for `check`; no case of the catalogue names them.
namespace fieldproof::conformance::isa_seeded_faults {

// Knows whether the holder before returned its token.
class JudgesHolders : public IsaLas {
  using IsaLas::IsaLas;

 protected:
  void on_dlpdu(const IsaDlpdu& dlpdu, const Place& place) override {
    is_heard_ = is_heard_ || is_from_holder(dlpdu);
    is_returned_ = is_returned_ || (dlpdu.type == IsaType::ee && is_from_holder(dlpdu));
    IsaLas::on_dlpdu(dlpdu, place);
  }
  // A token has just been delegated.
  void advance() override {
    was_silent_ = !std::exchange(is_heard_, false) && has_delegated_;
    was_kept_ = !std::exchange(is_returned_, false) && has_delegated_ && !was_silent_;
    has_delegated_ = true;
    IsaLas::advance();
  }
  // So far.
  bool is_silent() const { return !is_heard_ && has_delegated_; }
  bool was_silent() const { return was_silent_; }
  bool was_kept() const { return was_kept_; }

 private:
  bool has_delegated_ = false;
  bool is_heard_ = false;
  bool is_returned_ = false;
  bool was_silent_ = false;
  bool was_kept_ = false;
};

class ItemSkippedAfterTwoSilent : public JudgesHolders {
  using JudgesHolders::JudgesHolders;
  void advance() override {
    const bool was_silent_before = was_silent();
    JudgesHolders::advance();
    if (was_silent_before && was_silent()) JudgesHolders::advance();
  }
};

class ReclaimsEarlyAfterSilence : public JudgesHolders {
  using JudgesHolders::JudgesHolders;
  // Asked for before the token that is delegated counts.
  Time response_end(Time from) const override {
    const Time end = JudgesHolders::response_end(from);
    return is_silent() && las_state() == LasState::awaiting_single ? end - octet_times(16) : end;
  }
};

class SupervisesLongAfterKept : public JudgesHolders {
  using JudgesHolders::JudgesHolders;
  void advance() override {
    JudgesHolders::advance();
    has_kept_ = has_kept_ || was_kept();
  }
  Time supervision_end(const IsaScheduleItem& item, Time es_end) const override {
    return JudgesHolders::supervision_end(item, es_end) + octet_times(has_kept_ ? 32 : 0);
  }
  bool has_kept_ = false;
};

class SecondTransferIgnored : public IsaLas {
  using IsaLas::IsaLas;
  bool order_transfer(std::uint8_t node, Time now) override {
    return has_handed_over_ || IsaLas::order_transfer(node, now);
  }
  Time put_on_line(const Octets& octets, Time now) override {
    has_handed_over_ = has_handed_over_ || octets.front() == rules().codes.tl;
    return IsaLas::put_on_line(octets, now);
  }
  bool has_handed_over_ = false;
};

class YieldsOnce : public IsaLas {
  using IsaLas::IsaLas;
  bool yields_to(const IsaDlpdu& other) const override {
    return IsaLas::yields_to(other) && !std::exchange(has_yielded_, true);
  }
  mutable bool has_yielded_ = false;
};

class FirstItemSkippedAfterReturn : public IsaLas {
  using IsaLas::IsaLas;
  void on_dlpdu(const IsaDlpdu& dlpdu, const Place& place) override {
    const bool is_handed_back = las_state() == LasState::standby;
    IsaLas::on_dlpdu(dlpdu, place);
    if (dlpdu.type == IsaType::tl && dlpdu.destination == address() && is_handed_back) advance();
  }
};

}  // namespace fieldproof::conformance::isa_seeded_faults
