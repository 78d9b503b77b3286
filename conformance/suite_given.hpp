#pragma once

#include <any>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "conformance/assigned.hpp"
#include "harness/fault/disturbance.hpp"
#include "harness/fault/stress.hpp"
#include "harness/judge/pics.hpp"

// What a suite is given by its program: the same for all protocols.
namespace fieldproof::conformance {

// What disturbs lines: for cases with bursts of their own, and for plans. It comes from outside because a
// suite has no model of a disturbance, and because `shrink` and quiet replays run a suite with others: with
// some that are noted, and with none.
struct Disturbances {
  std::vector<fault::Stress> stresses{};
  std::map<std::int64_t, std::vector<fault::Stress>> link_stresses{};  // of lines of IEC 61158-2, by bit rate
  std::vector<fault::DisturbanceKind> of_plans{};

  // Without any, cases with the tag `bursts` are left out.
  bool have_stresses() const { return !stresses.empty() || !link_stresses.empty(); }
};

// The stations that the program brought along, by role: what the URI `own` means.
class OwnStations {
 public:
  template <typename Kind>
  using Make = MakeOwn<typename Kind::Device, typename Kind::Configuration>;

  template <typename Kind>
  OwnStations& add(Make<Kind> make) {
    makers_[Kind::role] = std::move(make);
    return *this;
  }
  bool has(std::string_view role) const { return makers_.contains(role); }
  // Null: there is none of this role.
  template <typename Kind>
  const Make<Kind>* find() const {
    const auto found = makers_.find(std::string_view(Kind::role));
    return found == makers_.end() ? nullptr : std::any_cast<Make<Kind>>(&found->second);
  }

 private:
  std::map<std::string, std::any, std::less<>> makers_;
};

// Of one station.
template <typename Kind>
OwnStations own_station(OwnStations::Make<Kind> make) {
  return OwnStations().add<Kind>(std::move(make));
}

struct SuiteGiven {
  Attach attach{};  // implementations outside; null: there are none
  Disturbances disturbances{};
  OwnStations own{};
  // Stations on real lines: what their URI says of them, as answers to a PICS that has none; nothing for a
  // URI of another kind.
  std::function<std::optional<judge::Pics>(const std::string& uri, const std::string& case_id)>
      on_real_line{};
};

}  // namespace fieldproof::conformance
