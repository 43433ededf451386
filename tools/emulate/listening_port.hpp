// A listening socket as the emulated tracker's far end: whoever connects is its client.
#pragma once

#include <functional>
#include <string>
#include <utility>

#include "tools/emulate/emulator_port.hpp"

namespace orcart {

/// Serves one client of a socket that listens already; a second one is let in and put out at once, so that it
/// need not wait for an answer. A client that has closed its own direction only still gets what it asked for,
/// unless another is at the door. One thread.
class ListeningPort final : public EmulatorPort {
 public:
  /// `again` listens at the same place once more, after the cable was out.
  using Listen = std::function<Result<FileDescriptor>()>;
  ListeningPort(FileDescriptor listener, std::string name, Listen again) noexcept
      : listener_(std::move(listener)), name_(std::move(name)), again_(std::move(again)) {}

  const std::string& name() const override { return name_; }
  void wait(Nanos time) override;
  bool take_arrival() override { return std::exchange(arrived_, false); }
  std::size_t read(std::span<std::byte> into) override;
  void write(std::span<const std::byte> bytes) override;
  void owe_nothing() override;
  std::uint32_t baud() override { return 0; }
  void cut() override;
  void mend() override;

 private:
  void admit();
  void turn_away();

  FileDescriptor listener_;
  FileDescriptor client_;
  std::string name_;
  Listen again_;
  bool arrived_ = false;
  bool said_all_ = false;  ///< the client; it may still listen
};

}  // namespace orcart
