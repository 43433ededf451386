// orcart emulate: devices of the cart for any other program to talk to.
#include <csignal>
#include <cstdio>
#include <memory>

#include "firmware-host/tracker/ndi/tool_definition.hpp"
#include "tools/emulate/circling_tools.hpp"
#include "tools/emulate/emulator_server.hpp"
#include "tools/emulate/fault_argument.hpp"
#include "tools/orcart/verbs.hpp"

namespace orcart {
namespace {

constexpr const char* kExample =
    "Examples:\n"
    "  orcart emulate tracker --pty --noise 0.1\n"
    "  orcart emulate tracker --tcp 8765 --fault silence@10-12 --fault bad-crc@20/50 --for 60\n"
    "  orcart emulate tracker --unix tracker.socket\n"
    "  orcart emulate tracker --pty --link /tmp/ttyNDI --model polaris --fault cut@10-15\n\n"
    "Clients upload their tools as to a real device; each then goes round on a slow circle, 1.5 m in front "
    "of the\n"
    "sensor. --rom plugs a tool in as a wired one. A fault is KIND[:AMOUNT][@FROM[-UNTIL]][/EVERY], in "
    "seconds from\n"
    "the start; KIND is silence, late (AMOUNT ms), truncated (after AMOUNT bytes), garbage, bad-crc, "
    "wrong-handle,\n"
    "frozen-frame, infrared, disabled or unplugged (tool AMOUNT), reset, bump, alert (bit AMOUNT of "
    "Info.Status.Alerts),\n"
    "or cut (the cable is out; with --link the terminal comes back under the same name).";

volatile std::sig_atomic_t stop_requested = 0;
void request_stop(int) {
  stop_requested = 1;
}

struct Arguments {
  bool pty = false;
  int tcp_port = -1;
  std::string socket;
  std::string listen = "127.0.0.1";
  std::string link;
  std::string model = "vega";
  std::vector<std::string> roms;
  std::vector<std::string> faults;
  double rate_hz = 60;
  double noise_mm = 0;
  double drift_ppm = 0;
  std::uint64_t seed = 1;
  double for_s = 0;
  bool wire_time = false;
};

Result<std::unique_ptr<EmulatorPort>> open_port(const Arguments& arguments) {
  if (arguments.pty) return open_pseudo_terminal(arguments.link);
  if (!arguments.socket.empty()) return open_unix_port(arguments.socket);
  return open_tcp_port({.address = arguments.listen, .port = static_cast<std::uint16_t>(arguments.tcp_port)});
}

Result<void> prepare(NdiEmulator& device, const Arguments& arguments, Instant start) {
  for (const std::string& file : arguments.roms) {
    const auto tool = ndi::read_tool_definition(file);
    if (!tool) return tl::unexpected(tool.error());
    if (!device.plug_in(tool->memory))
      return fail("--rom " + file + " is one too many; at most 4 would be accepted");
  }
  for (const std::string& text : arguments.faults) {
    const auto fault = parse_fault(text, start);
    if (!fault) return tl::unexpected(fault.error());
    if (!device.faults().add(*fault))
      return fail("--fault " + text + " is one too many; at most 32 would be accepted");
  }
  return {};
}

Result<void> serve(const Arguments& arguments) {
  const Instant start = RealClock{}.now();
  const CirclingTools motion;
  const auto device = std::make_unique<NdiEmulator>(
      NdiEmulatorSettings{.model = ndi_model_named(arguments.model).value_or(NdiModel::vega),
                          .frame_rate_hz = arguments.rate_hz,
                          .clock_drift_ppm = arguments.drift_ppm,
                          .has_line = arguments.wire_time,
                          .noise = {.sigma_mm = arguments.noise_mm, .seed = arguments.seed},
                          .on_at = start},
      motion);
  if (const auto prepared = prepare(*device, arguments, start); !prepared) return prepared;
  const auto port = open_port(arguments);
  if (!port) return tl::unexpected(port.error());
  std::printf("%s\n", (*port)->name().c_str());
  std::fflush(stdout);
  std::signal(SIGINT, request_stop);
  std::signal(SIGTERM, request_stop);
  EmulatorServer server(*device, **port);
  const Instant end = arguments.for_s > 0 ? start + from_seconds(arguments.for_s) : Instant::max();
  while (stop_requested == 0 && RealClock{}.now() < end) server.step(20ms);
  std::fprintf(stderr, "%llu replies, %llu bytes in, %llu bytes out\n",
               static_cast<unsigned long long>(device->replies_sent()),
               static_cast<unsigned long long>(server.bytes_received()),
               static_cast<unsigned long long>(server.bytes_sent()));
  return {};
}

}  // namespace

void add_emulate(CLI::App& app, int& exit_code) {
  CLI::App* emulate = app.add_subcommand("emulate", "Play a device of the cart for another program");
  emulate->require_subcommand(1);
  CLI::App* tracker = emulate->add_subcommand("tracker", "An NDI Polaris or Vega");
  tracker->footer(kExample);
  const auto arguments = std::make_shared<Arguments>();
  auto* where = tracker->add_option_group("where", "one of the three");
  where->add_flag("--pty", arguments->pty, "on a pseudo-terminal, whose name is printed");
  where->add_option("--tcp", arguments->tcp_port, "on a TCP port (a Vega has 8765; 0: any free one)")
      ->check(CLI::Range(0, 65535));
  where->add_option("--unix", arguments->socket,
                    "on a socket in the file system, such as a virtual machine's serial port connects to");
  where->require_option(1);
  tracker->add_option("--listen", arguments->listen, "IPv4 address for --tcp; this machine alone by default")
      ->capture_default_str();
  tracker
      ->add_option("--link", arguments->link, "a symbolic link to the pseudo-terminal, for a name that stays")
      ->needs("--pty");
  tracker
      ->add_option(
          "--model", arguments->model,
          "which device to play: what each knows differs (polaris: no GET, no BX2, at most 115200 baud)")
      ->check(CLI::IsMember({"polaris", "spectra", "vega", "lyra", "aurora"}))
      ->capture_default_str();
  tracker->add_option("--rom", arguments->roms, "a tool definition that is plugged in from the start");
  tracker->add_option("--rate", arguments->rate_hz, "frames in a second")
      ->check(CLI::Range(1.0, 400.0))
      ->capture_default_str();
  tracker->add_option("--noise", arguments->noise_mm, "standard deviation on each axis of each marker, mm")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str();
  tracker->add_option("--drift", arguments->drift_ppm, "of the device's clock, ppm")
      ->check(CLI::Range(-1000.0, 1000.0))
      ->capture_default_str();
  tracker->add_option("--seed", arguments->seed, "of the noise")->capture_default_str();
  tracker->add_option("--fault", arguments->faults, "KIND[:AMOUNT][@FROM[-UNTIL]][/EVERY]");
  tracker->add_flag("--wire-time", arguments->wire_time,
                    "bytes take as long as on a line at the device's baud rate");
  tracker->add_option("--for", arguments->for_s, "seconds; until interrupted by default")
      ->check(CLI::PositiveNumber);
  tracker->callback([arguments, &exit_code] {
    const auto served = serve(*arguments);
    if (!served) std::fprintf(stderr, "orcart emulate: %s\n", served.error().message.c_str());
    exit_code = served ? 0 : 1;
  });
}

}  // namespace orcart
