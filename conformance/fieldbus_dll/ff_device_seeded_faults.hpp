#pragma once

#include <map>

#include "conformance/fieldbus_dll/ff_seeded_faults.hpp"

// Basic devices that answer probes, or publish, otherwise.
namespace fieldproof::conformance::ff_seeded_faults {

// ---- probes ----

class NoProbeResponse : public FfStation {
  using FfStation::FfStation;
  bool answers_probe() const override { return false; }
};

// Drives so many DLPDUs and no more.
class MuteAfter : public FfStation {
 public:
  MuteAfter(const FfConfiguration& configuration, unsigned driven)
      : FfStation(configuration), left_(driven) {}

 private:
  Time put_on_line(const Octets& octets, Time now) override {
    if (left_ == 0) return now;
    --left_;
    return FfStation::put_on_line(octets, now);
  }
  unsigned left_;
};

class AnswersLate : public FfStation {
  using FfStation::FfStation;
  Duration silence_before_sending() const override { return response_delay(rules().link) + octet_times(1); }
  Time answer_until(const Place& place) const override {
    return FfStation::answer_until(place) + response_delay(rules().link);
  }
};

class AnswersForAllNodes : public FfStation {
  using FfStation::FfStation;
  bool is_mine(std::uint8_t) const override { return true; }
};

class LiveFromTheStart : public FfStation {
  using FfStation::FfStation;
  bool start(Time now) override {
    const bool has_started = FfStation::start(now);
    enter(fieldbus_dll::FfState::idle);
    return has_started;
  }
};

// ---- publishers ----

class PublishesFirstWrite : public FfStation {
  using FfStation::FfStation;
  FfDlpdu published(FfAddress address, Buffer& buffer) override {
    FfDlpdu dt3 = FfStation::published(address, buffer);
    dt3.data = first_.try_emplace(address, dt3.data).first->second;
    return dt3;
  }
  std::map<FfAddress, Octets> first_;
};

class PublishedNotFinal : public FfStation {
  using FfStation::FfStation;
  FfDlpdu published(FfAddress address, Buffer& buffer) override {
    FfDlpdu dt3 = FfStation::published(address, buffer);
    dt3.is_final = false;
    return dt3;
  }
};

// The first half is that of the time before.
class BufferTorn : public FfStation {
  using FfStation::FfStation;
  FfDlpdu published(FfAddress address, Buffer& buffer) override {
    FfDlpdu dt3 = FfStation::published(address, buffer);
    const Octets whole = dt3.data;
    const Octets& before = last_[address];
    for (std::size_t n = 0; n < std::min(before.size(), whole.size()) / 2; ++n) dt3.data[n] = before[n];
    last_[address] = whole;
    return dt3;
  }
  std::map<FfAddress, Octets> last_;
};

class CountsReads : public FfStation {
  using FfStation::FfStation;
  FfDlpdu published(FfAddress address, Buffer& buffer) override {
    ++buffer.writes;
    return FfStation::published(address, buffer);
  }
};

class CountsNothing : public FfStation {
  using FfStation::FfStation;
  FfDlpdu published(FfAddress address, Buffer& buffer) override {
    FfDlpdu dt3 = FfStation::published(address, buffer);
    dt3.writes = 0;
    return dt3;
  }
};

class CountsTo255 : public FfStation {
  using FfStation::FfStation;
  bool write(FfAddress address, const Octets& data, Time now) override {
    Buffer* const buffer = buffer_of(address);
    const bool is_full = buffer != nullptr && buffer->writes == 255;
    if (!FfStation::write(address, data, now)) return false;
    if (is_full) buffer->writes = 255;
    return true;
  }
};

class PublishesAnything : public FfStation {
  using FfStation::FfStation;
  void on_dlpdu(const FfDlpdu& dlpdu, const Place& place) override {
    FfDlpdu other = dlpdu;
    const bool is_mine_at_all = dlpdu.type == FfType::cd && is_mine(fieldbus_dll::node_of(dlpdu.destination));
    if (is_mine_at_all) other.destination = configuration().published.front();
    FfStation::on_dlpdu(other, place);
  }
};

class SubscribedTo : public FfStation {
 public:
  SubscribedTo(const FfConfiguration& configuration, bool all) : FfStation(configuration), all_(all) {}

 private:
  void on_dlpdu(const FfDlpdu& dlpdu, const Place& place) override {
    if (dlpdu.type != FfType::dt3) return FfStation::on_dlpdu(dlpdu, place);
    if (all_) user().on_published(dlpdu, place.end);
  }
  bool all_;
};

class SubscribedWithoutLink : public FfStation {
  using FfStation::FfStation;
  void on_dlpdu(const FfDlpdu& dlpdu, const Place& place) override {
    FfDlpdu other = dlpdu;
    for (const FfAddress one : configuration().subscribed) {
      if (dlpdu.type == FfType::dt3 && (one & 0xFFFF) == (dlpdu.source & 0xFFFF)) other.source = one;
    }
    FfStation::on_dlpdu(other, place);
  }
};

}  // namespace fieldproof::conformance::ff_seeded_faults
