#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>

#include "harness/iut/attached_case.hpp"
#include "harness/iut/served_station.hpp"
#include "protocols/token_bus/translator_settings.hpp"

// A translator between the bench and an implementation outside, in both directions: AttachedTranslator is a
// translator of the bench that an iut::Device plays; ServedTranslator is an iut::Device that a translator of
// ours plays.
//
// The implementation receives and sends levels, on port 0 the physical side and on port 1 the MAC side, as
// service_signals.hpp writes them. It is given a reception whole, when it begins: what it drives follows from
// levels that have come by then. It is given the settings of translator_settings, and writes and reads
// nothing.
namespace fieldproof::token_bus {

class AttachedTranslator final : public TranslatorDevice, private iut::Bench {
 public:
  // Throws iut::Misbehaviour when the implementation refuses the case, kernel::Error where it announces
  // anything but levels.
  AttachedTranslator(iut::Attachment attachment, const TranslatorConfiguration& configuration,
                     const std::string& case_id, std::uint64_t seed);

  void wire(segment::Port& phy, segment::Port& mac) override { ports_ = {&phy, &mac}; }
  void set_power(bool is_on, kernel::Time now) override { attached_.set_power(is_on, now); }
  void receive(segment::PortIndex port, const line::Waveform& reception) override;
  void on_time(kernel::Time now) override { attached_.on_time(now); }
  kernel::Time next_time() const override { return attached_.next_time(); }
  void end() override { attached_.end(); }

 private:
  void send(unsigned port, kernel::Time start, std::span<const std::uint16_t> characters) override;
  void transmit(unsigned port, line::Waveform& wave) override;
  void write(iut::Item item, std::uint64_t value, kernel::Time when) override;
  std::uint64_t read(iut::Item item, kernel::Time when) override;

  iut::AttachedCase attached_;
  std::array<segment::Port*, 2> ports_{};
};

class ServedTranslator final : public iut::ServedStation<TranslatorDevice> {
 public:
  using Make = std::function<std::unique_ptr<TranslatorDevice>(const TranslatorConfiguration&)>;
  explicit ServedTranslator(Make make) : make_(std::move(make)) {}

  bool begin(const iut::CaseBegin& begin, iut::Bench& bench) override;
  void set_power(bool is_on, kernel::Time now) override {
    act(now, [&] { station().set_power(is_on, now); });
  }
  using iut::ServedStation<TranslatorDevice>::receive;
  void receive(unsigned port, const line::Waveform& reception) override {
    act(reception.start, [&] { station().receive(port, reception); });
  }

 private:
  Make make_;
};

// The role as benches and attachments know it.
struct TranslatorRole {
  using Device = TranslatorDevice;
  using Configuration = TranslatorConfiguration;
  using Attached = AttachedTranslator;
  using Served = ServedTranslator;
  static constexpr const char* protocol = "token_bus";
  static constexpr const char* role = "translator";
};

}  // namespace fieldproof::token_bus
