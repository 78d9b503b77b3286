#pragma once

#include <algorithm>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "conformance/fieldbus_dll/ff_seeded_faults.hpp"

// Basic devices whose fault shows only in a sequence: each does with any single command what it should. They
// are for `check`; no case of the catalogue names them.
namespace fieldproof::conformance::ff_seeded_faults {

// ---- what comes while something is due ----

class TokenKeptBehindProbe : public FfStation {
  using FfStation::FfStation;
  void on_dlpdu(const FfDlpdu& dlpdu, const Place& place) override {
    const bool is_elsewhere = dlpdu.type == FfType::pn && dlpdu.node != node();
    if (!is_elsewhere || !token()) FfStation::on_dlpdu(dlpdu, place);
  }
};

class AnswerKeptBehindOther : public FfStation {
  using FfStation::FfStation;
  void on_dlpdu(const FfDlpdu& dlpdu, const Place& place) override {
    const bool is_probe_elsewhere = dlpdu.type == FfType::pn && dlpdu.node != node();
    if (!is_probe_elsewhere || state() != fieldbus_dll::FfState::replying) FfStation::on_dlpdu(dlpdu, place);
  }
};

class DataEndsToken : public FfStation {
  using FfStation::FfStation;
  void on_dlpdu(const FfDlpdu& dlpdu, const Place& place) override {
    if (dlpdu.type == FfType::dt1 && token()) {
      drop_token();
      enter(fieldbus_dll::FfState::idle);
    }
    FfStation::on_dlpdu(dlpdu, place);
  }
};

class DeafBehindFault : public FfStation {
  using FfStation::FfStation;
  std::vector<Arrived> heard_in(const line::Waveform& reception) override {
    std::vector<Arrived> all = FfStation::heard_in(reception);
    if (std::exchange(is_deaf_, all.empty())) all.clear();
    return all;
  }
  bool is_deaf_ = false;
};

// ---- what a token leaves behind ----

template <typename Base>
class NewestFirst : public Base {
  using Base::Base;
  bool submit(const FfRequest& request, Time now) override {
    if (!Base::submit(request, now)) return false;
    auto& queue = this->queues().queue(request.priority);
    std::rotate(queue.begin(), queue.end() - 1, queue.end());
    return true;
  }
};

class LeastOfLastToken : public FfStation {
  using FfStation::FfStation;
  void on_dlpdu(const FfDlpdu& dlpdu, const Place& place) override {
    FfDlpdu other = dlpdu;
    if (dlpdu.type == FfType::pt && dlpdu.node == node()) {
      other.priority = last_.value_or(dlpdu.priority);
      last_ = dlpdu.priority;
    }
    FfStation::on_dlpdu(other, place);
  }
  std::optional<Priority> last_;
};

class DurationOfLastTokenToo : public FfStation {
  using FfStation::FfStation;
  Time token_end(const FfDlpdu& pt, const Place& place) const override {
    return FfStation::token_end(pt, place) + octet_times(std::exchange(last_, pt.duration));
  }
  mutable std::uint16_t last_ = 0;
};

class EachThirdReturnMissing : public FfStation {
  using FfStation::FfStation;
  Time put_on_line(const Octets& octets, Time now) override {
    const bool is_return = octets == Octets{rules().codes.rt};
    if (is_return && ++returns_ % 3 == 0) return now;
    return FfStation::put_on_line(octets, now);
  }
  unsigned returns_ = 0;
};

class SecondOfPriorityLost : public FfStation {
  using FfStation::FfStation;
  void use_token(Time now) override {
    const bool held = token().has_value();
    FfStation::use_token(now);
    auto& urgent = queues().queue(Priority::urgent);
    if (held && !token() && urgent.size() > 1) urgent.pop_back();
  }
};

// ---- what a publisher leaves behind ----

class TailOfLastWrite : public FfStation {
  using FfStation::FfStation;
  bool write(FfAddress address, const Octets& data, Time now) override {
    Octets longer = data;
    const Buffer* const before = buffer_of(address);
    if (before != nullptr && before->data.size() > data.size())
      longer.insert(longer.end(), before->data.begin() + static_cast<std::ptrdiff_t>(data.size()),
                    before->data.end());
    return FfStation::write(address, data.size() > longer.size() ? data : longer, now);
  }
};

class WritesBetweenCdsCountOnce : public FfStation {
  using FfStation::FfStation;
  bool write(FfAddress address, const Octets& data, Time now) override {
    Buffer* const buffer = buffer_of(address);
    const bool is_again = buffer != nullptr && address == unpublished_;
    if (!FfStation::write(address, data, now)) return false;
    if (is_again) --buffer->writes;
    unpublished_ = address;
    return true;
  }
  FfDlpdu published(FfAddress address, Buffer& buffer) override {
    unpublished_ = 0;
    return FfStation::published(address, buffer);
  }
  FfAddress unpublished_ = 0;
};

class BuffersShareTheCount : public FfStation {
  using FfStation::FfStation;
  FfDlpdu published(FfAddress address, Buffer& buffer) override {
    FfDlpdu dt3 = FfStation::published(address, buffer);
    dt3.writes = 0;
    for (const FfAddress one : configuration().published)
      dt3.writes = static_cast<std::uint8_t>(dt3.writes + buffer_of(one)->writes);
    return dt3;
  }
};

// Takes the buffer with the CD and counts its writes when it begins to answer.
class CountOfALaterWrite : public FfStation {
  using FfStation::FfStation;
  Octets written(const FfDlpdu& dlpdu) const override {
    FfDlpdu other = dlpdu;
    if (dlpdu.type == FfType::dt3)
      other.writes = writes_.contains(dlpdu.source) ? writes_.at(dlpdu.source) : 0;
    return FfStation::written(other);
  }
  bool write(FfAddress address, const Octets& data, Time now) override {
    if (!FfStation::write(address, data, now)) return false;
    writes_[address] = buffer_of(address)->writes;
    return true;
  }
  std::map<FfAddress, std::uint8_t> writes_;
};

}  // namespace fieldproof::conformance::ff_seeded_faults
