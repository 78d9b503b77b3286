#include "conformance/fieldbus_dll/ff_words.hpp"

#include <array>

#include "conformance/fieldbus_dll/link_sequence.hpp"

namespace fieldproof::conformance {

using fieldbus_dll::FfAddress;
using fieldbus_dll::Priority;

Octets FfWords::octets_of(FfWord word, const std::vector<std::int64_t>& numbers) {
  switch (word) {
    case FfWord::token:
      return with_length({control(codes_.pt, numbers[1], numbers[3] != 0), node(numbers[0]),
                          static_cast<std::uint8_t>(numbers[2] >> 8), static_cast<std::uint8_t>(numbers[2])},
                         numbers[4]);
    case FfWord::compel:
      return with_length(compelling(numbers), numbers[3]);
    case FfWord::probe:
      return with_length({codes_.pn, node(numbers[0])}, numbers[1]);
    case FfWord::other:
      return with_length(other(numbers[0], static_cast<std::uint8_t>(numbers[1])), numbers[2]);
    case FfWord::data:
      return data(numbers);
    case FfWord::published:
      return published(numbers);
    case FfWord::control:
      return {static_cast<std::uint8_t>(numbers[0]), node(0), 0x01, 0xF4};
    default:
      return activation(numbers);
  }
}

Octets FfWords::user_data(std::int64_t to, std::int64_t size) {
  // That of the least urgent may be the longest.
  const auto priority =
      size > kUsualSize ? fieldbus_dll::Priority::time_available : fieldbus_dll::Priority::normal;
  return data({to, 0, static_cast<std::int64_t>(priority), 0, 0, size});
}

FfAddress FfWords::buffer(std::int64_t number) const {
  const auto own = static_cast<FfAddress>(bench_.node()) << 8;
  constexpr FfAddress kTopOfNode = 0x8000;
  const std::array<FfAddress, 13> all{FfBench::kPublished,
                                      FfBench::kPublished + 1,
                                      kLongPublished,
                                      FfBench::kPublished + 2,
                                      own,
                                      kLongPublished + kFfLink,
                                      FfBench::kSubscribed,
                                      FfBench::kPublished ^ kTopOfNode,
                                      kLongPublished + 1,
                                      FfBench::kPublished,
                                      kMoreOfDevice,
                                      kMoreOfDevice + 1,
                                      kMoreOfDevice + 2};
  return all.at(static_cast<std::size_t>(number));
}

FfAddress FfWords::destination(std::int64_t number) const {
  const std::array<FfAddress, 5> all{FfBench::kPeersAddress, kFfLink | FfBench::kPeersAddress,
                                     fieldbus_dll::kEverybody, 0xFFFF'2230,
                                     kFfLink | fieldbus_dll::kEverybody};
  return all.at(static_cast<std::size_t>(number));
}

std::uint8_t FfWords::control(unsigned code, std::int64_t priority, bool is_final, bool is_long) const {
  return static_cast<std::uint8_t>(code | static_cast<unsigned>(priority) |
                                   (is_final ? fieldbus_dll::kFinalBit : 0U) | (is_long ? kFfLongBit : 0U));
}

std::uint8_t FfWords::node(std::int64_t number) const {
  const std::array<int, 5> all{bench_.node(), bench_.node() ^ 0x80, bench_.node() + 1, bench_.node() - 1,
                               0xFF};
  return static_cast<std::uint8_t>(all.at(static_cast<std::size_t>(number)));
}

Octets FfWords::compelling(const std::vector<std::int64_t>& numbers) const {
  const FfAddress address = buffer(numbers[0]);
  const bool is_long = fieldbus_dll::is_long(address) || numbers[0] == 9;
  Octets octets{control(codes_.cd, numbers[1], numbers[2] != 0, is_long)};
  append_address(octets, address, is_long);
  return octets;
}

Octets FfWords::other(std::int64_t kind, std::uint8_t value) const {
  const std::array<Octets, 12> all{Octets{codes_.td, 0, 0, 0, 1, 0, value},
                                   Octets{codes_.cl, value},
                                   Octets{codes_.tl, value, 0, 1},
                                   Octets{codes_.rt},
                                   Octets{codes_.sr, value},
                                   Octets{codes_.ri, 0, value},
                                   Octets{codes_.pr, value},
                                   Octets{codes_.ct, value},
                                   Octets{codes_.idle},
                                   Octets{0xE2, bench_.node(), value},
                                   Octets{codes_.ri, 0, 0},
                                   Octets{codes_.sr, 2}};
  return all.at(static_cast<std::size_t>(kind));
}

Octets FfWords::data(const std::vector<std::int64_t>& numbers) {
  const auto own = static_cast<FfAddress>(bench_.node()) << 8;
  constexpr FfAddress kTopOfNode = 0x8000;
  const std::array<FfAddress, 10> to{own | 0x40,
                                     fieldbus_dll::kEverybody,
                                     own,
                                     FfBench::kPeersAddress,
                                     kFfLink | own | 1,
                                     kFfLink | own,
                                     kFfLink | fieldbus_dll::kEverybody,
                                     (own | 1) ^ kTopOfNode,
                                     0xFFFF'0000 | own | 0xFF,
                                     own | 1};
  const std::array<FfAddress, 5> from{FfBench::kPeersAddress, fieldbus_dll::address_of(FfBench::kScheduler),
                                      0x2100, 0x22FF, fieldbus_dll::address_of(FfBench::kPeer)};
  const FfAddress destination = to.at(static_cast<std::size_t>(numbers[0]));
  // The last of each has L, and one of its addresses no link.
  const bool is_long = fieldbus_dll::is_long(destination) || numbers[0] == 9;
  Octets octets{control(codes_.dt1, numbers[2], numbers[3] != 0, is_long)};
  append_address(octets, destination, is_long);
  append_address(octets,
                 from.at(static_cast<std::size_t>(numbers[1])) | (is_long && numbers[1] != 4 ? kFfLink : 0U),
                 is_long);
  const Octets data = content(numbers[4], numbers[5]);
  octets.insert(octets.end(), data.begin(), data.end());
  return octets;
}

Octets FfWords::published(const std::vector<std::int64_t>& numbers) const {
  const std::array<FfAddress, 6> all{FfBench::kSubscribed,      kLongSubscribed,     FfBench::kSubscribed + 1,
                                     kLongSubscribed + kFfLink, FfBench::kPublished, FfBench::kSubscribed};
  const auto which = static_cast<std::size_t>(numbers[0]);
  const FfAddress from =
      which < all.size() ? all[which] : kMoreOfOthers + static_cast<FfAddress>(which - all.size());
  const bool is_long = fieldbus_dll::is_long(from) || numbers[0] == 5;
  Octets octets{control(codes_.dt3, numbers[1], numbers[2] != 0, is_long)};
  append_address(octets, from, is_long);
  octets.push_back(static_cast<std::uint8_t>(numbers[3]));
  const Octets data = bench_.numbered_data(static_cast<std::size_t>(numbers[4]));
  octets.insert(octets.end(), data.begin(), data.end());
  return octets;
}

Octets FfWords::activation(const std::vector<std::int64_t>& numbers) const {
  const bool is_long = numbers[1] != 0;
  const FfAddress link = is_long ? kFfLink : 0U;
  Octets octets{control(codes_.dt1, numbers[0], false, is_long)};
  append_address(octets, link | fieldbus_dll::address_of(bench_.node()), is_long);
  append_address(octets, link | fieldbus_dll::address_of(FfBench::kScheduler), is_long);
  octets.push_back(static_cast<std::uint8_t>(fieldbus_dll::SpduKind::activation));
  octets.insert(octets.end(), static_cast<std::size_t>(numbers[2]), 0x5A);
  return octets;
}

Octets FfWords::content(std::int64_t first, std::int64_t size) {
  if (first == kSameAgain) return last_content_;
  Octets content = bench_.numbered_data(static_cast<std::size_t>(size));
  if (first > 0 && !content.empty()) content[0] = static_cast<std::uint8_t>(first - 1);
  return last_content_ = content;
}

}  // namespace fieldproof::conformance
