#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "harness/kernel/random.hpp"
#include "harness/kernel/time.hpp"
#include "harness/network/network.hpp"

// Random process data through a network, end to end: what was given to each source, and whether it is what
// its sink shows. Words are never 0: a 0 is the safe value of an output, which nobody sent.
//
// A sink shows a right word (that of the present exchange, or of the last ones where the signal admits them),
// holds the one before, shows its safe value, or shows a wrong one: nobody had sent it.
//
// Contract: whoever watches the network passes its events on; the statistics then judge the sinks and give
// the sources new words. Deterministic in the stream and in what the network does. An implementation under
// test can lie about none of it but what its own sinks show.
//
// Limit: a wrong word that happens to be admissible is taken for a right one, of 16 bits once in 65,535.
namespace fieldproof::network {

// What the line did to an exchange at the receivers that are disturbed.
enum class LineEffect : std::uint8_t {
  untouched,
  hit,      // an output was wrong for some time, and what it gave on was as it was sent
  changed,  // a receiver got something else than was driven; it may read the same in it
};

struct ErrorStatistics {
  // Exchanges of data.
  std::uint64_t sent = 0;
  std::uint64_t corrupted = 0;  // some receiver got something else than was driven
  std::uint64_t detected = 0;   // not served: rejected, or nothing came
  std::uint64_t missing = 0;    // of these: nothing came
  std::uint64_t retried = 0;    // attempts beyond the first
  std::uint64_t repeated = 0;   // exchanges for service that followed one that was not served
  // Words that an application got and nobody had sent.
  std::uint64_t accepted_wrong_inputs = 0;
  std::uint64_t accepted_wrong_outputs = 0;
  std::uint64_t wrong_exchanges = 0;  // in which, or after the one before, such words came, however many
  // Each exchange of data is one of four: of the three here and those that were accepted wrong.
  std::uint64_t untouched = 0;
  std::uint64_t without_effect = 0;  // hit, and each word arrived right at the first attempt
  // Not served, repeated, or a sink did not take over a word of it; also where what was hit came before.
  std::uint64_t refused = 0;
  // Those that put the checks to the test: accepted wrong, or refused and some receiver got something else.
  std::uint64_t differed = 0;
  // Words of served exchanges that a sink did not show: it held the ones before.
  std::uint64_t missed_outputs = 0;
  // Sinks that went to their safe value: a reset, after a stop or a silence.
  std::uint64_t cleared_outputs = 0;
  // Not served, but a sink had taken over its word, which was right.
  std::uint64_t partly_latched = 0;

  ErrorStatistics& operator+=(const ErrorStatistics& other);
  std::uint64_t balance() const { return untouched + without_effect + refused + wrong_exchanges; }
  std::uint64_t accepted_wrong() const { return accepted_wrong_inputs + accepted_wrong_outputs; }
};

// A word that an application got and nobody had sent.
struct WrongWord {
  std::size_t signal = 0;
  std::uint16_t sent = 0;
  std::uint16_t got = 0;
  kernel::Time when{};
};

class ExchangeStatistics {
 public:
  // Does not watch the network by itself.
  ExchangeStatistics(Network& network, kernel::Random random);

  // Counts from here on.
  void begin();
  // From here on it is waited for every signal to be delivered once.
  void begin_recovery();
  bool is_recovered() const { return undelivered_ == 0; }
  // Nothing more comes: a wrong word after the last exchange makes one more of what was cut.
  void end();

  void on_exchange(const Exchange& exchange, LineEffect effect);
  void on_shown(std::size_t signal, std::uint16_t word, kernel::Time when);

  const ErrorStatistics& counts() const { return counts_; }
  // Of what is counted.
  const std::optional<WrongWord>& first_wrong() const { return first_wrong_; }
  // Whether the last served exchange of data left a sink after; how many have left none.
  bool has_missed() const { return has_missed_; }
  std::uint64_t good_exchanges() const { return good_exchanges_; }

 private:
  struct Word {
    std::uint16_t sent = 0;
    std::uint16_t shown = 0;              // by the sink; of an image: when it was looked at last
    std::vector<std::uint16_t> before{};  // the other admissible words, the latest last
    bool is_delivered = false;
  };

  void count(const Exchange& exchange, bool is_corrupted);
  void weigh(LineEffect effect, bool is_whole);
  void judge_images(const Exchange& exchange);
  void judge_shown(const Exchange& exchange);
  void accept_wrong(std::size_t signal, std::uint16_t got, kernel::Time when);
  void deliver(Word& word);
  void renew(const Exchange& exchange);

  Network& network_;
  kernel::Random random_;
  std::vector<Word> words_;  // by signal
  std::vector<std::size_t> images_;
  bool has_taken_over_ = false;  // a sink, since the last exchange
  bool has_missed_ = false;
  bool was_unserved_ = false;
  std::uint64_t good_exchanges_ = 0;
  std::uint64_t wrong_before_ = 0;
  std::size_t undelivered_ = 0;
  ErrorStatistics counts_;
  std::optional<WrongWord> first_wrong_;
};

}  // namespace fieldproof::network
