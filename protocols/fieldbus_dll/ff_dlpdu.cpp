#include "protocols/fieldbus_dll/ff_dlpdu.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

#include "protocols/fieldbus_dll/dlpdu_layout.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

constexpr unsigned kLongBit = 0x08;

enum class Field : std::uint8_t {
  none,  // the rest of Fields
  destination,
  source,
  node,
  duration,
  version,
  link_time,
  writes,
  status,
  data
};
using Fields = std::array<Field, 4>;

// How the types differ: which bits of the first octet are free, and what follows it.
struct FfShape {
  FfType type;
  std::string_view name;
  std::uint8_t FfCodes::* code;
  unsigned free_bits;
  Fields fields;
};

constexpr unsigned kNoBits = 0;
constexpr unsigned kAllBits = kLongBit | kFinalBit | kPriorityBits;

constexpr std::array kFfShapes{
    FfShape{FfType::cd, "CD", &FfCodes::cd, kAllBits, {Field::destination}},
    FfShape{FfType::dt1, "DT1", &FfCodes::dt1, kAllBits, {Field::destination, Field::source, Field::data}},
    FfShape{FfType::dt3, "DT3", &FfCodes::dt3, kAllBits, {Field::source, Field::writes, Field::data}},
    FfShape{FfType::sr, "SR", &FfCodes::sr, kFinalBit, {Field::status}},
    FfShape{FfType::pt, "PT", &FfCodes::pt, kFinalBit | kPriorityBits, {Field::node, Field::duration}},
    FfShape{FfType::rt, "RT", &FfCodes::rt, kNoBits, {}},
    FfShape{FfType::ri, "RI", &FfCodes::ri, kNoBits, {Field::duration}},
    FfShape{FfType::pn, "PN", &FfCodes::pn, kNoBits, {Field::node}},
    FfShape{FfType::pr, "PR", &FfCodes::pr, kNoBits, {Field::node}},
    FfShape{FfType::td, "TD", &FfCodes::td, kNoBits, {Field::link_time}},
    FfShape{FfType::ct, "CT", &FfCodes::ct, kNoBits, {Field::node}},
    FfShape{FfType::cl, "CL", &FfCodes::cl, kNoBits, {Field::node}},
    FfShape{FfType::tl, "TL", &FfCodes::tl, kNoBits, {Field::node, Field::version}},
    FfShape{FfType::idle, "IDLE", &FfCodes::idle, kNoBits, {}},
};

const FfShape& shape_of(FfType type) {
  return kFfShapes[static_cast<std::size_t>(type)];
}

// RT has the code of a PT without priority, so the one with fewer free bits is asked first.
const FfShape* shape_of_control(unsigned control, const FfCodes& codes) {
  for (const unsigned bits : {kNoBits, kFinalBit, kFinalBit | kPriorityBits, kAllBits}) {
    for (const FfShape& shape : kFfShapes) {
      if (shape.free_bits == bits && (control & ~bits) == codes.*shape.code) return &shape;
    }
  }
  return nullptr;
}

bool has_priority(const FfShape& shape) {
  return (shape.free_bits & kPriorityBits) != 0;
}

// Takes fields off the front of octets.
class FieldReader {
 public:
  explicit FieldReader(std::span<const std::uint8_t> octets) : left_(octets) {}

  // False: too few octets, or a value that does not exist.
  bool read(Field field, FfDlpdu& dlpdu) {
    const std::size_t address = dlpdu.has_long_addresses ? 4 : 2;
    switch (field) {
      case Field::destination:
        return take(address, dlpdu.destination) && is_long(dlpdu.destination) == dlpdu.has_long_addresses;
      case Field::source:
        return take(address, dlpdu.source) && is_long(dlpdu.source) == dlpdu.has_long_addresses;
      case Field::node:
        return take(1, dlpdu.node);
      case Field::duration:
        return take(2, dlpdu.duration) && dlpdu.duration != 0;
      case Field::version:
        return take(2, dlpdu.schedule_version);
      case Field::link_time:
        return take(6, dlpdu.link_time);
      case Field::writes:
        return take(1, dlpdu.writes);
      case Field::status:
        return take(1, dlpdu.status) && dlpdu.status <= FfStatus::nothing_written;
      case Field::data:
        dlpdu.data.assign(left_.begin(), left_.end());
        left_ = {};
        return true;
      case Field::none:
        return true;
    }
    return true;
  }
  bool is_done() const { return left_.empty(); }

