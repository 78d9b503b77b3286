#include "harness/fault/known_names.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "harness/config/nearest.hpp"
#include "harness/fault/fields.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::fault {
namespace {

class Check {
 public:
  Check(const KnownNames& known, std::string_view list, std::size_t number)
      : known_(known), list_(list), number_(number) {}

  void receiver(const std::string& pattern) const { one("receiver", pattern, known_.receivers); }

  void when(const When& when) const {
    receiver(when.receiver);
    one("frame", when.frame_kind, known_.frame_kinds);
    one("field", when.field, known_.fields);
    if (when.after) one("observation", when.after->observation, known_.observations);
    for (const auto* parts : {&when.all_of, &when.any_of, &when.none_of}) {
      for (const When& part : *parts) this->when(part);
    }
  }

 private:
  void one(std::string_view what, const std::string& pattern, const std::vector<std::string>& names) const {
    if (std::ranges::any_of(names, [&](const std::string& name) { return fits(pattern, name); })) return;
    throw kernel::Error(
        kernel::ErrorKind::configuration,
        fmt::format("/{}/{} of the plan: there is no {} \"{}\" here; the nearest are \"{}\"", list_, number_,
                    what, pattern, fmt::join(config::nearest(pattern, names, 3), "\", \"")));
  }

  const KnownNames& known_;
  std::string_view list_;
  std::size_t number_;
};

}  // namespace

KnownNames names_of_transmissions(std::vector<std::string> receivers, std::vector<std::string> observations) {
  return {std::move(receivers),
          {std::string(TransmissionFields::kFrameKind)},
          {std::string(TransmissionFields::kField)},
          std::move(observations)};
}

void expect_known_names(const Plan& plan, const KnownNames& known) {
  for (std::size_t n = 0; n < plan.rules().size(); ++n) {
    Check(known, "rules", n).when(plan.rules()[n].when);
  }
  for (std::size_t n = 0; n < plan.disturbances().size(); ++n) {
    Check(known, "disturbances", n).receiver(plan.disturbances()[n].receiver);
  }
}

}  // namespace fieldproof::fault
