// The service manager's datagrams, and signs of life that end when a thread hangs.
#include "firmware-host/app/heartbeat.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

namespace orcart {
namespace {

/// A service manager of our own: an abstract datagram socket.
class Manager {
 public:
  Manager() : name_("@orcart-test-" + std::to_string(::getpid())) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    name_.copy(address.sun_path, sizeof address.sun_path - 1);
    address.sun_path[0] = '\0';
    fd_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    EXPECT_EQ(::bind(fd_, reinterpret_cast<sockaddr*>(&address),
                     static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name_.size())),
              0);
  }
  ~Manager() { ::close(fd_); }
  const std::string& name() const { return name_; }
  /// The next datagram; empty where there is none.
  std::string heard() {
    std::array<char, 256> text{};
    const ssize_t size = ::recv(fd_, text.data(), text.size(), 0);
    return size > 0 ? std::string(text.data(), static_cast<std::size_t>(size)) : "";
  }

 private:
  std::string name_;
  int fd_ = -1;
};

struct Watched {
  Manager manager;
  ServiceManager service{manager.name(), 400ms};
  ThreadLedger camera, render;
  HeartbeatStage heartbeat{service, {{"camera", &camera}, {"render", &render}}};
  Instant now = instant_from_nanos(1'000'000'000);

  void move(ThreadLedger& thread) { thread.turns.fetch_add(1, std::memory_order_relaxed); }
  void step_after(Nanos time) {
    now += time;
    heartbeat.step(now);
  }
};

TEST(Heartbeat, IsSentAQuarterOfThePatienceApartWhileEveryThreadMoves) {
  Watched cart;
  int signs = 0;
  for (int look = 0; look < 20; ++look) {
    cart.move(cart.camera);
    cart.move(cart.render);
    cart.step_after(HeartbeatStage::kLook);
    for (std::string heard = cart.manager.heard(); !heard.empty(); heard = cart.manager.heard()) {
      EXPECT_EQ(heard, "WATCHDOG=1");
      ++signs;
    }
  }
  EXPECT_EQ(signs, 10) << "20 looks of 50 ms, a sign each 100 ms";
}

TEST(Heartbeat, EndsBetween100And250MillisecondsAfterAThreadHungAndSaysWhich) {
  Watched cart;
  cart.step_after(HeartbeatStage::kLook);
  const Instant hung_at = cart.now;
  Instant noticed{};
  for (int look = 0; look < 8 && noticed == Instant{}; ++look) {
    cart.move(cart.camera);
    cart.step_after(HeartbeatStage::kLook);
    if (!cart.heartbeat.hung().empty()) noticed = cart.now;
  }
  EXPECT_EQ(cart.heartbeat.hung(), "render");
  EXPECT_GE(noticed - hung_at, 100ms);
  EXPECT_LE(noticed - hung_at, 250ms);
  std::string last, heard;
  while (!(heard = cart.manager.heard()).empty()) last = heard;
  EXPECT_EQ(last, "STATUS=thread render hangs: no sign of life until it moves");
  for (int look = 0; look < 20; ++look) {
    cart.move(cart.camera);
    cart.step_after(HeartbeatStage::kLook);
  }
  EXPECT_EQ(cart.manager.heard(), "") << "no sign of life from a cart that hangs";
}

TEST(Heartbeat, GoesOnWhenTheThreadMovesAgain) {
  Watched cart;
  for (int look = 0; look < 10; ++look) cart.step_after(HeartbeatStage::kLook);
  EXPECT_FALSE(cart.heartbeat.hung().empty());
  while (!cart.manager.heard().empty()) {
  }
  cart.move(cart.camera);
  cart.move(cart.render);
  cart.step_after(HeartbeatStage::kLook);
  EXPECT_TRUE(cart.heartbeat.hung().empty());
  EXPECT_EQ(cart.manager.heard(), "STATUS=thread camera moves again");
  EXPECT_EQ(cart.manager.heard(), "WATCHDOG=1");
}

TEST(Heartbeat, SaysThatTheCartIsReadyAndThatItStops) {
  Manager manager;
  RealClock clock;
  { const Heartbeat heartbeat(ServiceManager(manager.name(), 0ms), {}, clock); }
  EXPECT_EQ(manager.heard(), "READY=1\nSTATUS=running");
  EXPECT_EQ(manager.heard(), "STOPPING=1");
}

TEST(ServiceManager, IsFoundInTheEnvironment) {
  ::setenv("NOTIFY_SOCKET", "/run/notify", 1);
  ::setenv("WATCHDOG_USEC", "2000000", 1);
  ::unsetenv("WATCHDOG_PID");
  EXPECT_TRUE(ServiceManager::from_environment().present());
  EXPECT_EQ(ServiceManager::from_environment().watchdog(), 2s);
  ::setenv("WATCHDOG_PID", "1", 1);
  EXPECT_EQ(ServiceManager::from_environment().watchdog(), 0s) << "meant for another process";
  ::unsetenv("NOTIFY_SOCKET");
  EXPECT_FALSE(ServiceManager::from_environment().present());
  ::unsetenv("WATCHDOG_USEC");
  ::unsetenv("WATCHDOG_PID");
}

TEST(ServiceManager, LosesNothingWhereNobodyListens) {
  EXPECT_FALSE(ServiceManager().tell("READY=1"));
  EXPECT_FALSE(ServiceManager("/no-such-folder/notify", 0ms).tell("READY=1"));
  EXPECT_FALSE(ServiceManager(std::string(300, '/'), 0ms).tell("READY=1"));
}

}  // namespace
}  // namespace orcart
