// The Linux links against the emulated tracker behind a real pseudo-terminal and a real TCP port.
#include <fcntl.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <string>
#include <thread>

#include "board/linux/tcp_link.hpp"
#include "board/linux/tty_link.hpp"
#include "firmware-host/tracker/ndi_driver.hpp"
#include "tests/board/ports/byte_link_contract.hpp"
#include "tests/firmware-host/tracker/tracker_rig.hpp"
#include "tools/emulate/emulator_server.hpp"

namespace orcart::testing {

/// The emulated tracker served by a thread of its own, which ends with the object.
class ServedTracker {
 public:
  explicit ServedTracker(std::unique_ptr<EmulatorPort> port)
      : name(port->name()), port_(std::move(port)), thread_([this] { serve(); }) {}
  ~ServedTracker() {
    stop_.store(true, std::memory_order_relaxed);
    thread_.join();
  }
  const std::string name;

 private:
  void serve() {
    EmulatorServer server(device_, *port_);
    while (!stop_.load(std::memory_order_relaxed)) server.step(2ms);
  }

  CirclingTools motion_;
  NdiEmulator device_{{.has_line = false, .on_at = RealClock{}.now()}, motion_};
  std::unique_ptr<EmulatorPort> port_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

class TtyRig final : public ByteLinkRig {
 public:
  TtyRig()
      : served_(std::make_unique<ServedTracker>(open_pseudo_terminal().value())),
        link_(TtyLink::open(served_->name)) {}
  Clock& clock() override { return clock_; }
  ByteLink& link() override { return **link_; }
  void cut() override { served_.reset(); }
  bool mend() override { return false; }

 private:
  RealClock clock_;
  std::unique_ptr<ServedTracker> served_;
  Result<std::unique_ptr<TtyLink>> link_;
};

class TcpRig final : public ByteLinkRig {
 public:
  TcpRig() : served_(std::make_unique<ServedTracker>(open_tcp_port({.port = 0}).value())) {
    port_ = static_cast<std::uint16_t>(std::stoi(served_->name.substr(served_->name.find(':') + 1)));
    link_ = TcpLink::open({.host = "127.0.0.1", .port = port_}).value();
  }
  Clock& clock() override { return clock_; }
  ByteLink& link() override { return *link_; }
  void cut() override { served_.reset(); }
  bool mend() override {
    auto port = open_tcp_port({.port = port_});
    if (port) served_ = std::make_unique<ServedTracker>(std::move(*port));
    return port.has_value();
  }

 private:
  RealClock clock_;
  std::unique_ptr<ServedTracker> served_;
  std::uint16_t port_ = 0;
  std::unique_ptr<TcpLink> link_;
};

INSTANTIATE_TYPED_TEST_SUITE_P(PseudoTerminal, ByteLinkContract, TtyRig);
INSTANTIATE_TYPED_TEST_SUITE_P(Tcp, ByteLinkContract, TcpRig);

namespace {

/// Runs the driver on the wall clock until it has reported 20 device frames, at most for five seconds.
int frames_over(ByteLink& link, std::uint32_t baud) {
  RealClock clock;
  NdiDriver driver(two_tools(baud), link);
  const Instant end = clock.now() + 5s;
  int frames = 0;
  while (frames < 20 && clock.now() < end) {
    link.wait(std::min(end, driver.next_due()));
    frames += driver.step(clock.now()).new_reply ? 1 : 0;
  }
  return frames;
}

TEST(RealLinks, CarryTheDriverOverAPseudoTerminal) {
  TtyRig rig;
  EXPECT_EQ(frames_over(rig.link(), 921600), 20);
}

TEST(RealLinks, CarryTheDriverOverTcp) {
  TcpRig rig;
  EXPECT_EQ(frames_over(rig.link(), 0), 20);
}

/// A client that knows nothing of NDI: bytes out, and what comes back within a second or until a carriage
/// return.
class PlainClient {
 public:
  explicit PlainClient(const ServedTracker& served)
      : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    const int port = std::stoi(served.name.substr(served.name.find(':') + 1));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const timeval second{.tv_sec = 1, .tv_usec = 0};
    ::setsockopt(socket_.get(), SOL_SOCKET, SO_RCVTIMEO, &second, sizeof second);
    connected = ::connect(socket_.get(), reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
  }
  void say_no_more() { ::shutdown(socket_.get(), SHUT_WR); }
  void say(const std::string& bytes) { ::send(socket_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL); }
  /// "gone" where the other side hung up.
  std::string answer() {
    std::string all;
    char byte = 0;
    for (;;) {
      const ssize_t count = ::recv(socket_.get(), &byte, 1, 0);
      if (count == 0 || (count < 0 && errno == ECONNRESET)) return "gone";
      if (count < 0 || byte == '\r') return all;
      all += byte;
    }
  }
  bool connected = false;