 private:
  template <typename Value>
  bool take(std::size_t count, Value& value) {
    if (left_.size() < count) return false;
    std::uint64_t all = 0;
    for (const std::uint8_t octet : left_.first(count)) all = all << 8 | octet;
    value = static_cast<Value>(all);
    left_ = left_.subspan(count);
    return true;
  }

  std::span<const std::uint8_t> left_;
};

void append(Octets& octets, std::uint64_t value, std::size_t count) {
  for (std::size_t n = count; n-- > 0;) octets.push_back(static_cast<std::uint8_t>(value >> (8 * n)));
}

void append(Octets& octets, Field field, const FfDlpdu& dlpdu) {
  const std::size_t address = dlpdu.has_long_addresses ? 4 : 2;
  switch (field) {
    case Field::destination:
      return append(octets, dlpdu.destination, address);
    case Field::source:
      return append(octets, dlpdu.source, address);
    case Field::node:
      return append(octets, dlpdu.node, 1);
    case Field::duration:
      return append(octets, dlpdu.duration, 2);
    case Field::version:
      return append(octets, dlpdu.schedule_version, 2);
    case Field::link_time:
      return append(octets, dlpdu.link_time, 6);
    case Field::writes:
      return append(octets, dlpdu.writes, 1);
    case Field::status:
      return append(octets, static_cast<std::uint64_t>(dlpdu.status), 1);
    case Field::data:
      octets.insert(octets.end(), dlpdu.data.begin(), dlpdu.data.end());
      return;
    case Field::none:
      return;
  }
}

std::string address_text(FfAddress address) {
  return is_long(address) ? fmt::format("{:08X}", address) : fmt::format("{:04X}", address);
}

std::string field_text(Field field, const FfDlpdu& dlpdu) {
  switch (field) {
    case Field::destination:
      return " to " + address_text(dlpdu.destination);
    case Field::source:
      return " from " + address_text(dlpdu.source);
    case Field::node:
      return fmt::format(" {:02X}", dlpdu.node);
    case Field::duration:
      return fmt::format(" for {} octets", dlpdu.duration);
    case Field::version:
      return fmt::format(", schedule {}", dlpdu.schedule_version);
    case Field::link_time:
      return fmt::format(" {}", dlpdu.link_time);
    case Field::writes:
      return fmt::format(", write {}", dlpdu.writes);
    case Field::status:
      return dlpdu.status == FfStatus::unknown_address ? ", unknown address" : ", nothing written";
    case Field::data:
      return dlpdu.data.empty() ? "" : fmt::format(": {:02X}", fmt::join(dlpdu.data, " "));
    case Field::none:
      return "";
  }
  return "";
}

std::string_view layout_text(Field field) {
  switch (field) {
    case Field::destination:
      return "destination (2 or 4)";
    case Field::source:
      return "source (2 or 4)";
    case Field::node:
      return "node (1)";
    case Field::duration:
      return "duration in octets, not 0 (2)";
    case Field::version:
      return "version of the schedule (2)";
    case Field::link_time:
      return "link time in 1/32 ms (6)";
    case Field::writes:
      return "writes, modulo 256 (1)";
    case Field::status:
      return "reason (1): 0 unknown address, 1 nothing written";
    case Field::data:
      return "DLSDU";
    case Field::none:
      break;
  }
  return "";
}

}  // namespace

std::string first_octet_text(unsigned code, unsigned free_bits) {
  constexpr std::string_view kFree = "....LFPP";
  std::string text = "`";
  for (unsigned n = 0; n < 8; ++n) {
    const unsigned bit = 0x80U >> n;
    if (n == 4) text += ' ';
    text += (free_bits & bit) != 0 ? kFree[n] : (code & bit) != 0 ? '1' : '0';
  }
  return text + "`";
}

