#include "protocols/interbus/cycle_dissector.hpp"

#include <fmt/format.h>

#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "harness/line/frame_check_16.hpp"
#include "harness/line/telegram_receiver.hpp"
#include "protocols/interbus/dissector.hpp"

namespace fieldproof::interbus {
namespace {

unsigned word_of(std::uint8_t high, std::uint8_t low) {
  return unsigned{high} << 8U | low;
}

// Of one transmission: a train of cycles would fill pages.
constexpr std::size_t kMostClauses = 16;
constexpr std::size_t kMostWords = 64;

struct Cycle {
  bool is_id = false;
  bool is_whole = true;  // its first telegram was seen
  std::vector<std::uint8_t> transfer;
  std::vector<std::uint8_t> check;
};

class CycleTeller final : public trace::Teller {
 public:
  explicit CycleTeller(const Rules& rules)
      : rules_(rules),
        check_(line::shared_frame_check_16(rules.frame_check)),
        receiver_(line::shared_telegram_code(rules.telegram), rules.bit_rate) {}

  trace::Decoded tell(const line::Waveform& wave) override {
    text_.clear();
    clauses_ = stops_missing_ = 0;
    is_check_wrong_ = false;
    goes_on_ = cycle_.has_value();
    receiver_.receive(wave, [&](const line::Waveform&, const line::Telegram& telegram) { add(telegram); });
    end_status();
    end_cycle_part();
    if (clauses_ > kMostClauses) fmt::format_to(out(), "; and {} parts more", clauses_ - kMostClauses);
    if (stops_missing_ > 0) fmt::format_to(out(), "; {} stop bits missing", stops_missing_);
    if (receiver_.pending_until() != kernel::kNever)
      text_ += text_.empty() ? "cut telegram" : "; cut telegram";
    return {text_.empty() ? "idle" : std::move(text_), is_check_wrong_};
  }

 private:
  std::back_insert_iterator<std::string> out() { return std::back_inserter(text_); }

  void add(const line::Telegram& telegram) {
    if (telegram.is_stop_missing()) ++stops_missing_;
    if (!telegram.is_data()) {
      end_cycle_part();
      ++status_;
      return;
    }
    end_status();
    const bool is_id = (telegram.header & line::kSelect) != 0;
    const bool is_check = (telegram.header & line::kControl) != 0;
    const bool is_new = !cycle_ || cycle_->is_id != is_id || (!is_check && !cycle_->check.empty());
    if (is_new) {
      end_cycle_part();
      cycle_ = Cycle{is_id, !is_check, {}, {}};
      told_transfer_ = told_check_ = 0;
      goes_on_ = false;
    }
    (is_check ? cycle_->check : cycle_->transfer).push_back(telegram.data);
  }

  // False for a clause beyond those that are written.
  bool begin_clause() {
    if (++clauses_ > kMostClauses) return false;
    if (!text_.empty()) text_ += "; ";
    return true;
  }

  void end_status() {
    const std::size_t count = std::exchange(status_, 0);
    if (count > 0 && begin_clause()) {
      fmt::format_to(out(), "{} status telegram{}", count, count == 1 ? "" : "s");
    }
  }

  void end_cycle_part() {
    if (!cycle_ || (cycle_->transfer.size() == told_transfer_ && cycle_->check.size() == told_check_)) return;
    const bool judges = cycle_->is_whole && told_check_ < 2 && cycle_->check.size() >= 2;
    const bool fits = judges && is_check_right();
    is_check_wrong_ = is_check_wrong_ || (judges && !fits);
    if (begin_clause()) {
      fmt::format_to(out(), "{} cycle{}: SL {:d}", cycle_->is_id ? "ID" : "data", goes_on_ ? " goes on" : "",
                     cycle_->is_id);
      write_transfer();
      write_check(judges, fits);
    }
    told_transfer_ = cycle_->transfer.size();
    told_check_ = cycle_->check.size();
    goes_on_ = true;
  }

  line::FrameCheck16::State state() const { return check_.update(check_.start(), cycle_->transfer); }

  bool is_check_right() const {
    const auto right = check_.check_octets(state());
    return right[0] == cycle_->check[0] && right[1] == cycle_->check[1];
  }

  void write_transfer() {
    const std::vector<std::uint8_t>& octets = cycle_->transfer;
    std::string_view label;
    std::size_t words = 0;
    bool has_loopback = false;
    for (std::size_t at = 0; at < octets.size(); at += 2) {
      const bool is_word = at + 1 < octets.size();
      const unsigned word = is_word ? word_of(octets[at], octets[at + 1]) : octets[at];
      const bool is_loopback = is_word && !has_loopback && word == rules_.loopback_word;
      has_loopback = has_loopback || is_loopback;
      if (at + 1 < told_transfer_ || (at < told_transfer_ && !is_word)) continue;
      if (++words > kMostWords) continue;
      const std::string_view wanted = is_loopback ? "LBW" : cycle_->is_id ? "ID" : "data";
      if (label != wanted) fmt::format_to(out(), ", {}", wanted);
      label = wanted;
      fmt::format_to(out(), " {:0{}X}", word, is_word ? 4 : 2);
    }
    if (words > kMostWords) fmt::format_to(out(), " and {} words more", words - kMostWords);
  }

  void write_check(bool judges, bool fits) {
    const std::vector<std::uint8_t>& octets = cycle_->check;
    for (std::size_t at = told_check_ & ~std::size_t{1}; at < octets.size(); at += 2) {
      text_ += at == 0 ? ", FCS" : at == 2 ? ", status word" : ", end";
      if (at + 1 == octets.size()) {
        fmt::format_to(out(), " {:02X} (one octet)", octets[at]);
        continue;
      }
      const unsigned word = word_of(octets[at], octets[at + 1]);
      fmt::format_to(out(), " {:04X}", word);
      if (at == 0 && judges) write_verdict(fits);
      if (at == 2 && word != rules_.status_clean)
        text_ += word == rules_.status_marked ? " marked" : " unknown";
    }
  }

  void write_verdict(bool fits) {
    if (fits) {
      text_ += " ok";
      return;
    }
    const auto right = check_.check_octets(state());
    fmt::format_to(out(), " wrong ({:04X} fits)", right[0] << 8U | right[1]);
  }

  const Rules& rules_;
  const line::FrameCheck16& check_;
  line::TelegramReceiver receiver_;
  std::optional<Cycle> cycle_;  // the last one, until another begins
  std::size_t told_transfer_ = 0;
  std::size_t told_check_ = 0;
  bool goes_on_ = false;
  std::size_t status_ = 0;
  std::size_t clauses_ = 0;
  std::size_t stops_missing_ = 0;
  bool is_check_wrong_ = false;
  std::string text_;
};

}  // namespace

std::string CycleDissector::brief(const line::Waveform& wave) const {
  return describe(wave, rules_);
}

std::unique_ptr<trace::Teller> CycleDissector::teller() const {
  return std::make_unique<CycleTeller>(rules_);
}

}  // namespace fieldproof::interbus
