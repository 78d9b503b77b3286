#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "harness/config/source.hpp"
#include "harness/kernel/check.hpp"

namespace fieldproof::config {

namespace {

// The octets of the UTF-8 character at `offset`, 0 when there is none: too short, overlong, a surrogate or
// above U+10FFFF.
std::size_t character_size(std::string_view text, std::size_t offset) {
  const auto octet = [&](std::size_t n) -> unsigned {
    return offset + n < text.size() ? static_cast<unsigned char>(text[offset + n]) : 0U;
  };
  const auto follows = [&](std::size_t n, unsigned low = 0x80, unsigned high = 0xBF) {
    return octet(n) >= low && octet(n) <= high;
  };
  const unsigned first = octet(0);
  if (first < 0x80) return 1;
  if (first >= 0xC2 && first <= 0xDF) return follows(1) ? 2 : 0;
  if (first >= 0xE0 && first <= 0xEF) {
    const bool is_second_right = follows(1, first == 0xE0 ? 0xA0 : 0x80, first == 0xED ? 0x9F : 0xBF);
    return is_second_right && follows(2) ? 3 : 0;
  }
  if (first >= 0xF0 && first <= 0xF4) {
    const bool is_second_right = follows(1, first == 0xF0 ? 0x90 : 0x80, first == 0xF4 ? 0x8F : 0xBF);
    return is_second_right && follows(2) && follows(3) ? 4 : 0;
  }
  return 0;
}

// Refuses what the parser would take or report badly: a NUL octet ends its input, and it does not look at the
// characters of comments.
void check_characters(const Source& source) {
  for (std::size_t offset = 0; offset < source.text.size();) {
    const std::size_t size = character_size(source.text, offset);
    const unsigned octet = static_cast<unsigned char>(source.text[offset]);
    if (size == 0) {
      fail_at(source, offset,
              fmt::format("octet 0x{:02X} is not valid UTF-8; save the file as UTF-8", octet));
    }
    if (octet == 0) fail_at(source, offset, "a NUL octet is not allowed; the file is not text");
    offset += size;
  }
}

// Follows the tokens that the parser reports through the text, because the parser does not say where they
// are.
class Cursor {
 public:
  explicit Cursor(std::string_view text) : text_(text) {
    if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
  }

  std::size_t at() const { return at_; }

  // To the first octet that is neither space, comment nor separator.
  void to_token() {
    while (at_ < text_.size()) {
      if (std::string_view(" \t\r\n,:").find(text_[at_]) != std::string_view::npos) {
        ++at_;
      } else if (text_.substr(at_, 2) == "//") {
        at_ = std::min(text_.find_first_of("\r\n", at_), text_.size());
      } else if (text_.substr(at_, 2) == "/*" && text_.find("*/", at_ + 2) != std::string_view::npos) {
        at_ = text_.find("*/", at_ + 2) + 2;
      } else {
        return;
      }
    }
  }

  void over_bracket() { ++at_; }

  void over_word() { at_ = std::min(text_.find_first_of(" \t\r\n,:/]}[{\"", at_), text_.size()); }

  void over_string() {
    for (++at_; at_ < text_.size() && text_[at_] != '"'; ++at_) {
      if (text_[at_] == '\\') ++at_;
    }
    ++at_;
  }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
};

// Builds the nodes of a Source from the events of the parser.
class Builder : public nlohmann::json::json_sax_t {
 public:
  Builder(Source& source, const Limits& limits) : source_(source), limits_(limits), cursor_(source.text) {}

  bool null() override { return word(ValueKind::null, 0); }
  bool boolean(bool value) override { return word(ValueKind::boolean, value ? 1 : 0); }
  bool number_integer(std::int64_t value) override {
    word(ValueKind::integer, static_cast<std::uint64_t>(value));
    source_.nodes.back().is_negative = value < 0;
    return true;
  }
  bool number_unsigned(std::uint64_t value) override { return word(ValueKind::integer, value); }
  bool number_float(double value, const std::string&) override {
    return word(ValueKind::number, std::bit_cast<std::uint64_t>(value));
  }
  bool string(std::string& value) override {
    const std::uint32_t node = add(ValueKind::string);
    source_.nodes[node].bits = keep(std::move(value));
    cursor_.over_string();
    close(node);
    return true;
  }
  bool binary(nlohmann::json::binary_t&) override { return false; }  // JSON text has no such value

  bool key(std::string& name) override;
  bool start_object(std::size_t) override { return open(ValueKind::object); }
  bool start_array(std::size_t) override { return open(ValueKind::array); }
  bool end_object() override { return leave(); }
  bool end_array() override { return leave(); }
  bool parse_error(std::size_t octets_read, const std::string&,
                   const nlohmann::json::exception& error) override;

 private:
  struct Open {
    std::uint32_t node;
    std::uint32_t last_child = kNoNode;
    std::map<std::string, std::size_t> keys;  // and where each is written
  };

