#include "protocols/token_bus/attached_translator.hpp"

#include <fmt/format.h>

#include <utility>

#include "harness/iut/misbehaviour.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::token_bus {

// ---- an implementation outside ----

AttachedTranslator::AttachedTranslator(iut::Attachment attachment,
                                       const TranslatorConfiguration& configuration,
                                       const std::string& case_id, std::uint64_t seed)
    : attached_(std::move(attachment)) {
  if (attached_.unit_kind() != iut::UnitKind::levels) {
    throw kernel::Error(kernel::ErrorKind::implementation,
                        "a translator of the token bus receives and sends levels; this implementation "
                        "announces another unit");
  }
  attached_.begin({case_id, seed, translator_settings(configuration)}, *this);
}

void AttachedTranslator::receive(segment::PortIndex port, const line::Waveform& reception) {
  attached_.call(reception.start, [&](iut::Device& device) { device.receive(port, reception); });
}

void AttachedTranslator::transmit(unsigned port, line::Waveform& wave) {
  attached_.expect_supplied();
  if (port >= ports_.size()) {
    iut::refuse_impossible(fmt::format("drives port {}; a translator has port 0 and port 1", port));
  }
  attached_.expect_drive(wave);
  ports_.at(port)->drive(wave);
}

void AttachedTranslator::send(unsigned, kernel::Time, std::span<const std::uint16_t>) {
  iut::refuse_impossible("sends characters, having announced levels");
}

void AttachedTranslator::write(iut::Item item, std::uint64_t, kernel::Time) {
  iut::refuse_impossible(fmt::format("writes item {}; a translator has none to write", item));
}

std::uint64_t AttachedTranslator::read(iut::Item item, kernel::Time) {
  iut::refuse_impossible(fmt::format("reads item {}; a translator has none to read", item));
}

// ---- a translator of ours ----

bool ServedTranslator::begin(const iut::CaseBegin& begin, iut::Bench& bench) {
  play(make_(translator_configuration_of(begin)), bench);
  station().wire(port(kPhySide), port(kMacSide));
  return true;
}

}  // namespace fieldproof::token_bus
