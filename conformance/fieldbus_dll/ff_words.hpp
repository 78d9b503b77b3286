#pragma once

#include <cstdint>
#include <vector>

#include "conformance/fieldbus_dll/ff_bench.hpp"
#include "conformance/fieldbus_dll/ff_vocabulary.hpp"

namespace fieldproof::conformance {

// Numbers that words choose from: which node, address or kind it is.
inline constexpr fieldbus_dll::FfAddress kFfLink = 0x0001'0000;
inline constexpr fieldbus_dll::FfAddress kLongPublished = kFfLink | FfBench::kPublished;
inline constexpr fieldbus_dll::FfAddress kLongSubscribed = kFfLink | FfBench::kSubscribed;
inline constexpr fieldbus_dll::FfAddress kMoreOfDevice = FfBench::kPublished + kFirstOfMore;
inline constexpr fieldbus_dll::FfAddress kMoreOfOthers = FfBench::kSubscribed + kFirstOfMore;
inline constexpr unsigned kFfLongBit = 0x08;

inline constexpr std::int64_t kToUser = 0;  // of "to" of data
inline constexpr std::int64_t kToAnother = 3;

// What the words of a sequence for a basic device send, from the numbers of a command.
class FfWords {
 public:
  explicit FfWords(FfBench& bench) : bench_(bench), codes_(bench.rules().codes) {}

  Octets octets_of(FfWord word, const std::vector<std::int64_t>& numbers);
  // Of a peer, to an address of the word "data".
  static constexpr std::int64_t kUsualSize = 8;
  Octets user_data(std::int64_t to, std::int64_t size = kUsualSize);
  fieldbus_dll::FfAddress buffer(std::int64_t number) const;
  fieldbus_dll::FfAddress destination(std::int64_t number) const;

 private:
  std::uint8_t control(unsigned code, std::int64_t priority, bool is_final, bool is_long = false) const;
  std::uint8_t node(std::int64_t number) const;
  // The last one has L and no link, which makes it no address.
  Octets compelling(const std::vector<std::int64_t>& numbers) const;
  Octets other(std::int64_t kind, std::uint8_t value) const;
  Octets data(const std::vector<std::int64_t>& numbers);
  Octets published(const std::vector<std::int64_t>& numbers) const;
  Octets activation(const std::vector<std::int64_t>& numbers) const;
  // By its first octet it is what entities know, or do not.
  Octets content(std::int64_t first, std::int64_t size);

  FfBench& bench_;
  const fieldbus_dll::FfCodes& codes_;
  Octets last_content_{};
};

}  // namespace fieldproof::conformance
