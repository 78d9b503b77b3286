#pragma once

#include <memory>
#include <string>

#include "harness/iut/attached_case.hpp"
#include "harness/iut/device_recording.hpp"

// Recording and playing back an implementation, once for all roles and attachments.
namespace fieldproof::iut {

// The same attachment, and what its device does is kept. The recording must outlive it.
Attachment recorded(Attachment attachment, DeviceRecording& recording);
// Keeps that an implementation could not be attached.
void record_failure(DeviceRecording& recording, const kernel::Error& error);

// The device number `number` of a recording, which must outlive it: it does in call k what the recorded one
// did in its call k. Throws the Misbehaviour of one that could not be attached, and
// kernel::Error(configuration) for one that is not there. A call that is another one than was recorded throws
// kernel::Error(configuration): the setup is not that of the recording.
Attachment played_back(const DeviceRecording& recording, std::size_t number);

}  // namespace fieldproof::iut
