#include "conformance/case_devices.hpp"

#include "harness/kernel/error.hpp"

namespace fieldproof::conformance {

CaseDevices::CaseDevices(const TestCase& test_case, const Setup& setup, const Attach& attach)
    : test_case_(test_case), setup_(setup), attach_(attach) {
  if (!setup.playback_file.empty()) played_back_ = iut::DeviceRecording::load(setup.playback_file);
  if (setup.record) recording_ = std::make_shared<iut::DeviceRecording>();
}

std::optional<iut::Attachment> CaseDevices::outside(const iut::RoleName& role, const std::string& uri) {
  if (played_back_) return iut::played_back(*played_back_, played_back_devices_++);
  if (!attach_) return std::nullopt;
  try {
    return attach_(role, request(uri));
  } catch (const kernel::Error& error) {
    if (setup_.record && error.kind() == kernel::ErrorKind::implementation)
      iut::record_failure(*recording_, error);
    throw;
  }
}

void CaseDevices::keep(Outcome& outcome) {
  if (!recording_) return;
  outcome.recording.truncated = outcome.recording.truncated || recording_->is_truncated();
  outcome.recording.devices = std::move(recording_);
}

}  // namespace fieldproof::conformance
