#include "harness/iut/pool.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "harness/iut/scripted_peer.hpp"

namespace fieldproof::iut {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

constexpr PeerLimits kNoHurry{milliseconds(20'000), milliseconds(20'000)};

const RoleName kValveNode = kScriptedRole;

class PoolTest : public testing::Test {
 protected:
  DevicePool pool_of(const Script& script) const {
    return {"exec:script", kValveNode, script.command(), kNoHurry};
  }
  // A script that leaves a line in a file with each start.
  Script counted() const { return Script().then("echo started >> '" + folder_.file("starts") + "'"); }
  auto starts() const { return std::ranges::count(folder_.read("starts"), '\n'); }

  const ScriptFolder folder_;
};

std::string failure_of(const std::function<void()>& act, std::string_view reason = {}) {
  try {
    act();
  } catch (const Misbehaviour& done) {
    EXPECT_TRUE(reason.empty() || done.reason() == reason) << done.reason();
    return done.what();
  } catch (const kernel::Error& error) {
    return error.what();
  }
  return {};
}

// What goes on in another process takes a moment.
void wait_until(const std::function<bool()>& is_so) {
  for (int n = 0; n < 20'000 && !is_so(); ++n) std::this_thread::sleep_for(milliseconds(1));
  EXPECT_TRUE(is_so());
}

TEST_F(PoolTest, KnowsItsUris) {
  EXPECT_TRUE(DevicePool::is_meant("exec:./node"));
  EXPECT_TRUE(DevicePool::is_meant("unix:/run/node"));
  EXPECT_TRUE(DevicePool::is_meant("tcp:[::1]:4850"));
  EXPECT_FALSE(DevicePool::is_meant("ref"));
  EXPECT_FALSE(DevicePool::is_meant("plugin:./node.so"));
  EXPECT_EQ(DevicePool("tcp:[::1]:4850", kValveNode).uri(), "tcp:[::1]:4850");
  for (const char* wrong :
       {"ref", "exec:", "exec:'", "tcp:", "tcp:host", "tcp:host:", "tcp:host:12a", "tcp::5"}) {
    try {
      const DevicePool pool(wrong, kValveNode);
      ADD_FAILURE() << "taken: " << wrong;
    } catch (const kernel::Error& error) {
      EXPECT_EQ(error.kind(), kernel::ErrorKind::usage) << wrong;
    }
  }
}

TEST_F(PoolTest, CaseThatEndedWellLeavesItForTheNext) {
  DevicePool pool = pool_of(counted().tests_itself().stays());
  for (int n = 0; n < 3; ++n) pool.take().set_reusable();
  EXPECT_EQ(starts(), 1);
}

TEST_F(PoolTest, CaseThatDidNotEndWellEndsIt) {
  DevicePool pool = pool_of(counted().tests_itself().stays());
  pool.take();
  pool.take();
  EXPECT_EQ(starts(), 2);
}

TEST_F(PoolTest, CasesSideBySideHaveOneEachAndTheFirstTestsItself) {
  // Only the first one is asked more than its name.
  DevicePool pool =
      pool_of(counted()
                  .then("mkdir '" + folder_.file("first") + "' 2>/dev/null && first=yes")
                  .answers(capabilities_message())
                  .then("[ \"$first\" ] || { read a && echo asked >> '" + folder_.file("asked") + "'; }")
                  .answers(echoed_message())
                  .answers(unsupported_message())
                  .stays());
  {
    auto first = pool.take();
    auto second = pool.take();
    EXPECT_NE(&*first, &*second);
    first.set_reusable();
    second.set_reusable();
  }
  pool.take().set_reusable();
  EXPECT_EQ(starts(), 2);
  EXPECT_EQ(folder_.read("asked"), "");
}

TEST_F(PoolTest, DeathBetweenCasesIsToldOnceAndItIsReplaced) {
  DevicePool pool = pool_of(counted().tests_itself().then("echo good bye >&2; exit 3"));
  {
    auto lease = pool.take();
    wait_until([&] { return !lease->peer().is_alive(); });
    lease.set_reusable();
  }
  EXPECT_THAT(failure_of([&] { pool.take(); }, reasons::kDiedBetweenCases), HasSubstr("between two cases"));
  EXPECT_EQ(starts(), 1);
  EXPECT_EQ(failure_of([&] { pool.take(); }), "");
  EXPECT_EQ(starts(), 2);
}

TEST_F(PoolTest, WordsBetweenCasesAreToldOnceAndItIsReplaced) {
  DevicePool pool = pool_of(counted().tests_itself().says(done_message()).stays());
  {
    auto lease = pool.take();
    wait_until([&] { return lease->peer().has_more(); });
    lease.set_reusable();
  }
  EXPECT_THAT(failure_of([&] { pool.take(); }, reasons::kGarbage), HasSubstr("when nothing was asked"));
  EXPECT_EQ(failure_of([&] { pool.take(); }), "");
  EXPECT_EQ(starts(), 2);
}

TEST_F(PoolTest, OneThatNeverStartsIsStartedThreeTimes) {
  DevicePool pool = pool_of(counted().then("exit 1"));
  for (unsigned n = 0; n < DevicePool::kMostFailedStarts; ++n) {
    EXPECT_EQ(failure_of([&] { pool.take(); }, reasons::kCrashed), "exec:script ended with exit code 1");
  }
  for (int n = 0; n < 3; ++n) {
    EXPECT_EQ(
        failure_of([&] { pool.take(); }, reasons::kCrashed),
        "exec:script is not started any more after 3 starts that failed; the last one: exec:script ended "
        "with exit code 1");
  }
  EXPECT_EQ(starts(), 3);
}

TEST_F(PoolTest, SelfTestThatFailsIsAFailedStart) {
  DevicePool pool = pool_of(
      counted().answers(capabilities_message()).answers(echoed_message()).answers(done_message()).stays());
  for (int n = 0; n < 4; ++n) {
    EXPECT_THAT(failure_of([&] { pool.take(); }), HasSubstr("takes the case 'self_test/unknown/case'"));
  }
  EXPECT_EQ(starts(), 3);
}

TEST_F(PoolTest, StartThatSucceedsForgivesThoseBefore) {
  DevicePool pool =
      pool_of(counted()
                  .then("[ $(($(wc -l < '" + folder_.file("starts") + "') % 3)) = 0 ] || exit 1")
                  .tests_itself()
                  .stays());
  for (int n = 1; n <= 9; ++n) EXPECT_EQ(failure_of([&] { pool.take(); }).empty(), n % 3 == 0) << n;
  EXPECT_EQ(starts(), 9);
}

// Two connections, one after the other, that answer all that a pool asks for.
class PoolThreads : public PoolTest {
 protected:
  PoolThreads() : listener_(folder_.file("s")), thread_([this] { serve(); }) {}
  ~PoolThreads() override { thread_.join(); }

  void serve() {
    const std::vector<MessageOctets> words{capabilities_message(), echoed_message(), unsupported_message()};
    Descriptor first = listener_.accept_and_answer(words);
    while (!may_close_) std::this_thread::sleep_for(milliseconds(1));
    first.close();
    second_ = listener_.accept_and_answer(words);
  }

  Listener listener_;
  std::atomic<bool> may_close_ = false;
  Descriptor second_;
  std::thread thread_;
};

TEST_F(PoolThreads, ConnectionThatIsClosedBetweenCasesIsToldOnceAndReplaced) {
  DevicePool pool("unix:" + listener_.path(), kValveNode, kNoHurry);
  {
    auto lease = pool.take();
    may_close_ = true;
    wait_until([&] { return !lease->peer().is_alive(); });
    lease.set_reusable();
  }
  EXPECT_THAT(failure_of([&] { pool.take(); }, reasons::kDiedBetweenCases), HasSubstr("between two cases"));
  EXPECT_EQ(failure_of([&] { pool.take(); }), "");
}

// Who serves one connection lets others wait without a word. Of the cases that wait for their turn to start
// one finds that out, and all have theirs in the end.
TEST(SharedPoolThreads, CasesAtTheSameTimeShareTheOnlyConnection) {
  const ScriptFolder folder;
  const Listener listener(folder.file("s"));
  Descriptor only;
  std::thread server([&] {
    only = listener.accept_and_answer({capabilities_message(), echoed_message(), unsupported_message()});
  });
  DevicePool pool("unix:" + listener.path(), kValveNode, {milliseconds(2'000), milliseconds(20'000)});
  {
    auto first = pool.take();
    std::vector<std::thread> threads;
    for (int n = 0; n < 3; ++n) {
      threads.emplace_back([&] { EXPECT_EQ(failure_of([&] { pool.take().set_reusable(); }), ""); });
    }
    std::this_thread::sleep_for(milliseconds(2'500));
    first.set_reusable();
    {
      const auto returned = std::move(first);
    }
    for (std::thread& thread : threads) thread.join();
  }
  server.join();
  EXPECT_EQ(listener.accept_waiting(), 1U);
}

// It would wait for itself.
TEST(SharedPoolThreads, CaseThatNeedsTwoOfTheOnlyConnectionIsRefused) {
  const ScriptFolder folder;
  const Listener listener(folder.file("s"));
  Descriptor only;
  std::thread server([&] {
    only = listener.accept_and_answer({capabilities_message(), echoed_message(), unsupported_message()});
  });
  DevicePool pool("unix:" + listener.path(), kValveNode, {milliseconds(2'000), milliseconds(20'000)});
  const auto first = pool.take();
  EXPECT_THAT(failure_of([&] { pool.take(); }), HasSubstr("this case needs one more"));
  server.join();
}

TEST(SharedPoolThreads, CasesAtTheSameTimeDoNotShareOne) {
  const Script script = Script().tests_itself().stays();
  DevicePool pool("exec:script", kValveNode, script.command(), kNoHurry);
  std::mutex mutex;
  std::vector<const MessageDevice*> in_use;
  std::vector<std::thread> threads;
  for (int n = 0; n < 3; ++n) {
    threads.emplace_back([&] {
      for (int take = 0; take < 20; ++take) {
        auto lease = pool.take();
        {
          const std::scoped_lock lock(mutex);
          EXPECT_EQ(std::ranges::count(in_use, &*lease), 0);
          in_use.push_back(&*lease);
        }
        EXPECT_TRUE(lease->is_quiet());
        const std::scoped_lock lock(mutex);
        std::erase(in_use, &*lease);
        lease.set_reusable();
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
}

}  // namespace
}  // namespace fieldproof::iut
