// Where a client of the emulated tracker comes in: a pseudo-terminal, a TCP port of this machine, or a socket
// in its file system.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "board/linux/file_descriptor.hpp"
#include "realtime/base/instant.hpp"
#include "realtime/base/result.hpp"

namespace orcart {

/// One client at a time; after it has gone the next may come. One thread.
class EmulatorPort {
 public:
  virtual ~EmulatorPort() = default;
  /// What a client has to be told to open.
  virtual const std::string& name() const = 0;
  /// Sleeps until the client sent something or `time` is over; at most a few milliseconds where no client is
  /// there.
  virtual void wait(Nanos time) = 0;
  /// Whether a client came in since this was asked last; false where that cannot be told.
  virtual bool take_arrival() { return false; }
  /// 0 where there is nothing, or nobody.
  virtual std::size_t read(std::span<std::byte> into) = 0;
  virtual void write(std::span<const std::byte> bytes) = 0;
  /// The client is owed nothing now: one that has said that it will say no more may be let go.
  virtual void owe_nothing() {}
  /// The baud rate that the client has set; 0 where it cannot be told, or nobody is there.
  virtual std::uint32_t baud() = 0;
  /// As if the cable were pulled: whoever is there loses it, and nobody can come in. Again: no effect.
  virtual void cut() = 0;
  /// Plugs the cable in again, under the same name where that can be.
  virtual void mend() = 0;
};

/// `link`, where it is not empty, is made a symbolic link to the terminal: a name that stays. One that is
/// there already is written over; any other file is refused.
Result<std::unique_ptr<EmulatorPort>> open_pseudo_terminal(const std::string& link = {});

struct ListenAddress {
  std::string address = "127.0.0.1";
  std::uint16_t port = 8765;  ///< 0: any free one
};
Result<std::unique_ptr<EmulatorPort>> open_tcp_port(const ListenAddress& at);

/// Takes the place of a socket that lies there already.
Result<std::unique_ptr<EmulatorPort>> open_unix_port(const std::string& file);

}  // namespace orcart
