// The roles that an implementation outside can take, one row each, and the built-in stations that can be
// served in them (`fieldproof station`).
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "harness/iut/device.hpp"
#include "harness/iut/plugin.hpp"

namespace fieldproof::cli {

struct Role {
  std::string_view protocol;
  std::string_view name;
  iut::UnitOffer told;
  // The station of `ref` or `mutant:NAME` as an implementation. Throws kernel::Error(usage) for a mutant
  // that is not there.
  std::unique_ptr<iut::Device> (*serve)(const std::string& uri);
  // How many of its ports are lines on which it may hear and say telegrams.
  unsigned telegram_ports = 0;

  std::string path() const { return std::string(protocol) + "/" + std::string(name); }
};

std::span<const Role> roles();

}  // namespace fieldproof::cli
