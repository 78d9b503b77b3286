#pragma once

#include <memory>
#include <vector>

#include "conformance/case_devices.hpp"
#include "conformance/fieldbus_dll/link_bench.hpp"
#include "conformance/test_case.hpp"
#include "harness/fault/plan.hpp"
#include "protocols/fieldbus_dll/ff_device.hpp"
#include "protocols/fieldbus_dll/isa_device.hpp"

// The suite of the data link of IEC 61158 type 1 and of its drafts: data link entities and link masters of
// the profile ISA-D, basic devices and link masters of the profile FF-P, and their mutants.
//
// Implementations of a role: `ref`, `mutant:NAME`, and what the suite was given.
namespace fieldproof::conformance {

using MakeOwnIsa = MakeOwn<fieldbus_dll::IsaDevice, fieldbus_dll::IsaConfiguration>;
using MakeOwnFf = MakeOwn<fieldbus_dll::FfDevice, fieldbus_dll::FfConfiguration>;

struct FieldbusDllGiven {
  Attach attach{};  // implementations outside; null: there are none
  MakeOwnIsa own_isa_dle{};
  MakeOwnIsa own_isa_las{};
  MakeOwnFf own_ff_device{};
  MakeOwnFf own_ff_las{};
  std::vector<fault::DisturbanceKind> disturbances{};  // what a plan can name
  LinkStresses stresses{};  // for cases with the tag `bursts`; without any they are left out
};

std::unique_ptr<Suite> fieldbus_dll_suite(FieldbusDllGiven given = {});

}  // namespace fieldproof::conformance
