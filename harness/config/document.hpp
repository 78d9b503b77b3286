// The strict, typed reader of every configuration file (networks, fault plans, PICS, baselines, case files).
//
// A Document is one JSON text with comments. Values are read from it by what they must be: each `as_x`
// either returns a value of the asked type and range or throws kernel::Error(ErrorKind::configuration) with
// one sentence that says file, line, JSON pointer, what is wrong and what would be right:
//
//   examples/x.json:12: /stations/3/id_code: "0x1G" is not a hexadecimal number; write for example "0xBE"
//
// Objects are read inside `read_object`, which refuses keys that the reading code did not ask for:
//
//   const Document document = Document::load(path);
//   const Network network = read_object(document.root(), [&](ObjectReader& o) {
//     Network read;
//     read.bit_rate = o.required("bit_rate").as_bit_rate();
//     if (const auto delay = o.optional("pause")) read.pause = delay->as_duration();
//     for (const Value& station : o.required("stations").as_array(1, 512)) read.stations.push_back(...);
//     return read;
//   });
//
// Limits: text of at most Limits::size octets and Limits::depth nested containers, valid UTF-8, no NUL octet,
// no duplicate key, nothing but space and comments after the value. The parser does not recurse. A Value is
// a view: its Document must outlive it. Documents are immutable and may be read from several threads.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "harness/kernel/time.hpp"

namespace fieldproof::config {

struct Source;  // the parsed text, see source.hpp
struct Member;
class Value;

// Refuses a value for a reason that its type does not show: "the ring has no station 7; it has 0 to 5".
[[noreturn]] void fail(const Value& value, std::string_view sentence);

// What a file describes and cannot be, and where it says so: `at` is a pointer (RFC 6901) below what was
// read,
// "/data/3/to".
struct Violation {
  std::string at;
  std::string sentence;
};
// Refuses what the pointer names, or the nearest that is there above it.
[[noreturn]] void fail(const Value& root, const Violation& violation);

enum class ValueKind : std::uint8_t { null, boolean, integer, number, string, array, object };

// One value of a document together with its place. Cheap to copy.
class Value {
 public:
  Value(const Source& source, std::uint32_t node) : source_(&source), node_(node) {}

  // Place. Lines and columns count from 1, columns in octets; the pointer is RFC 6901 and empty for the root.
  std::string pointer() const;
  std::size_t line() const;
  std::size_t column() const;

  ValueKind kind() const;
  bool is_null() const { return kind() == ValueKind::null; }
  bool is_string() const { return kind() == ValueKind::string; }
  bool is_array() const { return kind() == ValueKind::array; }
  bool is_object() const { return kind() == ValueKind::object; }

  // The text, valid as long as the document.
  std::string_view as_string() const;
  bool as_bool() const;

  // A whole number min..max, written without fraction and exponent: `as_integer<std::uint16_t>(1, 512)`.
  template <std::integral T = std::int64_t>
  T as_integer(std::type_identity_t<T> min = std::numeric_limits<T>::min(),
               std::type_identity_t<T> max = std::numeric_limits<T>::max()) const {
    if constexpr (std::is_signed_v<T>) {
      return static_cast<T>(signed_between(min, max));
    } else {
      return static_cast<T>(unsigned_between(min, max));
    }
  }

  // A finite number min..max; whole numbers are numbers too.
  double as_number(double min = std::numeric_limits<double>::lowest(),
                   double max = std::numeric_limits<double>::max()) const;

  // A whole number 0..max, or the same as a string with hexadecimal digits: 190 or "0xBE".
  template <std::unsigned_integral T = std::uint64_t>
  T as_hex_or_integer(std::type_identity_t<T> max = std::numeric_limits<T>::max()) const {
    return static_cast<T>(hex_or_unsigned(max));
  }

  // A string that is one of the names. The first form answers with the position in the list.
  std::size_t as_choice(std::span<const std::string_view> names) const;
  template <typename T>
  T as_choice(std::initializer_list<std::pair<std::string_view, T>> meanings) const {
    std::vector<std::string_view> names;
    for (const auto& [name, meaning] : meanings) names.push_back(name);
    return (meanings.begin() + static_cast<std::ptrdiff_t>(as_choice(names)))->second;
  }

  // The elements of an array that has min..max of them.
  std::vector<Value> as_array(std::size_t min = 0,
                              std::size_t max = std::numeric_limits<std::size_t>::max()) const;

