#include "reports/packed_timeline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "harness/kernel/error.hpp"
#include "harness/kernel/untrusted_text.hpp"

namespace fieldproof::reports {
namespace {

using Json = nlohmann::ordered_json;

std::int64_t time_from(const Json& record, const char* key) {
  const std::string& text = record.at(key).get_ref<const std::string&>();
  std::int64_t time = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), time);
  if (failure == std::errc() && end == text.data() + text.size()) return time;
  throw kernel::Error(kernel::ErrorKind::configuration,
                      fmt::format("a time line has the time '{}'; write picoseconds as a decimal of 64 bits",
                                  kernel::escaped_line(text)));
}

// The distance in picoseconds; that of two 64-bit times has 64 bits without a sign.
std::string between(std::int64_t from, std::int64_t to) {
  return fmt::format("{}", static_cast<std::uint64_t>(to) - static_cast<std::uint64_t>(from));
}

class Packer {
 public:
  explicit Packer(const Json& timeline) : timeline_(timeline), begin_(first_time()) {}

  Json pack() {
    Json packed = {{"is_cut", timeline_.at("is_cut")},
                   {"begin_ps", fmt::format("{}", begin_)},
                   {"channels", Json::array()}};
    for (const Json& channel : timeline_.at("channels")) packed["channels"].push_back(channel.at("name"));
    packed["transmissions"] = each("transmissions", [this](const Json& one) {
      const std::int64_t start = time_from(one, "start_ps");
      const std::int64_t end = std::max(start, time_from(one, "end_ps"));
      return Json::array({one.at("channel"), between(begin_, start), between(start, end), place(one, "text"),
                          one.at("levels"), one.at("is_changed").get<bool>() ? 1 : 0});
    });
    packed["faults"] = each("faults", [this](const Json& one) {
      return Json::array({one.at("channel"), since_begin(one, "time_ps"), place(one, "text")});
    });
    packed["observations"] = each("observations", [this](const Json& one) {
      return Json::array(
          {one.at("channel"), since_begin(one, "time_ps"), place(one, "what"), place(one, "value")});
    });
    packed["findings"] = each("findings", [this](const Json& one) {
      return Json::array({since_begin(one, "time_ps"), place(one, "requirement"), place(one, "expected"),
                          place(one, "actual")});
    });
    packed["windows"] = each("windows", [this](const Json& one) {
      return Json::array({place(one, "kind"), since_begin(one, "from_ps"), since_begin(one, "to_ps")});
    });
    packed["steps"] = each("steps", [this](const Json& one) {
      return Json::array({since_begin(one, "time_ps"), place(one, "text")});
    });
    packed["texts"] = std::move(texts_);
    return packed;
  }

 private:
  template <typename Pack>
  Json each(const char* kind, Pack pack) const {
    Json list = Json::array();
    for (const Json& one : timeline_.at(kind)) list.push_back(pack(one));
    return list;
  }

  std::int64_t first_time() const {
    auto first = std::numeric_limits<std::int64_t>::max();
    for (const auto& [kind, key] :
         {std::pair("transmissions", "start_ps"), std::pair("faults", "time_ps"),
          std::pair("observations", "time_ps"), std::pair("findings", "time_ps"),
          std::pair("windows", "from_ps"), std::pair("windows", "to_ps"), std::pair("steps", "time_ps")}) {
      for (const Json& one : timeline_.at(kind)) first = std::min(first, time_from(one, key));
    }
    return first == std::numeric_limits<std::int64_t>::max() ? 0 : first;
  }

  std::string since_begin(const Json& record, const char* key) const {
    return between(begin_, time_from(record, key));
  }

  std::size_t place(const Json& record, const char* key) {
    const auto [known, is_new] = places_.try_emplace(record.at(key).get<std::string>(), texts_.size());
    if (is_new) texts_.push_back(record.at(key));
    return known->second;
  }

  const Json& timeline_;
  std::int64_t begin_;
  Json texts_ = Json::array();
  std::map<std::string, std::size_t, std::less<>> places_;
};

}  // namespace

Json packed_timeline(const Json& timeline) {
  return Packer(timeline).pack();
}

}  // namespace fieldproof::reports
