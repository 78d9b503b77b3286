// What a Document keeps of its text: the values in reading order, each with the octets it was written with.
//
// Nodes are stored depth first, so the first child of a container is the node after it and the others
// follow by `next`. Lines are not stored: they are searched from the offset when an error asks for them.
// Private to this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/config/document.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::config {

inline constexpr std::uint32_t kNoNode = std::numeric_limits<std::uint32_t>::max();

struct Node {
  ValueKind kind = ValueKind::null;
  bool is_negative = false;  // of an integer: `bits` is then the two's complement of a negative number
  std::uint32_t offset = 0;  // of the first octet of the value
  std::uint32_t size = 0;    // octets of the value, for containers up to and with the closing bracket
  std::uint32_t parent = kNoNode;
  std::uint32_t next = kNoNode;  // the next member or element of the same parent
  std::uint32_t position = 0;    // of an element in its array
  std::uint32_t key = kNoNode;   // of a member, in Source::strings
  std::uint32_t children = 0;
  std::uint64_t bits =
      0;  // boolean; integer; the octets of a double; the index of a string in Source::strings
};

struct Source {
  std::string name;
  std::string text;
  std::vector<std::size_t> line_starts;
  std::vector<Node> nodes;
  std::vector<std::string> strings;

  // Line and column of an octet, both from 1.
  std::pair<std::size_t, std::size_t> place(std::size_t offset) const;
  std::string pointer(std::uint32_t node) const;
  std::string_view raw(const Node& node) const {
    return std::string_view(text).substr(node.offset, node.size);
  }
};

// The pointer as errors show it: the root, whose pointer is empty, is "the top level".
std::string shown(const std::string& pointer);

// Text as errors show it: control characters escaped, cut at the first character after `limit` octets.
std::string printable(std::string_view text, std::size_t limit);

// A word in quotation marks as errors show it: control characters escaped, cut after 60 octets.
std::string in_quotes(std::string_view word);

// "name:line:column: sentence" as an error of the text itself.
[[noreturn]] void fail_at(const Source& source, std::size_t offset, std::string_view sentence);

// Fills nodes and strings from the text. Throws on everything that is not one JSON value.
void parse_into(Source& source, const Limits& limits);

// An RFC 6901 pointer continued by a key.
std::string continued(const std::string& pointer, std::string_view key);

}  // namespace fieldproof::config
