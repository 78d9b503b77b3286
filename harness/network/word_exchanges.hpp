#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "harness/network/network.hpp"

// Words of process data that are called for one by one on a shared line, by a scheduler or a token: which are
// called for, on their way, arrived or overdue. A network that has such words feeds this with what its lower
// tester and its applications see.
//
// Contract: one exchange for each call. It is served when the application of the destination has got the
// word, rejected when the word was sent only, missing else. A signal has one call at a time. Instants never
// decrease.
namespace fieldproof::network {

class WordExchanges {
 public:
  void add_signal() { words_.emplace_back(); }
  std::size_t size() const { return words_.size(); }
  void watch(ExchangeWatcher& watcher) { watcher_ = &watcher; }

  // ---- the application of the source ----
  void set_word(std::size_t signal, std::uint16_t word) { words_.at(signal).value = word; }
  void set_function(std::size_t signal, std::function<std::uint16_t(kernel::Time)> word) {
    words_.at(signal).function = std::move(word);
  }
  bool has_function(std::size_t signal) const { return words_[signal].function != nullptr; }
  std::uint16_t sample(std::size_t signal, kernel::Time now);

  // ---- the network ----
  // It starts: nothing is called for, and nothing has arrived.
  void begin();
  // It stops: what is called for becomes no exchange.
  void cancel();

  // ---- its line ----
  void begin_cycle(std::size_t kind, kernel::Time when);
  void end_delay(std::size_t kind, kernel::Time from, kernel::Time to);
  // The word must be over at `closes_at`.
  void call(std::size_t signal, kernel::Time begin, kernel::Time closes_at);
  // The same call once more: a retry of the exchange. It must be over then, or when it had to be.
  void call_again(std::size_t signal, kernel::Time begin, kernel::Time closes_at);
  void call_again(std::size_t signal, kernel::Time begin) {
    call_again(signal, begin, words_.at(signal).closes_at);
  }
  void on_sent(std::size_t signal) { words_[signal].is_sent = true; }
  // It is on its way, and must be over then.
  void on_sent(std::size_t signal, kernel::Time closes_at) {
    on_sent(signal);
    if (is_called(signal)) words_[signal].closes_at = closes_at;
  }
  void on_got(std::size_t signal, std::uint16_t value, kernel::Time when);
  bool is_called(std::size_t signal) const { return words_[signal].is_called; }
  bool is_sent(std::size_t signal) const { return words_[signal].is_sent; }
  void close(std::size_t signal, kernel::Time now);
  // Closes what is over; `on_closed` gets each signal.
  template <typename OnClosed>
  void close_due(kernel::Time now, OnClosed&& on_closed) {
    for (std::size_t n = 0; n < words_.size(); ++n) {
      if (!words_[n].is_called || words_[n].closes_at > now) continue;
      close(n, now);
      on_closed(n);
    }
  }
  kernel::Time next_close() const;

  // Since `begin`.
  bool has_all_arrived() const { return arrived_ == words_.size(); }
  bool has_arrived(std::size_t signal) const { return words_[signal].has_arrived; }
  std::optional<kernel::Time> last_call() const { return last_call_; }

 private:
  struct Word {
    std::uint16_t value = 0;
    std::function<std::uint16_t(kernel::Time)> function{};
    bool is_called = false;
    bool is_sent = false;
    bool is_got = false;
    bool has_arrived = false;
    std::uint64_t retries = 0;
    kernel::Time closes_at = kernel::kNever;
  };

  std::vector<Word> words_;
  std::size_t arrived_ = 0;
  std::optional<kernel::Time> last_call_{};
  ExchangeWatcher* watcher_ = nullptr;
};

}  // namespace fieldproof::network