  std::uint32_t add(ValueKind kind);
  bool word(ValueKind kind, std::uint64_t bits);
  bool open(ValueKind kind);
  bool leave();
  std::uint32_t keep(std::string text) {
    source_.strings.push_back(std::move(text));
    return static_cast<std::uint32_t>(source_.strings.size() - 1);
  }
  void close(std::uint32_t node) {
    source_.nodes[node].size = static_cast<std::uint32_t>(cursor_.at()) - source_.nodes[node].offset;
  }
  std::string where() const;

  Source& source_;
  const Limits& limits_;
  Cursor cursor_;
  std::vector<Open> open_;
  std::uint32_t key_ = kNoNode;  // of the member whose value comes next
};

std::uint32_t Builder::add(ValueKind kind) {
  cursor_.to_token();
  const auto node = static_cast<std::uint32_t>(source_.nodes.size());
  Node added;
  added.kind = kind;
  added.offset = static_cast<std::uint32_t>(cursor_.at());
  added.key = std::exchange(key_, kNoNode);
  if (!open_.empty()) {
    Open& parent = open_.back();
    added.parent = parent.node;
    added.position = source_.nodes[parent.node].children++;
    if (parent.last_child != kNoNode) source_.nodes[parent.last_child].next = node;
    parent.last_child = node;
  }
  source_.nodes.push_back(added);
  return node;
}

bool Builder::word(ValueKind kind, std::uint64_t bits) {
  const std::uint32_t node = add(kind);
  source_.nodes[node].bits = bits;
  cursor_.over_word();
  close(node);
  return true;
}

bool Builder::open(ValueKind kind) {
  if (open_.size() == limits_.depth) {
    cursor_.to_token();
    fail_at(source_, cursor_.at(),
            fmt::format("{}: more than {} objects and arrays inside each other; write the file flatter",
                        where(), limits_.depth));
  }
  const std::uint32_t node = add(kind);
  open_.push_back(Open{node, kNoNode, {}});
  cursor_.over_bracket();
  return true;
}

bool Builder::leave() {
  cursor_.to_token();
  cursor_.over_bracket();
  close(open_.back().node);
  open_.pop_back();
  return true;
}

bool Builder::key(std::string& name) {
  cursor_.to_token();
  Open& object = open_.back();
  const auto [earlier, is_new] = object.keys.try_emplace(name, cursor_.at());
  if (!is_new) {
    fail_at(source_, cursor_.at(),
            fmt::format("{}: key {} is already on line {}; remove one of the two",
                        shown(source_.pointer(object.node)), in_quotes(name),
                        source_.place(earlier->second).first));
  }
  cursor_.over_string();
  key_ = keep(std::move(name));
  return true;
}

std::string Builder::where() const {
  if (open_.empty()) return shown("");
  const std::string parent = source_.pointer(open_.back().node);
  if (key_ != kNoNode) return shown(continued(parent, source_.strings[key_]));
  const Node& container = source_.nodes[open_.back().node];
  return shown(container.kind == ValueKind::array ? fmt::format("{}/{}", parent, container.children)
                                                  : parent);
}

bool Builder::parse_error(std::size_t octets_read, const std::string&,
                          const nlohmann::json::exception& error) {
  // The parser has read to the end of the offending token, the cursor stands at its beginning, unless the
  // token is a separator, which the cursor passes over.
  cursor_.to_token();
  const std::size_t last = source_.text.empty() ? 0 : source_.text.size() - 1;
  const std::size_t read = octets_read == 0 ? 0 : octets_read - 1;
  const std::size_t offset = std::min({cursor_.at(), read, last});
  // "[json.exception.parse_error.101] parse error at line 1, column 2: syntax error while ..."
  std::string_view reason = error.what();
  if (const auto end = reason.find("syntax error"); end != std::string_view::npos) {
    reason.remove_prefix(end);
  } else if (const auto bracket = reason.find("] "); bracket != std::string_view::npos) {
    reason.remove_prefix(bracket + 2);
  }
  fail_at(source_, offset, fmt::format("{}: {}", where(), printable(reason, 400)));
}

}  // namespace

void parse_into(Source& source, const Limits& limits) {
  constexpr std::size_t kOffsets = std::numeric_limits<std::uint32_t>::max() - 1;
  const std::size_t size = std::min(limits.size, kOffsets);
  source.line_starts.assign(1, 0);
  if (source.text.size() > size) {
    fail_at(source, 0, fmt::format("the file has {} octets; at most {} are read", source.text.size(), size));
  }
  for (std::size_t offset = 0; offset < source.text.size(); ++offset) {
    if (source.text[offset] == '\n') source.line_starts.push_back(offset + 1);
  }
  check_characters(source);
  Builder builder(source, limits);
  constexpr bool kWholeText = true;
  constexpr bool kComments = true;
  const bool is_parsed = nlohmann::json::sax_parse(
      source.text, &builder, nlohmann::json::input_format_t::json, kWholeText, kComments);
  FIELDPROOF_CHECK(is_parsed, "the builder throws where it does not accept");
}

}  // namespace fieldproof::config