 private:
  FileDescriptor socket_;
};

TEST(RealLinks, TheNextClientInheritsNothing) {
  const ServedTracker served(open_tcp_port({.port = 0}).value());
  {
    PlainClient first(served);
    first.say("INIT \r");
    EXPECT_EQ(first.answer().substr(0, 4), "OKAY");
    first.say("VER 4");  // and hangs up in the middle of a word
  }
  PlainClient second(served);
  second.say("INIT \r");
  EXPECT_EQ(second.answer().substr(0, 4), "OKAY");
}

// As `printf 'INIT \\r' | nc -N` does.
TEST(RealLinks, AClientThatClosesItsOwnDirectionStillGetsItsAnswer) {
  const ServedTracker served(open_tcp_port({.port = 0}).value());
  for (int client = 0; client < 2; ++client) {
    PlainClient hurried(served);
    hurried.say("INIT \r");
    hurried.say_no_more();
    EXPECT_EQ(hurried.answer().substr(0, 4), "OKAY");
    EXPECT_EQ(hurried.answer(), "gone");
  }
}

TEST(RealLinks, APseudoTerminalAnswersAProgramThatDoesNotTouchItsSettings) {
  const ServedTracker served(open_pseudo_terminal().value());
  const FileDescriptor terminal(::open(served.name.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  ASSERT_TRUE(terminal.valid());
  ASSERT_EQ(::write(terminal.get(), "INIT \r", 6), 6);
  RealClock{}.sleep_until(RealClock{}.now() + 300ms);
  std::string all(1000, '\0');
  const ssize_t count = ::read(terminal.get(), all.data(), all.size());
  all.resize(count < 0 ? 0 : static_cast<std::size_t>(count));
  EXPECT_EQ(all, "OKAYA896\r") << "once, and nothing of what it said itself";
}

TEST(RealLinks, APseudoTerminalThatNobodyHasOpenedHearsNothing) {
  const auto port = open_pseudo_terminal().value();
  const CirclingTools motion;
  const Instant start = RealClock{}.now();
  NdiEmulator device({.reset_time = 10ms, .has_line = false, .on_at = start}, motion);
  device.faults().add({.fault = NdiFault::reset, .from = start + 50ms});
  EmulatorServer server(device, *port);
  while (RealClock{}.now() < start + 300ms) server.step(2ms);
  EXPECT_GT(server.bytes_sent(), 0u) << "it did restart";
  EXPECT_EQ(server.bytes_received(), 0u);
}

TEST(RealLinks, ASecondClientIsPutOutAtOnceAndTheFirstGoesOn) {
  const ServedTracker served(open_tcp_port({.port = 0}).value());
  PlainClient first(served);
  first.say("INIT \r");
  EXPECT_EQ(first.answer().substr(0, 4), "OKAY");
  PlainClient second(served);
  EXPECT_TRUE(second.connected);
  EXPECT_EQ(second.answer(), "gone");
  first.say("INIT \r");
  EXPECT_EQ(first.answer().substr(0, 4), "OKAY");
}

/// Serves an emulator whose cable is out from half a second to one second after its start.
class CutTracker {
 public:
  explicit CutTracker(std::unique_ptr<EmulatorPort> port) : name(port->name()), port_(std::move(port)) {
    const Instant now = RealClock{}.now();
    device_.faults().add({.fault = NdiFault::cut, .from = now + 500ms, .until = now + 1s});
    thread_ = std::thread([this] {
      EmulatorServer server(device_, *port_);
      while (!stop_.load(std::memory_order_relaxed)) server.step(2ms);
    });
  }
  ~CutTracker() {
    stop_.store(true, std::memory_order_relaxed);
    thread_.join();
  }
  const std::string name;

 private:
  CirclingTools motion_;
  NdiEmulator device_{{.has_line = false, .on_at = RealClock{}.now()}, motion_};
  std::unique_ptr<EmulatorPort> port_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// Whether the driver lost the tracker and had it again with both tools, within ten seconds.
bool comes_back_over(ByteLink& link, std::uint32_t baud) {
  RealClock clock;
  NdiDriver driver(two_tools(baud), link);
  const Instant end = clock.now() + 10s;
  bool lost = false;
  while (clock.now() < end) {
    link.wait(std::min(end, driver.next_due()));
    const DriverReport report = driver.step(clock.now());
    lost = lost || report.trouble == TrackerTrouble::disconnected;
    if (lost && report.new_reply && driver.reply().tools[1].state == ToolState::seen) return true;
  }
  return false;
}

TEST(RealLinks, ComeBackAfterTheCableOfAPseudoTerminalWasOut) {
  const std::string link = ::testing::TempDir() + "orcart-cut-tty";
  CutTracker tracker(open_pseudo_terminal(link).value());
  EXPECT_EQ(tracker.name, link);
  const auto tty = TtyLink::open(link);
  ASSERT_TRUE(tty) << tty.error().message;
  EXPECT_TRUE(comes_back_over(**tty, 921600));
}

TEST(RealLinks, ComeBackAfterTheNetworkCableWasOut) {
  CutTracker tracker(open_tcp_port({.port = 0}).value());
  const auto port = static_cast<std::uint16_t>(std::stoi(tracker.name.substr(tracker.name.find(':') + 1)));
  const auto tcp = TcpLink::open({.host = "127.0.0.1", .port = port});
  ASSERT_TRUE(tcp) << tcp.error().message;
  EXPECT_TRUE(comes_back_over(**tcp, 0));
}

/// Listens, but nobody takes the connections: once the queue is full nothing answers, as a device that
/// restarts.
class DeafListener {
 public:
  DeafListener() {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    ok = ::bind(socket_.get(), reinterpret_cast<sockaddr*>(&address), size) == 0 &&
         ::listen(socket_.get(), 0) == 0 &&
         ::getsockname(socket_.get(), reinterpret_cast<sockaddr*>(&address), &size) == 0;
    port = ntohs(address.sin_port);
  }
  bool ok = false;
  std::uint16_t port = 0;

 private:
  FileDescriptor socket_{::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)};
};

TEST(RealLinks, WaitForANetworkDeviceThatRestartsNoLongerThanAThreadMayStandStill) {
  const DeafListener listener;
  ASSERT_TRUE(listener.ok);
  auto link = TcpLink::open({.host = "127.0.0.1", .port = listener.port});
  ASSERT_TRUE(link) << link.error().message;
  RealClock clock;
  Nanos longest{};
  bool refused = false;
  for (int tries = 0; tries < 4 && !refused; ++tries) {
    const Instant begin = clock.now();
    refused = !(*link)->reopen();
    longest = std::max(longest, clock.now() - begin);
  }
  EXPECT_TRUE(refused);
  EXPECT_GE(longest, TcpLink::kReopenPatience - 1ms);
  EXPECT_LT(longest, 500ms) << "was 2 s: the watchdog ended the cart";
}

TEST(UnixPort, ServesOneClientAfterTheOther) {
  const std::string file = ::testing::TempDir() + "emulated-tracker-" + std::to_string(::getpid());
  const ServedTracker served(open_unix_port(file).value());
  EXPECT_EQ(served.name, file);
  for (int client = 0; client < 2; ++client) {
    const FileDescriptor line(::socket(AF_UNIX, SOCK_STREAM, 0));
    sockaddr_un address{.sun_family = AF_UNIX, .sun_path = {}};
    file.copy(address.sun_path, sizeof address.sun_path - 1);
    ASSERT_EQ(::connect(line.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    ASSERT_EQ(::send(line.get(), "INIT:E3A5\r", 10, MSG_NOSIGNAL), 10);
    std::array<char, 10> answer{};
    EXPECT_EQ(::recv(line.get(), answer.data(), 9, MSG_WAITALL), 9);
    EXPECT_STREQ(answer.data(), "OKAYA896\r");
  }
  ::unlink(file.c_str());
}

TEST(UnixPort, IsRefusedInASentenceWhereItCannotBe) {
  EXPECT_NE(open_unix_port(std::string(200, 'a')).error().message.find("1 to 107 bytes would be accepted"),
            std::string::npos);
  EXPECT_NE(open_unix_port("/no-such-folder/tracker").error().message.find("cannot be listened on"),
            std::string::npos);
}

TEST(RealLinks, SayInASentenceWhyTheyCannotBeOpened) {
  const auto absent = TtyLink::open("/dev/no-such-tracker");
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.error().message,
            "tracker device /dev/no-such-tracker cannot be opened: disconnected; plug the tracker in, or "
            "name another "
            "device");
  EXPECT_NE(TtyLink::open("/dev/null").error().message.find("a serial device such as /dev/ttyUSB0"),
            std::string::npos);
  const auto refused = TcpLink::open({.host = "127.0.0.1", .port = 1}, 100ms);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("does not answer"), std::string::npos);
}

}  // namespace
}  // namespace orcart::testing
