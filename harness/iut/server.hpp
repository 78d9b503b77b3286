#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "harness/iut/message_device.hpp"

// The implementation's side of the messages: serves a device of ours to a bench on a pair of descriptors. It
// is how a built-in station, or a shared library, runs in a process of its own.
namespace fieldproof::iut {

// Makes the device of a role; null for one that it does not have.
using MakeDevice = std::function<std::unique_ptr<Device>(const RoleName& role)>;

// What a device does by itself while no call has come: until the descriptor can be read.
using Idle = std::function<void(int descriptor)>;

// Until the bench closes its end. `input` and `output` may be one descriptor. Throws
// kernel::Error(implementation) when the bench does not keep to the protocol.
// A bench that does not say which role it wants is told `served`.
void serve(int input, int output, const RoleName& served, const MakeDevice& make_device,
           std::string_view own_name, const Idle& idle = {});

}  // namespace fieldproof::iut
