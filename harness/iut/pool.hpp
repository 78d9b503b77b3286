#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "harness/iut/message_device.hpp"

// The implementations that one URI means: one for each case that runs at the same time, used again for the
// next case as long as it behaves.
//
//   exec:./program ARGUMENTS    a process; started as often as cases run side by side
//   unix:/path, tcp:host:port   who listens there; connected to as often
//
// Contract: `take` gives a device that has said hello; the first one of a pool has also tested itself. One
// that died or spoke while no case ran is told as Misbehaviour by the `take` that meets it, and replaced
// after that. Where a socket serves no further connection while others are in use, a case waits for one of
// those. After kMostFailedStarts starts in a row that failed nothing is started any more.
namespace fieldproof::iut {

class DevicePool {
 public:
  static constexpr unsigned kMostFailedStarts = 3;

  // Throws kernel::Error(usage) for a URI that is none of these.
  DevicePool(std::string uri, RoleName role, PeerLimits limits = {});
  // Processes of this command, whatever the URI is by which people know them.
  DevicePool(std::string uri, RoleName role, std::vector<std::string> command, PeerLimits limits = {})
      : uri_(std::move(uri)), role_(std::move(role)), command_(std::move(command)), limits_(limits) {}

  // Of one case. It goes back by itself; one that was not ended well is not used again.
  class Lease {
   public:
    Lease(DevicePool& pool, std::unique_ptr<MessageDevice> device)
        : pool_(&pool), device_(std::move(device)), holder_(std::this_thread::get_id()) {}
    Lease(Lease&&) noexcept = default;
    Lease& operator=(Lease&&) = delete;
    ~Lease();
    MessageDevice& operator*() const { return *device_; }
    MessageDevice* operator->() const { return device_.get(); }
    // The case has ended as it should.
    void set_reusable() { is_reusable_ = true; }

   private:
    DevicePool* pool_;
    std::unique_ptr<MessageDevice> device_;
    std::thread::id holder_;
    bool is_reusable_ = false;
  };

  Lease take();
  const std::string& uri() const { return uri_; }

  // Which roles its implementation serves, as it says itself; or whether it serves this one.
  std::vector<RoleName> served_roles(const RoleName& asked = {}) const;

  // Is it the URI of an implementation in another process?
  static bool is_meant(std::string_view uri);

 private:
  Peer open() const;
  std::unique_ptr<MessageDevice> started();
  // Null: one is to be started. Counts as leased in either case.
  std::unique_ptr<MessageDevice> idle_or_waited_for();
  bool has_others();
  std::unique_ptr<MessageDevice> started_in_turn();
  void give_back(std::unique_ptr<MessageDevice> device, std::thread::id holder = std::this_thread::get_id());

  std::string uri_;
  RoleName role_;
  std::vector<std::string> command_;  // empty: who listens at the URI
  PeerLimits limits_;
  std::mutex mutex_;  // of what is idle and leased
  std::condition_variable returned_;
  std::vector<std::unique_ptr<MessageDevice>> idle_;
  std::size_t leased_ = 0;
  std::multiset<std::thread::id> holders_;  // of these, each in its thread
  bool is_limited_ = false;                 // no more are opened than there are
  std::mutex start_mutex_;                  // of all below; taken before mutex_
  bool is_tested_ = false;
  unsigned failed_starts_ = 0;
  std::string last_failure_;
};

}  // namespace fieldproof::iut
