#include "protocols/token_bus/translator_blocks.hpp"

namespace fieldproof::token_bus {

// ---- SMANAGER ----

void StationManager::power_on() {
  managed_until_ = kernel::kStart;
  reset();
}

void StationManager::reset() {
  if (ends_jabber_at_reset()) has_jabbered_ = false;
  is_looped_back_ = loops_back_at_reset();
  is_transmitter_enabled_ = enables_transmitter_at_reset();
}

ManagementAnswer StationManager::take(ManagementCommand command, kernel::Time until) {
  managed_until_ = until;
  const ManagementAnswer answer = answer_to(command);
  if (command == ManagementCommand::reset) reset();
  if (command == ManagementCommand::disable_loopback && disables_loopback()) is_looped_back_ = false;
  if (command == ManagementCommand::enable_transmitter && answer == ManagementAnswer::ack)
    is_transmitter_enabled_ = true;
  return answer;
}

ManagementAnswer StationManager::answer_to(ManagementCommand command) const {
  switch (command) {
    case ManagementCommand::reset:
    case ManagementCommand::disable_loopback:
      return ManagementAnswer::ack;
    case ManagementCommand::enable_transmitter:
      return has_jabbered_ ? ManagementAnswer::nack : ManagementAnswer::ack;
    case ManagementCommand::idle:
      return has_jabbered_ ? ManagementAnswer::physical_error : ManagementAnswer::idle;
    case ManagementCommand::serial_data:
    case ManagementCommand::unknown:
      break;
  }
  return ManagementAnswer::nack;
}

// ---- RBLK ----

void ReceiverBlanking::reset() {
  end_ = {};
  blanked_until_ = kernel::kStart;
}

bool ReceiverBlanking::begins_with(MacSymbol symbol) {
  end_.take(symbol);
  return end_.is_seen();
}

MacSymbol ReceiverBlanking::pass(MacSymbol symbol, kernel::Time begin, kernel::Time end, const Rules& rules) {
  if (begin < blanked_until_) symbol = MacSymbol::silence;
  if (begins_with(symbol)) blanked_until_ = end + mac_symbols(rules, symbols(rules));
  return symbol;
}

// ---- MACTX ----

bool Jabber::is_too_long(MacSymbol symbol, bool is_transmitter_on,
                         const TranslatorConfiguration& configuration) {
  symbols_ = counts(symbol, is_transmitter_on) ? symbols_ + 1 : 0;
  return symbols_ > most_symbols(configuration);
}

}  // namespace fieldproof::token_bus
