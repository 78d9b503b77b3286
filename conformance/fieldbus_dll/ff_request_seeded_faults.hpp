#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "conformance/fieldbus_dll/ff_seeded_faults.hpp"

// Basic devices that keep less than their settings say, or take other addresses for theirs.
namespace fieldproof::conformance::ff_seeded_faults {

class BuffersOf64 : public FfStation {
  using FfStation::FfStation;
  FfDlpdu published(FfAddress address, Buffer& buffer) override {
    FfDlpdu dt3 = FfStation::published(address, buffer);
    dt3.data.resize(std::min<std::size_t>(dt3.data.size(), 64));
    return dt3;
  }
};

// What was written between two CDs comes to nothing each second time.
class EachSecondWriteLost : public FfStation {
  using FfStation::FfStation;
  FfDlpdu published(FfAddress address, Buffer& buffer) override {
    if (is_kept_ = !is_kept_; is_kept_) kept_ = buffer.data;
    FfDlpdu dt3 = FfStation::published(address, buffer);
    dt3.data = kept_;
    return dt3;
  }
  Octets kept_;
  bool is_kept_ = false;
};

// The first ones of its lists.
class KnowsSoMany : public FfStation {
 public:
  KnowsSoMany(const FfConfiguration& configuration, std::size_t published, std::size_t subscribed)
      : FfStation(cut(configuration, published, subscribed)) {}

 private:
  static FfConfiguration cut(FfConfiguration configuration, std::size_t published, std::size_t subscribed) {
    configuration.published.resize(std::min(published, configuration.published.size()));
    configuration.subscribed.resize(std::min(subscribed, configuration.subscribed.size()));
    return configuration;
  }
};

class UrgentBehindThose : public FfStation {
  using FfStation::FfStation;
  bool submit(const FfRequest& request, Time now) override {
    has_late_ |= state() == fieldbus_dll::FfState::holding;
    return FfStation::submit(request, now);
  }
  std::optional<Priority> next_to_send(const Queues& queues, Priority least) const override {
    if (has_late_ && !queues.queue(Priority::normal).empty() && least <= Priority::normal)
      return Priority::normal;
    return FfStation::next_to_send(queues, least);
  }
  void use_token(Time now) override {
    FfStation::use_token(now);
    if (!token()) has_late_ = false;
  }
  bool has_late_ = false;
};

class LostBesideTheLast : public FfStation {
  using FfStation::FfStation;
  bool submit(const FfRequest& request, Time now) override {
    const bool drives_its_last = state() == fieldbus_dll::FfState::idle && now < line().driven_until();
    return drives_its_last || FfStation::submit(request, now);
  }
};

class NodeWithSign : public FfStation {
  using FfStation::FfStation;
  Octets written(const FfDlpdu& dlpdu) const override {
    FfDlpdu other = dlpdu;
    if (dlpdu.has_long_addresses && node() >= 0x80) other.source |= 0xFFFF'0000U;
    return FfStation::written(other);
  }
};

// FFFF on any link, or selector FF of any node.
class TakesForEverybody : public FfStation {
 public:
  TakesForEverybody(const FfConfiguration& configuration, bool has_link)
      : FfStation(configuration), has_link_(has_link) {}

 private:
  void on_dlpdu(const FfDlpdu& dlpdu, const Place& place) override {
    const bool is_taken = has_link_ ? dlpdu.has_long_addresses && (dlpdu.destination & 0xFFFF) == 0xFFFF
                                    : !dlpdu.has_long_addresses && (dlpdu.destination & 0xFF) == 0xFF;
    if (dlpdu.type == FfType::dt1 && is_taken) return user().on_data(dlpdu, place.end);
    FfStation::on_dlpdu(dlpdu, place);
  }
  bool has_link_;
};

}  // namespace fieldproof::conformance::ff_seeded_faults