std::string layout_text(FfType type, const FfCodes& codes) {
  const FfShape& shape = shape_of(type);
  std::string text = first_octet_text(codes.*shape.code, shape.free_bits);
  for (const Field field : shape.fields) {
    if (field != Field::none) text += fmt::format(", {}", layout_text(field));
  }
  return text;
}

std::optional<FfDlpdu> ff_dlpdu_of(std::span<const std::uint8_t> octets, const FfRules& rules) {
  if (octets.empty()) return std::nullopt;
  const unsigned control = octets[0];
  const FfShape* const shape = shape_of_control(control, rules.codes);
  if (shape == nullptr || (has_priority(*shape) && (control & kPriorityBits) == 0)) return std::nullopt;
  FfDlpdu dlpdu;
  dlpdu.type = shape->type;
  const unsigned free = control & shape->free_bits;
  if (has_priority(*shape)) dlpdu.priority = static_cast<Priority>(free & kPriorityBits);
  dlpdu.has_long_addresses = (free & kLongBit) != 0;
  const bool is_set = (free & kFinalBit) != 0;
  (shape->type == FfType::pt ? dlpdu.begins_circulation : dlpdu.is_final) = is_set;
  FieldReader reader(octets.subspan(1));
  for (const Field field : shape->fields) {
    if (!reader.read(field, dlpdu)) return std::nullopt;
  }
  if (!reader.is_done() || dlpdu.data.size() > most_data(rules.link, dlpdu.priority)) return std::nullopt;
  return dlpdu;
}

Octets octets_of(const FfDlpdu& dlpdu, const FfRules& rules) {
  const FfShape& shape = shape_of(dlpdu.type);
  unsigned control = rules.codes.*shape.code;
  unsigned bits = static_cast<unsigned>(dlpdu.priority);
  if (dlpdu.has_long_addresses) bits |= kLongBit;
  if (dlpdu.type == FfType::pt ? dlpdu.begins_circulation : dlpdu.is_final) bits |= kFinalBit;
  control |= bits & shape.free_bits;
  Octets octets{static_cast<std::uint8_t>(control)};
  for (const Field field : shape.fields) append(octets, field, dlpdu);
  return octets;
}

std::size_t octets_on_line(const FfDlpdu& dlpdu, const FfRules& rules) {
  return octets_of(dlpdu, rules).size() + kCheckOctets;
}

bool is_of_scheduler(FfType type) {
  switch (type) {
    case FfType::cd:
    case FfType::pt:
    case FfType::pn:
    case FfType::td:
    case FfType::cl:
    case FfType::tl:
      return true;
    default:
      return false;
  }
}

bool returns_token(const FfDlpdu& dlpdu) {
  return dlpdu.type == FfType::rt || dlpdu.is_final;
}

std::string describe(const FfDlpdu& dlpdu) {
  const FfShape& shape = shape_of(dlpdu.type);
  std::string text(shape.name);
  if (has_priority(shape)) text += fmt::format(" {}", text_of(dlpdu.priority));
  for (const Field field : shape.fields) {
    if (field == Field::writes || field == Field::data) continue;
    text += field_text(field, dlpdu);
  }
  if (dlpdu.begins_circulation) text += ", first";
  if (dlpdu.is_final) text += " final";
  if (dlpdu.type == FfType::dt3) text += field_text(Field::writes, dlpdu);
  if (dlpdu.type == FfType::dt1 || dlpdu.type == FfType::dt3) text += field_text(Field::data, dlpdu);
  return text;
}

std::string words_of(std::span<const std::uint8_t> octets, const FfRules& rules) {
  const auto dlpdu = ff_dlpdu_of(octets, rules);
  return dlpdu ? describe(*dlpdu) : no_dlpdu_text(octets);
}

}  // namespace fieldproof::fieldbus_dll