  // The members of an object with free keys, in file order. Objects with known keys: read_object.
  std::vector<Member> as_members() const;

  // Physical quantities are strings with their unit, "25 ms"; a plain number is refused. The decimal number
  // is converted exactly: what has no whole number of picoseconds or of bits per second is refused.
  kernel::Duration as_duration(kernel::Duration min = kernel::Duration::zero(),
                               kernel::Duration max = kernel::Duration::max()) const;  // ps ns us ms s
  std::int64_t as_bit_rate(std::int64_t min = 1,
                           std::int64_t max = std::numeric_limits<std::int64_t>::max())
      const;  // bit/s; written in bit/s, kbit/s, Mbit/s, Gbit/s
  double as_length_m(double min = 0.0, double max = std::numeric_limits<double>::max()) const;  // mm cm m km

 private:
  friend void fail(const Value& value, std::string_view sentence);
  friend class ObjectReader;
  std::int64_t signed_between(std::int64_t min, std::int64_t max) const;
  std::uint64_t unsigned_between(std::uint64_t min, std::uint64_t max) const;
  std::uint64_t hex_or_unsigned(std::uint64_t max) const;

  const Source* source_;
  std::uint32_t node_;
};

struct Member {
  std::string_view key;
  Value value;
};

// Reads the members of one object by key. Every key that is asked for is a known key; `finish` refuses the
// other ones and is called by read_object, so it cannot be forgotten. "$schema" of the top-level object is
// for editors and always allowed.
class ObjectReader {
 public:
  ObjectReader(const ObjectReader&) = delete;
  ObjectReader& operator=(const ObjectReader&) = delete;

  const Value& value() const { return value_; }
  Value required(std::string_view key);
  std::optional<Value> optional(std::string_view key);
  // There are keys that nobody has asked for so far.
  bool has_unread() const;

 private:
  template <typename Read>
  friend std::invoke_result_t<Read, ObjectReader&> read_object(const Value& value, Read&& read);
  template <typename Read>
  friend std::invoke_result_t<Read, ObjectReader&> read_open_object(const Value& value, Read&& read);

  explicit ObjectReader(const Value& value);
  void finish() const;
  const Member* nearest_unread(std::string_view key) const;

  Value value_;
  std::vector<Member> members_;
  std::vector<bool> read_;
  std::vector<std::string> known_;
};

// Calls `read` with a reader of the object, refuses unread keys, and hands on what `read` returned.
template <typename Read>
std::invoke_result_t<Read, ObjectReader&> read_object(const Value& value, Read&& read) {
  ObjectReader reader(value);
  if constexpr (std::is_void_v<std::invoke_result_t<Read, ObjectReader&>>) {
    std::invoke(std::forward<Read>(read), reader);
    reader.finish();
  } else {
    auto result = std::invoke(std::forward<Read>(read), reader);
    reader.finish();
    return result;
  }
}

// The same without the refusal, for documents of this program that may have grown keys since: results,
// journals. Configuration is read by read_object.
template <typename Read>
std::invoke_result_t<Read, ObjectReader&> read_open_object(const Value& value, Read&& read) {
  ObjectReader reader(value);
  return std::invoke(std::forward<Read>(read), reader);
}

struct Limits {
  std::size_t size = std::size_t{64} << 20;  // octets of text; never more than 2^32 - 2
  std::size_t depth = 64;                    // containers inside each other
};

// The whole file. Throws kernel::Error(configuration) when it cannot be read, when it is no regular file (a
// pipe may never begin, a device never end), and when it has more than `limit` octets.
std::string read_text(const std::filesystem::path& path, std::size_t limit = Limits{}.size);
// The same of a file of any size, block by block.
void read_blocks(const std::filesystem::path& path, const std::function<void(std::string_view)>& take);

class Document {
 public:
  // Reads and parses a file. Throws kernel::Error(configuration) when it cannot be read or is not JSON.
  static Document load(const std::filesystem::path& path, const Limits& limits = {});
  // Parses a text; `name` stands for the file in errors.
  static Document parse(std::string text, std::string name, const Limits& limits = {});

  Value root() const&;
  Value root() const&& = delete;  // the view would outlive what it shows
  const std::string& name() const;
  const std::string& text() const;

 private:
  explicit Document(std::shared_ptr<const Source> source);

  std::shared_ptr<const Source> source_;
};

}  // namespace fieldproof::config
